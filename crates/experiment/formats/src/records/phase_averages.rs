//! Averages by phase of a run: a file for each plane or volume, `averages-NAME.nc`.

use super::{RunFolder, study};
use crate::FileError;
use std::path::{Path, PathBuf};

pub use crate::netcdf::{
    PhaseAveragesWriter, StoredPhaseAverages, is_phase_averages, phase_averages_bytes,
    write_phase_averages,
};

/// What the name of a file with averages begins with.
pub(super) const AVERAGES: &str = "averages-";

impl RunFolder {
    /// `averages-hub-height.nc`: velocity averaged by phase on the plane or in the volume called `name`.
    pub fn phase_averages_path(&self, name: &str) -> PathBuf {
        self.path.join(format!("{AVERAGES}{name}.nc"))
    }

    /// The files of averages by phase that lie in the folder, by name.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn phase_averages_paths(&self) -> Result<Vec<PathBuf>, FileError> {
        let is_one = |path: &PathBuf| Self::phase_averages_name(path).is_some();
        Ok(study::entries(&self.path)?.into_iter().filter(is_one).collect())
    }

    /// The name of the plane or volume whose averages by phase the file at `path` holds, if it is one.
    pub fn phase_averages_name(path: &Path) -> Option<&str> {
        path.file_name()?.to_str()?.strip_prefix(AVERAGES)?.strip_suffix(".nc")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::{FieldSetting, Grid, Moments, PhaseAverages, PhaseBin};

    fn moments(start: f32, n_points: usize) -> Moments {
        let values = |add: usize| (0..n_points).map(|i| start + (add * 100 + i) as f32).collect();
        Moments {
            n_samples: (0..n_points as u32).collect(),
            mean: std::array::from_fn(values),
            stress: std::array::from_fn(|place| values(3 + place)),
        }
    }

    fn example() -> (FieldSetting, PhaseAverages) {
        let grid =
            Grid { origin: [0.4, -0.35, 0.2], spacing: [0.01, 0.02, 0.5], n_points: [4, 3, 2] };
        let setting = FieldSetting {
            name: "tunnel, ccw".to_owned(),
            wind_speed: 5.0,
            turbulence_intensity: None,
            diameter: 0.58,
            hub: [0.0, 0.0, 0.8],
        };
        let bin = |index: usize| PhaseBin {
            rotor: 0.5 + index as f64,
            helix: (index != 1).then_some(3.0 - index as f64),
            n_instants: 150 + index as u64,
            n_visits: 24,
        };
        let averages = PhaseAverages {
            grid,
            rotor_width: 0.5,
            helix_width: Some(0.7),
            span: [1.0, 11.0],
            bins: (0..3).map(bin).collect(),
            all: moments(-7.0, grid.len()),
            pressure: Some((0..grid.len()).map(|index| 0.25 * index as f32 - 2.0).collect()),
            each: (0..3).map(|index| moments(1e3 * index as f32, grid.len())).collect(),
        };
        (setting, averages)
    }

    fn write(path: &Path) -> (FieldSetting, PhaseAverages) {
        let (setting, averages) = example();
        write_phase_averages(path, &setting, &averages, |index| averages.each[index].clone())
            .unwrap();
        (setting, averages)
    }

    #[test]
    fn averages_come_back_as_they_were() {
        let folder = tempfile::tempdir().unwrap();
        let run = RunFolder::new(folder.path(), "helix");
        run.create().unwrap();
        let path = run.phase_averages_path("streamwise");
        let (setting, averages) = write(&path);
        let length = std::fs::metadata(&path).unwrap().len();
        assert!(length <= phase_averages_bytes(24, 3) && length > phase_averages_bytes(24, 3) / 2);
        let stored = StoredPhaseAverages::open(&path).unwrap();
        assert_eq!(stored.setting, setting);
        let read = stored.averages().unwrap();
        assert_eq!(read.grid.n_points, averages.grid.n_points);
        for axis in 0..3 {
            assert!((read.grid.spacing[axis] / averages.grid.spacing[axis] - 1.0).abs() < 1e-12);
        }
        assert_eq!(PhaseAverages { grid: averages.grid, ..read }, averages);
        assert!(is_phase_averages(&path) && !is_phase_averages(folder.path()));
        assert_eq!(run.phase_averages_paths().unwrap(), [path]);
    }

    #[test]
    fn some_points_at_a_time_make_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let [whole, parts] = ["whole.nc", "parts.nc"].map(|name| folder.path().join(name));
        let (setting, averages) = write(&whole);
        let at = |moments: &Moments, points: std::ops::Range<usize>| Moments {
            n_samples: moments.n_samples[points.clone()].to_vec(),
            mean: moments.mean.each_ref().map(|values| values[points.clone()].to_vec()),
            stress: moments.stress.each_ref().map(|values| values[points.clone()].to_vec()),
        };
        let head = PhaseAverages { all: Moments::default(), each: Vec::new(), ..averages.clone() };
        let mut writer = PhaseAveragesWriter::create(&parts, &setting, &head).unwrap();
        for points in [8..24, 0..3, 3..8] {
            let bin = |index: usize| at(&averages.each[index], points.clone());
            writer.write(points.clone(), &at(&averages.all, points.clone()), bin).unwrap();
        }
        writer.commit().unwrap();
        assert_eq!(std::fs::read(whole).unwrap(), std::fs::read(parts).unwrap());
    }

    #[test]
    fn a_file_that_ends_early_is_refused_with_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("averages-short.nc");
        write(&path);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 100]).unwrap();
        let refused = StoredPhaseAverages::open(&path).and_then(|stored| stored.averages());
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("averages-short.nc"), "{message}");
    }
}
