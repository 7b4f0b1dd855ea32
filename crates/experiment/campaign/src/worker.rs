//! A process that makes tasks, and whether another one still does.

use crate::error::CampaignError;
use crate::make::mark;
use crate::table::{KnownWorker, Table};
use formats::FileError;
use formats::lock::Lock;
use formats::machine;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// How often a process says that it is there.
const BEAT: Duration = Duration::from_secs(20);
/// Time without a word after which a process of another machine is taken for ended (s).
const SILENT: i64 = 300;

/// Workers that this process was so far (–).
static N_ENTERED: AtomicU64 = AtomicU64::new(0);

/// This process as one that makes tasks; others see that it is there until it is dropped.
pub(crate) struct Worker {
    pub(crate) name: String,
    pub(crate) host: String,
    /// Ends with the process, however that ends.
    _lock: Lock,
    ended: Option<Sender<()>>,
    beating: Option<JoinHandle<()>>,
}

impl Worker {
    /// Enters the campaign in `folder`.
    ///
    /// # Errors
    /// [`CampaignError::File`], [`CampaignError::Table`].
    pub(crate) fn enter(folder: &Path) -> Result<Self, CampaignError> {
        let host = machine::host();
        // The time tells processes of one number apart, the count those that enter within one process.
        let name = format!(
            "{host}-{}-{}-{}",
            std::process::id(),
            formats::clock::now().replace(':', "."),
            N_ENTERED.fetch_add(1, Ordering::Relaxed)
        );
        let lock = Lock::take(&lock_path(folder, &name), "the worker")?;
        let mut table = Table::open(folder)?;
        let place = here();
        table.beat(&name, &place, now())?;
        let (ended, wait) = channel();
        let (own, at) = (name.clone(), place.clone());
        let beating = std::thread::spawn(move || {
            while wait.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                // Others see by the lock, too, that it is there.
                let _ = table.beat(&own, &at, now());
            }
        });
        Ok(Self { name, host: place, _lock: lock, ended: Some(ended), beating: Some(beating) })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        drop(self.ended.take());
        if let Some(beating) = self.beating.take() {
            let _ = beating.join();
        }
    }
}

fn lock_path(folder: &Path, name: &str) -> PathBuf {
    folder.join("workers").join(format!("{name}.lock"))
}

/// This machine since it was started: two machines may have one name, and a lock is trusted on one alone.
pub(crate) fn here() -> String {
    let started = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    format!("{} {}", machine::host(), started.trim())
}

/// This moment, in seconds since 1970.
fn now() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_secs()).unwrap_or(i64::MAX)
}

/// Whether the process of `worker` of the campaign in `folder` is still there.
pub(crate) fn is_there(folder: &Path, worker: &KnownWorker) -> bool {
    let is_heard = worker.beat.is_some_and(|beat| now() - beat < SILENT);
    if worker.host != here() {
        // Locks of some file systems are those of one machine.
        return is_heard;
    }
    match Lock::take(&lock_path(folder, &worker.name), "the worker") {
        Err(FileError::Held { .. }) => true,
        Ok(lock) if lock.is_held() => false,
        _ => is_heard,
    }
}

/// Tasks of processes that have ended come back.
///
/// # Errors
/// [`CampaignError::Table`].
pub(crate) fn bring_back(folder: &Path, table: &mut Table) -> Result<(), CampaignError> {
    for worker in table.workers()? {
        if !is_there(folder, &worker) {
            table.bring_back(&worker.name, |id| mark(folder, id))?;
        }
    }
    Ok(())
}
