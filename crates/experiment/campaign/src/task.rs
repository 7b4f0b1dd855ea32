//! Tasks: every combination of levels, as overrides of the case, with a hash of what decides its results.

use crate::error::CampaignError;
use basis::records::SweptValue;
use formats::case::{CampaignFile, Draw, Exclusion, decisive_text};
use formats::{records, shipped};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use study::{Inputs, StudyError};

/// Version of the program: results of another one may have other bits.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// One simulation of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Task {
    /// Keys and linked factors with what they are in it.
    pub(crate) columns: Vec<(String, SweptValue)>,
    /// Overrides of the case.
    pub(crate) overrides: Vec<String>,
}

impl Task {
    /// Factors with their levels, in words: `wind.speed = 8, wind.seed = 1`.
    pub(crate) fn words(&self) -> String {
        self.words_without(&[]).join(", ")
    }

    /// The same one by one, but for those that are `left_out`.
    fn words_without(&self, left_out: &[String]) -> Vec<String> {
        let kept = self.columns.iter().filter(|(name, _)| !left_out.contains(name));
        kept.map(|(name, value)| format!("{name} = {}", value.words())).collect()
    }

    fn is_excluded_by(&self, exclusion: &Exclusion) -> bool {
        exclusion.conditions.iter().all(|(key, values)| {
            let own = self.columns.iter().find(|(name, _)| name == key);
            own.is_some_and(|(_, own)| values.iter().any(|value| value.words() == own.words()))
        })
    }
}

/// What the file of a campaign comes to.
pub(crate) struct Tasks {
    /// The tasks; the last factor changes fastest.
    pub(crate) tasks: Vec<Task>,
    /// Tasks that are excluded (–).
    pub(crate) n_excluded: usize,
    /// Tasks of the others that were not drawn (–).
    pub(crate) n_undrawn: usize,
}

/// All tasks of `file`.
///
/// # Errors
/// [`CampaignError::NoTask`].
pub(crate) fn all(file: &CampaignFile) -> Result<Tasks, CampaignError> {
    let mut tasks = vec![Task { columns: Vec::new(), overrides: Vec::new() }];
    for factor in &file.factors {
        let mut longer = Vec::with_capacity(tasks.len() * factor.levels.len());
        for task in &tasks {
            for level in &factor.levels {
                let mut task = task.clone();
                if factor.is_linked {
                    task.columns.push((factor.name.clone(), level.name.clone()));
                }
                for setting in &level.settings {
                    task.columns.push((setting.key.clone(), setting.value.clone()));
                    let places = setting.places.iter();
                    task.overrides.extend(places.map(|place| format!("{place}={}", setting.text)));
                }
                longer.push(task);
            }
        }
        tasks = longer;
    }
    let n_combinations = tasks.len();
    tasks.retain(|task| !file.excluded.iter().any(|exclusion| task.is_excluded_by(exclusion)));
    if tasks.is_empty() {
        return Err(CampaignError::NoTask { path: file.path.clone() });
    }
    let n_excluded = n_combinations - tasks.len();
    let n_left = tasks.len();
    if let Some(of) = &file.draw {
        draw(&mut tasks, of);
    }
    let n_undrawn = n_left - tasks.len();
    Ok(Tasks { tasks, n_excluded, n_undrawn })
}

/// Leaves as many combinations in `tasks` as `of` says, those that have the least hashes, each with all of
/// what is not drawn, as its seeds: so by chance, and the same each time; of a larger draw, those of a
/// smaller one are a part.
fn draw(tasks: &mut Vec<Task>, of: &Draw) {
    let hash = |task: &Task| records::sha256(task.words_without(&of.whole).join("\n").as_bytes());
    let hashes: Vec<String> = tasks.iter().map(hash).collect();
    let all: BTreeSet<&String> = hashes.iter().collect();
    let drawn: BTreeSet<&String> = all.into_iter().take(of.n).collect();
    let mut hashes = hashes.iter();
    tasks.retain(|_| hashes.next().is_some_and(|hash| drawn.contains(hash)));
}

/// SHA-256 of what decides the results of `task` of the case at `case`: the case with the task's levels, the
/// files that it names, the `runs` that are made, the version of the program.
///
/// # Errors
/// [`StudyError`] for a case that cannot be read, or a file that is not there.
pub(crate) fn hash(
    case: &Path,
    task: &Task,
    runs: &[String],
    inputs: &mut Inputs,
) -> Result<String, StudyError> {
    let file = shipped::read(case, &task.overrides)?;
    let mut text = format!("wakemix {VERSION}\nruns {runs:?}\n");
    for (name, print) in inputs.of(&file)? {
        text += &format!("{name} {print}\n");
    }
    text += &decisive_text(&file.case);
    Ok(records::sha256(text.as_bytes()))
}

/// The hashes of all `tasks`, on all cores.
///
/// # Errors
/// [`CampaignError::Level`] or [`CampaignError::Sample`] of the first task that cannot be read.
pub(crate) fn hashes(file: &CampaignFile, tasks: &[Task]) -> Result<Vec<String>, CampaignError> {
    let n_threads = study::cores();
    let found: Mutex<Vec<Option<Result<String, StudyError>>>> =
        Mutex::new(tasks.iter().map(|_| None).collect());
    let (next, broken) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
    std::thread::scope(|scope| {
        for _ in 0..n_threads {
            scope.spawn(|| {
                let mut inputs = Inputs::default();
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    // Tasks before the first one that is wrong are all looked at, so that it is the first.
                    let is_after = place > broken.load(Ordering::Relaxed);
                    let Some(task) = tasks.get(place).filter(|_| !is_after) else { return };
                    let hash = hash(&file.case, task, &file.runs, &mut inputs);
                    if hash.is_err() {
                        broken.fetch_min(place, Ordering::Relaxed);
                    }
                    if let Ok(mut found) = found.lock() {
                        found[place] = Some(hash);
                    }
                }
            });
        }
    });
    let found = found.into_inner().unwrap_or_default();
    let mut hashes = Vec::with_capacity(tasks.len());
    for (task, hash) in tasks.iter().zip(found) {
        match hash {
            Some(Ok(hash)) => hashes.push(hash),
            Some(Err(StudyError::Case(error))) => {
                return Err(CampaignError::Level {
                    settings: task.words(),
                    source: Box::new(error),
                });
            }
            Some(Err(error)) => {
                return Err(CampaignError::Sample {
                    settings: task.words(),
                    source: Box::new(error),
                });
            }
            None => {}
        }
    }
    Ok(hashes)
}
