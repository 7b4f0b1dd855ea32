//! Temperature on the planes of a record of wind, in one file that grows with it.

use super::growing::{Growing, header_of};
use super::read::{lacks, variable};
use super::{text, unwritable_as};
use crate::FileError;
use flow::inflow::{InflowError, PlaneGrid};
use netcdf_reader::{NcFile, NcSliceInfo, NcSliceInfoElem};
use netcdf_writer::{DimensionId, Error, NcFileBuilder, NcWriteOptions};
use std::path::{Path, PathBuf};

const WHAT: &str = "the temperature of a record of wind (NetCDF)";
const FIX: &str = "restore the file, or make the precursor again";
const TEMPERATURE: &str = "temperature";
/// Hottest air that a file may hold (K); beyond it the bytes mean something else.
const HOTTEST: f32 = 1000.0;
/// Share of a spacing by which points of wind and temperature may lie apart (–): one is stored in single
/// precision.
const APART: f64 = 1e-3;

/// Writes temperatures plane by plane, as they come.
#[derive(Debug)]
pub struct TemperatureWriter {
    file: Growing,
    bytes: Vec<u8>,
    n_points: usize,
}

impl TemperatureWriter {
    /// Starts the file that will stand at `path`, of planes with the points of `grid`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, grid: &PlaneGrid) -> Result<Self, FileError> {
        Ok(Self::new(Growing::create(path, WHAT, &header(path, grid)?)?, grid))
    }

    /// Goes on with the file after its first `n_planes`; what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it does not hold as many.
    pub fn resume(path: &Path, grid: &PlaneGrid, n_planes: u64) -> Result<Self, FileError> {
        let (header, of_plane) = (header(path, grid)?, plane_bytes(grid));
        Ok(Self::new(Growing::resume(path, WHAT, &header, of_plane, n_planes)?, grid))
    }

    fn new(file: Growing, grid: &PlaneGrid) -> Self {
        let bytes = Vec::with_capacity(plane_bytes(grid) as usize);
        Self { file, bytes, n_points: grid.n_y * grid.n_z }
    }

    /// Adds the temperatures (K) of the plane at `time` (s since the first one): rows of z upwards, in each,
    /// y from the right to the left looking downwind. Allocates nothing.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// When there is not one temperature for each point.
    pub fn write(&mut self, time: f64, temperatures: &[f64]) -> Result<(), FileError> {
        assert_eq!(temperatures.len(), self.n_points, "a plane has one temperature per point");
        self.bytes.clear();
        self.bytes.extend(time.to_be_bytes());
        self.bytes.extend(temperatures.iter().flat_map(|value| (*value as f32).to_be_bytes()));
        self.file.write(&self.bytes)
    }

    /// Puts all planes on the disk; gives their number, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        self.file.flush()
    }

    /// Completes the file under its name. Nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.file.finish()
    }
}

/// Bytes of a plane of `grid` in the file.
pub fn plane_bytes(grid: &PlaneGrid) -> u64 {
    (size_of::<f64>() + size_of::<f32>() * grid.n_y * grid.n_z) as u64
}

/// All of the file before its first plane.
fn header(path: &Path, grid: &PlaneGrid) -> Result<Vec<u8>, FileError> {
    let bytes = encode(grid).map_err(|error| unwritable_as(WHAT, path, error))?;
    Ok(header_of(bytes, plane_bytes(grid)))
}

/// The bytes of a file with one plane that holds zeros.
fn encode(grid: &PlaneGrid) -> Result<Vec<u8>, Error> {
    let mut file = NcFileBuilder::new();
    file.add_attribute("Conventions", text("CF-1.8"))?;
    file.add_attribute("title", text("potential temperature on the planes of a record of wind"))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    let places = |axis: usize, n: usize| -> Vec<f64> {
        (0..n).map(|index| grid.first[axis] + index as f64 * grid.spacing[axis]).collect()
    };
    let z = add_axis(&mut file, "z", "height above the ground", &places(1, grid.n_z))?;
    let left = "distance to the left of the middle of the planes looking downwind";
    let y = add_axis(&mut file, "y", left, &places(0, grid.n_y))?;
    let time = file.add_unlimited_dimension("time")?;
    let variable = file.add_variable::<f64>("time", &[time])?;
    file.add_variable_attribute(variable, "units", text("s"))?;
    file.add_variable_attribute(variable, "axis", text("T"))?;
    file.add_variable_attribute(variable, "long_name", text("time since the first plane"))?;
    file.write_variable(variable, &[0.0])?;
    let variable = file.add_variable::<f32>(TEMPERATURE, &[time, z, y])?;
    file.add_variable_attribute(variable, "units", text("K"))?;
    file.add_variable_attribute(variable, "standard_name", text("air_potential_temperature"))?;
    file.add_variable_attribute(variable, "long_name", text("potential temperature"))?;
    file.write_variable(variable, &vec![0.0_f32; grid.n_y * grid.n_z])?;
    Ok(file.to_vec(NcWriteOptions::offset64())?.1)
}

fn add_axis(
    file: &mut NcFileBuilder,
    name: &str,
    meaning: &str,
    values: &[f64],
) -> Result<DimensionId, Error> {
    let dimension = file.add_dimension(name, values.len() as u64)?;
    let variable = file.add_variable::<f64>(name, &[dimension])?;
    file.add_variable_attribute(variable, "units", text("m"))?;
    file.add_variable_attribute(variable, "axis", text(&name.to_uppercase()))?;
    file.add_variable_attribute(variable, "long_name", text(meaning))?;
    file.write_variable(variable, values)?;
    Ok(dimension)
}

/// Temperatures of a file, read plane by plane.
pub struct TemperatureReader {
    file: NcFile,
    path: PathBuf,
    n_points: [usize; 2],
}

impl TemperatureReader {
    /// Opens the file at `path`, which is to hold the temperatures of planes of `grid`.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else or of
    /// other planes.
    pub fn open(path: &Path, grid: &PlaneGrid) -> Result<Self, FileError> {
        let metadata = std::fs::metadata(path);
        let length = metadata.map_err(|e| FileError::system("read", WHAT, path, e))?.len() as usize;
        let wrong = |problem: String| FileError::content(WHAT, path, problem, FIX);
        let file = NcFile::open(path).map_err(|error| wrong(error.to_string()))?;
        check(&file, length, grid).map_err(wrong)?;
        Ok(Self { file, path: path.to_owned(), n_points: [grid.n_z, grid.n_y] })
    }

    /// Writes the temperatures (K) of plane number `step` into `values`, n_z × n_y.
    ///
    /// # Errors
    /// [`InflowError::Plane`] when they cannot be had.
    pub fn read(&self, step: usize, values: &mut [f32]) -> Result<(), InflowError> {
        let wrong = |problem: String| InflowError::Plane {
            step,
            problem: format!("{WHAT} {}: {problem}; {FIX}", self.path.display()),
        };
        let all = |n: usize| NcSliceInfoElem::Slice { start: 0, end: n as u64, step: 1 };
        let [rows, columns] = self.n_points.map(all);
        let selections = vec![NcSliceInfoElem::Index(step as u64), rows, columns];
        let plane = self
            .file
            .read_variable_slice::<f32>(TEMPERATURE, &NcSliceInfo { selections })
            .map_err(|error| wrong(error.to_string()))?;
        for (value, found) in values.iter_mut().zip(&plane) {
            if !(*found > 0.0 && *found < HOTTEST) {
                return Err(wrong(format!("it holds {found} K")));
            }
            *value = *found;
        }
        Ok(())
    }
}

/// Whether `file`, of `length` bytes, holds temperatures of planes of `grid`; else what is wrong.
fn check(file: &NcFile, length: usize, grid: &PlaneGrid) -> Result<(), String> {
    for (axis, name, n) in [(0, "y", grid.n_y), (1, "z", grid.n_z)] {
        let places = variable(file, name, length)?;
        let place = |index: usize| grid.first[axis] + index as f64 * grid.spacing[axis];
        let close = |(index, found): (usize, &f64)| {
            (found - place(index)).abs() <= APART * grid.spacing[axis]
        };
        if places.len() != n || !places.iter().enumerate().all(close) {
            return Err(format!("its points along {name} are not those of the wind"));
        }
    }
    let shape = file.variable(TEMPERATURE).map_err(|_| lacks(TEMPERATURE))?.shape();
    let expected = [grid.n_steps, grid.n_z, grid.n_y].map(|n| n as u64);
    if shape[..] != expected[..] {
        return Err(format!("it has the shape {shape:?}, and the wind {expected:?}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const GRID: PlaneGrid = PlaneGrid {
        n_y: 3,
        n_z: 2,
        spacing: [20.0, 20.0],
        first: [-20.0, 10.0],
        interval: 2.0,
        speed: 8.0,
        n_steps: 4,
        repeats: false,
    };

    fn plane(step: usize) -> Vec<f64> {
        (0..6).map(|point| 288.0 + step as f64 + 0.25 * f64::from(point)).collect()
    }

    fn opened(path: &Path, grid: &PlaneGrid) -> String {
        match TemperatureReader::open(path, grid) {
            Ok(_) => "opened".to_owned(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn what_is_recorded_with_a_break_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("temperature.nc");
        let mut writer = TemperatureWriter::create(&path, &GRID).unwrap();
        (0..2).for_each(|step| writer.write(2.0 * step as f64, &plane(step)).unwrap());
        let kept = writer.flush().unwrap();
        // Written after the checkpoint, and lost.
        writer.write(4.0, &plane(40)).unwrap();
        drop(writer);
        assert!(TemperatureWriter::resume(&path, &GRID, kept + 2).is_err());
        let mut writer = TemperatureWriter::resume(&path, &GRID, kept).unwrap();
        (2..4).for_each(|step| writer.write(2.0 * step as f64, &plane(step)).unwrap());
        writer.finish().unwrap();
        let reader = TemperatureReader::open(&path, &GRID).unwrap();
        let mut values = [0.0; 6];
        for step in [3, 0, 2, 1] {
            reader.read(step, &mut values).unwrap();
            assert!(values.iter().zip(plane(step)).all(|(a, b)| f64::from(*a) == b));
        }
        assert!(reader.read(4, &mut values).is_err());
        // A longer record goes on with what is complete.
        let mut writer = TemperatureWriter::resume(&path, &GRID, 4).unwrap();
        writer.write(8.0, &plane(4)).unwrap();
        writer.finish().unwrap();
        assert!(
            opened(&path, &GRID).contains("it has the shape [5, 2, 3], and the wind [4, 2, 3]")
        );
        let longer = PlaneGrid { n_steps: 5, ..GRID };
        assert_eq!(opened(&path, &longer), "opened");
        let aside = PlaneGrid { first: [-20.0, 12.0], ..longer };
        assert!(opened(&path, &aside).contains("its points along z are not those of the wind"));
    }

    #[test]
    fn what_is_no_temperature_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("temperature.nc");
        let grid = PlaneGrid { n_steps: 1, ..GRID };
        assert!(matches!(TemperatureReader::open(&path, &grid), Err(FileError::System { .. })));
        let mut writer = TemperatureWriter::create(&path, &grid).unwrap();
        let mut cold = plane(0);
        cold[4] = f64::NAN;
        writer.write(0.0, &cold).unwrap();
        writer.finish().unwrap();
        let reader = TemperatureReader::open(&path, &grid).unwrap();
        let error = reader.read(0, &mut [0.0; 6]).unwrap_err().to_string();
        assert!(error.contains("plane 0 of the wind cannot be read") && error.contains("NaN K"));
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() / 3]).unwrap();
        assert_ne!(opened(&path, &grid), "opened");
    }
}
