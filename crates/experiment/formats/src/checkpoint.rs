//! Checkpoints: named sections of state, checked on reading, streamed so that no field is copied in memory.
//!
//! Layout, little-endian: magic, version (u32), sections, end. A section is the length of its name (u32) and
//! the name, then chunks, each its length (u32, not 0) and bytes, then a chunk length of 0 and the CRC-32 of
//! name and bytes. The end is a name length of `u32::MAX` and the number of sections (u32). The first section
//! says which run of which case it is.

use crate::FileError;
use crate::atomic::{self, AtomicFile};
use crate::case;
use crc32fast::Hasher;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

const MAGIC: [u8; 8] = *b"wmcheckp";
const VERSION: u32 = 3;
const WHAT: &str = "the checkpoint";
const IDENTITY: &str = "identity";
/// Bytes of a chunk (–), and of the buffers.
const CHUNK: usize = 1 << 20;
const LONGEST_NAME: u32 = 64;
const END: u32 = u32::MAX;
const FRESH: &str = "start the run afresh: --run NAME --overwrite in place of --resume";

/// What is wrong with a checkpoint.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CheckpointProblem {
    /// Some other file.
    #[error("it is no checkpoint")]
    NoCheckpoint,
    /// Written by a program that writes them otherwise.
    #[error("its layout has version {found}, this program knows version {VERSION}")]
    OtherVersion {
        /// Version found.
        found: u32,
    },
    /// Of another run.
    #[error("it belongs to run `{found}`, not to run `{expected}`")]
    OtherRun {
        /// Run found.
        found: String,
        /// Run given.
        expected: String,
    },
    /// Of another case, or of this one before it was changed.
    #[error("the case has changed since it was written")]
    OtherCase,
    /// Its end is missing.
    #[error("it is cut off after {bytes} bytes")]
    CutOff {
        /// Bytes that are there.
        bytes: u64,
    },
    /// Its bytes are not those written.
    #[error("its section `{section}` is damaged")]
    Damaged {
        /// Section.
        section: String,
    },
    /// It lacks a section.
    #[error("it has no section `{section}`")]
    Missing {
        /// Section.
        section: String,
    },
    /// A section is sound but holds something else.
    #[error("its section `{section}` does not hold what this program expects: {reason}")]
    Unfitting {
        /// Section.
        section: String,
        /// Why.
        reason: String,
    },
}

impl CheckpointProblem {
    fn fix(&self) -> &'static str {
        match self {
            Self::OtherVersion { .. } => {
                "go on with the version of the program that wrote it, or start the run afresh: --run NAME --overwrite in place of --resume"
            }
            Self::OtherCase => {
                "undo the change to go on, or start the run afresh: --run NAME --overwrite in place of --resume; threads, checkpoint interval and other runs may change"
            }
            _ => FRESH,
        }
    }

    fn at(self, path: &Path) -> FileError {
        let fix = self.fix();
        FileError::Checkpoint { path: path.to_owned(), problem: self, fix }
    }
}

/// Which run of which case a checkpoint belongs to.
#[derive(Serialize, Deserialize)]
struct Identity {
    run: String,
    fingerprint: [u8; 32],
}

/// Writes a checkpoint; the one before it stands until [`finish`](Self::finish).
#[derive(Debug)]
pub struct CheckpointWriter {
    file: AtomicFile,
    path: PathBuf,
    n_sections: u32,
}

impl CheckpointWriter {
    /// Starts the checkpoint at `path` of the run `run` of the case in `case_text`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, case_text: &str, run: &str) -> Result<Self, FileError> {
        let file = AtomicFile::create(path, WHAT)?;
        let mut writer = Self { file, path: path.to_owned(), n_sections: 0 };
        writer.put(&MAGIC)?;
        writer.put(&VERSION.to_le_bytes())?;
        let fingerprint = case::fingerprint(case_text, run);
        writer.state(IDENTITY, &Identity { run: run.to_owned(), fingerprint })?;
        Ok(writer)
    }

    /// Writes `state` as the section `name`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn state<T: Serialize>(&mut self, name: &str, state: &T) -> Result<(), FileError> {
        self.stream(name, |writer| {
            let bytes = postcard::to_stdvec(state).map_err(io::Error::other)?;
            writer.write_all(&bytes)
        })
    }

    /// Writes what `write` writes as the section `name`, whose length need not be known.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn stream(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), FileError> {
        let streamed = self.stream_section(name, write);
        streamed.map_err(|source| FileError::system("write", WHAT, &self.path, source))?;
        self.n_sections += 1;
        Ok(())
    }

    fn stream_section(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let length = u32::try_from(name.len()).ok().filter(|length| *length <= LONGEST_NAME);
        let length = length.ok_or(ErrorKind::InvalidInput)?;
        self.file.write_all(&length.to_le_bytes())?;
        self.file.write_all(name.as_bytes())?;
        let mut crc = Hasher::new();
        crc.update(name.as_bytes());
        let chunk = Vec::with_capacity(CHUNK);
        let mut chunks = ChunkWriter { file: &mut self.file, chunk, crc };
        write(&mut chunks)?;
        chunks.flush()?;
        let crc = chunks.crc.finalize();
        self.file.write_all(&0_u32.to_le_bytes())?;
        self.file.write_all(&crc.to_le_bytes())
    }

    /// Completes the checkpoint and puts it in the place of the one before.
    ///
    /// # Errors
    /// [`FileError::System`]; the checkpoint before it still stands then.
    pub fn finish(mut self) -> Result<(), FileError> {
        self.put(&END.to_le_bytes())?;
        self.put(&self.n_sections.to_le_bytes())?;
        self.file.commit()
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        self.file
            .write_all(bytes)
            .map_err(|source| FileError::system("write", WHAT, &self.path, source))
    }
}

/// Cuts what is written into chunks.
struct ChunkWriter<'a> {
    file: &'a mut AtomicFile,
    chunk: Vec<u8>,
    crc: Hasher,
}

impl Write for ChunkWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.chunk.len() == CHUNK {
            self.flush()?;
        }
        let taken = bytes.len().min(CHUNK - self.chunk.len());
        self.chunk.extend_from_slice(&bytes[..taken]);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.chunk.is_empty() {
            // A chunk is never longer than CHUNK.
            self.file.write_all(&(self.chunk.len() as u32).to_le_bytes())?;
            self.file.write_all(&self.chunk)?;
            self.crc.update(&self.chunk);
            self.chunk.clear();
        }
        Ok(())
    }
}

/// Reads a checkpoint.
#[derive(Debug)]
pub struct CheckpointReader {
    file: BufReader<File>,
    path: PathBuf,
    /// Name of each section with the place of its first chunk.
    sections: Vec<(String, u64)>,
}

impl CheckpointReader {
    /// Opens the checkpoint at `path`, which must be whole and of the run `run` of the case in `case_text`.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Checkpoint`] when the run cannot go on from
    /// it.
    pub fn open(path: &Path, case_text: &str, run: &str) -> Result<Self, FileError> {
        let read = |source| FileError::system("read", WHAT, path, source);
        let file = atomic::open(path).map_err(read)?;
        let length = file.metadata().map_err(read)?.len();
        let file = BufReader::with_capacity(CHUNK, file);
        let mut reader = Self { file, path: path.to_owned(), sections: Vec::new() };
        reader.index(length)?;
        let identity: Identity = reader.state(IDENTITY)?;
        let problem = if identity.run != run {
            Some(CheckpointProblem::OtherRun { found: identity.run, expected: run.to_owned() })
        } else if identity.fingerprint != case::fingerprint(case_text, run) {
            Some(CheckpointProblem::OtherCase)
        } else {
            None
        };
        problem.map_or(Ok(reader), |problem| Err(problem.at(path)))
    }

    /// On return every section is known and the end is there.
    fn index(&mut self, length: u64) -> Result<(), FileError> {
        let cut_off = CheckpointProblem::CutOff { bytes: length };
        let mut magic = [0; 8];
        match self.file.read_exact(&mut magic) {
            Ok(()) if magic == MAGIC => {}
            Err(error) if error.kind() != ErrorKind::UnexpectedEof => {
                return Err(FileError::system("read", WHAT, &self.path, error));
            }
            _ => return Err(CheckpointProblem::NoCheckpoint.at(&self.path)),
        }
        let problem = match self.index_sections(length) {
            Ok(None) => return Ok(()),
            Ok(Some(problem)) => problem,
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => cut_off,
            Err(error) => return Err(FileError::system("read", WHAT, &self.path, error)),
        };
        Err(problem.at(&self.path))
    }

    fn index_sections(&mut self, length: u64) -> io::Result<Option<CheckpointProblem>> {
        let version = read_u32(&mut self.file)?;
        if version != VERSION {
            return Ok(Some(CheckpointProblem::OtherVersion { found: version }));
        }
        loop {
            let name_length = read_u32(&mut self.file)?;
            if name_length == END {
                let n_sections = read_u32(&mut self.file)?;
                let whole = usize::try_from(n_sections).is_ok_and(|n| n == self.sections.len());
                let damaged = || CheckpointProblem::Damaged { section: "end".into() };
                return Ok((!whole).then(damaged));
            }
            if name_length > LONGEST_NAME {
                let section = self.sections.last().map_or("identity", |(name, _)| name);
                return Ok(Some(CheckpointProblem::Damaged { section: section.to_owned() }));
            }
            let mut name = vec![0; name_length as usize];
            self.file.read_exact(&mut name)?;
            let name = String::from_utf8_lossy(&name).into_owned();
            self.sections.push((name, self.file.stream_position()?));
            loop {
                let chunk = read_u32(&mut self.file)?;
                if chunk == 0 {
                    break;
                }
                self.file.seek_relative(i64::from(chunk))?;
                // Seeking beyond the end is no error; it is a cut-off file.
                if self.file.stream_position()? > length {
                    return Err(ErrorKind::UnexpectedEof.into());
                }
            }
            read_u32(&mut self.file)?;
        }
    }

    /// Whether there is a section `name`, which an earlier program may not have written.
    pub fn holds(&self, name: &str) -> bool {
        self.sections.iter().any(|(section, _)| section == name)
    }

    /// The state in the section `name`.
    ///
    /// # Errors
    /// [`FileError::Checkpoint`] when there is none, or it is damaged or of another program.
    pub fn state<T: DeserializeOwned>(&mut self, name: &str) -> Result<T, FileError> {
        let mut bytes = Vec::new();
        self.stream(name, |reader| reader.read_to_end(&mut bytes).map(|_| ()))?;
        let reason = match postcard::take_from_bytes(&bytes) {
            Ok((state, [])) => return Ok(state),
            Ok((_, left)) => format!("{} bytes are left over", left.len()),
            Err(error) => error.to_string(),
        };
        Err(CheckpointProblem::Unfitting { section: name.to_owned(), reason }.at(&self.path))
    }

    /// Hands the bytes of the section `name` to `read`.
    ///
    /// # Errors
    /// [`FileError::Checkpoint`] when there is none, or it is damaged, or `read` makes nothing of it; what
    /// `read` has taken in is worthless then.
    pub fn stream(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut dyn Read) -> io::Result<()>,
    ) -> Result<(), FileError> {
        let section = || name.to_owned();
        let place = self.sections.iter().find(|(section, _)| section == name);
        let Some(&(_, place)) = place else {
            return Err(CheckpointProblem::Missing { section: section() }.at(&self.path));
        };
        let failed = |source| FileError::system("read", WHAT, &self.path, source);
        self.file.seek(SeekFrom::Start(place)).map_err(failed)?;
        let mut crc = Hasher::new();
        crc.update(name.as_bytes());
        let mut chunks = ChunkReader { file: &mut self.file, left: 0, ended: false, crc };
        let taken = read(&mut chunks);
        // What `read` left over counts too, and a damaged section explains whatever `read` says of it.
        let sound = io::copy(&mut chunks, &mut io::sink()).and_then(|_| {
            let found = chunks.crc.clone().finalize();
            Ok(read_u32(chunks.file)? == found)
        });
        match (sound, taken) {
            (Ok(true), Ok(())) => Ok(()),
            (Ok(true), Err(error)) => {
                let reason = error.to_string();
                Err(CheckpointProblem::Unfitting { section: section(), reason }.at(&self.path))
            }
            (Ok(false), _) => Err(CheckpointProblem::Damaged { section: section() }.at(&self.path)),
            (Err(source), _) => Err(FileError::system("read", WHAT, &self.path, source)),
        }
    }
}

/// Joins chunks together.
struct ChunkReader<'a> {
    file: &'a mut BufReader<File>,
    left: u32,
    ended: bool,
    crc: Hasher,
}

impl Read for ChunkReader<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.left == 0 && !self.ended {
            self.left = read_u32(self.file)?;
            self.ended = self.left == 0;
        }
        let wanted = bytes.len().min(self.left as usize);
        let taken = self.file.read(&mut bytes[..wanted])?;
        if taken == 0 && wanted > 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        self.crc.update(&bytes[..taken]);
        self.left -= taken as u32;
        Ok(taken)
    }
}

fn read_u32(reader: &mut impl Read) -> io::Result<u32> {
    let mut bytes = [0; 4];
    reader.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

#[cfg(test)]
mod tests;
