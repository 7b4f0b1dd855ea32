//! The page of a tuning.

use crate::{Compromise, Tuned, TuningError, figures};
use report::{AnswerRecords, AnswerTable};
use search::Normal;

/// Probability of the optimum's place that is told of (–).
const LEAST_TOLD: f64 = 0.02;
/// Places that are told of (–).
const MOST_PLACES: usize = 10;

/// Writes the page and the figures of `tuned` into its folder.
///
/// # Errors
/// [`TuningError::Report`].
pub(crate) fn write(tuned: &Tuned) -> Result<(), TuningError> {
    let optimum = &tuned.found.optimum;
    let records = AnswerRecords {
        kind: "Tuning".to_owned(),
        name: tuned.file.run.clone(),
        headline: format!(
            "The array gains {} with {}.",
            percent(&optimum.value),
            tuned.file.words(&optimum.point)
        ),
        warnings: warnings(tuned),
        facts: facts(tuned),
        tables: tables(tuned),
        signals: vec![figures::all(tuned)?],
        file: Some(["The study".to_owned(), tuned.file.text.clone()]),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    report::write_answer(&records, &tuned.directory)?;
    Ok(())
}

/// "7.50 ± 1.20 %".
fn percent(value: &Normal) -> String {
    let [_, high] = value.band_95();
    format!("{:.2} ± {:.2} %", 100.0 * value.mean, 100.0 * (high - value.mean))
}

/// What a reader of the numbers must know.
fn warnings(tuned: &Tuned) -> Vec<String> {
    let mut warnings = Vec::new();
    let optimum = &tuned.found.optimum;
    for (variable, value) in tuned.file.variables.iter().zip(&optimum.point) {
        if *value == variable.axis.from || *value == variable.axis.to {
            warnings.push(format!(
                "the optimum lies at the end of the range of {}; more may be gained beyond it",
                variable.name
            ));
        }
    }
    let [low, _] = optimum.value.band_95();
    if low <= 0.0 {
        warnings.push(
            "the interval of the gain holds zero: these runs do not tell that there is any"
                .to_owned(),
        );
    }
    let n_blocks =
        tuned.found.history.evaluations.iter().flat_map(|one| &one.outputs).map(Vec::len).min();
    if n_blocks == Some(1) {
        warnings.push(
            "each run has one block: the noise is guessed from the scatter about the curve, not known from replicates"
                .to_owned(),
        );
    }
    warnings
}

/// What it is, value with unit, remark.
fn fact(what: &str, value: impl ToString, remark: impl ToString) -> [String; 3] {
    [what.to_owned(), value.to_string(), remark.to_string()]
}

fn facts(tuned: &Tuned) -> Vec<[String; 3]> {
    let found = &tuned.found;
    let optimum = &found.optimum;
    let mut facts = Vec::new();
    for ((variable, value), ends) in
        tuned.file.variables.iter().zip(&optimum.point).zip(&optimum.place_95)
    {
        let [low, high] = ends.map(|end| variable.value_with_unit(end));
        let remark = format!("with 95 % between {low} and {high}");
        facts.push(fact(&variable.name, variable.value_with_unit(*value), remark));
    }
    facts.push(fact(
        "Gain of the array",
        percent(&optimum.value),
        "of the baseline's power, with its 95 % interval",
    ));
    for (name, value) in tuned.turbines.iter().zip(&optimum.outputs) {
        facts.push(fact(
            &format!("of it {name}"),
            percent(value),
            "of the array's power in the baseline",
        ));
    }
    let [low, high] = optimum.greatest_95.map(|end| format!("{:.2}", 100.0 * end));
    facts.push(fact(
        "Greatest gain",
        format!("{low} to {high} %"),
        "of 95 % of drawn curves, wherever each has it",
    ));
    let shared = format!("± {:.2} %", 196.0 * found.sum.shared_deviation());
    facts.push(fact(
        "Error that all runs share",
        shared,
        "the wind of their blocks; in the gain's interval",
    ));
    if let Some(gain) = found.expected_gain {
        let remark = if found.is_settled {
            "less than the study asks for: it ended"
        } else {
            "the budget is spent"
        };
        facts.push(fact("One more run", format!("{:.3} %", 100.0 * gain), remark));
    }
    for (source, likeness) in tuned.file.cheaper.iter().zip(tuned.likenesses()) {
        let likeness = likeness.map_or("–".to_owned(), |likeness| format!("{likeness:.2}"));
        let remark =
            format!("made before, {} runs; correlation of their curves with these", source.n_runs);
        facts.push(fact(&format!("Cheaper source {}", source.name), likeness, remark));
    }
    facts.push(fact(
        "Runs",
        found.history.len(),
        format!("of {}, and their baseline", tuned.file.run),
    ));
    facts
}

fn tables(tuned: &Tuned) -> Vec<AnswerTable> {
    let mut tables = vec![of_iterations(tuned), of_places(tuned)];
    tables.extend(tuned.compromises.iter().map(|compromise| of_compromise(tuned, compromise)));
    tables
}

fn of_iterations(tuned: &Tuned) -> AnswerTable {
    let rows = tuned.found.steps.iter().map(|step| {
        let points: Vec<String> =
            step.proposal.points.iter().map(|point| tuned.file.words(point)).collect();
        let expected = step
            .proposal
            .expected_gain
            .map_or("–".to_owned(), |gain| format!("{:.3}", 100.0 * gain));
        vec![
            step.n_evaluations.to_string(),
            if step.proposal.round == 0 { "first design".to_owned() } else { points.join("; ") },
            expected,
            tuned.file.words(&step.optimum.point),
            percent(&step.optimum.value),
        ]
    });
    let headings = ["Runs", "made last", "gain expected of it (%)", "optimum then", "gain there"];
    AnswerTable {
        caption: "What was known after each iteration.".to_owned(),
        headings: headings.map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

fn of_places(tuned: &Tuned) -> AnswerTable {
    let places = tuned.found.optimum.places.iter();
    let told = places.filter(|(_, share)| *share >= LEAST_TOLD).take(MOST_PLACES);
    let row = |(point, share): &(Vec<f64>, f64)| {
        vec![tuned.file.words(point), format!("{:.0}", 100.0 * share)]
    };
    AnswerTable {
        caption: "Where the optimum may lie: the share of drawn curves that are highest there."
            .to_owned(),
        headings: vec!["Setting".to_owned(), "probability (%)".to_owned()],
        rows: told.map(row).collect(),
    }
}

fn of_compromise(tuned: &Tuned, compromise: &Compromise) -> AnswerTable {
    let rows = compromise
        .settings
        .iter()
        .map(|(point, gain, load)| vec![tuned.file.words(point), percent(gain), percent(load)]);
    AnswerTable {
        caption: format!(
            "Power against the damage-equivalent load of {}: settings that no other one betters in both.",
            compromise.channel
        ),
        headings: ["Setting", "gain of the array", "change of the load"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
    }
}
