//! The scans of a run's lidars: a file for each, `scans-TURBINE.SENSOR.nc`.

pub use crate::netcdf::{
    ScanInstant, ScanSetting, ScanWriter, StoredScans, read_scans, scan_bytes,
};

use super::RunFolder;
use std::path::PathBuf;

/// What the name of a lidar's scans begins with.
pub(super) const SCANS: &str = "scans-";

/// Name of the file with the scans of the lidar `sensor` of `turbine`: `scans-T1.lidar.nc`.
pub fn scans_name(turbine: &str, sensor: &str) -> String {
    // No name has a point in it.
    format!("{SCANS}{turbine}.{sensor}.nc")
}

impl RunFolder {
    /// `scans-T1.lidar.nc`: the scans of the lidar `sensor` of `turbine`; until the run is complete they are
    /// in `scans-T1.lidar.nc.part`.
    pub fn scans_path(&self, turbine: &str, sensor: &str) -> PathBuf {
        self.path.join(scans_name(turbine, sensor))
    }
}
