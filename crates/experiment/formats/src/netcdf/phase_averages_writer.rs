//! Averages by phase written to one file, without holding all of it: bin by bin, or some points at a time.

use super::grid::add_grid;
use super::phase_averages::{BIN_BYTES, POINT_BYTES, PRESSURE, SAMPLES, STRESS_NAMES, WHAT};
use super::{COMPONENTS, text, unwritable_as};
use crate::FileError;
use crate::atomic::AtomicFile;
use basis::records::{FieldSetting, Moments, PhaseAverages, PhaseBin, STRESSES};
use netcdf_writer::{DimensionId, Error, NcAttrValue, NcFileBuilder, NcWriteOptions, NcWriteType};
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Where the number of records stands in the file.
const PLACE_OF_NUMBER: usize = 4;

/// Writes averages by phase in `setting` to `path`: `head`, whose own bins are not looked at, and what `bin`
/// gives of each. In memory there is one bin at a time.
///
/// # Errors
/// [`FileError::System`].
///
/// # Panics
/// Where a bin has other points than the grid of `head`.
pub fn write_phase_averages(
    path: &Path,
    setting: &FieldSetting,
    head: &PhaseAverages,
    bin: impl FnMut(usize) -> Moments,
) -> Result<(), FileError> {
    let mut writer = PhaseAveragesWriter::create(path, setting, head)?;
    writer.write(0..head.grid.len(), &head.all, bin)?;
    writer.commit()
}

/// Averages by phase that are written some points at a time, all bins of them together.
pub struct PhaseAveragesWriter {
    file: AtomicFile,
    path: PathBuf,
    n_points: usize,
    n_bins: usize,
    /// Where the moments of all instants, and where the first bin begins (byte).
    begin: [u64; 2],
    /// One variable at some points as it is written.
    bytes: Vec<u8>,
}

impl PhaseAveragesWriter {
    /// Starts the file that will stand at `path`, of averages in `setting` of which `head` tells all but
    /// moments: those in it are not looked at.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(
        path: &Path,
        setting: &FieldSetting,
        head: &PhaseAverages,
    ) -> Result<Self, FileError> {
        let n_points = head.grid.len();
        let header = encode(setting, head).map_err(|error| unwritable_as(WHAT, path, error))?;
        let end = header.len() as u64;
        let begin = [end - (n_points * POINT_BYTES) as u64, end];
        let file = AtomicFile::create(path, WHAT)?;
        let n_bins = head.bins.len();
        let path = path.to_owned();
        let mut own = Self { file, path, n_points, n_bins, begin, bytes: Vec::new() };
        own.begun(&header, &head.bins).map_err(|error| own.refused(error))?;
        Ok(own)
    }

    /// Writes the `header`, and of each of `bins` what it has beside its points.
    fn begun(&mut self, header: &[u8], bins: &[PhaseBin]) -> io::Result<()> {
        let n_bins = u32::try_from(bins.len()).unwrap_or(u32::MAX);
        self.file.write_all(&header[..PLACE_OF_NUMBER])?;
        self.file.write_all(&n_bins.to_be_bytes())?;
        self.file.write_all(&header[PLACE_OF_NUMBER + 4..self.begin[0] as usize])?;
        for (index, bin) in bins.iter().enumerate() {
            self.file.seek(SeekFrom::Start(self.place_of_bin(index)))?;
            self.file.write_all(&bin.rotor.to_be_bytes())?;
            self.file.write_all(&bin.helix.unwrap_or(f64::NAN).to_be_bytes())?;
            for count in [bin.n_instants, bin.n_visits] {
                self.file.write_all(&i32::try_from(count).unwrap_or(i32::MAX).to_be_bytes())?;
            }
        }
        Ok(())
    }

    fn place_of_bin(&self, index: usize) -> u64 {
        self.begin[1] + index as u64 * (BIN_BYTES + self.n_points * POINT_BYTES) as u64
    }

    /// Writes the moments at `points`, by their number in the grid: of `all` instants, and those that `bin`
    /// gives of each bin.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// Where moments are of other points.
    pub fn write(
        &mut self,
        points: Range<usize>,
        all: &Moments,
        mut bin: impl FnMut(usize) -> Moments,
    ) -> Result<(), FileError> {
        self.write_moments(self.begin[0], &points, all).map_err(|error| self.refused(error))?;
        for index in 0..self.n_bins {
            let place = self.place_of_bin(index) + BIN_BYTES as u64;
            let moments = bin(index);
            let written = self.write_moments(place, &points, &moments);
            written.map_err(|error| self.refused(error))?;
        }
        Ok(())
    }

    /// Writes `moments` at `points`, in the order in which [`encode`] names the variables, which begin at
    /// `place`.
    fn write_moments(
        &mut self,
        place: u64,
        points: &Range<usize>,
        moments: &Moments,
    ) -> io::Result<()> {
        let n_samples: Vec<i32> = moments.n_samples.iter().copied().map(signed).collect();
        self.write_values(place, (0, points), &n_samples, i32::to_be_bytes)?;
        for (variable, values) in moments.mean.iter().chain(&moments.stress).enumerate() {
            self.write_values(place, (variable + 1, points), values, f32::to_be_bytes)?;
        }
        Ok(())
    }

    /// Writes `values` of a variable, by its number, at points.
    fn write_values<T: Copy>(
        &mut self,
        place: u64,
        (variable, points): (usize, &Range<usize>),
        values: &[T],
        bytes: impl Fn(T) -> [u8; 4],
    ) -> io::Result<()> {
        assert_eq!(values.len(), points.len(), "moments of the points that are written");
        self.bytes.clear();
        self.bytes.extend(values.iter().flat_map(|value| bytes(*value)));
        let offset = 4 * (variable * self.n_points + points.start);
        self.file.seek(SeekFrom::Start(place + offset as u64))?;
        self.file.write_all(&self.bytes)
    }

    /// Puts the file in its place, once all points are written.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn commit(self) -> Result<(), FileError> {
        self.file.commit()
    }

    fn refused(&self, error: io::Error) -> FileError {
        FileError::system("write", WHAT, &self.path, error)
    }
}

fn signed(count: u32) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// The bytes of a file before its first bin: all but the moments of all instants, which are zero. Those stand
/// at the end.
fn encode(setting: &FieldSetting, head: &PhaseAverages) -> Result<Vec<u8>, Error> {
    let mut file = NcFileBuilder::new();
    file.add_attribute("Conventions", text("CF-1.8"))?;
    file.add_attribute("title", text("wind velocity averaged by phase"))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    file.add_attribute("name", text(&setting.name))?;
    let comment = "x downwind, y to the left looking downwind, z upward; a bin goes half its width to either side of its middle; stresses are means of products of deviations from the means of the same bin; all_ tells of all instants";
    file.add_attribute("comment", text(comment))?;
    let numbers = [
        ("wind_speed_m_s", Some(setting.wind_speed)),
        ("turbulence_intensity", setting.turbulence_intensity),
        ("rotor_diameter_m", Some(setting.diameter)),
        ("rotor_bin_width_rad", Some(head.rotor_width)),
        ("helix_bin_width_rad", head.helix_width),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            file.add_attribute(name, NcAttrValue::Doubles(vec![value]))?;
        }
    }
    file.add_attribute("hub_m", NcAttrValue::Doubles(setting.hub.to_vec()))?;
    file.add_attribute("time_span_s", NcAttrValue::Doubles(head.span.to_vec()))?;
    let [z, y, x] = add_grid(&mut file, &head.grid)?;
    let bin = file.add_unlimited_dimension("bin")?;
    if let Some(pressure) = &head.pressure {
        let meaning = ("m2 s-2", "mean pressure above that of undisturbed air, over density");
        add_one(&mut file, PRESSURE, meaning, &[z, y, x], pressure)?;
    }
    add(&mut file, "all_", &[z, y, x], head.grid.len())?;
    let azimuths = [
        ("rotor_azimuth", "azimuth of blade 1 at the middle of the bin, from the top"),
        (
            "helix_azimuth",
            "angle of the tilting and yawing pitch at the middle of the bin, from yaw",
        ),
    ];
    for (name, long_name) in azimuths {
        add_one(&mut file, name, ("rad", long_name), &[bin], &[] as &[f64])?;
    }
    let counts = [
        ("n_instants", "instants in the bin"),
        ("n_visits", "times that the bin was entered: independent instants at least"),
    ];
    for (name, long_name) in counts {
        add_one(&mut file, name, ("1", long_name), &[bin], &[] as &[i32])?;
    }
    add(&mut file, "", &[bin, z, y, x], 0)?;
    Ok(file.to_vec(NcWriteOptions::offset64())?.1)
}

/// Adds the variables of moments, whose names begin with `prefix`, over `dimensions`: `n_values` zeros each.
fn add(
    file: &mut NcFileBuilder,
    prefix: &str,
    dimensions: &[DimensionId],
    n_values: usize,
) -> Result<(), Error> {
    let meaning = ("1", "samples, of which holes are none");
    add_one(file, &format!("{prefix}{SAMPLES}"), meaning, dimensions, &vec![0_i32; n_values])?;
    let zeros = vec![0.0_f32; n_values];
    for (name, long_name) in COMPONENTS {
        let long_name = format!("mean {long_name}");
        let meaning = ("m s-1", long_name.as_str());
        add_one(file, &format!("{prefix}{name}"), meaning, dimensions, &zeros)?;
    }
    for (name, [a, b]) in STRESS_NAMES.iter().zip(STRESSES) {
        let long_name = format!(
            "mean product of the deviations of {} and {}",
            COMPONENTS[a].1, COMPONENTS[b].1
        );
        let meaning = ("m2 s-2", long_name.as_str());
        add_one(file, &format!("{prefix}{name}"), meaning, dimensions, &zeros)?;
    }
    Ok(())
}

/// Adds the variable `name` with its unit and its meaning.
fn add_one<T: NcWriteType>(
    file: &mut NcFileBuilder,
    name: &str,
    (unit, long_name): (&str, &str),
    dimensions: &[DimensionId],
    values: &[T],
) -> Result<(), Error> {
    let variable = file.add_variable::<T>(name, dimensions)?;
    file.add_variable_attribute(variable, "units", text(unit))?;
    file.add_variable_attribute(variable, "long_name", text(long_name))?;
    file.write_variable(variable, values)
}
