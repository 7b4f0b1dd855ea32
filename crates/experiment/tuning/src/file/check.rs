//! What a study file says, held against itself and its case.

use super::{
    AcquisitionName, Cheaper, FIX, KernelName, Raw, RawBudget, RawCheaper, RawDesign, RawVariable,
    TuningFile, Variable, WHAT, case_path,
};
use crate::TuningError;
use analysis::statistics::BLOCK_LENGTH;
use formats::{FileError, shipped};
use search::{Acquisition, Axis, Design, Shape};
use std::ops::Range;
use std::path::Path;
use study::StudyError;
use toml::Spanned;

/// Wöhler's exponents of composite blades and of steel (–), as in summaries.
const SLOPES: [f64; 2] = [10.0, 4.0];

/// The file's text, for places in it.
struct Text<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Text<'_> {
    /// That what stands at `span` under `key` is not as `expected`; `fix` says how to fix it.
    fn refused(&self, span: Range<usize>, key: &str, expected: &str, fix: &str) -> TuningError {
        let line = 1 + self.text[..span.start.min(self.text.len())].matches('\n').count();
        let problem = format!("line {line}, `{key}`: {expected}");
        FileError::content(WHAT, self.path, problem, fix).into()
    }
}

/// `raw` of the file at `path` with `text`, checked.
pub(super) fn checked(raw: Raw, path: &Path, text: String) -> Result<TuningFile, TuningError> {
    let place = Text { path, text: &text };
    let case = case_path(path, raw.case.get_ref());
    let (run, baseline) = runs(&raw, &case, &place)?;
    let super::Objective::Power = raw.objective;
    let variables =
        raw.variable.iter().map(|one| variable(one, &place)).collect::<Result<Vec<_>, _>>()?;
    if variables.is_empty() {
        return Err(place.refused(0..0, "variable", "one or more are expected", FIX));
    }
    let (n_runs, parallel, least_gain) = budget(raw.budget.get_ref(), &place)?;
    let block = block(raw.block.as_ref(), &place)?;
    let (design, n_first) = design(raw.design.as_ref(), &variables, n_runs, &place)?;
    let mut file = TuningFile {
        path: path.to_owned(),
        text: String::new(),
        case,
        run,
        baseline,
        variables,
        block,
        shape: shape(raw.kernel),
        acquisition: acquisition(raw.acquisition),
        design,
        n_first,
        budget: n_runs,
        least_gain,
        parallel,
        seed: raw.seed,
        loads: raw.loads.as_ref().map_or(Vec::new(), |loads| {
            let loads = loads.get_ref();
            let slope = |channel: &String| loads.exponent.unwrap_or_else(|| usual_slope(channel));
            loads.channels.iter().map(|channel| (channel.clone(), slope(channel))).collect()
        }),
        set: Vec::new(),
        cheaper: Vec::new(),
    };
    ends_are_sound(&file, &raw.variable, &place)?;
    for one in &raw.cheaper {
        let found = cheaper(one, &file, &place)?;
        file.cheaper.push(found);
        let index = file.cheaper.len() - 1;
        ends_are_sound(&file.of_cheaper(index), &raw.variable, &place)?;
    }
    file.text = text;
    Ok(file)
}

/// Runs, runs at a time, and the least gain that another run is made for.
fn budget(budget: &RawBudget, place: &Text) -> Result<(usize, usize, Option<f64>), TuningError> {
    let positive = |number: &Spanned<usize>, key: &str| {
        let n = *number.get_ref();
        let expected = "a number of 1 or more is expected";
        let refused = || place.refused(number.span(), key, expected, FIX);
        if n > 0 { Ok(n) } else { Err(refused()) }
    };
    let n_runs = positive(&budget.runs, "budget.runs")?;
    let parallel = budget.parallel.as_ref().map_or(Ok(1), |n| positive(n, "budget.parallel"))?;
    let Some(least) = &budget.least_gain else { return Ok((n_runs, parallel, None)) };
    let value = *least.get_ref();
    if value > 0.0 && value < 1.0 {
        return Ok((n_runs, parallel, Some(value)));
    }
    let (key, expected) = ("budget.least_gain", "a share above 0 and below 1 is expected");
    let fix = "write 0.001 for a thousandth of the baseline's power";
    Err(place.refused(least.span(), key, expected, fix))
}

/// A source of cheaper data.
fn cheaper(
    spanned: &Spanned<RawCheaper>,
    file: &TuningFile,
    place: &Text,
) -> Result<Cheaper, TuningError> {
    let RawCheaper { name, case, set, runs } = spanned.get_ref();
    let refused = |key: &str, expected: &str, fix: &str| {
        Err(place.refused(spanned.span(), key, expected, fix))
    };
    let is_folder = |letter: char| letter.is_alphanumeric() || letter == '-' || letter == '_';
    let is_taken = name == "baseline" || name.starts_with("point-") || name == "figures";
    if name.is_empty() || is_taken || !name.chars().all(is_folder) {
        let expected = "letters, digits and - are expected, and no name of another folder";
        return refused("cheaper.name", expected, "write name = \"coarse\", say");
    }
    if file.cheaper.iter().any(|other| other.name == *name) {
        let expected = format!("two are called {name}");
        return refused("cheaper.name", &expected, "give each a name of its own");
    }
    if case.is_none() && set.is_empty() {
        let expected = "`case` or `set` is expected: else it is the case that is tuned";
        return refused("cheaper", expected, "write set = [\"flow.cells_per_diameter=8\"], say");
    }
    if *runs.get_ref() < 2 {
        let fix = "as many as fill the ranges: ten for two variables, say";
        return Err(place.refused(runs.span(), "cheaper.runs", "2 or more are expected", fix));
    }
    let case = case.as_ref().map_or(file.case.clone(), |name| case_path(place.path, name));
    let read = shipped::read(&case, set);
    let found = match read {
        Ok(found) => found,
        Err(error) => {
            let lines = error.to_lines();
            let first = lines.lines().next().unwrap_or_default();
            let expected = format!("the case {} cannot be read: {first}", case.display());
            return refused(
                "cheaper.set",
                &expected,
                "name keys of that case; docs/case-file.md lists them",
            );
        }
    };
    for run in [&file.run, &file.baseline] {
        if !found.case.runs.iter().any(|own| own.name == *run) {
            let expected = format!("the case {} has no run called `{run}`", case.display());
            return refused(
                "cheaper.case",
                &expected,
                "give it the runs of the case that is tuned",
            );
        }
    }
    Ok(Cheaper { name: name.clone(), case, set: set.clone(), n_runs: *runs.get_ref() })
}

/// Length of a block (s).
fn block(block: Option<&Spanned<f64>>, place: &Text) -> Result<f64, TuningError> {
    let Some(block) = block else { return Ok(BLOCK_LENGTH) };
    let value = *block.get_ref();
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    let fix = "write 600 for ten minutes, or leave it out";
    Err(place.refused(block.span(), "block", "seconds above 0 are expected", fix))
}

/// Wöhler's exponent of the moment `channel` unless the file gives one (–).
fn usual_slope(channel: &str) -> f64 {
    let name = channel.rsplit_once('.').map_or(channel, |(_, name)| name);
    if name.starts_with("Root") { SLOPES[0] } else { SLOPES[1] }
}

fn shape(name: KernelName) -> Shape {
    match name {
        KernelName::Matern32 => Shape::Matern32,
        KernelName::Matern52 => Shape::Matern52,
        KernelName::SquaredExponential => Shape::SquaredExponential,
    }
}

fn acquisition(name: AcquisitionName) -> Acquisition {
    match name {
        AcquisitionName::ExpectedImprovement => Acquisition::ExpectedImprovement,
        AcquisitionName::KnowledgeGradient => Acquisition::KnowledgeGradient,
        AcquisitionName::UpperBound => Acquisition::UpperBound,
    }
}

/// Names of the run that is tuned and of its baseline.
fn runs(raw: &Raw, case: &Path, place: &Text) -> Result<(String, String), TuningError> {
    let file = shipped::read(case, &[]).map_err(StudyError::from)?;
    let runs = &file.case.runs;
    let names = runs.iter().map(|run| run.name.as_str()).collect::<Vec<_>>().join(", ");
    let fix = format!("its runs are {names}");
    let find = |name: &Spanned<String>, key: &str| {
        let expected =
            format!("the case {} has no run called `{}`", case.display(), name.get_ref());
        let found = runs.iter().find(|run| run.name == *name.get_ref());
        found.ok_or_else(|| place.refused(name.span(), key, &expected, &fix))
    };
    let run = find(&raw.run, "run")?;
    let compared = match (&raw.baseline, &run.compare_with) {
        (Some(baseline), _) => find(baseline, "baseline")?.name.clone(),
        (None, Some(other)) => other.clone(),
        (None, None) => runs[0].name.clone(),
    };
    if compared == run.name {
        let expected = format!("the run `{compared}` compares with none");
        let fix = format!("name the run that it is to gain over with `baseline`; {fix}");
        return Err(place.refused(raw.run.span(), "run", &expected, &fix));
    }
    Ok((run.name.clone(), compared))
}

/// One variable.
fn variable(raw: &Spanned<RawVariable>, place: &Text) -> Result<Variable, TuningError> {
    let RawVariable { key, name, unit, from, to, step, mirrored } = raw.get_ref();
    let (low, high) = (*from.get_ref(), *to.get_ref());
    if !(low.is_finite() && high.is_finite() && low < high) {
        let expected = format!("a number above `from`, {low}, is expected");
        return Err(place.refused(
            to.span(),
            "variable.to",
            &expected,
            "give ranges from less to more",
        ));
    }
    let last = key.get_ref().rsplit('.').next().unwrap_or_default();
    if *mirrored && last != "strouhal" {
        let expected =
            "only a Strouhal number, whose sign is the sense of a helix, can be mirrored";
        let fix = "leave `mirrored` out, or name the key `control.TURBINE.strouhal`";
        return Err(place.refused(key.span(), "variable.key", expected, fix));
    }
    if *mirrored && low <= 0.0 {
        let expected =
            "of a mirrored variable a number above 0 is expected, the least in either sense";
        return Err(place.refused(from.span(), "variable.from", expected, "write 0.05, say"));
    }
    let plain = if *mirrored { Axis::mirrored(low, high) } else { Axis::new(low, high) };
    let step = match step {
        Some(step) if !(*step.get_ref() > 0.0 && *step.get_ref() <= high - low) => {
            let expected = format!("a number above 0, of {} at most, is expected", high - low);
            return Err(place.refused(
                step.span(),
                "variable.step",
                &expected,
                "leave it out for any value",
            ));
        }
        step => step.as_ref().map(|step| *step.get_ref()),
    };
    Ok(Variable {
        name: name
            .clone()
            .unwrap_or_else(|| if last == "strouhal" { "St".to_owned() } else { last.to_owned() }),
        key: key.get_ref().clone(),
        unit: if unit.is_empty() && last.ends_with("_deg") {
            "°".to_owned()
        } else {
            unit.clone()
        },
        axis: Axis { step, ..plain },
    })
}

/// The first design and its points.
fn design(
    raw: Option<&Spanned<RawDesign>>,
    variables: &[Variable],
    n_runs: usize,
    place: &Text,
) -> Result<(Design, usize), TuningError> {
    let usual = (3 * variables.len()).max(4).min(n_runs);
    let Some(spanned) = raw else { return Ok((Design::Hypercube, usual)) };
    let raw = spanned.get_ref();
    let fewest = |n: usize, span: Range<usize>, key: &str| {
        if (2..=n_runs).contains(&n) {
            return Ok(());
        }
        let expected =
            format!("2 to {n_runs} points are expected, as many as `budget.runs` at most");
        Err(place.refused(span, key, &expected, "four for one variable, six for two are usual"))
    };
    let Some(points) = &raw.points else {
        let Some(first) = &raw.first else { return Ok((Design::Hypercube, usual)) };
        fewest(*first.get_ref(), first.span(), "design.first")?;
        return Ok((Design::Hypercube, *first.get_ref()));
    };
    if raw.first.is_some() {
        let expected = "either `first` or `points` is expected, not both";
        return Err(place.refused(spanned.span(), "design", expected, "take one of them away"));
    }
    fewest(points.get_ref().len(), points.span(), "design.points")?;
    let is_in = |point: &Vec<f64>| {
        let holds = |(variable, value): (&Variable, &f64)| {
            (variable.axis.from..=variable.axis.to).contains(value)
                && value.abs() >= variable.axis.gap
        };
        point.len() == variables.len() && variables.iter().zip(point).all(holds)
    };
    if let Some(index) = points.get_ref().iter().position(|point| !is_in(point)) {
        let n = variables.len();
        let expected =
            format!("point {} is not {n} numbers within the ranges of the variables", index + 1);
        return Err(place.refused(
            points.span(),
            "design.points",
            &expected,
            "give a number for each variable, in their order",
        ));
    }
    Ok((Design::Points(points.get_ref().clone()), points.get_ref().len()))
}

/// Nothing where the case can be read with both ends of every variable.
fn ends_are_sound(
    file: &TuningFile,
    raw: &[Spanned<RawVariable>],
    place: &Text,
) -> Result<(), TuningError> {
    for (variable, raw) in file.variables.iter().zip(raw) {
        for value in [variable.axis.from, variable.axis.to] {
            let overrides = [file.set.clone(), variable.overrides(&file.run, value)].concat();
            if let Err(error) = shipped::read(&file.case, &overrides) {
                let lines = error.to_lines();
                let first = lines.lines().next().unwrap_or_default();
                let expected =
                    format!("the case cannot be run with {}: {first}", overrides.join(" "));
                let fix = "name a key of the case, and a range that it takes; docs/case-file.md lists them";
                return Err(place.refused(
                    raw.get_ref().key.span(),
                    "variable.key",
                    &expected,
                    fix,
                ));
            }
        }
    }
    Ok(())
}
