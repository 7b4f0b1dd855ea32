//! A study in its folder: from the case file to the records of every run. The stages that it goes through
//! need no files.

use crate::columns::Columns;
use crate::cost::{check_disk, check_memory};
use crate::gains::{self, Comparison};
use crate::outputs::Outputs;
use crate::pitch_identification::PitchIdentifications;
use crate::prepared::Prepared;
use crate::ready::Ready;
use crate::same_case::{WindDigests, another, check_same};
use crate::self_check::SelfChecked;
use crate::simulate::{Ending, Job, simulate};
use crate::summarise::{self, Left};
use crate::{Observer, StudyError};
use basis::records::{Cost, Summary};
use farm::case::Run;
use formats::leftovers;
use formats::lock::Lock;
use formats::records::{self, Manifest, PitchResponseRecord, RunFolder, read_pitch_responses};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// What to run, and where the results go.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyOptions {
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
    /// Replace old results.
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
    options: &StudyOptions,
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
    options: &StudyOptions,
    outputs: &Outputs,
    stop: &AtomicBool,
    observer: &mut dyn Observer,
) -> Result<Outcome, StudyError> {
    let prepared = Prepared::read(&options.case, &options.overrides)?;
    let mut study = Study::open(options, outputs, &prepared)?;
    let _locks = if options.dry_run { Vec::new() } else { study.lock(options, observer)? };
    if options.resume {
        // Another process may have completed runs before these were locked.
        study.open.retain(|&index| !study.folders[index].is_complete());
    }
    let study = study;
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
        let keep = &mut |found: &[_]| study.keep_pitch_responses(found);
        let ready = match Ready::new(prepared, checked, identifications, keep, stop, observer)? {
            ControlFlow::Break(()) => return interrupted(),
            ControlFlow::Continue(ready) => ready,
        };
        if options.overwrite {
            // What was there goes before the first run, so that wherever this study is stopped, what is
            // left is of it alone and can be resumed.
            study.open.iter().try_for_each(|&index| study.folders[index].clear())?;
        }
        for place in 0..study.open.len() {
            if study.make(&ready, place, stop, observer)?.is_break() {
                return interrupted();
            }
        }
        ready.prepared
    };
    for &index in &study.wanted {
        gains::catch_up(&prepared, &study.wind, index, &study.folders, observer)?;
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
    /// SHA-256 of the files of wind when the study began.
    wind: WindDigests,
    resume: bool,
}

impl<'a> Study<'a> {
    /// The study that `options` name; what its folder holds is left as it is.
    ///
    /// # Errors
    /// [`StudyError::UnknownRun`], [`StudyError::OutputExists`], [`StudyError::NothingToResume`],
    /// [`StudyError::OtherCase`], [`StudyError::OtherFile`], and [`StudyError::File`] for a folder that
    /// cannot be written into.
    fn open(
        options: &StudyOptions,
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
        let wind = prepared.wind_digests()?;
        if options.resume {
            for &index in &wanted {
                check_same(prepared, &wind, &runs[index], &folders[index])?;
            }
        }
        for &index in &open {
            // Gains are over a run of the same wind, or over none.
            if let Some(other) = gains::compared(prepared, index)
                && !open.contains(&other)
                && folders[other].is_complete()
            {
                check_same(prepared, &wind, &runs[other], &folders[other])?;
            }
        }
        Ok(Self { outputs, directory, folders, wanted, open, wind, resume: options.resume })
    }

    /// Locks the runs that are asked for, so that no other process writes them, and takes away what killed
    /// processes have left in the study's own folder; the locks end with what is given.
    ///
    /// # Errors
    /// [`StudyError::File`] says who else writes one of them; [`StudyError::OutputExists`] when one was made
    /// meanwhile.
    fn lock(
        &self,
        options: &StudyOptions,
        observer: &mut dyn Observer,
    ) -> Result<Vec<Lock>, StudyError> {
        let folders = || self.wanted.iter().map(|&index| &self.folders[index]);
        let mut locks = folders().map(RunFolder::lock).collect::<Result<Vec<Lock>, _>>()?;
        // The one that made the folder goes last, and takes it away where nothing came into it.
        locks.reverse();
        if !locks.iter().all(Lock::is_held) {
            observer.warned(&format!(
                "the file system of {} knows no locks: see to it that no other process writes these runs",
                self.directory.display()
            ));
        }
        let keeps = options.resume || options.overwrite;
        if !keeps && folders().any(RunFolder::holds_results) {
            return Err(StudyError::OutputExists { directory: self.directory.clone() });
        }
        leftovers::remove_abandoned(&self.directory, None)?;
        Ok(locks)
    }

    /// Keeps what was `found` of pitch responses in the study's folder, beside what those who make other runs
    /// of it have kept there.
    ///
    /// # Errors
    /// [`StudyError::File`].
    fn keep_pitch_responses(&self, found: &[PitchResponseRecord]) -> Result<(), StudyError> {
        if self.wanted.len() == self.folders.len() {
            return Ok(records::write_pitch_responses(&self.directory, found)?);
        }
        Ok(records::add_pitch_responses(&self.directory, found)?)
    }

    /// Tells `observer` what the open runs will cost, and checks the rotors where there are such runs; a
    /// break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError::Memory`], [`StudyError::Disk`], [`StudyError::SelfCheck`].
    fn cost(
        &self,
        prepared: &Prepared,
        identifications: &PitchIdentifications,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), SelfChecked>, StudyError> {
        let mut estimate = prepared.estimate(&self.open, identifications, self.outputs);
        observer.estimated(&estimate);
        check_memory(&estimate)?;
        let folders = self.open.iter().map(|&index| &self.folders[index]);
        check_disk(&estimate, &self.directory, folders)?;
        for warning in &prepared.warnings {
            observer.warned(&warning.message);
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
        let wind = self.same_wind(&ready.prepared, &run.name)?;
        let manifest = begin_run(&ready.prepared, wind, index, folder, self.resume)?;
        let (outputs, resume, place) = (self.outputs, self.resume, (place, self.open.len()));
        let job = Job { ready, run, folder, outputs, resume, place };
        match simulate(&job, stop, observer)? {
            Ending::Interrupted => Ok(ControlFlow::Break(())),
            Ending::Complete { cost, left, backend } => {
                let summary = self.summary(ready, index, &left, cost)?;
                let known = &ready.prepared.warnings;
                let n_known = known.iter().filter(|warning| warning.concerns(&run.name)).count();
                for warning in &summary.warnings[n_known..] {
                    observer.warned(&warning.message);
                }
                records::write_manifest(folder, &manifest.finish(&backend))?;
                // The summary comes last: with it the run is complete.
                records::write_summary(folder, &summary)?;
                folder.remove_checkpoint()?;
                observer.finished(&summary);
                Ok(ControlFlow::Continue(()))
            }
        }
    }

    /// SHA-256 of the files of wind as they are now, before the run called `run`.
    ///
    /// # Errors
    /// [`StudyError::ChangedWind`] when they are not what they were when the study began.
    fn same_wind(&self, prepared: &Prepared, run: &str) -> Result<WindDigests, StudyError> {
        let wind = prepared.wind_digests()?;
        match another(&self.wind, &wind) {
            None => Ok(wind),
            Some((file, sha256)) => {
                Err(StudyError::ChangedWind { run: run.to_owned(), file, sha256 })
            }
        }
    }

    /// The numbers of run number `index`, with its gains where the run that it compares with is there.
    fn summary(
        &self,
        ready: &Ready,
        index: usize,
        left: &[Left],
        cost: Cost,
    ) -> Result<Summary, StudyError> {
        let (prepared, folder) = (&ready.prepared, &self.folders[index]);
        let run = &prepared.case.runs[index];
        let mut columns = Columns::open(folder, prepared)?;
        let mut summary = summarise::summarise(prepared, run, &mut columns, left, cost)?;
        if let Comparison::Made(other, mut there) =
            gains::comparison(prepared, &self.wind, index, &self.folders)?
        {
            gains::add(&mut summary, (run, &mut columns), (other, &mut there))?;
        }
        // For these numbers columns of the series were read.
        let peak_memory = formats::machine::peak_memory();
        summary.cost.peak_memory = summary.cost.peak_memory.max(peak_memory);
        Ok(summary)
    }
}

/// On return the run's folder is ready: empty but for the manifest, which tells of `wind`, or as an
/// interrupted run left it when `resume`.
fn begin_run(
    prepared: &Prepared,
    wind: WindDigests,
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
    let manifest = manifest.in_wind(wind).with_libraries(&prepared.libraries);
    records::write_manifest(folder, &manifest)?;
    Ok(manifest)
}

/// Places of the runs called `names`; of all when empty.
fn wanted_runs(runs: &[Run], names: &[String]) -> Result<Vec<usize>, StudyError> {
    if names.is_empty() {
        return Ok((0..runs.len()).collect());
    }
    let mut wanted = Vec::new();
    for name in names {
        let index = runs.iter().position(|run| run.name == *name);
        let index = index.ok_or_else(|| StudyError::UnknownRun {
            name: name.clone(),
            known: runs.iter().map(|run| run.name.clone()).collect(),
        })?;
        // One that is named twice is made once.
        if !wanted.contains(&index) {
            wanted.push(index);
        }
    }
    Ok(wanted)
}

/// `name` as a folder name: letters, digits, dashes.
fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '-' })
        .collect()
}
