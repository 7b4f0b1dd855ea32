//! Planes at instants in one file, which grows while the run goes on.
//!
//! Until the run is complete the file has `.part` after its name. There its header says that it holds as many
//! instants as there are bytes for, which the format allows, so that what a killed run has left can be looked
//! at. What comes last is their number, and the name.

use super::{Over, PlaneSetting, WHAT, encode, unwritable};
use crate::checkpoint::{ANEW, GONE};
use crate::{FileError, atomic};
use basis::records::Plane;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Number of records where it follows from the length of the file.
const AS_LONG_AS_IT_IS: [u8; 4] = [0xFF; 4];
/// Where the number of records stands in the file.
const PLACE_OF_NUMBER: u64 = 4;

/// Writes planes as they come, one file for all.
#[derive(Debug)]
pub struct InstantWriter {
    file: BufWriter<File>,
    part: PathBuf,
    path: PathBuf,
    /// One instant as it is written.
    bytes: Vec<u8>,
    n_values: usize,
    n_instants: u64,
}

impl InstantWriter {
    /// Starts the file that will stand at `path`, of planes with the points of `like` in `setting`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, setting: &PlaneSetting, like: &Plane) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let header = header(path, setting, like)?;
        let mut file = File::create(&part).map_err(|e| refused("write", &part, e))?;
        file.write_all(&header).map_err(|e| refused("write", &part, e))?;
        Ok(Self::new(file, part, path, like, 0))
    }

    /// Goes on with the file after its first `n_instants`; what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it does not hold as many, or other planes.
    pub fn resume(
        path: &Path,
        setting: &PlaneSetting,
        like: &Plane,
        n_instants: u64,
    ) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        if !part.exists() {
            // The run was complete, or was killed before it could say so.
            let taken = fs::rename(path, &part);
            if taken.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
                return Err(FileError::content(WHAT, &part, GONE.to_owned(), ANEW));
            }
            taken.map_err(|e| refused("rename", path, e))?;
        }
        let header = header(path, setting, like)?;
        let n_values = like.n_points.iter().product();
        let needed = header.len() as u64 + n_instants * instant_bytes(n_values);
        let open = || -> io::Result<(File, u64)> {
            let mut file = File::options().write(true).open(&part)?;
            let length = file.metadata()?.len();
            if length >= needed {
                file.set_len(needed)?;
                file.write_all(&header)?;
                file.seek(SeekFrom::End(0))?;
            }
            Ok((file, length))
        };
        let (file, length) = open().map_err(|e| refused("write", &part, e))?;
        if length < needed {
            let problem = format!("it has {length} bytes, the checkpoint has {needed}");
            return Err(FileError::content(WHAT, &part, problem, ANEW));
        }
        Ok(Self::new(file, part, path, like, n_instants))
    }

    fn new(file: File, part: PathBuf, path: &Path, like: &Plane, n_instants: u64) -> Self {
        let n_values = like.n_points.iter().product();
        let bytes = Vec::with_capacity(instant_bytes(n_values) as usize);
        let path = path.to_owned();
        Self { file: BufWriter::new(file), part, path, bytes, n_values, n_instants }
    }

    /// Adds `plane`; allocates nothing.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// When it has other points than those that the file was started with.
    pub fn write(&mut self, plane: &Plane) -> Result<(), FileError> {
        self.bytes.clear();
        self.bytes.extend_from_slice(&plane.time.to_be_bytes());
        for values in &plane.velocity {
            assert_eq!(values.len(), self.n_values, "planes of one file are of one size");
            self.bytes.extend(values.iter().flat_map(|value| value.to_be_bytes()));
        }
        self.file.write_all(&self.bytes).map_err(|e| refused("write", &self.part, e))?;
        self.n_instants += 1;
        Ok(())
    }

    /// Puts all instants on the disk; gives their number, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        let done = self.file.flush().and_then(|()| self.file.get_ref().sync_data());
        done.map_err(|e| refused("write", &self.part, e))?;
        Ok(self.n_instants)
    }

    /// Completes the file under its name; without an instant there is none. Nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.flush()?;
        if self.n_instants == 0 {
            return fs::remove_file(&self.part).map_err(|e| refused("remove", &self.part, e));
        }
        // More than 2³² instants nobody keeps.
        let number = u32::try_from(self.n_instants).map_or(AS_LONG_AS_IT_IS, u32::to_be_bytes);
        let file = self.file.get_mut();
        let done = file
            .seek(SeekFrom::Start(PLACE_OF_NUMBER))
            .and_then(|_| file.write_all(&number))
            .and_then(|()| file.sync_all());
        done.map_err(|e| refused("write", &self.part, e))?;
        fs::rename(&self.part, &self.path).map_err(|e| refused("rename", &self.part, e))
    }
}

/// Bytes of an instant: its time, and three components at `n_values` points.
fn instant_bytes(n_values: usize) -> u64 {
    (size_of::<f64>() + 3 * n_values * size_of::<f32>()) as u64
}

/// All of the file before its first instant.
fn header(path: &Path, setting: &PlaneSetting, like: &Plane) -> Result<Vec<u8>, FileError> {
    let whole = encode(setting, like, &Over::Time { grows: true });
    let mut bytes = whole.map_err(|error| unwritable(path, error))?;
    let n_values = like.n_points.iter().product();
    bytes.truncate(bytes.len() - instant_bytes(n_values) as usize);
    bytes[PLACE_OF_NUMBER as usize..][..4].copy_from_slice(&AS_LONG_AS_IT_IS);
    Ok(bytes)
}

fn refused(verb: &'static str, path: &Path, source: io::Error) -> FileError {
    FileError::system(verb, WHAT, path, source)
}
