//! All studies of a case file in a folder: one, or those of its sweep, each in a folder of its own; their
//! runs one after the other or side by side.

mod parts;
mod references;
mod wanted;

use crate::air;
use crate::cost::{check_disk, check_memory, together};
use crate::jobs::{self, Shared, held};
use crate::options::{Outcome, StudyOptions};
use crate::outputs::{Outputs, announce};
use crate::prepared::Prepared;
use crate::self_check::SelfChecked;
use crate::study::Study;
use crate::threads::cores;
use crate::{Estimate, Observer, StudyError, gains};
use basis::records::Sweep;
use formats::FileError;
use formats::lock::Lock;
use formats::records::{self, PitchResponseRecord, read_pitch_responses};
use formats::shipped;
use parts::{Part, Parts};
use references::{MadeSoFar, ToldOfPanic};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Runs the studies that `options` name; `stop` asks them to leave checkpoints and return.
///
/// # Errors
/// [`StudyError`]; files of runs that were complete before stay whole.
pub fn run(
    options: &StudyOptions,
    stop: &AtomicBool,
    observer: &mut (dyn Observer + Send),
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
    observer: &mut (dyn Observer + Send),
) -> Result<Outcome, StudyError> {
    announce();
    let mut files = shipped::read_all(&options.case, &options.overrides)?;
    if let Some(n_seeds) = options.seeds {
        let mut overrides = options.overrides.clone();
        overrides.push(formats::case::seeds_override(&files, n_seeds)?);
        files = shipped::read_all(&options.case, &overrides)?;
    }
    let prepared = files.files.iter().map(Prepared::of_file).collect::<Result<Vec<_>, _>>()?;
    prepared.iter().for_each(|prepared| observer.prepared(prepared));
    let name = file_name(&files.files[0].case.name);
    let directory = options.output.clone().unwrap_or_else(|| Path::new("runs").join(name));
    let mut all = All::open(options, outputs, prepared, files.sweep, directory)?;
    let _locks = if options.dry_run { Vec::new() } else { all.lock(options, observer)? };
    all.known = all.known_responses(options)?;
    let interrupted = |directory: PathBuf| Ok(Outcome::Interrupted { directory });
    if options.dry_run {
        all.studies.iter().try_for_each(|opened| air::try_recorded(&opened.prepared))?;
    }
    let n_jobs = match all.cost(options, outputs, stop, observer)? {
        ControlFlow::Break(()) => return interrupted(all.directory),
        ControlFlow::Continue(n_jobs) => n_jobs,
    };
    if options.dry_run {
        return Ok(Outcome::Estimated);
    }
    observer.beginning(&all.directory);
    let parts = match all.make(options, n_jobs, stop, observer)? {
        Made::Interrupted(directory) => return interrupted(directory),
        Made::All(parts) => parts,
    };
    let mut summaries = Vec::new();
    for part in parts.list {
        let (study, prepared) = part.over();
        for &index in &study.wanted {
            gains::catch_up(&prepared, &study.wind, index, &study.folders, observer)?;
        }
        let made = records::read_summaries(&study.directory)?;
        summaries.extend(made.into_iter().map(|(_, summary)| summary));
    }
    Ok(Outcome::Done { summaries, directory: parts.directory })
}

/// A study that is to be made, opened.
struct Opened<'a> {
    /// Its folder in that of the sweep; empty without a sweep of studies.
    folder: String,
    study: Study<'a>,
    prepared: Prepared,
    checked: SelfChecked,
}

/// All studies that are to be made.
struct All<'a> {
    directory: PathBuf,
    sweep: Option<Sweep>,
    studies: Vec<Opened<'a>>,
    /// Pitch responses that were identified before.
    known: Vec<PitchResponseRecord>,
}

/// How the runs of all studies ended.
enum Made<'a> {
    Interrupted(PathBuf),
    All(Parts<'a>),
}

impl<'a> All<'a> {
    /// Opens what `options` ask for of the studies `prepared`, which `sweep` tells apart.
    fn open(
        options: &StudyOptions,
        outputs: &'a Outputs,
        prepared: Vec<Prepared>,
        sweep: Option<Sweep>,
        directory: PathBuf,
    ) -> Result<Self, StudyError> {
        check_folder(&directory, sweep.as_ref(), options.overwrite)?;
        let mut studies = Vec::with_capacity(prepared.len());
        let wanted = wanted::of_studies(&options.runs, sweep.as_ref(), &prepared)?;
        for (index, (prepared, runs)) in prepared.into_iter().zip(wanted).enumerate() {
            let Some(runs) = runs else { continue };
            let folder =
                sweep.as_ref().map_or(String::new(), |sweep| sweep.studies[index].folder.clone());
            let place = if folder.is_empty() { directory.clone() } else { directory.join(&folder) };
            let study = Study::open(options, outputs, &prepared, (place, runs))?;
            studies.push(Opened { folder, study, prepared, checked: SelfChecked::default() });
        }
        references::check(&studies)?;
        if options.resume && !options.dry_run && !records::is_begun(&directory) {
            return Err(StudyError::NothingToResume { directory });
        }
        Ok(Self { directory, sweep, studies, known: Vec::new() })
    }

    /// Locks all runs that are asked for, and tells what is swept in the folder.
    fn lock(
        &mut self,
        options: &StudyOptions,
        observer: &mut dyn Observer,
    ) -> Result<Vec<Vec<Lock>>, StudyError> {
        let mut locks = Vec::with_capacity(self.studies.len());
        for Opened { study, .. } in &mut self.studies {
            locks.push(study.lock(options, observer)?);
            // Another process may have completed runs before these were locked.
            study.leave_complete();
        }
        match &self.sweep {
            Some(sweep) => records::write_sweep(&self.directory, sweep)?,
            None => records::remove_sweep(&self.directory)?,
        }
        Ok(locks)
    }

    /// Pitch responses that earlier sessions have identified for any of the studies, where they go on; where
    /// they begin anew, what another program identified is taken away.
    fn known_responses(
        &self,
        options: &StudyOptions,
    ) -> Result<Vec<PitchResponseRecord>, StudyError> {
        let mut known: Vec<PitchResponseRecord> = Vec::new();
        for Opened { study, .. } in &self.studies {
            if !options.resume {
                if !options.dry_run {
                    records::discard_unreadable_pitch_responses(&study.directory)?;
                }
                continue;
            }
            for record in read_pitch_responses(&study.directory)? {
                if !known.iter().any(|other| other.key == record.key) {
                    known.push(record);
                }
            }
        }
        Ok(known)
    }

    /// Tells `observer` what the open runs will cost, and checks the rotors where there are such runs; gives
    /// the runs at a time, or a break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError::Memory`], [`StudyError::Disk`], [`StudyError::SelfCheck`].
    fn cost(
        &mut self,
        options: &StudyOptions,
        outputs: &Outputs,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), usize>, StudyError> {
        let estimates = self.estimates(outputs);
        let Some(memory) = estimates.iter().map(|estimate| estimate.memory).max() else {
            return Ok(ControlFlow::Continue(1));
        };
        let n_runs = estimates.iter().map(|estimate| estimate.n_runs).sum();
        let n_jobs = jobs::number(options.jobs, n_runs, memory);
        let mut estimate = together(&estimates, n_jobs);
        observer.estimated(&estimate);
        check_memory(&estimate, self.studies[0].prepared.case.flow.solver)?;
        let studies = self.studies.iter().map(|opened| &opened.study);
        let folders = studies.flat_map(|study| study.open.iter().map(|&run| &study.folders[run]));
        check_disk(&estimate, &self.directory, folders)?;
        let mut told = BTreeSet::new();
        for warning in self.studies.iter().flat_map(|opened| &opened.prepared.warnings) {
            if told.insert(&warning.message) {
                observer.warned(&warning.message);
            }
        }
        if let Some(threads) = options.threads {
            self.use_threads(threads);
        }
        let is_quick = options.is_checked || options.dry_run && !options.check;
        if self.check_rotors(is_quick, n_jobs, stop, observer)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let speeds = self.studies.iter().filter_map(|opened| opened.checked.updates_per_second);
        estimate.updates_per_second = speeds.reduce(f64::min);
        if estimate.updates_per_second.is_some() {
            observer.estimated(&estimate);
        }
        if n_jobs > 1 {
            self.use_threads((cores() / n_jobs).max(1));
        }
        Ok(ControlFlow::Continue(n_jobs))
    }

    /// Gives each run `threads` where its case does not say.
    fn use_threads(&mut self, threads: usize) {
        for opened in &mut self.studies {
            opened.prepared.case.flow.threads.get_or_insert(threads);
        }
    }

    /// What each study will cost; what several need identified is reckoned once.
    fn estimates(&self, outputs: &Outputs) -> Vec<Estimate> {
        let mut counted = BTreeSet::new();
        let estimate = |opened: &Opened| {
            let Opened { study, prepared, .. } = opened;
            let identifications = prepared.identifications(&study.open, self.known.clone());
            prepared.estimate(&study.open, &identifications.costs(&mut counted), outputs)
        };
        self.studies.iter().map(estimate).collect()
    }

    /// Checks the rotors of each study with open runs, those that are alike once, or only times the machine
    /// where it `is_quick`; a break when `stop` asked for an end.
    fn check_rotors(
        &mut self,
        is_quick: bool,
        n_jobs: usize,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<()>, StudyError> {
        let mut known: BTreeMap<String, SelfChecked> = BTreeMap::new();
        for Opened { study, prepared, checked, .. } in &mut self.studies {
            if study.open.is_empty() {
                continue;
            }
            let alike = prepared.checked_alike();
            if let Some(known) = known.get(&alike) {
                *checked = known.clone();
                continue;
            }
            let timed = || prepared.timed(&prepared.case.runs[study.open[0]], n_jobs);
            if is_quick {
                *checked = timed()?;
                known.insert(alike, checked.clone());
                continue;
            }
            *checked = match prepared.self_check(stop, observer)? {
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
                ControlFlow::Continue(checked) => checked,
            };
            if checked.updates_per_second.is_none() {
                checked.updates_per_second = timed()?.updates_per_second;
            }
            known.insert(alike, checked.clone());
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Makes all open runs, `n_jobs` at a time.
    fn make(
        self,
        options: &StudyOptions,
        n_jobs: usize,
        stop: &AtomicBool,
        observer: &mut (dyn Observer + Send),
    ) -> Result<Made<'a>, StudyError> {
        let Self { directory, studies, known, .. } = self;
        let list: Vec<Part> = studies.into_iter().map(Part::new).collect();
        let parts = Parts { directory, list, known: Mutex::new(known), cleared: Mutex::new(false) };
        let tasks = parts.tasks();
        let work = tasks.iter().map(|task| task.effort.until(task.n_steps)).sum();
        let shared = Shared::new(observer, stop, (tasks.len(), work), n_jobs);
        let (next, failed, broken) =
            (AtomicUsize::new(0), Mutex::new(None), AtomicBool::new(false));
        let made = MadeSoFar::of(tasks.len());
        let is_over = || broken.load(Ordering::Relaxed) || held(&failed).is_some();
        let worker = || {
            let _told = ToldOfPanic(&broken);
            loop {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let Some(task) = tasks.get(place).filter(|_| held(&failed).is_none()) else {
                    return;
                };
                if !made.wait(&task.after, is_over) {
                    return;
                }
                let number = (place, tasks.len());
                match parts.make(task, number, options.overwrite, stop, &shared) {
                    Ok(ControlFlow::Continue(())) => made.add(place),
                    Ok(ControlFlow::Break(())) => return broken.store(true, Ordering::Relaxed),
                    Err(error) => {
                        held(&failed).get_or_insert(error);
                        return;
                    }
                }
            }
        };
        if n_jobs == 1 {
            worker();
        } else {
            std::thread::scope(|scope| {
                for _ in 0..n_jobs {
                    scope.spawn(worker);
                }
            });
        }
        if let Some(error) = held(&failed).take() {
            return Err(error);
        }
        let is_broken = broken.into_inner();
        Ok(if is_broken { Made::Interrupted(parts.directory) } else { Made::All(parts) })
    }
}

/// Nothing where `directory` holds nothing yet, or what the case makes: the studies of `sweep`, or one; also
/// where it is to `overwrite` what another program left there.
fn check_folder(
    directory: &Path,
    sweep: Option<&Sweep>,
    overwrite: bool,
) -> Result<(), StudyError> {
    let of_studies = |sweep: &Sweep| -> Vec<String> {
        let keys = sweep.keys.iter().filter(|key| key.of_studies);
        keys.map(|key| key.key.clone()).collect()
    };
    let words = |keys: &[String]| match keys {
        [] => "one study".to_owned(),
        keys => format!("a study for each value of {}", keys.join(", ")),
    };
    let expected = sweep.map_or(Vec::new(), of_studies);
    let found = match records::read_sweep(directory) {
        Err(FileError::Content { .. }) if overwrite => return Ok(()),
        Err(error) => return Err(error.into()),
        Ok(Some(found)) => of_studies(&found),
        Ok(None) if records::is_begun(directory) => Vec::new(),
        Ok(None) => return Ok(()),
    };
    if found.iter().collect::<BTreeSet<_>>() == expected.iter().collect::<BTreeSet<_>>() {
        return Ok(());
    }
    let (found, expected) = (words(&found), words(&expected));
    Err(StudyError::OtherSweep { directory: directory.to_owned(), found, expected })
}

/// `name` as a folder name: letters, digits, dashes.
fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '-' })
        .collect()
}
