//! How far a campaign is.

use crate::error::CampaignError;
use crate::table::{Counts, Table, parsed};
use crate::task::Task;
use crate::worker::is_there;
use std::path::Path;

/// A task that has failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Its number.
    pub task: i64,
    /// Its levels, in words.
    pub settings: String,
    /// Why.
    pub message: String,
}

/// Where a campaign stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Its name.
    pub name: String,
    /// Tasks in each state.
    pub counts: Counts,
    /// Tasks of processes that have ended, which come back with the next `run` (–).
    pub n_left_behind: i64,
    /// Mean wall time of the tasks that are done (s); absent before the first.
    pub task_time: Option<f64>,
    /// Tasks an hour at the pace of those that are being made (–); absent where none is.
    pub rate: Option<f64>,
    /// Time left at this pace (s); absent where none is being made.
    pub time_left: Option<f64>,
    /// What has failed.
    pub failures: Vec<Failure>,
}

/// Where the campaign in `folder` stands.
///
/// # Errors
/// [`CampaignError::NoCampaign`], [`CampaignError::Table`].
pub fn status(folder: &Path) -> Result<Status, CampaignError> {
    const FAILED: &str =
        "SELECT id, task, coalesce(message, '') FROM tasks WHERE state = 'failed' ORDER BY id";
    const TIME: &str = "SELECT avg(wall_time) FROM tasks WHERE state = 'done'";
    let table = Table::open(folder)?;
    let (meta, counts) = (table.meta()?, table.counts()?);
    let workers = table.workers()?;
    let ended = workers.iter().filter(|worker| !is_there(folder, worker));
    let n_left_behind: i64 = ended.map(|worker| worker.n_tasks).sum();
    let failures = table.read(|connection| {
        let mut query = connection.prepare(FAILED)?;
        let failure = |row: &rusqlite::Row| {
            let task: Task = parsed(row, 1)?;
            Ok(Failure { task: row.get(0)?, settings: task.words(), message: row.get(2)? })
        };
        query.query_map([], failure)?.collect::<rusqlite::Result<Vec<Failure>>>()
    })?;
    let task_time: Option<f64> =
        table.read(|connection| connection.query_row(TIME, [], |row| row.get(0)))?;
    let n_running = counts.running - n_left_behind;
    let rate = task_time.filter(|_| n_running > 0).map(|time| n_running as f64 * 3600.0 / time);
    let n_open = (counts.pending + counts.running) as f64;
    let time_left = rate.map(|rate| 3600.0 * n_open / rate);
    Ok(Status { name: meta.name, counts, n_left_behind, task_time, rate, time_left, failures })
}
