//! Checkpoints: named sections of state, checked on reading, streamed so that no field is copied in memory.
//!
//! Layout, little-endian: magic, version (u32), sections, end. A section is the length of its name (u32) and
//! the name, then chunks, each its length (u32, not 0) and bytes, then a chunk length of 0 and the CRC-32 of
//! name and bytes. The end is a name length of `u32::MAX` and the number of sections (u32). The first section
//! says which run of which case it is, and what computed it.

mod problem;
mod told;

pub use problem::CheckpointProblem;
pub(crate) use problem::{ANEW, GONE};

use crate::FileError;
use crate::atomic::{self, AtomicFile};
use crate::case;
use crc32fast::Hasher;
use problem::VERSION;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MAGIC: [u8; 8] = *b"wmcheckp";
const WHAT: &str = "the checkpoint";
const IDENTITY: &str = "identity";
/// Bytes of a chunk (–), and of the buffers.
const CHUNK: usize = 1 << 20;
const LONGEST_NAME: u32 = 96;
const END: u32 = u32::MAX;
/// Which run of which case a checkpoint belongs to, and what computes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity<'a> {
    /// Text of the case.
    pub case_text: &'a str,
    /// Name of the run.
    pub run: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// What of the machine decides the bits, in words.
    pub backend: &'a str,
}

/// The same as it is kept.
#[derive(Serialize, Deserialize)]
struct Kept {
    run: String,
    fingerprint: [u8; 32],
    version: String,
    backend: String,
}

impl Identity<'_> {
    fn kept(&self) -> Kept {
        Kept {
            run: self.run.to_owned(),
            // It may go on for longer than it was to when the checkpoint was written.
            fingerprint: case::fingerprint_of_state(self.case_text, self.run),
            version: self.version.to_owned(),
            backend: self.backend.to_owned(),
        }
    }
}

impl Kept {
    /// What speaks against going on with it where `expected` is to go on.
    fn problem(self, expected: Self) -> Option<CheckpointProblem> {
        let (run, version, backend) = (expected.run, expected.version, expected.backend);
        if self.run != run {
            Some(CheckpointProblem::OtherRun { found: self.run, expected: run })
        } else if self.fingerprint != expected.fingerprint {
            Some(CheckpointProblem::OtherCase)
        } else if self.version != version {
            Some(CheckpointProblem::OtherProgram { found: self.version, expected: version })
        } else if self.backend != backend {
            Some(CheckpointProblem::OtherBackend { found: self.backend, expected: backend })
        } else {
            None
        }
    }
}

/// Writes a checkpoint; the one before it stands until [`finish`](Self::finish).
#[derive(Debug)]
pub struct CheckpointWriter {
    file: AtomicFile,
    path: PathBuf,
    n_sections: u32,
}

impl CheckpointWriter {
    /// Starts the checkpoint at `path` of the run that `identity` names.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, identity: &Identity) -> Result<Self, FileError> {
        let file = AtomicFile::create(path, WHAT)?;
        let mut writer = Self { file, path: path.to_owned(), n_sections: 0 };
        writer.put(&MAGIC)?;
        writer.put(&VERSION.to_le_bytes())?;
        writer.state(IDENTITY, &identity.kept())?;
        Ok(writer)
    }

    /// Writes `state` as the section `name`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn state<T: Serialize>(&mut self, name: &str, state: &T) -> Result<(), FileError> {
        self.stream(name, |writer| told::write_state(state, writer))
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
    /// Opens the checkpoint at `path`, which must be whole and of the run that `identity` names, computed by
    /// the same program on a machine that computes alike.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Checkpoint`] when the run cannot go on from
    /// it.
    pub fn open(path: &Path, identity: &Identity) -> Result<Self, FileError> {
        let read = |source| FileError::system("read", WHAT, path, source);
        let file = atomic::open(path).map_err(read)?;
        let length = file.metadata().map_err(read)?.len();
        let file = BufReader::with_capacity(CHUNK, file);
        let mut reader = Self { file, path: path.to_owned(), sections: Vec::new() };
        reader.index(length)?;
        let kept: Kept = reader.state(IDENTITY)?;
        let problem = kept.problem(identity.kept());
        problem.map_or(Ok(reader), |problem| Err(FileError::checkpoint(path, problem)))
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
            _ => return Err(FileError::checkpoint(&self.path, CheckpointProblem::NoCheckpoint)),
        }
        let problem = match self.index_sections(length) {
            Ok(None) => return Ok(()),
            Ok(Some(problem)) => problem,
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => cut_off,
            Err(error) => return Err(FileError::system("read", WHAT, &self.path, error)),
        };
        Err(FileError::checkpoint(&self.path, problem))
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
        Err(self.unfitting(name, reason))
    }

    /// What to say where the section `name` is sound but holds something else, for `reason`.
    pub fn unfitting(&self, name: &str, reason: String) -> FileError {
        let problem = CheckpointProblem::Unfitting { section: name.to_owned(), reason };
        FileError::checkpoint(&self.path, problem)
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
            let problem = CheckpointProblem::Missing { section: section() };
            return Err(FileError::checkpoint(&self.path, problem));
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
        let refused = |problem| FileError::checkpoint(&self.path, problem);
        match (sound, taken) {
            (Ok(true), Ok(())) => Ok(()),
            (Ok(true), Err(error)) => {
                let reason = error.to_string();
                Err(refused(CheckpointProblem::Unfitting { section: section(), reason }))
            }
            (Ok(false), _) => Err(refused(CheckpointProblem::Damaged { section: section() })),
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
