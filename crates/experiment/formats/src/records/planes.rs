//! The planes of a run: a file for each, in `planes/`.

use super::RunFolder;
use crate::{FileError, netcdf};
use basis::records::Plane;

pub use crate::netcdf::{AtPhase, InstantWriter, PlacedTurbine, PlaneSetting};

/// Ends the name of a mean, of the last instant, and of averages by phase.
pub(super) const MEAN: &str = "-mean.nc";
pub(super) const LAST: &str = "-last.nc";
pub(super) const PHASES: &str = "-phases.nc";

/// Writes the mean of a plane over the analysed time: `planes/NAME-mean.nc`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_mean_plane(
    folder: &RunFolder,
    setting: &PlaneSetting,
    plane: &Plane,
) -> Result<(), FileError> {
    netcdf::write_plane(&folder.planes_path().join(format!("{}{MEAN}", plane.name)), setting, plane)
}

/// Writes a plane at the run's last instant: `planes/NAME-last.nc`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_last_plane(
    folder: &RunFolder,
    setting: &PlaneSetting,
    plane: &Plane,
) -> Result<(), FileError> {
    netcdf::write_plane(&folder.planes_path().join(format!("{}{LAST}", plane.name)), setting, plane)
}

/// Writes the means of a plane at phases of the excitation: `planes/NAME-phases.nc`; nothing where there is
/// none.
///
/// # Errors
/// [`FileError::System`].
pub fn write_phase_planes(
    folder: &RunFolder,
    setting: &PlaneSetting,
    phases: &[AtPhase],
) -> Result<(), FileError> {
    let Some(first) = phases.first() else { return Ok(()) };
    let name = format!("{}{PHASES}", first.plane.name);
    netcdf::write_phases(&folder.planes_path().join(name), setting, phases)
}
