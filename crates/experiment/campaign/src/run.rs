//! Making tasks, side by side, until none is left.

use crate::claim::{Claimed, Next};
use crate::error::CampaignError;
use crate::make::{Made, discard, make, mark, prune, prune_all};
use crate::plan::n_workers;
use crate::table::{Counts, Meta, Table, check_version};
use crate::worker::{Worker, bring_back};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use study::Inputs;

/// How long a thread waits for tasks beside which it may take none before it looks again.
const MOMENT: Duration = Duration::from_secs(1);

/// What is to be made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Tasks at a time; as many as cores carry when absent.
    pub jobs: Option<usize>,
    /// Make failed tasks again.
    pub retry_failed: bool,
    /// First and last of the tasks to be made, from 1; all when absent.
    pub only: Option<(i64, i64)>,
    /// End after so many tasks.
    pub limit: Option<i64>,
}

/// How far a campaign is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Task that has just ended.
    pub task: i64,
    /// Its levels, in words.
    pub settings: String,
    /// Why it failed, where it did.
    pub failure: Option<String>,
    /// Where the tasks of the campaign stand.
    pub counts: Counts,
    /// Tasks that this process is to make still (–).
    pub n_left: i64,
    /// Time left for them at the pace so far (s).
    pub time_left: f64,
}

/// Observes the making of tasks.
pub trait Observer: Send {
    /// The tasks begin: so many at a time.
    fn beginning(&mut self, _counts: &Counts, _n_workers: usize) {}
    /// A task has ended.
    fn ended(&mut self, _progress: &Progress) {}
}

/// Says nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {}

/// How the making ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// Tasks that were made (–).
    pub n_done: i64,
    /// Tasks that failed (–).
    pub n_failed: i64,
    /// Tasks that were asked for and that other processes are making (–).
    pub n_elsewhere: i64,
    /// Whether it was stopped before all were made.
    pub is_interrupted: bool,
    /// Where all tasks of the campaign stand.
    pub counts: Counts,
}

/// Makes the tasks of the campaign in `folder` that are pending, until none is left or `stop` asks for an
/// end.
///
/// # Errors
/// [`CampaignError`]; a task that cannot be made is no error, but failed.
pub fn run(
    folder: &Path,
    options: &RunOptions,
    stop: &AtomicBool,
    observer: &mut dyn Observer,
) -> Result<Ended, CampaignError> {
    study::outputs::announce();
    let mut table = Table::open(folder)?;
    let meta = table.meta()?;
    check_version(folder, &meta)?;
    let wanted = options.only.map(|only| clipped(&table, only)).transpose()?;
    bring_back(folder, &mut table)?;
    if options.retry_failed {
        table.retry(wanted.unwrap_or((1, i64::MAX)))?;
    }
    let done = done(&table)?;
    prune_all(folder, &meta.keep, |id| done.binary_search(&id).is_ok())?;
    let worker = Worker::enter(folder)?;
    let counts = table.counts()?;
    let n_open = count(&table, "pending", wanted)?.min(options.limit.unwrap_or(i64::MAX));
    let most = usize::try_from(n_open).unwrap_or(usize::MAX).max(1);
    let n_workers = options.jobs.unwrap_or_else(|| n_workers(meta.threads)).min(most).max(1);
    observer.beginning(&counts, n_workers);
    let job = Job {
        folder,
        meta,
        wanted,
        worker: &worker,
        stop,
        left: AtomicI64::new(options.limit.unwrap_or(i64::MAX)),
        state: Mutex::new(State {
            observer,
            ended: Ended::default(),
            n_open,
            began: Instant::now(),
            error: None,
        }),
        has_ended: Condvar::new(),
    };
    std::thread::scope(|scope| {
        for _ in 0..n_workers {
            scope.spawn(|| {
                if let Err(error) = job.work() {
                    job.state().error.get_or_insert(error);
                }
            });
        }
    });
    let state = job.state.into_inner().unwrap_or_else(PoisonError::into_inner);
    match state.error {
        Some(error) => Err(error),
        None => {
            let n_elsewhere = count(&table, "running", wanted)?;
            Ok(Ended { n_elsewhere, counts: table.counts()?, ..state.ended })
        }
    }
}

/// `only`, as far as there are such tasks.
fn clipped(table: &Table, (first, last): (i64, i64)) -> Result<(i64, i64), CampaignError> {
    let n_tasks = table.counts()?.all();
    if first < 1 || first > n_tasks || last < first {
        let wanted = if first == last { first.to_string() } else { format!("{first}-{last}") };
        return Err(CampaignError::NoSuchTask { wanted, n_tasks });
    }
    Ok((first, last.min(n_tasks)))
}

/// Numbers of the tasks that are done, in their order.
fn done(table: &Table) -> Result<Vec<i64>, CampaignError> {
    const DONE: &str = "SELECT id FROM tasks WHERE state = 'done' ORDER BY id";
    table.read(|connection| connection.prepare(DONE)?.query_map([], |row| row.get(0))?.collect())
}

/// How many of the `wanted` tasks are in this `state` (–).
fn count(table: &Table, state: &str, wanted: Option<(i64, i64)>) -> Result<i64, CampaignError> {
    const COUNT: &str = "SELECT count(*) FROM tasks WHERE state = ?1 AND id BETWEEN ?2 AND ?3";
    let (first, last) = wanted.unwrap_or((1, i64::MAX));
    table.read(|connection| {
        connection.query_row(COUNT, rusqlite::params![state, first, last], |row| row.get(0))
    })
}

/// What the threads of a process share.
struct Job<'a> {
    folder: &'a Path,
    meta: Meta,
    wanted: Option<(i64, i64)>,
    worker: &'a Worker,
    stop: &'a AtomicBool,
    /// Tasks that may still be taken (–).
    left: AtomicI64,
    state: Mutex<State<'a>>,
    /// A task of this process has ended.
    has_ended: Condvar,
}

struct State<'a> {
    observer: &'a mut dyn Observer,
    ended: Ended,
    n_open: i64,
    began: Instant,
    error: Option<CampaignError>,
}

impl<'a> Job<'a> {
    fn state(&self) -> MutexGuard<'_, State<'a>> {
        held(&self.state)
    }

    /// Takes one task after the other.
    fn work(&self) -> Result<(), CampaignError> {
        let mut table = Table::open(self.folder)?;
        let mut inputs = Inputs::default();
        loop {
            if self.stop.load(Ordering::Relaxed) {
                self.state().ended.is_interrupted = true;
                return Ok(());
            }
            if self.state().error.is_some() || self.left.fetch_sub(1, Ordering::Relaxed) <= 0 {
                return Ok(());
            }
            let Worker { name, host, .. } = self.worker;
            let claim = |table: &mut Table| {
                table.claim(name, host, self.wanted, |id| mark(self.folder, id))
            };
            let mut next = claim(&mut table)?;
            if matches!(next, Next::Nothing) {
                // Another process may have ended with tasks in its hands.
                bring_back(self.folder, &mut table)?;
                next = claim(&mut table)?;
            }
            let claimed = match next {
                Next::Task(claimed) => claimed,
                Next::Nothing => return Ok(()),
                Next::Wait => {
                    self.left.fetch_add(1, Ordering::Relaxed);
                    self.wait();
                    continue;
                }
            };
            if let Err(error) = self.make(&mut table, &claimed, &mut inputs) {
                // Where not even that can be written, it comes back with the end of this process.
                let _ = table.give_back(claimed.id, &self.worker.name);
                return Err(error);
            }
        }
    }

    /// Waits until a task of this process has ended, or for a moment.
    fn wait(&self) {
        drop(self.has_ended.wait_timeout(self.state(), MOMENT));
    }

    fn make(
        &self,
        table: &mut Table,
        claimed: &Claimed,
        inputs: &mut Inputs,
    ) -> Result<(), CampaignError> {
        let began = Instant::now();
        let (id, name) = (claimed.id, self.worker.name.as_str());
        if claimed.is_fresh {
            // It is this worker's now: nobody else is in its folder.
            discard(self.folder, id)?;
            table.begin_anew(id, name)?;
        }
        let failure = match make(self.folder, &self.meta, claimed, inputs, self.stop)? {
            Made::Interrupted => {
                self.state().ended.is_interrupted = true;
                return table.give_back(id, name);
            }
            Made::Failed(message) => {
                table.fail(id, name, &message)?;
                Some(message)
            }
            Made::Done(summaries, backend) => {
                let wall_time = began.elapsed().as_secs_f64();
                if table.finish(id, name, &summaries, wall_time, &backend)? {
                    prune(self.folder, id, &self.meta.keep)?;
                }
                None
            }
        };
        self.tell(table.counts()?, claimed, failure);
        Ok(())
    }

    fn tell(&self, counts: Counts, claimed: &Claimed, failure: Option<String>) {
        let mut state = self.state();
        match failure {
            Some(_) => state.ended.n_failed += 1,
            None => state.ended.n_done += 1,
        }
        let n_made = state.ended.n_done + state.ended.n_failed;
        // Other processes take some of them.
        let n_left = (state.n_open - n_made).min(counts.pending + counts.running).max(0);
        let time_left = state.began.elapsed().as_secs_f64() / n_made as f64 * n_left as f64;
        let (task, settings) = (claimed.id, claimed.task.words());
        let progress = Progress { task, settings, failure, counts, n_left, time_left };
        state.observer.ended(&progress);
        self.has_ended.notify_all();
    }
}

/// What `mutex` holds, also after a thread has panicked.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
