//! Tasks of seconds, made whole to tell what all of them take: of such a task the steps are only a part.

use crate::error::CampaignError;
use crate::make;
use crate::task::{self, Task};
use formats::FileError;
use formats::case::CampaignFile;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use study::{Inputs, Outcome, StudyError};

/// Tasks that each worker makes (–). The first is not counted: it reads what the others find read.
const ROUNDS: usize = 3;

/// Wall times (s) of some of `tasks`, the first ones, each made whole and `n_workers` at a time as in the
/// campaign itself, in a folder that goes, on the disk of the folder `beside`.
///
/// # Errors
/// [`CampaignError::Sample`] where not one of them can be made.
pub(crate) fn times(
    file: &CampaignFile,
    tasks: &[&Task],
    threads: Option<usize>,
    n_workers: usize,
    beside: &Path,
) -> Result<Vec<f64>, CampaignError> {
    // On the disk that the campaign will use.
    let there = beside.ancestors().find(|path| path.is_dir()).unwrap_or(Path::new("."));
    let folder = tempfile::tempdir_in(there)
        .map_err(|source| FileError::system("create", "a folder to time tasks", there, source))?;
    let next = AtomicUsize::new(0);
    let made: Mutex<Vec<Made>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..n_workers {
            scope.spawn(|| {
                let mut inputs = Inputs::default();
                for round in 0..ROUNDS {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(task) = tasks.get(place) else { return };
                    let output = folder.path().join(place.to_string());
                    let timed = || timed(file, task, threads, &output, &mut inputs);
                    // As in the campaign, where such a task is failed and the others go on.
                    let Ok(time) = catch_unwind(AssertUnwindSafe(timed)) else { continue };
                    let is_counted = round > 0 || tasks.len() <= n_workers;
                    let made_one = Made { task: place, time, is_counted };
                    made.lock().unwrap_or_else(PoisonError::into_inner).push(made_one);
                }
            });
        }
    });
    let made = made.into_inner().unwrap_or_else(PoisonError::into_inner);
    let counted = made.iter().filter(|made| made.is_counted);
    let times: Vec<f64> = counted.filter_map(|made| made.time.as_ref().ok().copied()).collect();
    let failed = made.into_iter().find_map(|made| Some((made.task, made.time.err()?)));
    match failed {
        Some((task, source)) if times.is_empty() => {
            Err(CampaignError::Sample { settings: tasks[task].words(), source: Box::new(source) })
        }
        _ => Ok(times),
    }
}

/// A task that was made to be timed.
struct Made {
    /// Its place in the list.
    task: usize,
    time: Result<f64, StudyError>,
    is_counted: bool,
}

/// Wall time (s) of `task`, with all that a worker does for it.
fn timed(
    file: &CampaignFile,
    task: &Task,
    threads: Option<usize>,
    output: &Path,
    inputs: &mut Inputs,
) -> Result<f64, StudyError> {
    let began = Instant::now();
    task::hash(&file.case, task, &file.runs, inputs)?;
    let study = make::Study {
        case: &file.case,
        runs: &file.runs,
        overrides: &task.overrides,
        threads,
        output,
    };
    let outcome = study.run(false, &AtomicBool::new(false))?;
    debug_assert!(matches!(outcome, Outcome::Done { .. }));
    make::remove(output)?;
    Ok(began.elapsed().as_secs_f64())
}
