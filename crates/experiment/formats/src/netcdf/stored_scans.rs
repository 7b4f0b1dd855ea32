//! Scans of a lidar out of the file that was written.

use super::read::{lacks, variable};
use super::scans::{MEASURED, PLACES, SPEED, WHAT};
use crate::{FileError, atomic};
use basis::scan::{Scan, ScanBlocks};
use basis::{HelixFrame, Sense};
use netcdf_reader::NcFile;
use std::path::Path;

const FIX: &str = "restore the file, or make the run again";

/// Scans as a file holds them.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredScans {
    /// Name of the run.
    pub run: String,
    /// Name of the turbine.
    pub turbine: String,
    /// Name of the lidar.
    pub sensor: String,
    /// Pattern of its scan, as the case names it; empty where the file does not tell.
    pub pattern: String,
    /// Rotor diameter (m).
    pub rotor_diameter: f64,
    /// The frame of the helix that the turbine pitched; none where it pitched none.
    pub helix: Option<HelixFrame>,
    /// Distances along the lines of sight (m), one for each point.
    pub ranges: Vec<f64>,
    /// Distances on each line (–); points go through all lines at the first, then at the next.
    pub n_ranges: usize,
    /// When the controller saw each scan (s).
    pub times: Vec<f64>,
    /// Azimuth of blade 1 at each scan (rad).
    pub azimuths: Vec<f64>,
    /// When each point of each scan was measured (s), points fastest; not a number where it was not yet.
    measured: Vec<f64>,
    /// Speeds along the lines of sight (m/s), points fastest; not a number where there is none.
    speeds: Vec<f32>,
    /// Places downwind, left and up of the rotor's centre (m), points fastest.
    places: [Vec<f32>; 3],
}

impl StoredScans {
    /// Scans (–).
    pub fn n_scans(&self) -> usize {
        self.times.len()
    }

    /// Points of a scan (–).
    pub fn n_points(&self) -> usize {
        self.ranges.len()
    }

    /// The points at range number `index` of each line of sight.
    pub fn points_at(&self, index: usize) -> std::ops::Range<usize> {
        let n_lines = self.n_points() / self.n_ranges;
        index * n_lines..(index + 1) * n_lines
    }

    /// On return `reading` is what scan number `index` is to a controller, of its `points` alone: what
    /// [`Scan::of`] takes.
    pub fn reading(&self, index: usize, points: std::ops::Range<usize>, reading: &mut Vec<f64>) {
        reading.clear();
        reading.resize(Scan::n_values(points.len()), f64::NAN);
        let Some(scan) = ScanBlocks::of(reading) else { return };
        let first = index * self.n_points();
        let range = first + points.start..first + points.end;
        let widen = |to: &mut [f64], from: &[f32]| {
            for (to, from) in to.iter_mut().zip(&from[range.clone()]) {
                *to = f64::from(*from);
            }
        };
        widen(scan.speeds, &self.speeds);
        for (to, from) in scan.places.into_iter().zip(&self.places) {
            widen(to, from);
        }
        scan.times.copy_from_slice(&self.measured[range]);
        let n_valid = scan.speeds.iter().filter(|speed| speed.is_finite()).count();
        scan.head[0] = (index + 1) as f64;
        scan.head[1] = n_valid as f64 / scan.speeds.len() as f64;
    }
}

/// Reads the scans of a lidar.
///
/// # Errors
/// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else.
pub fn read_scans(path: &Path) -> Result<StoredScans, FileError> {
    let bytes = atomic::read_bytes(path, WHAT)?;
    decode(&bytes).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

pub(super) fn decode(bytes: &[u8]) -> Result<StoredScans, String> {
    let most = bytes.len();
    let file = NcFile::from_bytes(bytes).map_err(|error| error.to_string())?;
    let found = |name: &str| file.global_attribute(name).ok().map(|found| found.value.clone());
    let word = |name: &str| found(name)?.as_string();
    let text = |name: &str| word(name).ok_or_else(|| lacks(name));
    let number = |name: &str| {
        let value = found(name)?.as_f64_vec()?;
        value.first().copied().filter(|value| value.is_finite() && *value > 0.0)
    };
    let needed = |name: &str| number(name).ok_or_else(|| format!("`{name}` is no number above 0"));
    let [ranges, times, azimuths] =
        ["range", "time", "azimuth"].map(|name| variable(&file, name, most));
    let (ranges, times, azimuths) = (ranges?, times?, azimuths?);
    let n_ranges = needed("n_ranges")? as usize;
    if ranges.is_empty() || n_ranges == 0 || !ranges.len().is_multiple_of(n_ranges) {
        return Err(format!("it has {} points at `n_ranges` = {n_ranges}", ranges.len()));
    }
    if times.iter().chain(&azimuths).chain(&ranges).any(|value| !value.is_finite()) {
        return Err("a time, an azimuth or a range is no number".to_owned());
    }
    let n_values = ranges.len().checked_mul(times.len()).filter(|n| *n <= most / size_of::<f32>());
    let n_values = n_values.ok_or("it holds fewer values than it says")?;
    let measured = variable(&file, MEASURED, most)?;
    if measured.len() != n_values || azimuths.len() != times.len() {
        return Err(format!("`azimuth` or `{MEASURED}` is not of the length of `time`"));
    }
    let [downwind, left, up] = PLACES.map(|name| of_points(&file, name, n_values));
    Ok(StoredScans {
        run: text("run")?,
        turbine: text("turbine")?,
        sensor: text("sensor")?,
        pattern: word("lidar_scan").unwrap_or_default(),
        rotor_diameter: needed("rotor_diameter_m")?,
        helix: helix(word("helix_sense"), number("helix_rate_rad_s"))?,
        n_ranges,
        measured,
        speeds: of_points(&file, SPEED, n_values)?,
        places: [downwind?, left?, up?],
        ranges,
        times,
        azimuths,
    })
}

/// The frame of the helix, where the file tells of one.
fn helix(sense: Option<String>, rate: Option<f64>) -> Result<Option<HelixFrame>, String> {
    let Some(word) = sense else { return Ok(None) };
    let senses = [Sense::Clockwise, Sense::CounterClockwise];
    let sense = senses.into_iter().find(|sense| sense.to_string() == word);
    let sense = sense.ok_or_else(|| format!("`helix_sense` = \"{word}\" is unknown"))?;
    let rate = rate.ok_or("`helix_rate_rad_s` is no number above 0")?;
    Ok(Some(HelixFrame { sense, rate }))
}

/// The values of the variable `name`, one for each of `n_values` points of scans.
fn of_points(file: &NcFile, name: &str, n_values: usize) -> Result<Vec<f32>, String> {
    let shape = file.variable(name).map_err(|_| lacks(name))?.shape();
    if shape.iter().try_fold(1_u64, |n, m| n.checked_mul(*m)) != Some(n_values as u64) {
        return Err(format!("`{name}` has the shape {shape:?} for {n_values} values"));
    }
    let mut values = vec![0.0_f32; n_values];
    file.read_variable_into::<f32>(name, &mut values).map_err(|error| error.to_string())?;
    Ok(values)
}
