//! Velocity on regular grids at instants, whoever wrote it: NetCDF, VTK image data, Tecplot's text.
//!
//! What is asked for is in memory: an instant, or some points at many. Lengths come in metres, velocities in
//! metres a second, whatever the units of the file; what is missing in it is not a number.

mod layout;
mod netcdf;
mod numbers;
mod placed;
mod tags;
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
use vti::VtiFields;

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
    Vti(VtiFields),
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
            let (fields, times) = VtiFields::open(path)?;
            (fields.grid(), times, FoundSetting::default(), Kind::Vti(fields))
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
        (field.grid, field.time) = (self.grid, self.times[index]);
        self.read_points(index..index + 1, 0..self.grid.len(), &mut field.velocity)
    }

    /// On return `velocity` is u, v, w (m/s) at `instants`, one after the other, at `points`, by their number
    /// in the grid. Of a file in which numbers lie at known places no other is read, and nothing is allocated
    /// where there is room; text is read whole each time.
    ///
    /// # Errors
    /// As [`FieldFile::read`].
    pub fn read_points(
        &mut self,
        instants: Range<usize>,
        points: Range<usize>,
        velocity: &mut [Vec<f32>; 3],
    ) -> Result<(), FileError> {
        let n_values = instants.len() * points.len();
        velocity.iter_mut().for_each(|values| values.resize(n_values, 0.0));
        for (step, instant) in instants.enumerate() {
            let places = step * points.len()..(step + 1) * points.len();
            let own = velocity.each_mut().map(|values| &mut values[places.clone()]);
            match &mut self.kind {
                Kind::NetCdf(fields) => fields.read(&self.path, instant, &points, own)?,
                Kind::Vti(fields) => fields.read(instant, &points, own)?,
                Kind::Tecplot(fields) => fields.read(instant, &points, own)?,
            }
        }
        self.look_for_zeros(velocity);
        Ok(())
    }

    /// Whether some points can be read without the others: not those of text.
    pub fn reads_in_places(&self) -> bool {
        match &self.kind {
            Kind::NetCdf(_) => true,
            Kind::Vti(fields) => fields.reads_in_places(),
            Kind::Tecplot(_) => false,
        }
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
        let row = self.grid.len() / n_points[slowest];
        let mut strip = [const { Vec::new() }; 3];
        self.read_points(instants, steps.start * row..steps.end * row, &mut strip)?;
        Ok(strip)
    }

    /// Counts velocities that are zero, and takes them off where they are holes.
    fn look_for_zeros(&mut self, velocity: &mut [Vec<f32>; 3]) {
        let [u, v, w] = velocity;
        let is_zero = |u: f32, v: f32, w: f32| (u == 0.0) & (v == 0.0) & (w == 0.0);
        let each = u.iter().zip(v.iter()).zip(w.iter());
        let n_zeros: u64 = each.map(|((u, v), w)| u64::from(is_zero(*u, *v, *w))).sum();
        self.n_zeros += n_zeros;
        if n_zeros == 0 || self.zeros == Zeros::Air {
            return;
        }
        for ((u, v), w) in u.iter_mut().zip(v).zip(w) {
            if is_zero(*u, *v, *w) {
                [*u, *v, *w] = [f32::NAN; 3];
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
