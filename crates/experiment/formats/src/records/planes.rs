//! The planes of a run: a file for each, in `planes/`.

use super::RunFolder;
use crate::{FileError, netcdf};
use basis::records::Plane;
use std::path::PathBuf;

pub use crate::netcdf::{AtPhase, InstantWriter, PlacedTurbine, PlaneSetting};

/// Ends the name of a mean, of the last instant, and of averages by phase.
pub(super) const MEAN: &str = "-mean.nc";
pub(super) const LAST: &str = "-last.nc";
pub(super) const PHASES: &str = "-phases.nc";

impl RunFolder {
    /// Names of the planes that were kept at instants: what lies in `planes/` but means, last instants and
    /// averages by phase.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn instants_names(&self) -> Result<Vec<String>, FileError> {
        let name = |path: PathBuf| {
            let file = path.file_name()?.to_str()?;
            let is_other = [MEAN, LAST, PHASES].iter().any(|end| file.ends_with(end));
            let name = file.strip_suffix(".nc")?;
            (!is_other).then(|| name.to_owned())
        };
        Ok(self.plane_files()?.into_iter().filter_map(name).collect())
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_lies_beside_instants_is_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let run = RunFolder::new(folder.path(), "helix");
        fs::create_dir_all(run.planes_path()).expect("a folder");
        for end in [".nc", MEAN, LAST, PHASES] {
            fs::write(run.planes_path().join(format!("hub-height{end}")), "").expect("a file");
        }
        fs::write(run.planes_path().join("notes.txt"), "").expect("a file");
        assert_eq!(run.instants_names().expect("names"), ["hub-height"]);
    }
}
