//! From the study file to what was found.

use crate::data::Cut;
use crate::folder::{Folder, is_begun, n_points};
use crate::loads::compromise;
use crate::runs::{Runs, Watcher, held};
use crate::{
    Cheaper, Cost, TuneOptions, TuneOutcome, Tuned, TuningError, TuningFile, Watch, pages, record,
};
use search::{Found, History, Proposal, SearchError, Space, maximise};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use study::{Estimate, Observer, Prepared, StudyOptions};

/// Why a search ended without an optimum.
enum End {
    Interrupted,
    Failed(TuningError),
}

impl From<TuningError> for End {
    fn from(error: TuningError) -> Self {
        Self::Failed(error)
    }
}

impl From<SearchError> for End {
    fn from(error: SearchError) -> Self {
        Self::Failed(error.into())
    }
}

/// Tunes as `options` ask; `stop` asks for checkpoints and an end.
///
/// # Errors
/// [`TuningError`]; runs that were complete before stay whole.
pub fn tune(
    options: &TuneOptions,
    stop: &AtomicBool,
    watch: &mut (dyn Watch + Send),
) -> Result<TuneOutcome, TuningError> {
    let file = TuningFile::read(&options.study)?;
    let cut = Cut::new(&file, &Prepared::read(&file.case, &[])?)?;
    let cheaper = cheaper(&file, &cut)?;
    let space = file.space()?;
    let stem = options.study.file_stem().unwrap_or_default();
    let directory = options.output.clone().unwrap_or_else(|| Path::new("runs").join(stem));
    if options.dry_run {
        return Ok(TuneOutcome::Estimated(cost(&file, &directory, stop)?));
    }
    let mut folder = Folder::open(directory.clone(), &file, options.resume)?;
    let watcher: Watcher = Mutex::new(watch);
    let runs = Runs { file: &file, stop, watcher: &watcher };
    let mut settings = file.settings(cut.turbines.len());
    let searched = || -> Result<Found, End> {
        for ((own, cut), Cheaper { name, .. }) in cheaper.iter().zip(&file.cheaper) {
            let place = directory.join(name);
            let resume = is_begun(&place);
            let mut folder = Folder::open(place, own, resume)?;
            let runs = Runs { file: own, ..runs };
            settings.cheaper.push(known_before(&runs, cut, &mut folder, &space)?);
        }
        if !runs.baseline(&folder)? {
            return Err(End::Interrupted);
        }
        maximise(&space, &settings, |proposal| evaluated(&runs, &cut, &mut folder, proposal))
    }();
    let found = match searched {
        Ok(found) => found,
        Err(End::Interrupted) => return Ok(TuneOutcome::Interrupted { directory }),
        Err(End::Failed(error)) => return Err(error),
    };
    let points = space.candidates(file.seed);
    let n_turbines = cut.turbines.len();
    let compromises = file
        .loads
        .iter()
        .enumerate()
        .map(|(place, load)| compromise(&found.sum, n_turbines + place, load, &points));
    let compromises = compromises.collect::<Result<_, _>>()?;
    let (turbines, directory) = (cut.turbines.clone(), folder.path().to_owned());
    let page = directory.join("report.html");
    let tuned = Tuned { file, turbines, found, compromises, directory, page };
    record::write(&tuned, &settings.cheaper, &cut.outputs())?;
    pages::write(&tuned)?;
    Ok(TuneOutcome::Done(Box::new(tuned)))
}

/// The cheaper sources of `file`, each as a tuning of its own with how its records are cut, which must
/// have what `cut` has.
///
/// # Errors
/// [`TuningError::OtherSource`], and those of cases that cannot be read.
fn cheaper(file: &TuningFile, cut: &Cut) -> Result<Vec<(TuningFile, Cut)>, TuningError> {
    let of = |(index, source): (usize, &Cheaper)| {
        let own = file.of_cheaper(index);
        let its = Cut::new(&own, &Prepared::read(&own.case, &own.set)?)?;
        if its.turbines != cut.turbines {
            let name = source.name.clone();
            let [there, here] = [its.turbines, cut.turbines.clone()].map(|all| all.join(", "));
            return Err(TuningError::OtherSource { name, there, here });
        }
        Ok((own, its))
    };
    file.cheaper.iter().enumerate().map(of).collect()
}

/// What the points of a cheaper source give that fill `space`.
fn known_before(
    runs: &Runs,
    cut: &Cut,
    folder: &mut Folder,
    space: &Space,
) -> Result<History, End> {
    if !runs.baseline(folder)? {
        return Err(End::Interrupted);
    }
    let file = runs.file;
    let points = file.design.points(space, file.n_first, file.seed)?;
    let proposal = Proposal { round: 0, points, expected_gain: None };
    let mut history = History::default();
    for (point, evaluation) in evaluated(runs, cut, folder, &proposal)? {
        history.add(point, evaluation, cut.outputs().len())?;
    }
    Ok(history)
}

/// Makes the points of `proposal`, or those that were made in its place, and reads what they gave.
fn evaluated(
    runs: &Runs,
    cut: &Cut,
    folder: &mut Folder,
    proposal: &Proposal,
) -> Result<Vec<(Vec<f64>, search::Evaluation)>, End> {
    let (first, points) = folder.keep(proposal)?;
    let words: Vec<String> = points.iter().map(|point| runs.file.words(point)).collect();
    held(runs.watcher).proposed(first, runs.file.budget, &words, proposal.expected_gain);
    if !runs.points(folder, first, &points)? {
        return Err(End::Interrupted);
    }
    let read = |(place, point): (usize, Vec<f64>)| {
        let [own, other] = runs.pair(folder, first + place);
        Ok((point, cut.evaluation(&own, &other)?))
    };
    points.into_iter().enumerate().map(read).collect()
}

/// Keeps the last cost that is told.
#[derive(Default)]
struct Told(Option<Estimate>);

impl Observer for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.0 = Some(estimate.clone());
    }
}

/// What the tuning of `file` in `directory` will still cost at most.
fn cost(file: &TuningFile, directory: &Path, stop: &AtomicBool) -> Result<Cost, TuningError> {
    let of_source = |(index, source): (usize, &Cheaper)| {
        let place = directory.join(&source.name);
        Ok((source.name.clone(), cost(&file.of_cheaper(index), &place, stop)?))
    };
    let cheaper = file.cheaper.iter().enumerate().map(of_source);
    let cheaper = cheaper.collect::<Result<Vec<_>, TuningError>>()?;
    let mut told = Told::default();
    let options = StudyOptions {
        case: file.case.clone(),
        output: Some(directory.join("point-001")),
        runs: vec![file.run.clone()],
        overrides: file.set.clone(),
        dry_run: true,
        ..StudyOptions::default()
    };
    study::run(&options, stop, &mut told)?;
    let made = n_points(directory).min(file.budget);
    let each = if file.is_of_run_alone() { 1 } else { 2 };
    let baseline = usize::from(each == 1 && made == 0);
    let left = each * (file.budget - made) + baseline;
    Ok(Cost {
        n_runs: left,
        time_of_one: told.0.as_ref().and_then(Estimate::wall_time),
        n_at_a_time: file.parallel,
        memory: told.0.as_ref().map_or(0, |estimate| estimate.memory),
        disk: told.0.as_ref().map_or(0, |estimate| estimate.disk),
        cheaper,
    })
}
