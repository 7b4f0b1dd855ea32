//! The job table: where each task stands, in SQLite. Every change is one transaction, so that several
//! processes may work in one folder and a kill at any moment leaves it whole.

use crate::error::CampaignError;
use crate::task::{Task, VERSION};
use basis::records::Summary;
use formats::machine;
use rusqlite::{Connection, OptionalExtension, Row, Transaction, TransactionBehavior, params};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long a process waits for another one's transaction.
const PATIENCE: Duration = Duration::from_secs(60);
/// Processes that may end while they make a task before it is failed (–).
const MOST_ATTEMPTS: i64 = 3;

const SCHEMA: &str = "
CREATE TABLE meta(content TEXT NOT NULL);
CREATE TABLE tasks(
    id INTEGER PRIMARY KEY, hash TEXT NOT NULL UNIQUE, task TEXT NOT NULL,
    state TEXT NOT NULL DEFAULT 'pending', worker TEXT, host TEXT, pid INTEGER, since TEXT,
    attempts INTEGER NOT NULL DEFAULT 0, wall_time REAL, message TEXT);
CREATE INDEX by_state ON tasks(state, id);
CREATE TABLE summaries(
    task INTEGER NOT NULL, place INTEGER NOT NULL, summary TEXT NOT NULL, PRIMARY KEY(task, place));
CREATE TABLE workers(name TEXT PRIMARY KEY, host TEXT NOT NULL, beat INTEGER NOT NULL);
";

/// What holds for all tasks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Meta {
    /// Name of the campaign.
    pub(crate) name: String,
    /// Version of the program that planned it.
    pub(crate) version: String,
    /// Its file, and the case.
    pub(crate) file: PathBuf,
    pub(crate) case: PathBuf,
    /// SHA-256 of all hashes.
    pub(crate) plan: String,
    /// Columns of the factors.
    pub(crate) columns: Vec<String>,
    /// Runs that are made; all when empty.
    pub(crate) runs: Vec<String>,
    /// What stays of a task: `summary`, `series` or `all`.
    pub(crate) keep: String,
    /// Names of the numbers to collect.
    pub(crate) collect: Vec<String>,
    /// Threads of a task (–); all cores when absent.
    pub(crate) threads: Option<usize>,
    /// Disk that a task takes at most while it is made (bytes).
    pub(crate) disk: u64,
}

/// Tasks in each state (–).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Still to be made (–).
    pub pending: i64,
    /// Being made (–).
    pub running: i64,
    /// Complete (–).
    pub done: i64,
    /// Failed (–).
    pub failed: i64,
}

impl Counts {
    /// Of all states (–).
    pub fn all(&self) -> i64 {
        self.pending + self.running + self.done + self.failed
    }
}

/// A task that a worker has taken.
#[derive(Clone, Debug)]
pub(crate) struct Claimed {
    pub(crate) id: i64,
    pub(crate) hash: String,
    pub(crate) task: Task,
}

/// A process that is said to make tasks.
#[derive(Clone, Debug)]
pub(crate) struct KnownWorker {
    pub(crate) name: String,
    pub(crate) host: String,
    /// When it was heard of last, in seconds since 1970; none where it never was.
    pub(crate) beat: Option<i64>,
    /// Tasks that it has (–).
    pub(crate) n_tasks: i64,
}

/// The open job table.
pub(crate) struct Table {
    pub(crate) connection: Connection,
    path: PathBuf,
}

/// The job table in `folder`.
pub(crate) fn path_in(folder: &Path) -> PathBuf {
    folder.join("campaign.db")
}

impl Table {
    /// Opens the table in `folder`.
    ///
    /// # Errors
    /// [`CampaignError::NoCampaign`], [`CampaignError::Table`].
    pub(crate) fn open(folder: &Path) -> Result<Self, CampaignError> {
        if !path_in(folder).is_file() {
            return Err(CampaignError::NoCampaign { folder: folder.to_owned() });
        }
        Self::connect(path_in(folder))
    }

    /// Makes the table of `tasks` in `folder`, which has none; it is there whole or not at all.
    ///
    /// # Errors
    /// [`CampaignError::Table`].
    pub(crate) fn create(
        folder: &Path,
        meta: &Meta,
        tasks: &[(Task, String)],
    ) -> Result<(), CampaignError> {
        let mut table = Self::connect(path_in(folder))?;
        table.change("make", |transaction| {
            transaction.execute_batch(SCHEMA)?;
            transaction.execute("INSERT INTO meta VALUES(?1)", [json(meta)?])?;
            let mut insert =
                transaction.prepare("INSERT INTO tasks(id, hash, task) VALUES(?1, ?2, ?3)")?;
            for (index, (task, hash)) in tasks.iter().enumerate() {
                insert.execute(params![index as i64 + 1, hash, json(task)?])?;
            }
            Ok(())
        })
    }

    fn connect(path: PathBuf) -> Result<Self, CampaignError> {
        let open = || -> rusqlite::Result<Connection> {
            let connection = Connection::open(&path)?;
            connection.busy_timeout(PATIENCE)?;
            // A journal in shared memory is for processes of one machine alone.
            let journal = if machine::is_shared(&path) { "DELETE" } else { "WAL" };
            connection.pragma_update(None, "journal_mode", journal)?;
            connection.pragma_update(None, "synchronous", "FULL")?;
            Ok(connection)
        };
        match open() {
            Ok(connection) => Ok(Self { connection, path }),
            Err(source) => Err(CampaignError::Table { doing: "open", path, source }),
        }
    }

    /// Does what `change` says in one transaction, which others wait for.
    pub(crate) fn change<T>(
        &mut self,
        doing: &'static str,
        change: impl FnOnce(&Transaction) -> rusqlite::Result<T>,
    ) -> Result<T, CampaignError> {
        let connection = &mut self.connection;
        let done = connection.transaction_with_behavior(TransactionBehavior::Immediate);
        let done = done.and_then(|transaction| {
            let found = change(&transaction)?;
            transaction.commit()?;
            Ok(found)
        });
        done.map_err(|source| CampaignError::Table { doing, path: self.path.clone(), source })
    }

    /// What `query` finds.
    pub(crate) fn read<T>(
        &self,
        query: impl FnOnce(&Connection) -> rusqlite::Result<T>,
    ) -> Result<T, CampaignError> {
        let failed =
            |source| CampaignError::Table { doing: "read", path: self.path.clone(), source };
        query(&self.connection).map_err(failed)
    }

    /// Whether the plan is in the table: not where a process was killed while it made the file.
    pub(crate) fn is_planned(&self) -> Result<bool, CampaignError> {
        let count = "SELECT count(*) FROM sqlite_master WHERE name = 'meta'";
        self.read(|connection| connection.query_row(count, [], |row| row.get(0)))
    }

    /// What holds for all tasks.
    pub(crate) fn meta(&self) -> Result<Meta, CampaignError> {
        self.read(|connection| {
            connection.query_row("SELECT content FROM meta", [], |row| parsed(row, 0))
        })
    }

    pub(crate) fn set_meta(&mut self, meta: &Meta) -> Result<(), CampaignError> {
        self.change("write", |transaction| {
            transaction.execute("UPDATE meta SET content = ?1", [json(meta)?]).map(drop)
        })
    }

    /// How many tasks are in each state.
    pub(crate) fn counts(&self) -> Result<Counts, CampaignError> {
        self.read(|connection| {
            let mut counts = Counts::default();
            let mut query =
                connection.prepare("SELECT state, count(*) FROM tasks GROUP BY state")?;
            let mut rows = query.query([])?;
            while let Some(row) = rows.next()? {
                let n = row.get(1)?;
                match row.get::<_, String>(0)?.as_str() {
                    "pending" => counts.pending = n,
                    "running" => counts.running = n,
                    "done" => counts.done = n,
                    _ => counts.failed = n,
                }
            }
            Ok(counts)
        })
    }

    /// Takes the next pending task, of those with numbers in `wanted` where it names any, for `worker`.
    pub(crate) fn claim(
        &mut self,
        worker: &str,
        host: &str,
        wanted: Option<(i64, i64)>,
    ) -> Result<Option<Claimed>, CampaignError> {
        const CLAIM: &str = "UPDATE tasks SET state = 'running', worker = ?1, host = ?2, pid = ?3, since = ?4, attempts = attempts + 1, message = NULL \
             WHERE id = (SELECT id FROM tasks WHERE state = 'pending' AND id BETWEEN ?5 AND ?6 ORDER BY id LIMIT 1) \
             RETURNING id, hash, task";
        let (first, last) = wanted.unwrap_or((1, i64::MAX));
        let (pid, since) = (std::process::id(), formats::clock::now());
        self.change("claim a task in", |transaction| {
            let claimed = |row: &Row| {
                Ok(Claimed { id: row.get(0)?, hash: row.get(1)?, task: parsed(row, 2)? })
            };
            let values = params![worker, host, pid, since, first, last];
            transaction.query_row(CLAIM, values, claimed).optional()
        })
    }

    /// Task `id` is complete with these `summaries`, after `wall_time` (s); false where another worker has
    /// taken it meanwhile.
    pub(crate) fn finish(
        &mut self,
        id: i64,
        worker: &str,
        summaries: &[Summary],
        wall_time: f64,
    ) -> Result<bool, CampaignError> {
        const DONE: &str = "UPDATE tasks SET state = 'done', wall_time = ?3, message = NULL WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| {
            if transaction.execute(DONE, params![id, worker, wall_time])? == 0 {
                return Ok(false);
            }
            transaction.execute("DELETE FROM summaries WHERE task = ?1", [id])?;
            for (place, summary) in summaries.iter().enumerate() {
                let values = params![id, place as i64, json(summary)?];
                transaction.execute("INSERT INTO summaries VALUES(?1, ?2, ?3)", values)?;
            }
            Ok(true)
        })
    }

    /// Task `id` has failed with `message`.
    pub(crate) fn fail(
        &mut self,
        id: i64,
        worker: &str,
        message: &str,
    ) -> Result<(), CampaignError> {
        const FAILED: &str = "UPDATE tasks SET state = 'failed', message = ?3 WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| {
            transaction.execute(FAILED, params![id, worker, message]).map(drop)
        })
    }

    /// Task `id` is to be made by somebody else, and this attempt does not count.
    pub(crate) fn give_back(&mut self, id: i64, worker: &str) -> Result<(), CampaignError> {
        const BACK: &str = "UPDATE tasks SET state = 'pending', attempts = attempts - 1, worker = NULL WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| transaction.execute(BACK, params![id, worker]).map(drop))
    }

    /// Failed tasks between `first` and `last` are to be made again; gives their numbers.
    pub(crate) fn retry(&mut self, (first, last): (i64, i64)) -> Result<Vec<i64>, CampaignError> {
        const RETRY: &str = "UPDATE tasks SET state = 'pending', attempts = 0 WHERE state = 'failed' AND id BETWEEN ?1 AND ?2 RETURNING id";
        self.change("write", |transaction| {
            let mut query = transaction.prepare(RETRY)?;
            query.query_map([first, last], |row| row.get(0))?.collect()
        })
    }

    /// Tasks of the worker called `name`, which has ended, come back; those that have been begun too often
    /// are failed.
    pub(crate) fn bring_back(&mut self, name: &str) -> Result<(), CampaignError> {
        const FAILED: &str = "UPDATE tasks SET state = 'failed', message = ?2 WHERE worker = ?1 AND state = 'running' AND attempts >= ?3";
        const BACK: &str = "UPDATE tasks SET state = 'pending', worker = NULL WHERE worker = ?1 AND state = 'running'";
        let message = format!(
            "{MOST_ATTEMPTS} processes ended while they made it: killed, out of memory, or by the crash of a controller's library; make it alone with `wakemix campaign exec`"
        );
        self.change("write", |transaction| {
            transaction.execute(FAILED, params![name, message, MOST_ATTEMPTS])?;
            transaction.execute(BACK, [name])?;
            transaction.execute("DELETE FROM workers WHERE name = ?1", [name]).map(drop)
        })
    }

    /// Notes that the worker called `name` is there at `now`, in seconds since 1970.
    pub(crate) fn beat(&mut self, name: &str, host: &str, now: i64) -> Result<(), CampaignError> {
        const BEAT: &str =
            "INSERT INTO workers VALUES(?1, ?2, ?3) ON CONFLICT(name) DO UPDATE SET beat = ?3";
        self.change("write", |transaction| {
            transaction.execute(BEAT, params![name, host, now]).map(drop)
        })
    }

    /// All processes that have tasks.
    pub(crate) fn workers(&self) -> Result<Vec<KnownWorker>, CampaignError> {
        const WORKERS: &str = "SELECT t.worker, max(t.host), max(w.beat), count(*) FROM tasks t LEFT JOIN workers w ON w.name = t.worker WHERE t.state = 'running' GROUP BY t.worker";
        self.read(|connection| {
            let mut query = connection.prepare(WORKERS)?;
            let worker = |row: &Row| {
                Ok(KnownWorker {
                    name: row.get(0)?,
                    host: row.get(1)?,
                    beat: row.get(2)?,
                    n_tasks: row.get(3)?,
                })
            };
            query.query_map([], worker)?.collect()
        })
    }
}

/// Nothing where this version of the program planned the campaign of `meta` in `folder`.
///
/// # Errors
/// [`CampaignError::OtherVersion`].
pub(crate) fn check_version(folder: &Path, meta: &Meta) -> Result<(), CampaignError> {
    if meta.version == VERSION {
        return Ok(());
    }
    let (planned, here) = (meta.version.clone(), VERSION.to_owned());
    Err(CampaignError::OtherVersion { folder: folder.to_owned(), planned, here })
}

/// `value` as it stands in the table.
pub(crate) fn json(value: &impl Serialize) -> rusqlite::Result<String> {
    let failed = |error: serde_json::Error| rusqlite::Error::ToSqlConversionFailure(error.into());
    serde_json::to_string(value).map_err(failed)
}

/// The value in column `index` of `row`.
pub(crate) fn parsed<T: for<'de> Deserialize<'de>>(row: &Row, index: usize) -> rusqlite::Result<T> {
    let text: String = row.get(index)?;
    serde_json::from_str(&text).map_err(|error| {
        rusqlite::Error::FromSqlConversionFailure(index, rusqlite::types::Type::Text, error.into())
    })
}
