//! From a campaign's file to its job table, and what it will cost.

use crate::error::CampaignError;
use crate::table::{Meta, Table, path_in};
use crate::task::{self, Task, Tasks, VERSION};
use crate::whole;
use formats::atomic;
use formats::case::{CampaignFile, Keep};
use formats::{machine, records, shipped};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use study::Sample;

/// Tasks that are looked at and timed for a moment (–).
const SAMPLED: usize = 3;
/// Time of a task (s) up to which some are made whole instead: of a second, the steps are two thirds.
const WHOLE: f64 = 20.0;
/// Disk that the numbers of a run of a task take in the table (bytes), about.
const NUMBERS: u64 = 8 << 10;

/// A factor as a plan tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedFactor {
    /// Its key or name.
    pub name: String,
    /// Its levels, in words.
    pub levels: Vec<String>,
}

/// What the tasks cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// CPU time of all tasks together (s); absent where no sample tells its speed.
    pub cpu_time: Option<f64>,
    /// Wall time on this machine (s); absent where no sample tells its speed.
    pub wall_time: Option<f64>,
    /// Tasks at a time behind that (–).
    pub n_workers: usize,
    /// Threads of a task (–).
    pub threads: usize,
    /// Tasks that were timed (–).
    pub n_sampled: usize,
    /// Whether these were made whole; else a moment of each was timed.
    pub made_whole: bool,
    /// Memory of the tasks that are made at a time (bytes).
    pub memory: u64,
    /// Disk that stays (bytes).
    pub disk: u64,
    /// Disk of the tasks under way beside it (bytes).
    pub passing: u64,
}

/// A plan that is in its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the campaign.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// What is varied.
    pub factors: Vec<PlannedFactor>,
    /// Tasks (–).
    pub n_tasks: usize,
    /// Combinations of levels that are excluded (–).
    pub n_excluded: usize,
    /// Tasks of the others that were not drawn (–).
    pub n_undrawn: usize,
    /// Whether the folder held this plan before.
    pub was_there: bool,
    /// What it costs.
    pub cost: Cost,
}

/// Plans the campaign of the file at `path` in `folder`, `campaigns/NAME` when absent: every task is read by
/// the case reader, a sample of them is timed. The same plan in the same folder changes nothing that is done.
///
/// # Errors
/// [`CampaignError`].
pub fn plan(path: &Path, folder: Option<&Path>) -> Result<Plan, CampaignError> {
    study::outputs::announce();
    let mut file = shipped::read_campaign(path)?;
    if file.case.is_file() {
        file.case = std::path::absolute(&file.case).unwrap_or(file.case);
    }
    let usual = Path::new("campaigns").join(&file.name);
    let folder = folder.unwrap_or(&usual).to_owned();
    let Tasks { tasks, n_excluded, n_undrawn } = task::all(&file)?;
    let hashes = task::hashes(&file, &tasks)?;
    check_distinct(&tasks, &hashes)?;
    let threads = threads(&file, &tasks[0])?;
    let cost = cost(&file, &folder, (&tasks, &hashes), threads)?;
    let meta = Meta {
        name: file.name.clone(),
        version: VERSION.to_owned(),
        file: std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
        case: file.case.clone(),
        plan: records::sha256(hashes.join("\n").as_bytes()),
        columns: tasks[0].columns.iter().map(|(name, _)| name.clone()).collect(),
        runs: file.runs.clone(),
        keep: word(file.keep).to_owned(),
        collect: file.collect.clone(),
        threads,
        disk: cost.passing / cost.n_workers as u64,
    };
    let n_tasks = tasks.len();
    let was_there = write(&folder, &meta, tasks.into_iter().zip(hashes).collect())?;
    let words = |factor: &formats::case::Factor| PlannedFactor {
        name: factor.name.clone(),
        levels: factor.levels.iter().map(|level| level.name.words()).collect(),
    };
    let factors = file.factors.iter().map(words).collect();
    Ok(Plan { name: file.name, folder, factors, n_tasks, n_excluded, n_undrawn, was_there, cost })
}

/// The word of the campaign's file for `keep`.
fn word(keep: Keep) -> &'static str {
    match keep {
        Keep::Summary => "summary",
        Keep::Series => "series",
        Keep::All => "all",
    }
}

fn check_distinct(tasks: &[Task], hashes: &[String]) -> Result<(), CampaignError> {
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for (place, hash) in hashes.iter().enumerate() {
        if let Some(before) = known.insert(hash, place) {
            let (first, second) = (tasks[before].words(), tasks[place].words());
            return Err(CampaignError::Duplicate { first, second });
        }
    }
    Ok(())
}

/// Threads of a task: as the campaign or the case says, else one in prescribed wind and all cores where the
/// air is resolved.
fn threads(file: &CampaignFile, first: &Task) -> Result<Option<usize>, CampaignError> {
    let case = shipped::read(&file.case, &first.overrides)?.case;
    let usual = || if case.flow.solver.needs_self_check { None } else { Some(1) };
    Ok(file.threads.or(case.flow.threads).or_else(usual))
}

/// Tasks at a time on this machine (–): as many as cores carry with so many threads each.
pub(crate) fn n_workers(threads: Option<usize>) -> usize {
    let cores = study::cores();
    threads.map_or(1, |threads| (cores / threads).max(1))
}

/// The cost of `tasks` with these `hashes` in `folder`, from some that are timed, chosen by their hashes: so
/// by chance, and the same each time. First, middle and last would be the corners of all factors.
fn cost(
    file: &CampaignFile,
    folder: &Path,
    (tasks, hashes): (&[Task], &[String]),
    threads: Option<usize>,
) -> Result<Cost, CampaignError> {
    let mut by_hash: Vec<(&String, &Task)> = hashes.iter().zip(tasks).collect();
    by_hash.sort_by_key(|(hash, _)| *hash);
    let in_turn: Vec<&Task> = by_hash.into_iter().map(|(_, task)| task).collect();
    let mut samples = Vec::with_capacity(SAMPLED);
    for task in in_turn.iter().take(SAMPLED) {
        let case = shipped::read(&file.case, &task.overrides)?;
        let failed =
            |source| CampaignError::Sample { settings: task.words(), source: Box::new(source) };
        samples.push(Sample::of(&case, &file.runs, threads).map_err(failed)?);
    }
    let cores = study::cores();
    let n_workers = n_workers(threads).min(tasks.len());
    let mut times = Times {
        seconds: samples.iter().filter_map(|sample| sample.wall_time).collect(),
        n_sampled: samples.len(),
        made_whole: false,
    };
    let longest = times.seconds.iter().copied().reduce(f64::max);
    if longest.is_some_and(|longest| longest <= WHOLE) {
        let seconds = whole::times(file, &in_turn, threads, n_workers, folder)?;
        times = Times { n_sampled: seconds.len(), seconds, made_whole: true };
    }
    Ok(spread(&samples, &times, tasks.len(), n_workers, threads.unwrap_or(cores), file.keep))
}

/// What tasks took.
pub(crate) struct Times {
    /// Wall time of each whose time is known (s).
    pub(crate) seconds: Vec<f64>,
    pub(crate) n_sampled: usize,
    pub(crate) made_whole: bool,
}

/// The cost of `n_tasks` that are like `samples` and take such `times`, `n_workers` at a time, on so many
/// `threads` each.
pub(crate) fn spread(
    samples: &[Sample],
    times: &Times,
    n_tasks: usize,
    n_workers: usize,
    threads: usize,
    keep: Keep,
) -> Cost {
    let all = &times.seconds;
    let mean = (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64);
    let most = |part: fn(&Sample) -> u64| samples.iter().map(part).max().unwrap_or(0);
    let kept = NUMBERS
        + match keep {
            Keep::Summary => 0,
            Keep::Series => most(|sample| sample.series),
            Keep::All => most(|sample| sample.disk),
        };
    Cost {
        cpu_time: mean.map(|mean| (n_tasks * threads) as f64 * mean),
        // The last round is as long as the others, however few tasks are in it.
        wall_time: mean.map(|mean| n_tasks.div_ceil(n_workers) as f64 * mean),
        n_workers,
        threads,
        n_sampled: times.n_sampled,
        made_whole: times.made_whole,
        memory: n_workers as u64 * most(|sample| sample.memory),
        disk: n_tasks as u64 * kept,
        passing: n_workers as u64 * most(|sample| sample.disk),
    }
}

/// Puts the plan into `folder`, where it may be already: then what may change without another result is
/// taken over.
fn write(folder: &Path, meta: &Meta, tasks: Vec<(Task, String)>) -> Result<bool, CampaignError> {
    if path_in(folder).is_file() {
        let mut table = Table::open(folder)?;
        if table.is_planned()? {
            let there = table.meta()?;
            if let Some(difference) = difference(&table, &there, meta)? {
                let (folder, found) = (folder.to_owned(), there.name);
                return Err(CampaignError::OtherPlan { folder, found, difference });
            }
            table.set_meta(meta)?;
            return Ok(true);
        }
    }
    atomic::create_folder(folder)?;
    let free = machine::free_disk(folder);
    let needed = tasks.len() as u64 * NUMBERS;
    if let Some(free) = free.filter(|free| *free < needed) {
        let source = study::StudyError::Disk {
            needed: needed as f64 / 1e9,
            available: free as f64 / 1e9,
            directory: folder.to_owned(),
        };
        return Err(CampaignError::Sample {
            settings: meta.name.clone(),
            source: Box::new(source),
        });
    }
    Table::create(folder, meta, &tasks)?;
    Ok(false)
}

/// In what the plan of `meta` differs from that of `there` in `table`; none where they are the same.
fn difference(table: &Table, there: &Meta, meta: &Meta) -> Result<Option<String>, CampaignError> {
    if there.plan == meta.plan {
        return Ok(None);
    }
    let n_tasks = table.counts()?.all();
    Ok(Some(if there.name != meta.name {
        format!("the campaign `{}`", meta.name)
    } else if there.version != meta.version {
        format!("wakemix {} planned it, this is {}", there.version, meta.version)
    } else if there.columns != meta.columns {
        format!("it varies {}, not {}", meta.columns.join(", "), there.columns.join(", "))
    } else {
        format!(
            "its levels, its draw, its case or a file that this names are others than those of the {n_tasks} tasks there"
        )
    }))
}
