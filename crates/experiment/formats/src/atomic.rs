//! Files that appear whole or not at all: write beside, sync, rename.

use crate::beside;
use crate::checkpoint::CheckpointProblem;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use thiserror::Error;

/// Bytes gathered before the system is asked to write them.
const BUFFER: usize = 1 << 20;
/// Longest file that is read whole (bytes).
const LONGEST: u64 = 256 << 20;

/// Why a file could not be read or written.
#[derive(Debug, Error, miette::Diagnostic)]
pub enum FileError {
    /// The system refused.
    #[error("cannot {verb} {what} {}", path.display())]
    #[diagnostic(code(wakemix::file))]
    System {
        /// `read`, `write`, `create`, ….
        verb: &'static str,
        /// What the file holds, in words.
        what: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// How to fix it.
        #[help]
        fix: String,
        /// What the system said.
        source: io::Error,
    },
    /// The file was read, but does not hold what it should.
    #[error("{} does not hold {what}: {problem}", path.display())]
    #[diagnostic(code(wakemix::content))]
    Content {
        /// What it should hold, in words.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// What is wrong, with the place where known.
        problem: String,
        /// How to fix it.
        #[help]
        fix: String,
    },
    /// Another process is writing it.
    #[error("{what} is being written by {holder}")]
    #[diagnostic(
        code(wakemix::held),
        help(
            "wait until that ends, or end it; other runs of the case can be made beside it with --run NAME, and -o DIR takes another folder"
        )
    )]
    Held {
        /// What only one process may write at a time, in words.
        what: String,
        /// Who does, in words.
        holder: String,
    },
    /// A run cannot go on from this checkpoint.
    #[error("cannot resume from the checkpoint {}: {problem}", path.display())]
    #[diagnostic(code(wakemix::checkpoint))]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: CheckpointProblem,
        /// How to fix it.
        #[help]
        fix: &'static str,
    },
}

impl FileError {
    /// What the system said when asked to `verb` the `what` at `path`, with the fix that its kind suggests.
    pub fn system(verb: &'static str, what: &'static str, path: &Path, source: io::Error) -> Self {
        let fix = fix_of(source.kind(), path);
        Self::System { verb, what, path: path.to_owned(), fix, source }
    }

    /// `path` does not hold `what`, because of `problem`; `fix` says how to fix it.
    pub fn content(
        what: &'static str,
        path: &Path,
        problem: impl Into<String>,
        fix: impl Into<String>,
    ) -> Self {
        let (problem, fix) = (problem.into(), fix.into());
        Self::Content { what, path: path.to_owned(), problem, fix }
    }

    /// No run can go on from the checkpoint at `path`, because of `problem`.
    pub(crate) fn checkpoint(path: &Path, problem: CheckpointProblem) -> Self {
        let fix = problem.fix();
        Self::Checkpoint { path: path.to_owned(), problem, fix }
    }
}

fn fix_of(kind: ErrorKind, path: &Path) -> String {
    let folder = path.parent().unwrap_or(path).display();
    match kind {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => format!(
            "the disk or quota of {folder} is full: free some space and repeat the command (a run: with --resume), or begin again in another folder (-o)"
        ),
        ErrorKind::PermissionDenied => {
            format!("check the permissions of {folder}, or choose another folder (-o DIR)")
        }
        ErrorKind::ReadOnlyFilesystem => {
            format!("{folder} is read-only: choose another folder (-o DIR)")
        }
        ErrorKind::NotFound => format!("check that {} exists and is spelt right", path.display()),
        ErrorKind::IsADirectory => format!("{} is a folder: name a file", path.display()),
        ErrorKind::Unsupported => format!("name a file in the place of {}", path.display()),
        ErrorKind::FileTooLarge => "name a smaller file".to_owned(),
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            format!(
                "something other than a folder stands at {folder}: remove it or choose another folder (-o DIR)"
            )
        }
        _ => format!("check the disk that holds {folder}"),
    }
}

/// Writes `bytes` to `path`, replacing what was there, whole or not at all; `what` the file holds, in words.
///
/// # Errors
/// [`FileError::System`]; then the old file, if any, still stands.
pub fn write(path: &Path, what: &'static str, bytes: &[u8]) -> Result<(), FileError> {
    let mut file = AtomicFile::create(path, what)?;
    file.write_all(bytes).map_err(|source| FileError::system("write", what, path, source))?;
    file.commit()
}

/// Where a file that is written as its content comes stands until it is whole: `.part` after its name.
pub(crate) fn part_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

/// Makes the folder `path` with all above it, when it is not there.
///
/// # Errors
/// [`FileError::System`].
pub fn create_folder(path: &Path) -> Result<(), FileError> {
    fs::create_dir_all(path)
        .map_err(|source| FileError::system("create", "the folder", path, source))
}

/// Reads the text of the file at `path`, which holds `what`.
///
/// # Errors
/// [`FileError::System`], or [`FileError::Content`] when it is not UTF-8.
pub fn read_text(path: &Path, what: &'static str) -> Result<String, FileError> {
    let bytes = read_bytes(path, what)?;
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        let problem = format!("byte {place} is not UTF-8 text");
        FileError::content(what, path, problem, "save the file as UTF-8 text")
    })
}

/// Reads the file at `path`, which holds `what`.
///
/// # Errors
/// [`FileError::System`].
pub fn read_bytes(path: &Path, what: &'static str) -> Result<Vec<u8>, FileError> {
    read_whole(path).map_err(|source| FileError::system("read", what, path, source))
}

/// Opens the file at `path` to be read. Devices, pipes and sockets are none: they may never end, or never
/// begin.
///
/// # Errors
/// What the system says, [`ErrorKind::IsADirectory`], and [`ErrorKind::Unsupported`] for what is no file.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    // Asked before it is opened: who opens a pipe waits for the one who writes.
    let kind = fs::metadata(path)?;
    if kind.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        let problem = "it is no file, but a device, a pipe or a socket";
        return Err(io::Error::new(ErrorKind::Unsupported, problem));
    }
    File::open(path)
}

/// All bytes of the file at `path`.
///
/// # Errors
/// Those of [`open`], and [`ErrorKind::FileTooLarge`] beyond 256 MiB, which nothing has that is read whole.
pub(crate) fn read_whole(path: &Path) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let length = file.metadata()?.len();
    let mut bytes = Vec::new();
    if length <= LONGEST {
        bytes.reserve_exact(length as usize);
        file.take(LONGEST + 1).read_to_end(&mut bytes)?;
    }
    if length > LONGEST || bytes.len() as u64 > LONGEST {
        let problem = format!("it has more than {} MiB", LONGEST >> 20);
        return Err(io::Error::new(ErrorKind::FileTooLarge, problem));
    }
    Ok(bytes)
}

/// Whether files can be made in `folder`, or in the nearest folder above it that is there; nothing stays.
///
/// # Errors
/// [`FileError::System`].
pub fn check_folder(folder: &Path) -> Result<(), FileError> {
    let here = Path::new(".");
    let mut there = if folder.as_os_str().is_empty() { here } else { folder };
    while fs::symlink_metadata(there).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        let above = there.parent().unwrap_or(here);
        there = if above.as_os_str().is_empty() { here } else { above };
    }
    let what = "into the folder";
    let refused = |source| FileError::system("write", what, folder, source);
    if !fs::metadata(there).map_err(refused)?.is_dir() {
        let fix = format!("{} is not a folder: choose another one (-o DIR)", there.display());
        let (path, source) = (folder.to_owned(), ErrorKind::NotADirectory.into());
        return Err(FileError::System { verb: "write", what, path, fix, source });
    }
    // Threads of one process look at one folder at the same time: each has a probe of its own.
    static PROBES: AtomicU64 = AtomicU64::new(0);
    let number = PROBES.fetch_add(1, Ordering::Relaxed);
    let probe = beside::beside(&there.join(format!("probe-{number}")), beside::PART);
    File::create(&probe).and_then(|_| fs::remove_file(&probe)).map_err(refused)
}

/// A file being written beside its place; [`commit`](Self::commit) moves it there, dropping it leaves
/// nothing.
#[derive(Debug)]
pub struct AtomicFile {
    file: Option<BufWriter<File>>,
    beside: PathBuf,
    path: PathBuf,
    what: &'static str,
}

impl AtomicFile {
    /// Starts a file that will stand at `path`; `what` it holds, in words. The folder must exist.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, what: &'static str) -> Result<Self, FileError> {
        let place = beside::beside(path, beside::PART);
        let file = File::create(&place)
            .map_err(|source| FileError::system("write", what, path, source))?;
        beside::claim(&file);
        let file = Some(BufWriter::with_capacity(BUFFER, file));
        Ok(Self { file, beside: place, path: path.to_owned(), what })
    }

    /// Syncs the bytes to the disk and moves the file to its place.
    ///
    /// # Errors
    /// [`FileError::System`]; then the old file, if any, still stands.
    pub fn commit(mut self) -> Result<(), FileError> {
        let file = self.file.take();
        let done = file.map_or(Ok(()), |file| {
            file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
        });
        done.and_then(|()| fs::rename(&self.beside, &self.path))
            .map_err(|source| FileError::system("write", self.what, &self.path, source))?;
        sync_folder(&self.path);
        Ok(())
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_mut().map_or(Ok(0), |file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.as_mut().map_or(Ok(0), |file| file.seek(place))
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        // After a commit nothing lies there any more, and a failure here hides no bytes of the user's.
        if let Some(file) = self.file.take() {
            // Without this the buffer would be written once more, into a file about to go.
            let (file, _unwritten) = file.into_parts();
            drop(file);
        }
        let _ = fs::remove_file(&self.beside);
    }
}

/// Makes a rename at `path` last through a power cut, where the system can; elsewhere does nothing.
pub(crate) fn sync_folder(path: &Path) {
    if cfg!(unix)
        && let Some(folder) = path.parent()
    {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // Some file systems cannot sync a folder; the file itself is safe by now.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn names(folder: &Path) -> Vec<OsString> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    }

    #[test]
    fn a_file_appears_whole_and_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        write(&path, "the summary", b"one").unwrap();
        write(&path, "the summary", b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["summary.json"]);
    }

    #[test]
    fn threads_look_at_one_folder_at_the_same_time() {
        let folder = tempfile::tempdir().unwrap();
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let path = folder.path().join(format!("tasks/{thread}"));
                scope.spawn(move || (0..500).for_each(|_| check_folder(&path).unwrap()));
            }
        });
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn what_was_not_committed_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("checkpoint");
        write(&path, "the checkpoint", b"good").unwrap();
        let mut file = AtomicFile::create(&path, "the checkpoint").unwrap();
        file.write_all(&[7; 3 << 20]).unwrap();
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"good");
        assert_eq!(names(folder.path()), ["checkpoint"]);
    }

    #[test]
    fn refusals_name_file_content_and_fix() {
        let error = write(Path::new("/nowhere/at/all.nc"), "the plane", b"x").unwrap_err();
        assert_eq!(error.to_string(), "cannot write the plane /nowhere/at/all.nc");
        let full = io::Error::from(ErrorKind::StorageFull);
        let error = FileError::system("write", "the series", Path::new("out/a/series.csv"), full);
        let FileError::System { fix, .. } = error else { panic!("not a refusal") };
        assert!(fix.contains("out/a is full") && fix.contains("--resume"), "{fix}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_as_such() {
        // /dev/full refuses every byte as a full disk does.
        let file = File::options().write(true).open("/dev/full").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("volume.vti");
        let beside = folder.path().join(".volume.part");
        fs::write(&beside, b"").unwrap();
        let mut full = AtomicFile {
            file: Some(BufWriter::with_capacity(16, file)),
            beside,
            path: path.clone(),
            what: "the volume",
        };
        let message = full.write_all(&[1; 64]).and_then(|()| full.flush()).unwrap_err();
        assert_eq!(message.kind(), ErrorKind::StorageFull);
        drop(full);
        assert!(names(folder.path()).is_empty());
    }
}
