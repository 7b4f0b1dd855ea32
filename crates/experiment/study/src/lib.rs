//! A study from case file to report: every run of a case, with its files.
//!
//! Reading order: [`run`], then `prepare` (what all runs share) with `models` (their turbines), `probes` (how pitch acts), `simulate` (one run) with its `outputs`, `summarise` (its numbers, from its `columns`), `gains` (over another run).

mod air;
mod azimuth_offset;
mod channels;
mod columns;
mod error;
mod gains;
mod loads;
mod lock;
mod models;
pub mod outputs;
mod phase;
mod prepare;
mod probes;
mod seeds;
mod simulate;
mod summarise;
mod synchronisation;
mod tips;
mod watcher;

pub use azimuth_offset::{OffsetAnswer, OffsetQuestion, azimuth_offset};
pub use error::StudyError;
pub use lock::{LockAnswer, LockQuestion, lock};
pub use outputs::Outputs;
pub use phase::{PhaseAnswer, PhaseAnswers, PhaseAxis, PhaseQuestion, phase, phases, tune};
pub use prepare::Setup;
pub use seeds::{GainsAnswer, GainsQuestion, PartGains, RunGains, SeedsError, gains_over_seeds};
pub use watcher::{Estimate, Probing, Progress, Watcher};

use basis::records::Summary;
use columns::Columns;
use farm::case::Run;
use formats::case;
use formats::records::{self, Manifest, RunFolder};
use gains::Comparison;
use simulate::{Ending, Job, simulate};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// What to run, and where the results go.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Case file.
    pub case: PathBuf,
    /// Folder for the results; `runs/NAME-OF-THE-CASE` when absent.
    pub output: Option<PathBuf>,
    /// Runs to make; all when empty.
    pub runs: Vec<String>,
    /// Overrides of the case's keys, `key.path=value`.
    pub overrides: Vec<String>,
    /// Go on with what is there.
    pub resume: bool,
    /// Put new results in the place of old ones.
    pub overwrite: bool,
    /// Say what it would cost, and stop.
    pub dry_run: bool,
}

/// How a study ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// All asked runs are complete.
    Done {
        /// Their summaries, and those of runs that were complete before.
        summaries: Vec<Summary>,
        /// The report.
        report: PathBuf,
    },
    /// The cost was told, nothing was run.
    Estimated,
    /// Stopped on request; it can be resumed.
    Interrupted {
        /// Folder of the results.
        directory: PathBuf,
    },
}

/// Runs the study that `options` name; `stop` asks it to leave a checkpoint and return.
///
/// # Errors
/// [`StudyError`]; files of runs that were complete before stay whole.
pub fn run(
    options: &Options,
    stop: &AtomicBool,
    watcher: &mut dyn Watcher,
) -> Result<Outcome, StudyError> {
    run_with(options, &Outputs::standard(), stop, watcher)
}

/// The same with other `outputs` than those that every study has, for example with one of your own added.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    options: &Options,
    outputs: &Outputs,
    stop: &AtomicBool,
    watcher: &mut dyn Watcher,
) -> Result<Outcome, StudyError> {
    let mut setup = Setup::read(&options.case, &options.overrides)?;
    let wanted = wanted_runs(&setup, &options.runs)?;
    let directory = options
        .output
        .clone()
        .unwrap_or_else(|| Path::new("runs").join(file_name(&setup.case.name)));
    let folders: Vec<RunFolder> =
        setup.case.runs.iter().map(|run| RunFolder::new(&directory, &run.name)).collect();
    let open: Vec<usize> = wanted
        .iter()
        .copied()
        .filter(|&index| !(options.resume && folders[index].is_complete()))
        .collect();
    let keeps = options.resume || options.overwrite || options.dry_run;
    if !keeps && open.iter().any(|&index| folders[index].path().exists()) {
        return Err(StudyError::OutputExists { directory });
    }
    if options.resume {
        for &index in &wanted {
            check_same(&setup, &setup.case.runs[index], &folders[index])?;
        }
    }
    for &index in &open {
        // Gains are over a run of the same wind, or over none.
        if let Some(other) = gains::compared(&setup, index)
            && !open.contains(&other)
            && folders[other].is_complete()
        {
            check_same(&setup, &setup.case.runs[other], &folders[other])?;
        }
    }
    let probes = setup.probes(&open, &directory, options.resume)?;
    let mut estimate = setup.estimate(open.len(), &probes);
    estimate.disk += outputs.disk(&setup);
    watcher.estimated(&estimate);
    setup.check_memory(&estimate)?;
    for warning in &setup.warnings {
        watcher.warned(warning);
    }
    if !open.is_empty() {
        match setup.self_check(stop, watcher)? {
            ControlFlow::Break(()) => return Ok(Outcome::Interrupted { directory }),
            ControlFlow::Continue(speed) => estimate.updates_per_second = speed,
        }
        watcher.estimated(&estimate);
    }
    if options.dry_run {
        return Ok(Outcome::Estimated);
    }
    if !open.is_empty() {
        if setup.calibrate(probes, &directory, stop, watcher)?.is_break() {
            return Ok(Outcome::Interrupted { directory });
        }
        setup.make_turbulence(watcher)?;
    }
    for (place, &index) in open.iter().enumerate() {
        let run = &setup.case.runs[index];
        let folder = &folders[index];
        let manifest = begin_run(&setup, index, folder, options.resume)?;
        let (resume, place) = (options.resume, (place, open.len()));
        let job = Job { setup: &setup, run, folder, outputs, resume, place };
        match simulate(&job, stop, watcher)? {
            Ending::Interrupted => return Ok(Outcome::Interrupted { directory }),
            Ending::Complete { cost, clipped_shares } => {
                let mut columns = Columns::open(folder, &setup)?;
                let mut summary =
                    summarise::summarise(&setup, run, &mut columns, &clipped_shares, cost)?;
                if let Comparison::Made(other, mut there) =
                    gains::comparison(&setup, index, &folders)?
                {
                    let there = (other, &mut there);
                    gains::add(&mut summary, (run, &mut columns), there)?;
                }
                for warning in &summary.warnings[setup.warnings.len()..] {
                    watcher.warned(&warning.message);
                }
                // For these numbers columns of the series were read.
                let peak_memory = formats::machine::peak_memory();
                summary.cost.peak_memory = summary.cost.peak_memory.max(peak_memory);
                records::write_manifest(folder, &manifest.finish())?;
                // The summary comes last: with it the run is complete.
                records::write_summary(folder, &summary)?;
                folder.remove_checkpoint()?;
                watcher.finished(&summary);
            }
        }
    }
    for &index in &wanted {
        gains::catch_up(&setup, index, &folders, watcher)?;
    }
    let (summaries, report) = self::report(&directory)?;
    Ok(Outcome::Done { summaries, report })
}

/// Rebuilds the report of the study in `directory` from its records; gives the summaries and the report's path.
///
/// # Errors
/// [`StudyError::File`] for records that cannot be read, [`StudyError::Report`] for a report that cannot be written.
pub fn report(directory: &Path) -> Result<(Vec<Summary>, PathBuf), StudyError> {
    let study = records::read_study(directory)?;
    let synchronisation = synchronisation::synchronisation(&study)?;
    let mut runs = Vec::with_capacity(study.runs.len());
    let mut summaries = Vec::with_capacity(study.runs.len());
    for run in study.runs {
        let mut summary = run.summary;
        let series = run.series.read(|channel| report::draws(&summary, channel))?;
        summaries.push(summary.clone());
        summary.warnings.extend(study.warnings.iter().cloned());
        runs.push(report::RunRecords {
            summary,
            series,
            mean_planes: run.mean_planes,
            instant_planes: run.last_planes,
        });
    }
    let study = report::StudyRecords {
        case_name: study.case_name,
        description: study.description,
        case_text: study.case_text,
        runs,
        synchronisation,
        version: study.version,
    };
    report::write(&study, directory)?;
    Ok((summaries, directory.join("report.html")))
}

/// On return the run's folder is ready: empty but for the manifest, or as an interrupted run left it when `resume`.
fn begin_run(
    setup: &Setup,
    index: usize,
    folder: &RunFolder,
    resume: bool,
) -> Result<Manifest, StudyError> {
    folder.remove_leftovers()?;
    if resume && folder.checkpoint_path().exists() && folder.manifest_path().exists() {
        return Ok(records::read_manifest(folder)?);
    }
    folder.clear()?;
    folder.create()?;
    let texts = setup.turbine_texts.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let version = env!("CARGO_PKG_VERSION");
    let manifest = Manifest::start(version, &setup.case, &setup.case_text, index, texts);
    records::write_manifest(folder, &manifest)?;
    Ok(manifest)
}

/// Whether what is in `folder` was made with this very case, these very turbines and controllers.
fn check_same(setup: &Setup, run: &Run, folder: &RunFolder) -> Result<(), StudyError> {
    if !folder.manifest_path().exists() {
        return Ok(());
    }
    let manifest = records::read_manifest(folder)?;
    let same_case = case::fingerprint(&manifest.case_text, &run.name)
        == case::fingerprint(&setup.case_text, &run.name);
    let same_turbines = setup.turbine_texts.iter().all(|(name, text)| {
        manifest.turbines_sha256.get(name) == Some(&records::sha256(text.as_bytes()))
    });
    if same_case && same_turbines {
        Ok(())
    } else {
        Err(StudyError::OtherCase { run: run.name.clone(), directory: folder.path().to_owned() })
    }
}

fn wanted_runs(setup: &Setup, names: &[String]) -> Result<Vec<usize>, StudyError> {
    let runs = &setup.case.runs;
    if names.is_empty() {
        return Ok((0..runs.len()).collect());
    }
    names
        .iter()
        .map(|name| {
            runs.iter().position(|run| run.name == *name).ok_or_else(|| StudyError::UnknownRun {
                name: name.clone(),
                known: runs.iter().map(|run| run.name.clone()).collect(),
            })
        })
        .collect()
}

/// `name` as a folder name: letters, digits, dashes.
fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '-' })
        .collect()
}
