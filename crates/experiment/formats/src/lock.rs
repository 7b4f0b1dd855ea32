//! Locks on what only one process may write at a time, kept by the system: they end with their process,
//! however that ends.

use crate::clock::now;
use crate::{FileError, atomic, machine};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

const WHAT: &str = "the lock";
/// What Linux says of network file systems without locks, ENOLCK.
const NO_LOCKS: Option<i32> = if cfg!(target_os = "linux") { Some(37) } else { None };
/// Most that is read of who holds a lock (bytes).
const LONGEST: u64 = 1000;

/// A lock that this process holds.
#[derive(Debug)]
pub struct Lock {
    /// None where the file system knows no locks.
    file: Option<File>,
    path: PathBuf,
    /// Whether the folder was made for the lock.
    made_folder: bool,
}

impl Lock {
    /// The lock in the file at `path`, on `what`, in words; nobody else can take it until this one is
    /// dropped.
    ///
    /// # Errors
    /// [`FileError::Held`] says who holds it; [`FileError::System`].
    pub fn take(path: &Path, what: &str) -> Result<Self, FileError> {
        Self::with(path, |file| match file.try_lock() {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Err(held(what, file)),
            Err(TryLockError::Error(error)) => unknown(error, path),
        })
    }

    /// The same, once whoever holds it now has let it go: for what takes a moment.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn wait(path: &Path) -> Result<Self, FileError> {
        Self::with(path, |file| match file.lock() {
            Ok(()) => Ok(true),
            Err(error) => unknown(error, path),
        })
    }

    /// Whether the lock keeps others out: not where the file system knows no locks.
    pub fn is_held(&self) -> bool {
        self.file.is_some()
    }

    /// The lock in the file at `path`, which `lock` locks where the file system knows locks.
    fn with(
        path: &Path,
        mut lock: impl FnMut(&mut File) -> Result<bool, FileError>,
    ) -> Result<Self, FileError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let is_named = !folder.as_os_str().is_empty();
        let made_folder = is_named && !folder.exists();
        let mut taken = Self { file: None, path: path.to_owned(), made_folder };
        loop {
            if is_named {
                atomic::create_folder(folder)?;
            }
            let mut options = File::options();
            let opened = options.read(true).write(true).create(true).truncate(false).open(path);
            let mut file = match opened {
                // Whoever made the folder has just taken it away again.
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                opened => opened.map_err(|e| FileError::system("open", WHAT, path, e))?,
            };
            if !lock(&mut file)? {
                return Ok(taken);
            }
            // Whoever held it may have taken the file away: then another one stands there, or none.
            if is_at(&file, path) {
                // Who holds it is told as far as it can be written; the lock holds without.
                let _ = file.set_len(0).and_then(|()| file.write_all(holder().as_bytes()));
                taken.file = Some(file);
                return Ok(taken);
            }
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Only while it is held, and only where `is_at` can tell those who wait that it is gone.
        if cfg!(unix) && self.file.is_some() {
            let _ = fs::remove_file(&self.path);
            if let Some(folder) = self.path.parent().filter(|_| self.made_folder) {
                // Refused when something is in it.
                let _ = fs::remove_dir(folder);
            }
        }
    }
}

/// No lock where the file system knows none.
fn unknown(error: io::Error, path: &Path) -> Result<bool, FileError> {
    if error.kind() == ErrorKind::Unsupported || error.raw_os_error() == NO_LOCKS {
        return Ok(false);
    }
    Err(FileError::system("take", WHAT, path, error))
}

/// Whether `file` is the one that stands at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(opened), Ok(standing)) => place(opened) == place(standing),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_file: &File, _path: &Path) -> bool {
    true
}

/// This process, for those whom it keeps out.
fn holder() -> String {
    let host = machine::host();
    let on = if host.is_empty() { String::new() } else { format!(" on {host}") };
    let command: Vec<String> =
        std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
    let (process, since) = (std::process::id(), now());
    format!("process {process}{on} since {since} ({})\n", command.join(" "))
}

/// The lock on `what`, in `file`, is somebody else's.
fn held(what: &str, file: &mut File) -> FileError {
    let mut text = Vec::new();
    // Where the system does not let others read a locked file, nobody is named.
    let read = file.rewind().and_then(|()| file.take(LONGEST).read_to_end(&mut text));
    let text = String::from_utf8_lossy(&text);
    let holder = match (read, text.lines().next()) {
        (Ok(_), Some(line)) if !line.is_empty() => line.to_owned(),
        _ => "another process".to_owned(),
    };
    FileError::Held { what: what.to_owned(), holder }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn one_at_a_time_and_the_other_is_told_who() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study/.baseline.lock");
        let lock = Lock::take(&path, "run baseline").unwrap();
        assert!(lock.is_held());
        let error = Lock::take(&path, "run baseline").unwrap_err();
        let process = format!("process {}", std::process::id());
        assert!(error.to_string().contains(&process), "{error}");
        assert!(error.to_string().starts_with("run baseline is being written by"), "{error}");
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains("--run NAME") && help.contains("-o"), "{help}");
        // Another run may go on beside it.
        let other = Lock::take(&folder.path().join("study/.helix.lock"), "run helix").unwrap();
        drop(lock);
        let again = Lock::take(&path, "run baseline").unwrap();
        drop((other, again));
        if cfg!(unix) {
            let study = path.parent().unwrap();
            assert!(fs::read_dir(study).unwrap().next().is_none(), "something is left");
            // What was made for a lock alone goes with it.
            let alone = folder.path().join("alone/.baseline.lock");
            drop(Lock::take(&alone, "run baseline").unwrap());
            assert!(!alone.parent().unwrap().exists());
        }
    }

    #[test]
    fn a_file_that_a_killed_process_left_is_no_lock() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".baseline.lock");
        fs::write(&path, "process 4711 since long ago, with a command that is longer than ours")
            .unwrap();
        let lock = Lock::take(&path, "run baseline").unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with(&format!("process {}", std::process::id())), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        drop(lock);
    }

    #[test]
    fn who_waits_gets_it_and_nobody_is_in_it_beside_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study/.lock.report");
        let inside = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        let lock = Lock::wait(&path).unwrap();
                        assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0);
                        std::thread::yield_now();
                        inside.fetch_sub(1, Ordering::SeqCst);
                        drop(lock);
                    }
                });
            }
        });
    }
}
