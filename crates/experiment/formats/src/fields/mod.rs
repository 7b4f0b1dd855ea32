//! Velocity on regular grids at instants, whoever wrote it: NetCDF, VTK image data, Tecplot's text.
//!
//! An instant at a time is in memory. Lengths come in metres, velocities in metres a second, whatever the
//! units of the file; what is missing in it is not a number.

mod netcdf;
mod tecplot_fields;
mod units;
mod vti;

pub use units::Lengths;
pub(crate) use units::{length_in, speed_in, time_in};

use crate::FileError;
use basis::records::{Field, Grid};
use netcdf::NetCdfFields;
use std::ops::Range;
use std::path::{Path, PathBuf};
use tecplot_fields::TecplotFields;

const WHAT: &str = "velocity on a grid";

/// What a file tells of what its fields were taken of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundSetting {
    /// Case and run, or what else it calls itself.
    pub name: Option<String>,
    /// Free-stream speed (m/s).
    pub wind_speed: Option<f64>,
    /// Turbulence intensity (–).
    pub turbulence_intensity: Option<f64>,
    /// Rotor diameter (m).
    pub diameter: Option<f64>,
    /// Middle of the rotor (m).
    pub hub: Option<[f64; 3]>,
}

/// Fields at instants.
pub struct FieldFile {
    path: PathBuf,
    grid: Grid,
    times: Vec<f64>,
    has_times: bool,
    found: FoundSetting,
    zeros: Zeros,
    n_zeros: u64,
    kind: Kind,
}

/// What it means where all three components are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Zeros {
    /// Air that stands still.
    #[default]
    Air,
    /// A hole: programs for particle images write so where they found no velocity.
    Holes,
}

enum Kind {
    NetCdf(NetCdfFields),
    /// A file for each instant.
    Vti(Vec<PathBuf>),
    Tecplot(TecplotFields),
}

impl FieldFile {
    /// Opens the fields at `path`: a NetCDF file, a file of VTK image data or a folder of such, each an
    /// instant, or Tecplot's text with a zone for each instant. Lengths without a unit are in `lengths`.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read; [`FileError::Content`] names what is missing or wrong:
    /// columns, units, an uneven grid, a time that runs back.
    pub fn open(path: &Path, lengths: Lengths) -> Result<Self, FileError> {
        let extension = |path: &Path| {
            path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase()
        };
        let (grid, times, found, kind) = if path.is_dir() || extension(path) == "vti" {
            let files = vti::files(path)?;
            let (grid, times) = vti::heads(&files)?;
            (grid, times, FoundSetting::default(), Kind::Vti(files))
        } else if ["dat", "tec", "plt"].contains(&extension(path).as_str()) {
            let fields = TecplotFields::open(path, lengths)?;
            let (grid, times) = (fields.grid(), fields.times());
            (grid, times, FoundSetting::default(), Kind::Tecplot(fields))
        } else {
            let (fields, grid, times, found) = NetCdfFields::open(path, lengths)?;
            (grid, times, found, Kind::NetCdf(fields))
        };
        let (path, (times, has_times)) = (path.to_owned(), told_or_numbered(times));
        let zeros = Zeros::default();
        Self { path, grid, times, has_times, found, zeros, n_zeros: 0, kind }.checked()
    }

    /// The same with `zeros` for what it means where all components are zero.
    pub fn with_zeros(self, zeros: Zeros) -> Self {
        Self { zeros, ..self }
    }

    /// Vectors that were zero in what was read so far (–).
    pub fn n_zeros(&self) -> u64 {
        self.n_zeros
    }

    fn checked(self) -> Result<Self, FileError> {
        let refusal =
            |problem: String, fix: &str| Err(FileError::content(WHAT, &self.path, problem, fix));
        if self.times.is_empty() {
            return refusal("it holds no instant".to_owned(), "give a file with one at least");
        }
        if let Some(index) = self.times.iter().position(|time| !time.is_finite()) {
            let problem = format!("the time of instant {index} is {}", self.times[index]);
            return refusal(problem, "correct the times in the file");
        }
        if let Some(index) = self.times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let (before, after) = (self.times[index], self.times[index + 1]);
            let problem = format!(
                "time runs back: instant {} is at {after} s, the one before at {before} s",
                index + 1
            );
            return refusal(problem, "sort the instants by time, or give records one by one");
        }
        Ok(self)
    }

    /// The file or folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The points.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The instants (s), which grow; their numbers where the file tells no times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Whether the file tells the times of its instants.
    pub fn has_times(&self) -> bool {
        self.has_times
    }

    /// What the file tells of what its fields were taken of.
    pub fn found(&self) -> &FoundSetting {
        &self.found
    }

    /// An instant without numbers, to be read into.
    pub fn empty(&self) -> Field {
        Field { grid: self.grid, time: 0.0, velocity: Default::default() }
    }

    /// On return `field` is instant number `index`.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be read, or is of other points than the first.
    pub fn read(&mut self, index: usize, field: &mut Field) -> Result<(), FileError> {
        match &mut self.kind {
            Kind::NetCdf(fields) => fields.read(&self.path, index, &mut field.velocity)?,
            Kind::Vti(files) => vti::read(&files[index], &self.grid, &mut field.velocity)?,
            Kind::Tecplot(fields) => fields.read(index, &mut field.velocity)?,
        }
        (field.grid, field.time) = (self.grid, self.times[index]);
        self.look_for_zeros(&mut field.velocity);
        Ok(())
    }

    /// Velocity u, v, w (m/s) at the `instants`, one after the other, at the points that lie `steps` steps
    /// along the last of x, y, z with more than one point; in the order of the grid.
    ///
    /// # Errors
    /// As [`FieldFile::read`].
    pub fn read_strip(
        &mut self,
        instants: Range<usize>,
        steps: Range<usize>,
    ) -> Result<[Vec<f32>; 3], FileError> {
        let n_points = self.grid.n_points;
        let slowest = (0..3).rev().find(|axis| n_points[*axis] > 1).unwrap_or(0);
        if let Kind::NetCdf(fields) = &self.kind {
            let mut strip = fields.read_strip(&self.path, instants, (slowest, steps))?;
            self.look_for_zeros(&mut strip);
            return Ok(strip);
        }
        let row = self.grid.len() / n_points[slowest];
        let points = steps.start * row..steps.end * row;
        let mut strip = [const { Vec::new() }; 3];
        let mut field = self.empty();
        for index in instants {
            self.read(index, &mut field)?;
            for (strip, values) in strip.iter_mut().zip(&field.velocity) {
                strip.extend_from_slice(&values[points.clone()]);
            }
        }
        Ok(strip)
    }

    /// Counts velocities that are zero, and takes them off where they are holes.
    fn look_for_zeros(&mut self, velocity: &mut [Vec<f32>; 3]) {
        let [u, v, w] = velocity;
        for ((u, v), w) in u.iter_mut().zip(v).zip(w) {
            if [*u, *v, *w] == [0.0; 3] {
                self.n_zeros += 1;
                if self.zeros == Zeros::Holes {
                    [*u, *v, *w] = [f32::NAN; 3];
                }
            }
        }
    }
}

/// The instants (s), and whether they are told: where one is not, they are numbered.
fn told_or_numbered(times: Vec<Option<f64>>) -> (Vec<f64>, bool) {
    match times.iter().copied().collect::<Option<Vec<f64>>>() {
        Some(told) => (told, true),
        None => ((0..times.len()).map(|index| index as f64).collect(), false),
    }
}

#[cfg(test)]
mod tests;
