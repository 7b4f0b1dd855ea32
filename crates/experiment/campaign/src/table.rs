//! The job table: where each task stands, in SQLite. Every change is one transaction, so that several
//! processes may work in one folder and a kill at any moment leaves it whole.

use crate::error::CampaignError;
use crate::task::{Task, VERSION};
use basis::records::Summary;
use formats::machine;
use rusqlite::{Connection, ErrorCode, Row, Transaction, TransactionBehavior, params};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long a process waits for another one's transaction.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often a transaction is begun that finds the table held for longer than that (–).
const MOST_TRIES: usize = 5;
/// Layout of the tables below, in SQLite's `user_version`.
const LAYOUT: i64 = 2;

/// Of a task: `attempts` are processes that took it and have not ended it well, `mark` is when its folder
/// showed progress last as it was taken, `fresh` tells that its folder is to go before it is made.
const SCHEMA: &str = "
CREATE TABLE meta(content TEXT NOT NULL);
CREATE TABLE tasks(
    id INTEGER PRIMARY KEY, hash TEXT NOT NULL UNIQUE, task TEXT NOT NULL,
    state TEXT NOT NULL DEFAULT 'pending', worker TEXT, host TEXT, pid INTEGER, since TEXT,
    attempts INTEGER NOT NULL DEFAULT 0, mark INTEGER NOT NULL DEFAULT 0,
    fresh INTEGER NOT NULL DEFAULT 0, wall_time REAL, backend TEXT, message TEXT);
CREATE INDEX by_state ON tasks(state, attempts, id);
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
        let table = Self::connect(path_in(folder))?;
        let layout = table.read(|connection| {
            connection.pragma_query_value(None, "user_version", |row| row.get::<_, i64>(0))
        })?;
        if layout != LAYOUT && table.is_planned()? {
            return Err(CampaignError::OtherLayout { folder: folder.to_owned() });
        }
        Ok(table)
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
            transaction.pragma_update(None, "user_version", LAYOUT)?;
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
        match patiently(open) {
            Ok(connection) => Ok(Self { connection, path }),
            Err(source) => Err(CampaignError::Table { doing: "open", path, source }),
        }
    }

    /// Does what `change` says in one transaction, which others wait for; begins it again where they hold the
    /// table for too long.
    pub(crate) fn change<T>(
        &mut self,
        doing: &'static str,
        change: impl Fn(&Transaction) -> rusqlite::Result<T>,
    ) -> Result<T, CampaignError> {
        let connection = &mut self.connection;
        let done = patiently(|| {
            let transaction =
                connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
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
        let count = |connection: &Connection| {
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
        };
        self.read(|connection| patiently(|| count(connection)))
    }

    /// Task `id` is complete with these `summaries`, after `wall_time` (s), computed on `backend`; false if
    /// another worker has taken it meanwhile.
    pub(crate) fn finish(
        &mut self,
        id: i64,
        worker: &str,
        summaries: &[Summary],
        wall_time: f64,
        backend: &str,
    ) -> Result<bool, CampaignError> {
        const DONE: &str = "UPDATE tasks SET state = 'done', wall_time = ?3, backend = ?4, message = NULL WHERE id = ?1 AND worker = ?2 AND state = 'running'";
        self.change("write", |transaction| {
            if transaction.execute(DONE, params![id, worker, wall_time, backend])? == 0 {
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

/// What `tried` gives, which is tried again, some times, where others hold the table for too long.
pub(crate) fn patiently<T>(mut tried: impl FnMut() -> rusqlite::Result<T>) -> rusqlite::Result<T> {
    for _ in 1..MOST_TRIES {
        match tried() {
            Err(error) if is_busy(&error) => {}
            other => return other,
        }
    }
    tried()
}

fn is_busy(error: &rusqlite::Error) -> bool {
    let code = error.sqlite_error_code();
    matches!(code, Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked))
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
