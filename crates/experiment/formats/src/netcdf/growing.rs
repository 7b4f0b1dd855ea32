//! A NetCDF file that grows record by record while its run goes on.
//!
//! Until the run is complete the file has `.part` after its name. There its header says that it holds as many
//! records as there are bytes for, which the format allows, so that what a killed run has left can be looked
//! at. What comes last is their number, and the name.

use crate::checkpoint::{ANEW, GONE};
use crate::{FileError, atomic};
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Number of records where it follows from the length of the file.
const AS_LONG_AS_IT_IS: [u8; 4] = [0xFF; 4];
/// Where the number of records stands in the file.
const PLACE_OF_NUMBER: usize = 4;

/// A file under way.
#[derive(Debug)]
pub(super) struct Growing {
    file: BufWriter<File>,
    part: PathBuf,
    path: PathBuf,
    what: &'static str,
    n_records: u64,
}

/// All of a file before its first record: of `whole`, which holds one of `record_bytes`.
pub(super) fn header_of(mut whole: Vec<u8>, record_bytes: u64) -> Vec<u8> {
    whole.truncate(whole.len() - record_bytes as usize);
    whole[PLACE_OF_NUMBER..][..4].copy_from_slice(&AS_LONG_AS_IT_IS);
    whole
}

impl Growing {
    /// Starts the file that will stand at `path` and holds `what`, with its `header`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub(super) fn create(
        path: &Path,
        what: &'static str,
        header: &[u8],
    ) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let started =
            File::create(&part).and_then(|mut file| file.write_all(header).map(|()| file));
        let file = started.map_err(|e| FileError::system("write", what, &part, e))?;
        Ok(Self { file: BufWriter::new(file), part, path: path.to_owned(), what, n_records: 0 })
    }

    /// Goes on with the file after its first `n_records` of `record_bytes`; what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it does not hold as many.
    pub(super) fn resume(
        path: &Path,
        what: &'static str,
        header: &[u8],
        record_bytes: u64,
        n_records: u64,
    ) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        if !part.exists() {
            // The run was complete, or was killed before it could say so.
            let taken = fs::rename(path, &part);
            if taken.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
                return Err(FileError::content(what, &part, GONE.to_owned(), ANEW));
            }
            taken.map_err(|e| FileError::system("rename", what, path, e))?;
        }
        let needed = header.len() as u64 + n_records * record_bytes;
        let open = || -> io::Result<(File, u64)> {
            let mut file = File::options().write(true).open(&part)?;
            let length = file.metadata()?.len();
            if length >= needed {
                file.set_len(needed)?;
                file.write_all(header)?;
                file.seek(SeekFrom::End(0))?;
            }
            Ok((file, length))
        };
        let (file, length) = open().map_err(|e| FileError::system("write", what, &part, e))?;
        if length < needed {
            let problem = format!("it has {length} bytes, the checkpoint has {needed}");
            return Err(FileError::content(what, &part, problem, ANEW));
        }
        Ok(Self { file: BufWriter::new(file), part, path: path.to_owned(), what, n_records })
    }

    /// Adds a `record` as it is written; allocates nothing.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub(super) fn write(&mut self, record: &[u8]) -> Result<(), FileError> {
        self.file.write_all(record).map_err(|e| self.refused("write", e))?;
        self.n_records += 1;
        Ok(())
    }

    /// Puts all records on the disk; gives their number, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub(super) fn flush(&mut self) -> Result<u64, FileError> {
        let done = self.file.flush().and_then(|()| self.file.get_ref().sync_data());
        done.map_err(|e| self.refused("write", e))?;
        Ok(self.n_records)
    }

    /// Completes the file under its name; without a record there is none. Nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub(super) fn finish(&mut self) -> Result<(), FileError> {
        self.flush()?;
        if self.n_records == 0 {
            return fs::remove_file(&self.part).map_err(|e| self.refused("remove", e));
        }
        // More than 2³² records nobody keeps.
        let number = u32::try_from(self.n_records).map_or(AS_LONG_AS_IT_IS, u32::to_be_bytes);
        let file = self.file.get_mut();
        let done = file
            .seek(SeekFrom::Start(PLACE_OF_NUMBER as u64))
            .and_then(|_| file.write_all(&number))
            .and_then(|()| file.sync_all());
        done.map_err(|e| self.refused("write", e))?;
        fs::rename(&self.part, &self.path).map_err(|e| self.refused("rename", e))
    }

    fn refused(&self, verb: &'static str, source: io::Error) -> FileError {
        FileError::system(verb, self.what, &self.part, source)
    }
}
