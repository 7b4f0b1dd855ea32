//! Planes at instants in one file, which grows while the run goes on.

use super::growing::{Growing, header_of};
use super::{Over, PlaneSetting, WHAT, encode, unwritable};
use crate::FileError;
use basis::records::Plane;
use std::path::Path;

/// Writes planes as they come, one file for all.
#[derive(Debug)]
pub struct InstantWriter {
    file: Growing,
    /// One instant as it is written.
    bytes: Vec<u8>,
    n_values: usize,
}

impl InstantWriter {
    /// Starts the file that will stand at `path`, of planes with the points of `like` in `setting`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, setting: &PlaneSetting, like: &Plane) -> Result<Self, FileError> {
        let header = header(path, setting, like)?;
        Ok(Self::new(Growing::create(path, WHAT, &header)?, like))
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
        let (header, of_instant) = (header(path, setting, like)?, instant_bytes(n_values(like)));
        Ok(Self::new(Growing::resume(path, WHAT, &header, of_instant, n_instants)?, like))
    }

    fn new(file: Growing, like: &Plane) -> Self {
        let n_values = n_values(like);
        Self { file, bytes: Vec::with_capacity(instant_bytes(n_values) as usize), n_values }
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
        self.file.write(&self.bytes)
    }

    /// Puts all instants on the disk; gives their number, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        self.file.flush()
    }

    /// Completes the file under its name; without an instant there is none. Nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.file.finish()
    }
}

/// Points of a plane like `like` (–).
fn n_values(like: &Plane) -> usize {
    like.n_points.iter().product()
}

/// Bytes of an instant: its time, and three components at `n_values` points.
fn instant_bytes(n_values: usize) -> u64 {
    (size_of::<f64>() + 3 * n_values * size_of::<f32>()) as u64
}

/// All of the file before its first instant.
fn header(path: &Path, setting: &PlaneSetting, like: &Plane) -> Result<Vec<u8>, FileError> {
    let whole = encode(setting, like, &Over::Time { grows: true });
    let bytes = whole.map_err(|error| unwritable(path, error))?;
    Ok(header_of(bytes, instant_bytes(n_values(like))))
}
