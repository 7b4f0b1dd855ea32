//! Which task a worker takes next, and what becomes of tasks whose process has ended.
//!
//! When a process with several workers crashes, all its tasks come back, and one alone is to blame. So a task
//! that came back is made alone: its process takes it while it holds no other, and takes none beside it. An
//! innocent one is then done, and the other is failed after some ends.

use crate::error::CampaignError;
use crate::table::{Table, parsed};
use crate::task::Task;
use rusqlite::{OptionalExtension, Row, params};

/// Processes that may end while they make a task before it is failed (–).
const MOST_ATTEMPTS: i64 = 3;

/// A task that a worker has taken.
#[derive(Clone, Debug)]
pub(crate) struct Claimed {
    pub(crate) id: i64,
    pub(crate) hash: String,
    pub(crate) task: Task,
    /// Whether what lies in its folder is to go before it is made.
    pub(crate) is_fresh: bool,
}

/// What there is to do next.
#[derive(Clone, Debug)]
pub(crate) enum Next {
    /// This task.
    Task(Box<Claimed>),
    /// What is pending is to be made alone, or what this process makes is: wait for that.
    Wait,
    /// No task is pending.
    Nothing,
}

impl Table {
    /// Takes the next pending task, of those numbered in `wanted` where it names any, for `worker`; `mark`
    /// tells when the folder of a task has shown progress last.
    pub(crate) fn claim(
        &mut self,
        worker: &str,
        host: &str,
        wanted: Option<(i64, i64)>,
        mark: impl Fn(i64) -> i64,
    ) -> Result<Next, CampaignError> {
        const HELD: &str = "SELECT count(*), coalesce(max(attempts), 0) FROM tasks WHERE worker = ?1 AND state = 'running'";
        const NEW: &str = "SELECT id FROM tasks WHERE state = 'pending' AND attempts = 0 AND id BETWEEN ?1 AND ?2 ORDER BY id LIMIT 1";
        const CAME_BACK: &str = "SELECT id FROM tasks WHERE state = 'pending' AND attempts > 0 AND id BETWEEN ?1 AND ?2 ORDER BY id LIMIT 1";
        const CLAIM: &str = "UPDATE tasks SET state = 'running', worker = ?1, host = ?2, pid = ?3, since = ?4, attempts = attempts + 1, mark = ?5, message = NULL \
             WHERE id = ?6 RETURNING id, hash, task, fresh";
        let (first, last) = wanted.unwrap_or((1, i64::MAX));
        let (pid, since) = (std::process::id(), formats::clock::now());
        self.change("claim a task in", |transaction| {
            let find = |query: &str| {
                let id = |row: &Row| row.get::<_, i64>(0);
                transaction.query_row(query, [first, last], id).optional()
            };
            let (new, came_back) = (find(NEW)?, find(CAME_BACK)?);
            let held = |row: &Row| Ok((row.get(0)?, row.get(1)?));
            let (n_held, attempts): (i64, i64) = transaction.query_row(HELD, [worker], held)?;
            let id = match (new, came_back) {
                (None, None) => return Ok(Next::Nothing),
                _ if attempts > 1 => return Ok(Next::Wait),
                (Some(id), _) => id,
                (None, Some(id)) if n_held == 0 => id,
                (None, Some(_)) => return Ok(Next::Wait),
            };
            let claimed = |row: &Row| {
                Ok(Claimed {
                    id: row.get(0)?,
                    hash: row.get(1)?,
                    task: parsed(row, 2)?,
                    is_fresh: row.get(3)?,
                })
            };
            let values = params![worker, host, pid, since, mark(id), id];
            Ok(Next::Task(Box::new(transaction.query_row(CLAIM, values, claimed)?)))
        })
    }

    /// The folder of task `id`, which `worker` has, is empty.
    pub(crate) fn begin_anew(&mut self, id: i64, worker: &str) -> Result<(), CampaignError> {
        const EMPTY: &str = "UPDATE tasks SET fresh = 0, mark = 0 WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| {
            transaction.execute(EMPTY, params![id, worker]).map(drop)
        })
    }

    /// Task `id` is to be made by somebody else, and this attempt does not count.
    pub(crate) fn give_back(&mut self, id: i64, worker: &str) -> Result<(), CampaignError> {
        const BACK: &str = "UPDATE tasks SET state = 'pending', attempts = attempts - 1, worker = NULL WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| transaction.execute(BACK, params![id, worker]).map(drop))
    }

    /// Failed tasks between `first` and `last` come back. Whoever takes one empties its folder: only
    /// then nobody else is in it.
    pub(crate) fn retry(&mut self, (first, last): (i64, i64)) -> Result<(), CampaignError> {
        const RETRY: &str = "UPDATE tasks SET state = 'pending', attempts = 0, fresh = 1 WHERE state = 'failed' AND id BETWEEN ?1 AND ?2";
        self.change("write", |transaction| transaction.execute(RETRY, [first, last]).map(drop))
    }

    /// Tasks of the worker called `name`, which has ended, come back. Those that have got further, as `mark`
    /// tells of their folders, come back as if they had not been begun; of the others those that have been
    /// begun too often are failed.
    pub(crate) fn bring_back(
        &mut self,
        name: &str,
        mark: impl Fn(i64) -> i64,
    ) -> Result<(), CampaignError> {
        const HELD: &str =
            "SELECT id, mark, attempts FROM tasks WHERE worker = ?1 AND state = 'running'";
        const SET: &str =
            "UPDATE tasks SET state = ?2, attempts = ?3, worker = ?4, message = ?5 WHERE id = ?1";
        let message = format!(
            "{MOST_ATTEMPTS} processes ended while they made it, and it got no further: killed, out of memory, or by the crash of a controller's library; make it alone with `wakemix campaign exec`"
        );
        self.change("write", |transaction| {
            let mut query = transaction.prepare(HELD)?;
            let held = |row: &Row| Ok((row.get(0)?, row.get(1)?, row.get(2)?));
            let tasks: Vec<(i64, i64, i64)> =
                query.query_map([name], held)?.collect::<rusqlite::Result<_>>()?;
            for (id, before, attempts) in tasks {
                let attempts = if mark(id) > before { 0 } else { attempts };
                let values = if attempts >= MOST_ATTEMPTS {
                    params![id, "failed", attempts, name, message]
                } else {
                    params![id, "pending", attempts, None::<String>, None::<String>]
                };
                transaction.execute(SET, values)?;
            }
            transaction.execute("DELETE FROM workers WHERE name = ?1", [name]).map(drop)
        })
    }
}
