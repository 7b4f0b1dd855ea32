//! One task, from its case to its numbers.

use crate::claim::Claimed;
use crate::error::{CampaignError, in_words, is_of_machine, is_of_what_was_left};
use crate::table::Meta;
use crate::task;
use basis::records::Summary;
use formats::FileError;
use formats::records::{self, RunFolder};
use std::any::Any;
use std::fs;
use std::io::ErrorKind;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::UNIX_EPOCH;
use study::{Inputs, Outcome, Silent, StudyError, StudyOptions};

/// Files of a run that stay where its series is kept.
const SERIES: [&str; 3] = ["series.csv", "manifest.json", "summary.json"];

/// How a task ended.
pub(crate) enum Made {
    /// With its numbers, and what they were computed on.
    Done(Vec<Summary>, String),
    /// It cannot be made, for this reason.
    Failed(String),
    /// It was asked to stop.
    Interrupted,
}

/// Folder of the task numbered `id` of the campaign in `folder`.
pub(crate) fn folder_of(folder: &Path, id: i64) -> PathBuf {
    folder.join("tasks").join(format!("{id:06}"))
}

/// Makes the task that was `claimed` of the campaign of `meta` in `folder`; goes on where an earlier process
/// has left it.
///
/// # Errors
/// [`CampaignError::Changed`]; [`CampaignError::Stopped`] for what every further task would meet.
pub(crate) fn make(
    folder: &Path,
    meta: &Meta,
    claimed: &Claimed,
    inputs: &mut Inputs,
    stop: &AtomicBool,
) -> Result<Made, CampaignError> {
    let stopped =
        |source: StudyError| CampaignError::Stopped { task: claimed.id, source: Box::new(source) };
    let hash = || task::hash(&meta.case, &claimed.task, &meta.runs, inputs);
    match catch_unwind(AssertUnwindSafe(hash)) {
        Ok(Ok(hash)) if hash == claimed.hash => {}
        Ok(Ok(_)) => return Err(CampaignError::Changed { task: claimed.id }),
        Ok(Err(error)) => return Err(stopped(error)),
        Err(panic) => return Ok(panicked(&*panic)),
    }
    let output = folder_of(folder, claimed.id);
    let asked = Study {
        case: &meta.case,
        runs: &meta.runs,
        overrides: &claimed.task.overrides,
        threads: meta.threads,
        output: &output,
    };
    let study = |resume: bool| catch_unwind(AssertUnwindSafe(|| asked.run(resume, stop)));
    let resume = records::is_begun(&output);
    let mut made = study(resume);
    if resume
        && let Ok(Err(error)) = &made
        && is_of_what_was_left(error, &output)
    {
        // Damaged, or of a machine with other instructions: it is of no use to anybody.
        remove(&output)?;
        made = study(false);
    }
    match made {
        Ok(Ok(Outcome::Done { summaries, .. })) => {
            let backend = backend(&output, &summaries);
            Ok(Made::Done(summaries, backend))
        }
        Ok(Ok(_)) => Ok(Made::Interrupted),
        Ok(Err(error)) if is_of_machine(&error) => Err(stopped(error)),
        Ok(Err(error)) => Ok(Made::Failed(in_words(&error))),
        Err(panic) => Ok(panicked(&*panic)),
    }
}

/// The study that a task is.
pub(crate) struct Study<'a> {
    pub(crate) case: &'a Path,
    /// Runs that are made; all when empty.
    pub(crate) runs: &'a [String],
    pub(crate) overrides: &'a [String],
    /// Threads (–); all cores when absent.
    pub(crate) threads: Option<usize>,
    pub(crate) output: &'a Path,
}

impl Study<'_> {
    /// Makes it anew, or goes on with what is there.
    ///
    /// # Errors
    /// [`StudyError`].
    pub(crate) fn run(&self, resume: bool, stop: &AtomicBool) -> Result<Outcome, StudyError> {
        let threads = self.threads.map(|threads| format!("flow.threads={threads}"));
        let options = StudyOptions {
            case: self.case.to_owned(),
            output: Some(self.output.to_owned()),
            runs: self.runs.to_owned(),
            overrides: self.overrides.iter().cloned().chain(threads).collect(),
            resume,
            overwrite: !resume,
            jobs: Some(1),
            ..StudyOptions::default()
        };
        study::run(&options, stop, &mut Silent)
    }
}

/// What the runs of `summaries` in `folder` were computed on, as their manifests tell.
fn backend(folder: &Path, summaries: &[Summary]) -> String {
    let of = |summary: &Summary| {
        records::read_manifest(&RunFolder::new(folder, &summary.run)).ok()?.backend
    };
    let mut found: Vec<String> = summaries.iter().filter_map(of).collect();
    found.dedup();
    found.join("; ")
}

/// When the folder of the task numbered `id` showed progress last: when its newest checkpoint or summary was
/// written, in nanoseconds since 1970; 0 where it has none.
pub(crate) fn mark(folder: &Path, id: i64) -> i64 {
    let runs = entries(&folder_of(folder, id)).unwrap_or_default();
    let files =
        runs.iter().flat_map(|run| ["checkpoint", "summary.json"].map(|name| run.join(name)));
    let written = |path: PathBuf| {
        let since = fs::metadata(path).ok()?.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        i64::try_from(since.as_nanos()).ok()
    };
    files.filter_map(written).max().unwrap_or(0)
}

/// A task in which the program has panicked.
fn panicked(panic: &(dyn Any + Send)) -> Made {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let said = text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("without a word");
    Made::Failed(format!("the program panicked: {said}"))
}

/// Takes from the folder of the task numbered `id`, which is done, what is not to stay.
///
/// # Errors
/// [`FileError`].
pub(crate) fn prune(folder: &Path, id: i64, keep: &str) -> Result<(), FileError> {
    let folder = folder_of(folder, id);
    match keep {
        "all" => Ok(()),
        "series" => prune_to_series(&folder),
        _ => remove(&folder),
    }
}

/// Takes the folder of the task numbered `id` away, so that it begins anew.
///
/// # Errors
/// [`FileError`].
pub(crate) fn discard(folder: &Path, id: i64) -> Result<(), FileError> {
    remove(&folder_of(folder, id))
}

/// Takes away what processes that were killed left of tasks that are done.
///
/// # Errors
/// [`FileError`].
pub(crate) fn prune_all(
    folder: &Path,
    keep: &str,
    is_done: impl Fn(i64) -> bool,
) -> Result<(), FileError> {
    if keep != "summary" {
        return Ok(());
    }
    for path in entries(&folder.join("tasks"))? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Ok(id) = name.parse()
            && is_done(id)
        {
            prune(folder, id, keep)?;
        }
    }
    Ok(())
}

fn prune_to_series(folder: &Path) -> Result<(), FileError> {
    for path in entries(folder)? {
        if !path.is_dir() {
            remove(&path)?;
            continue;
        }
        for file in entries(&path)? {
            let is_kept =
                SERIES.iter().any(|name| file.file_name().is_some_and(|own| own == *name));
            if !is_kept {
                remove(&file)?;
            }
        }
    }
    Ok(())
}

/// What lies in `folder`; nothing where it is not there.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let failed = |source| FileError::system("read", "the folder", folder, source);
    match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(failed(error)),
        Ok(entries) => {
            let paths: std::io::Result<Vec<PathBuf>> =
                entries.map(|entry| Ok(entry?.path())).collect();
            let mut paths = paths.map_err(failed)?;
            paths.sort();
            Ok(paths)
        }
    }
}

/// Takes a file or folder away, if it is there.
pub(crate) fn remove(path: &Path) -> Result<(), FileError> {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(FileError::system("remove", "what a task left", path, error))
        }
        _ => Ok(()),
    }
}
