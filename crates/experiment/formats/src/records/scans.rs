//! The scans of a run's lidars: a file for each, `scans-TURBINE.SENSOR.nc`.

use super::study::entries;
use super::{RunFolder, SCANS};
use crate::FileError;
use std::path::PathBuf;

pub use crate::netcdf::{
    ScanInstant, ScanSetting, ScanWriter, StoredScans, read_scans, scan_bytes,
};

/// Files of the scans of the complete run in `folder`, by name.
///
/// # Errors
/// [`FileError::System`].
pub(super) fn paths(folder: &RunFolder) -> Result<Vec<PathBuf>, FileError> {
    let mut paths = entries(folder.path())?;
    paths.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(SCANS) && name.ends_with(".nc")
    });
    Ok(paths)
}
