//! A study in its folder: from the case file to the records of every run. The stages that it goes through
//! need no files.

use crate::columns::Columns;
use crate::cost::check_memory;
use crate::gains::{self, Comparison};
use crate::outputs::Outputs;
use crate::pitch_identification::PitchIdentifications;
use crate::prepared::Prepared;
use crate::ready::Ready;
use crate::same_case::check_same;
use crate::self_check::SelfChecked;
use crate::simulate::{Ending, Job, simulate};
use crate::summarise;
use crate::{Observer, StudyError};
use basis::records::{Cost, Summary};
use farm::case::Run;
use formats::records::{self, Manifest, RunFolder, read_pitch_responses, write_pitch_responses};
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
    /// All runs that were asked for are complete.
    Done {
        /// Their summaries, and those of runs that were complete before.
        summaries: Vec<Summary>,
        /// Folder of the results.
        directory: PathBuf,
    },
    /// The cost was reported, nothing was run.
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
    observer: &mut dyn Observer,
) -> Result<Outcome, StudyError> {
    run_with(options, &Outputs::standard(), stop, observer)
}

/// The same with other `outputs` than those that every study has, for example with one of your own added.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    options: &Options,
    outputs: &Outputs,
    stop: &AtomicBool,
    observer: &mut dyn Observer,
) -> Result<Outcome, StudyError> {
    let prepared = Prepared::read(&options.case, &options.overrides)?;
    let study = Study::open(options, outputs, &prepared)?;
    let known = if options.resume { read_pitch_responses(&study.directory)? } else { Vec::new() };
    let identifications = prepared.identifications(&study.open, known);
    let interrupted = || Ok(Outcome::Interrupted { directory: study.directory.clone() });
    let checked = match study.cost(&prepared, &identifications, stop, observer)? {
        ControlFlow::Break(()) => return interrupted(),
        ControlFlow::Continue(checked) => checked,
    };
    if options.dry_run {
        return Ok(Outcome::Estimated);
    }
    let prepared = if study.open.is_empty() {
        prepared
    } else {
        let keep = &mut |found: &[_]| Ok(write_pitch_responses(&study.directory, found)?);
        let ready = match Ready::new(prepared, checked, identifications, keep, stop, observer)? {
            ControlFlow::Break(()) => return interrupted(),
            ControlFlow::Continue(ready) => ready,
        };
        for place in 0..study.open.len() {
            if study.make(&ready, place, stop, observer)?.is_break() {
                return interrupted();
            }
        }
        ready.prepared
    };
    for &index in &study.wanted {
        gains::catch_up(&prepared, index, &study.folders, observer)?;
    }
    let made = records::read_summaries(&study.directory)?;
    let summaries = made.into_iter().map(|(_, summary)| summary).collect();
    Ok(Outcome::Done { summaries, directory: study.directory })
}

/// Folders of a study, and which of its runs are to be made.
struct Study<'a> {
    outputs: &'a Outputs,
    directory: PathBuf,
    /// One per run of the case.
    folders: Vec<RunFolder>,
    /// Runs that are asked for, by their places in the case.
    wanted: Vec<usize>,
    /// Those of them that are not complete.
    open: Vec<usize>,
    resume: bool,
}

impl<'a> Study<'a> {
    /// The study that `options` name; what its folder holds is left as it is.
    ///
    /// # Errors
    /// [`StudyError::UnknownRun`], [`StudyError::OutputExists`], [`StudyError::NothingToResume`],
    /// [`StudyError::OtherCase`], and [`StudyError::File`] for a folder that cannot be written into.
    fn open(
        options: &Options,
        outputs: &'a Outputs,
        prepared: &Prepared,
    ) -> Result<Self, StudyError> {
        let runs = &prepared.case.runs;
        let wanted = wanted_runs(runs, &options.runs)?;
        let directory = options
            .output
            .clone()
            .unwrap_or_else(|| Path::new("runs").join(file_name(&prepared.case.name)));
        let folders: Vec<RunFolder> =
            runs.iter().map(|run| RunFolder::new(&directory, &run.name)).collect();
        let open: Vec<usize> = wanted
            .iter()
            .copied()
            .filter(|&index| !(options.resume && folders[index].is_complete()))
            .collect();
        let keeps = options.resume || options.overwrite || options.dry_run;
        if !keeps && open.iter().any(|&index| folders[index].holds_results()) {
            return Err(StudyError::OutputExists { directory });
        }
        if !options.dry_run {
            formats::atomic::check_folder(&directory)?;
        }
        if options.resume && !options.dry_run && !records::is_begun(&directory) {
            return Err(StudyError::NothingToResume { directory });
        }
        if options.resume {
            for &index in &wanted {
                check_same(prepared, &runs[index], &folders[index])?;
            }
        }
        for &index in &open {
            // Gains are over a run of the same wind, or over none.
            if let Some(other) = gains::compared(prepared, index)
                && !open.contains(&other)
                && folders[other].is_complete()
            {
                check_same(prepared, &runs[other], &folders[other])?;
            }
        }
        Ok(Self { outputs, directory, folders, wanted, open, resume: options.resume })
    }

    /// Tells `observer` what the open runs will cost, and checks the rotors where there are such runs; a
    /// break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError::Memory`], [`StudyError::SelfCheck`].
    fn cost(
        &self,
        prepared: &Prepared,
        identifications: &PitchIdentifications,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), SelfChecked>, StudyError> {
        let mut estimate = prepared.estimate(self.open.len(), identifications, self.outputs);
        observer.estimated(&estimate);
        check_memory(&estimate)?;
        for warning in &prepared.warnings {
            observer.warned(warning);
        }
        if self.open.is_empty() {
            return Ok(ControlFlow::Continue(SelfChecked::default()));
        }
        let checked = prepared.self_check(stop, observer)?;
        if let ControlFlow::Continue(checked) = &checked {
            estimate.updates_per_second = checked.updates_per_second;
            observer.estimated(&estimate);
        }
        Ok(checked)
    }

    /// Makes the open run number `place`, from simulation to summary; a break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError`].
    fn make(
        &self,
        ready: &Ready,
        place: usize,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<()>, StudyError> {
        let index = self.open[place];
        let (run, folder) = (&ready.prepared.case.runs[index], &self.folders[index]);
        if self.resume && folder.holds_results() && !folder.checkpoint_path().exists() {
            let name = &run.name;
            observer.warned(&format!("{name} left no checkpoint: it begins at time zero again"));
        }
        let manifest = begin_run(&ready.prepared, index, folder, self.resume)?;
        let (outputs, resume, place) = (self.outputs, self.resume, (place, self.open.len()));
        let job = Job { ready, run, folder, outputs, resume, place };
        match simulate(&job, stop, observer)? {
            Ending::Interrupted => Ok(ControlFlow::Break(())),
            Ending::Complete { cost, clipped_shares } => {
                let summary = self.summary(ready, index, &clipped_shares, cost)?;
                for warning in &summary.warnings[ready.prepared.warnings.len()..] {
                    observer.warned(&warning.message);
                }
                records::write_manifest(folder, &manifest.finish())?;
                // The summary comes last: with it the run is complete.
                records::write_summary(folder, &summary)?;
                folder.remove_checkpoint()?;
                observer.finished(&summary);
                Ok(ControlFlow::Continue(()))
            }
        }
    }

    /// The numbers of run number `index`, with its gains where the run that it compares with is there.
    fn summary(
        &self,
        ready: &Ready,
        index: usize,
        clipped_shares: &[f64],
        cost: Cost,
    ) -> Result<Summary, StudyError> {
        let (prepared, folder) = (&ready.prepared, &self.folders[index]);
        let run = &prepared.case.runs[index];
        let mut columns = Columns::open(folder, prepared)?;
        let mut summary = summarise::summarise(prepared, run, &mut columns, clipped_shares, cost)?;
        if let Comparison::Made(other, mut there) =
            gains::comparison(prepared, index, &self.folders)?
        {
            gains::add(&mut summary, (run, &mut columns), (other, &mut there))?;
        }
        // For these numbers columns of the series were read.
        let peak_memory = formats::machine::peak_memory();
        summary.cost.peak_memory = summary.cost.peak_memory.max(peak_memory);
        Ok(summary)
    }
}

/// On return the run's folder is ready: empty but for the manifest, or as an interrupted run left it when
/// `resume`.
fn begin_run(
    prepared: &Prepared,
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
    let texts = prepared.turbine_texts.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let version = env!("CARGO_PKG_VERSION");
    let manifest = Manifest::start(version, &prepared.case, &prepared.case_text, index, texts);
    records::write_manifest(folder, &manifest)?;
    Ok(manifest)
}

/// Places of the runs called `names`; of all when empty.
fn wanted_runs(runs: &[Run], names: &[String]) -> Result<Vec<usize>, StudyError> {
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
