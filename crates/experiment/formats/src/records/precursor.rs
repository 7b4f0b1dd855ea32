//! What a precursor leaves behind: `DIR/` with its case, statistics, planes of wind and result.

use super::{gone, read_layout_or, write_json};
use crate::lock::Lock;
use crate::{FileError, atomic, leftovers};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Version of the layout of [`PrecursorResult`].
pub const PRECURSOR_VERSION: u32 = 2;
const WHAT: &str = "the result of a precursor";
/// Changes from block to block of a wind that is steady: of speed and friction velocity (–), of direction
/// (deg).
const STEADY_SPEED: f64 = 0.01;
const STEADY_FRICTION: f64 = 0.03;
const STEADY_DIRECTION: f64 = 1.0;

/// What came of a precursor. It is complete with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrecursorResult {
    /// Version of this layout.
    pub schema_version: u32,
    /// Version of the program.
    pub version: String,
    /// Name of the precursor.
    pub name: String,
    /// Its file as run, with every default.
    pub case_text: String,
    /// What of the machine decides the bits, in words.
    pub backend: String,
    /// When it was complete (UTC, RFC 3339).
    pub finished: String,
    /// What a reader of the numbers must know.
    pub warnings: Vec<String>,
    /// The planes of wind.
    pub planes: RecordedPlanes,
    /// What changed from one half of the end of the spin-up to the other; absent without a spin-up.
    pub spin_up: Option<Drift>,
    /// The same of the time that was recorded.
    pub record: Option<Drift>,
    /// Means over level and time that was recorded, from the ground up.
    pub profile: Vec<ProfileRow>,
    /// Friction velocity over the time that was recorded (m/s).
    pub friction_velocity: f64,
    /// Height where the mean stress of that time is a twentieth of the ground's, over 0.95 (m).
    pub boundary_layer_height: f64,
    /// Speed of the geostrophic wind that drove it at the end (m/s).
    pub geostrophic_speed: f64,
    /// Where that came from (deg, clockwise from north).
    pub geostrophic_direction_deg: f64,
    /// Cells (–).
    pub n_cells: u64,
    /// Steps (–).
    pub n_steps: u64,
    /// Wall time (s).
    pub wall_time: f64,
}

/// The planes of wind in `planes.bts`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedPlanes {
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// Planes (–).
    pub n_planes: usize,
    /// Points along y and z (–).
    pub n_points: [usize; 2],
    /// Distance of points (m).
    pub spacing: f64,
    /// Time between planes (s).
    pub interval: f64,
    /// Hub height (m).
    pub hub_height: f64,
    /// Mean speed across the planes at hub height, linear between their rows (m/s).
    pub hub_speed: f64,
    /// Standard deviation of u there over its mean (–).
    pub turbulence_intensity: f64,
    /// Where the wind of the file comes from in the box (deg, clockwise from north).
    pub direction_deg: f64,
    /// By how much the mean wind at hub height turned from that while it was recorded (deg, to the left seen
    /// downwind).
    pub turned_deg: f64,
}

/// Means of two blocks of equal length, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// Length of a block (s).
    pub block: f64,
    /// Speed at hub height (m/s).
    pub hub_speed: [f64; 2],
    /// Where that wind comes from (deg, clockwise from north).
    pub direction_deg: [f64; 2],
    /// Friction velocity (m/s).
    pub friction_velocity: [f64; 2],
}

impl Drift {
    /// Whether it is that of a wind that has become steady: at most 1 % in speed at hub height, 3 % in
    /// friction velocity and 1° in direction from one block to the next.
    pub fn is_steady(&self) -> bool {
        self.of_speed().abs() <= STEADY_SPEED
            && self.of_friction().abs() <= STEADY_FRICTION
            && self.of_direction().abs() <= STEADY_DIRECTION
    }

    /// Change of the speed at hub height over its mean (–).
    pub fn of_speed(&self) -> f64 {
        change(self.hub_speed)
    }

    /// Change of the friction velocity over its mean (–).
    pub fn of_friction(&self) -> f64 {
        change(self.friction_velocity)
    }

    /// Change of the direction (deg), the shorter way round.
    pub fn of_direction(&self) -> f64 {
        let [before, after] = self.direction_deg;
        (after - before + 180.0).rem_euclid(360.0) - 180.0
    }
}

fn change([before, after]: [f64; 2]) -> f64 {
    2.0 * (after - before) / (after + before)
}

/// Means of one level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProfileRow {
    /// Height (m).
    pub height: f64,
    /// Speed (m/s).
    pub speed: f64,
    /// Where the wind comes from (deg, clockwise from north).
    pub direction_deg: f64,
    /// √(2k/3) over speed (–).
    pub turbulence_intensity: f64,
    /// Flux of momentum, what the grid does not resolve included (m²/s²).
    pub stress: f64,
    /// Potential temperature (K).
    pub temperature: f64,
    /// Flux of heat upwards, what the grid does not resolve included (K m/s).
    pub heat_flux: f64,
}

/// The folder of a precursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrecursorFolder {
    path: PathBuf,
}

impl PrecursorFolder {
    /// The folder at `path`; nothing is touched.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `case.toml`: the precursor as run, with every default.
    pub fn case_path(&self) -> PathBuf {
        self.path.join("case.toml")
    }

    /// `statistics.nc`.
    pub fn statistics_path(&self) -> PathBuf {
        self.path.join("statistics.nc")
    }

    /// `planes.bts`; what a longer record goes on from stands beside it, in `planes.bts.part`.
    pub fn planes_path(&self) -> PathBuf {
        self.path.join("planes.bts")
    }

    /// `temperature.nc`: that of the same planes.
    pub fn temperature_path(&self) -> PathBuf {
        self.path.join("temperature.nc")
    }

    /// `checkpoint`.
    pub fn checkpoint_path(&self) -> PathBuf {
        self.path.join("checkpoint")
    }

    /// `precursor.json`.
    pub fn result_path(&self) -> PathBuf {
        self.path.join("precursor.json")
    }

    /// `report.html`; its figures lie in `figures`.
    pub fn report_path(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// All of them, the result first.
    fn files(&self) -> [PathBuf; 9] {
        [
            self.result_path(),
            self.report_path(),
            self.checkpoint_path(),
            self.planes_path(),
            atomic::part_of(&self.planes_path()),
            self.temperature_path(),
            atomic::part_of(&self.temperature_path()),
            self.statistics_path(),
            self.case_path(),
        ]
    }

    /// Whether a precursor has left anything in it.
    pub fn holds_results(&self) -> bool {
        self.files().iter().any(|file| fs::symlink_metadata(file).is_ok())
    }

    /// Whether the precursor is complete.
    pub fn is_complete(&self) -> bool {
        self.result_path().is_file()
    }

    /// Takes away what an earlier precursor left, the result first.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn clear(&self) -> Result<(), FileError> {
        self.files().iter().try_for_each(|file| gone(fs::remove_file(file), file))
    }

    /// Makes the precursor one that is under way again, without result, report and planes, which will be
    /// others; what it goes on from stays.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn reopen(&self) -> Result<(), FileError> {
        let files =
            [self.result_path(), self.report_path(), self.planes_path(), self.temperature_path()];
        files.iter().try_for_each(|file| gone(fs::remove_file(file), file))
    }

    /// Makes the folder and takes away what a killed process was writing there; nobody else writes it until
    /// the lock is dropped.
    ///
    /// # Errors
    /// [`FileError::Held`] says who else does; [`FileError::System`].
    pub fn lock(&self) -> Result<Lock, FileError> {
        atomic::create_folder(&self.path)?;
        let lock = Lock::take(
            &self.path.join(".lock"),
            &format!("the precursor in {}", self.path.display()),
        )?;
        leftovers::remove_leftovers(&self.path)?;
        Ok(lock)
    }

    /// Writes `text` as the precursor's file.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn write_case(&self, text: &str) -> Result<(), FileError> {
        atomic::write(&self.case_path(), "the precursor's file", text.as_bytes())
    }

    /// Writes the result.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn write_result(&self, result: &PrecursorResult) -> Result<(), FileError> {
        write_json(&self.result_path(), WHAT, result)
    }

    /// Reads the result.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it is something else.
    pub fn read_result(&self) -> Result<PrecursorResult, FileError> {
        let path = self.result_path();
        read_layout_or(&path, WHAT, PRECURSOR_VERSION, AGAIN, LATER)
    }
}

/// What helps where the result is of another layout.
const AGAIN: &str = "make the precursor again with `wakemix inflow precursor CASE --overwrite`, or read it with the wakemix that made it";
const LATER: &str = "use the wakemix that made it, or a later one";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_of_an_earlier_program_is_refused_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let folder = PrecursorFolder::new(folder.path());
        std::fs::create_dir_all(folder.result_path().parent().unwrap()).unwrap();
        std::fs::write(folder.result_path(), r#"{ "schema_version": 1 }"#).unwrap();
        let FileError::Content { problem, fix, .. } = folder.read_result().unwrap_err() else {
            panic!("another error than that of the version");
        };
        assert!(problem.contains("its schema_version is 1") && fix.contains("inflow precursor"));
    }

    #[test]
    fn a_wind_that_changes_little_is_steady() {
        let steady = Drift {
            block: 3600.0,
            hub_speed: [9.0, 9.05],
            direction_deg: [359.6, 0.4],
            friction_velocity: [0.3, 0.295],
        };
        assert!(steady.is_steady());
        for unsteady in [
            Drift { hub_speed: [9.0, 9.2], ..steady },
            Drift { direction_deg: [359.6, 1.4], ..steady },
            Drift { friction_velocity: [0.3, 0.28], ..steady },
            Drift { friction_velocity: [0.3, f64::NAN], ..steady },
        ] {
            assert!(!unsteady.is_steady(), "{unsteady:?}");
        }
    }
}
