//! Velocity at many instants in a file, read in strips of points, so that a file of any length takes little
//! memory.

use super::COMPONENTS;
use super::grid::{grid_of, shape_of};
use super::read::{lacks, variable};
use crate::{FileError, atomic};
use basis::records::Grid;
use netcdf_reader::{NcFile, NcSliceInfo, NcSliceInfoElem};
use std::ops::Range;
use std::path::{Path, PathBuf};

const WHAT: &str = "velocity at instants (NetCDF)";
const FIX: &str = "give a file with u, v, w over time, z, y, x, such as planes/hub-height.nc of a run with output.plane_interval";

/// Velocity on a grid at instants, in a file.
pub struct StoredInstants {
    path: PathBuf,
    file: NcFile,
    /// The points.
    pub grid: Grid,
    /// The instants (s), ascending.
    pub times: Vec<f64>,
    /// What the file says of itself.
    pub about: AboutInstants,
}

/// What a file of instants says of itself; nothing where it does not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AboutInstants {
    /// Name of the case.
    pub case: Option<String>,
    /// Name of the run.
    pub run: Option<String>,
    /// Name of the plane.
    pub plane: Option<String>,
    /// Free-stream speed (m/s).
    pub wind_speed: Option<f64>,
    /// Turbulence intensity (–).
    pub turbulence_intensity: Option<f64>,
    /// Diameter of the first rotor (m).
    pub rotor_diameter: Option<f64>,
}

impl StoredInstants {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else, or
    /// its time runs back.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let unreadable = |error| FileError::system("read", WHAT, path, error);
        // Asked before the library opens it: what is no file is refused here.
        let length = atomic::open(path).and_then(|file| file.metadata()).map_err(unreadable)?.len();
        let most = usize::try_from(length).unwrap_or(usize::MAX);
        let content = |problem| FileError::content(WHAT, path, problem, FIX);
        let file = NcFile::open(path).map_err(|error| content(error.to_string()))?;
        let (grid, times) = decode(&file, most).map_err(content)?;
        let about = about(&file);
        Ok(Self { path: path.to_owned(), file, grid, times, about })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Velocity u, v, w (m/s; not a number where there is a hole) at all instants, one after the other, at
    /// the points that lie `steps` steps from the first along the last of x, y, z that has more than one
    /// point, x fastest.
    ///
    /// # Errors
    /// [`FileError::Content`] when the file does not hold them.
    pub fn read(&self, steps: Range<usize>) -> Result<[Vec<f32>; 3], FileError> {
        self.slice(steps).map_err(|problem| FileError::content(WHAT, &self.path, problem, FIX))
    }

    fn slice(&self, steps: Range<usize>) -> Result<[Vec<f32>; 3], String> {
        let n_points = self.grid.n_points;
        let slowest = (0..3).rev().find(|axis| n_points[*axis] > 1).unwrap_or(0);
        let whole = NcSliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 };
        let mut selections = vec![whole; 4];
        let (start, end) = (steps.start as u64, steps.end as u64);
        selections[3 - slowest] = NcSliceInfoElem::Slice { start, end, step: 1 };
        let slice = NcSliceInfo { selections };
        let in_all = self.times.len() * (self.grid.len() / n_points[slowest]) * steps.len();
        let mut velocity = [const { Vec::new() }; 3];
        for ((name, _), values) in COMPONENTS.iter().zip(&mut velocity) {
            let read = self.file.read_variable_slice::<f32>(name, &slice);
            *values = read.map_err(|error| error.to_string())?.into_raw_vec_and_offset().0;
            if values.len() != in_all {
                return Err(format!("`{name}` is cut short"));
            }
        }
        Ok(velocity)
    }
}

/// Points and instants of a file of `most` bytes.
fn decode(file: &NcFile, most: usize) -> Result<(Grid, Vec<f64>), String> {
    let times = variable(file, "time", most)?;
    let grid = grid_of(file, ["x", "y", "z"], most)?;
    let [n_x, n_y, n_z] = grid.n_points;
    let expected = [times.len(), n_z, n_y, n_x];
    let in_all = expected.iter().try_fold(1_usize, |n, m| n.checked_mul(*m));
    if in_all.is_none_or(|n| n > most / size_of::<f32>()) {
        return Err("it holds fewer values than it says".to_owned());
    }
    for (name, _) in COMPONENTS {
        let shape = shape_of(file, name)?;
        if shape != expected {
            return Err(format!(
                "`{name}` has the shape {shape:?}, not time, z, y, x: {expected:?}"
            ));
        }
        let kind = file.variable(name).map_err(|_| lacks(name))?.dtype().clone();
        if kind != netcdf_reader::NcType::Float {
            return Err(format!("`{name}` holds {kind:?}, not numbers in single precision"));
        }
    }
    for (index, time) in times.iter().enumerate() {
        if !time.is_finite() {
            return Err(format!("instant {index} has no time"));
        }
        if index > 0 && *time <= times[index - 1] {
            let before = times[index - 1];
            return Err(format!(
                "time runs back: instant {index} is at {time} s, after {before} s"
            ));
        }
    }
    if times.is_empty() {
        return Err("it holds no instant".to_owned());
    }
    Ok((grid, times))
}

fn about(file: &NcFile) -> AboutInstants {
    let found = |name: &str| file.global_attribute(name).ok().map(|found| found.value.clone());
    let text = |name: &str| found(name)?.as_string();
    let number = |name: &str| {
        let values = found(name)?.as_f64_vec()?;
        values.first().copied().filter(|value| value.is_finite() && *value > 0.0)
    };
    AboutInstants {
        case: text("case"),
        run: text("run"),
        plane: text("plane"),
        wind_speed: number("wind_speed_m_s"),
        turbulence_intensity: number("turbulence_intensity"),
        rotor_diameter: number("rotor_diameter_m"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::netcdf::{InstantWriter, PlaneSetting};
    use basis::records::{Plane, PlaneAxes};

    fn plane(axes: PlaneAxes, time: f64) -> Plane {
        let values = |add: f32| (0..6).map(|i| add + i as f32 + 10.0 * time as f32).collect();
        Plane {
            name: "cut".to_owned(),
            axes,
            origin: [1.0, 2.0, 3.0],
            spacing: [0.5, 2.0],
            n_points: [3, 2],
            time,
            averaged: 0.0,
            velocity: [values(0.0), values(100.0), values(200.0)],
        }
    }

    fn written(path: &Path, axes: PlaneAxes, times: &[f64]) {
        let setting = PlaneSetting::example();
        let mut writer = InstantWriter::create(path, &setting, &plane(axes, times[0])).unwrap();
        for time in times {
            writer.write(&plane(axes, *time)).unwrap();
        }
        writer.finish().unwrap();
    }

    #[test]
    fn strips_are_those_of_the_planes_at_all_instants() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cut.nc");
        for axes in [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind] {
            written(&path, axes, &[1.0, 2.0, 4.0]);
            let stored = StoredInstants::open(&path).unwrap();
            assert_eq!(stored.times, [1.0, 2.0, 4.0]);
            assert_eq!(stored.grid, Grid::of_plane(&plane(axes, 1.0)));
            let [u, v, _] = stored.read(1..2).unwrap();
            assert_eq!(u, [13.0, 14.0, 15.0, 23.0, 24.0, 25.0, 43.0, 44.0, 45.0]);
            assert_eq!(v[8], 145.0);
            assert_eq!(stored.read(0..2).unwrap()[0].len(), 18);
            assert_eq!(stored.about.plane.as_deref(), Some("cut"));
            assert_eq!(stored.about.rotor_diameter, Some(240.0));
        }
    }

    #[test]
    fn time_that_runs_back_is_refused_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("back.nc");
        written(&path, PlaneAxes::Crosswind, &[1.0, 2.0, 1.5]);
        let message = StoredInstants::open(&path).err().unwrap().to_string();
        assert!(message.contains("instant 2 is at 1.5 s, after 2 s"), "{message}");
        assert!(message.contains("back.nc"), "{message}");
    }
}
