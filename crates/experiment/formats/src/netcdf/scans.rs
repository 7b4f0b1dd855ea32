//! Scans of one lidar in one file, which grows while the run goes on.

use super::growing::{Growing, header_of};
use super::{text, unwritable_as};
use crate::FileError;
use basis::keys::{Value, Values};
use basis::scan::{Scan, ScanLayout};
use basis::{HelixFrame, Matrix3, Vector3};
use netcdf_writer::{DimensionId, Error, NcAttrValue, NcFileBuilder, NcWriteOptions};
use std::f64::consts::TAU;
use std::path::Path;

pub(super) const WHAT: &str = "scans of a lidar (NetCDF)";
/// The speed along the lines of sight.
pub(super) const SPEED: &str = "line_of_sight_velocity";
/// When each point was measured.
pub(super) const MEASURED: &str = "measured_at";
/// Places from the rotor's centre.
pub(super) const PLACES: [&str; 3] = ["downwind", "left", "up"];
/// Bytes of the file before its first scan, beside those of its points.
const HEADER_BYTES: u64 = 12 << 10;
/// Bytes of a point before the first scan: line of sight and range.
const POINT_BYTES: u64 = 4 * size_of::<f64>() as u64;

/// What the scans are of.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanSetting {
    /// Name of the case.
    pub case: String,
    /// Name of the run.
    pub run: String,
    /// Name of the turbine.
    pub turbine: String,
    /// Name of the lidar among the turbine's sensors.
    pub sensor: String,
    /// What its keys in the case hold, in the units of the case.
    pub values: Values,
    /// Where its points are looked for.
    pub layout: ScanLayout,
    /// Centre of the undeflected rotor when time begins, farm frame (m).
    pub hub: [f64; 3],
    /// Rotor diameter (m).
    pub rotor_diameter: f64,
    /// The frame of the helix that the turbine pitches; none where it pitches none.
    pub helix: Option<HelixFrame>,
    /// Mean speed at hub height of the first turbine that the case sets (m/s).
    pub wind_speed: f64,
}

/// A scan at the instant at which it was seen.
#[derive(Clone, Copy, Debug)]
pub struct ScanInstant<'a> {
    /// The instant, since the start of the run (s).
    pub time: f64,
    /// Azimuth of blade 1 (rad).
    pub azimuth: f64,
    /// Centre of the undeflected rotor, farm frame (m).
    pub origin: Vector3,
    /// Level axes that turn with the nacelle: downwind, left, up.
    pub axes: Matrix3,
    /// The scan.
    pub scan: Scan<'a>,
}

/// Writes scans as they come, one file for all of a lidar.
#[derive(Debug)]
pub struct ScanWriter {
    file: Growing,
    /// One scan as it is written.
    bytes: Vec<u8>,
    helix: Option<HelixFrame>,
    n_points: usize,
}

impl ScanWriter {
    /// Starts the file that will stand at `path`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, setting: &ScanSetting) -> Result<Self, FileError> {
        Ok(Self::new(Growing::create(path, WHAT, &header(path, setting)?)?, setting))
    }

    /// Goes on with the file after its first `n_scans`; what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it does not hold as many.
    pub fn resume(path: &Path, setting: &ScanSetting, n_scans: u64) -> Result<Self, FileError> {
        let (header, of_scan) = (header(path, setting)?, record_bytes(setting));
        Ok(Self::new(Growing::resume(path, WHAT, &header, of_scan, n_scans)?, setting))
    }

    fn new(file: Growing, setting: &ScanSetting) -> Self {
        let bytes = Vec::with_capacity(record_bytes(setting) as usize);
        Self { file, bytes, helix: setting.helix, n_points: setting.layout.ranges.len() }
    }

    /// Adds a scan; allocates nothing.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// When it has other points than those that the file was started with.
    pub fn write(&mut self, instant: &ScanInstant) -> Result<(), FileError> {
        let ScanInstant { time, azimuth, origin, axes, scan } = *instant;
        assert_eq!(scan.n_points(), self.n_points, "scans of one file are of one size");
        let bytes = &mut self.bytes;
        bytes.clear();
        bytes.extend(time.to_be_bytes());
        bytes.extend(azimuth.to_be_bytes());
        bytes.extend(self.helix.map(|helix| phase(&helix, time).to_be_bytes()).iter().flatten());
        bytes.extend(scan.times().iter().flat_map(|time| time.to_be_bytes()));
        for values in [scan.speeds(), scan.downwind(), scan.left(), scan.up()] {
            bytes.extend(values.iter().flat_map(|value| (*value as f32).to_be_bytes()));
        }
        for axis in 0..3 {
            let places = scan.downwind().iter().zip(scan.left()).zip(scan.up());
            let in_farm = places.map(|((x, y), z)| origin + axes * Vector3::new(*x, *y, *z));
            bytes.extend(in_farm.flat_map(|place| (place[axis] as f32).to_be_bytes()));
        }
        let quality = scan.speeds().iter().zip(scan.times()).map(|(speed, time)| {
            let is_lost = !speed.is_finite();
            u8::from(is_lost) + u8::from(is_lost && !time.is_finite())
        });
        bytes.extend(quality);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        self.file.write(bytes)
    }

    /// Puts all scans on the disk; gives their number, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        self.file.flush()
    }

    /// Completes the file under its name; without a scan there is none. Nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.file.finish()
    }
}

/// The most bytes of a file of scans of `n_points`: those before its first scan, and those of a scan.
pub fn scan_bytes(n_points: u64) -> [u64; 2] {
    [
        HEADER_BYTES + POINT_BYTES * n_points,
        3 * 8 + (n_points * (8 + 7 * 4 + 1)).next_multiple_of(4),
    ]
}

/// Phase of the frame of a `helix` at `time` (s): its angle wrapped to a turn (rad).
fn phase(helix: &HelixFrame, time: f64) -> f64 {
    (helix.rate * time).rem_euclid(TAU)
}

/// Bytes of a scan in the file.
fn record_bytes(setting: &ScanSetting) -> u64 {
    let [_, most] = scan_bytes(setting.layout.ranges.len() as u64);
    most - if setting.helix.is_none() { size_of::<f64>() as u64 } else { 0 }
}

/// All of the file before its first scan.
fn header(path: &Path, setting: &ScanSetting) -> Result<Vec<u8>, FileError> {
    let bytes = encode(setting).map_err(|error| unwritable_as(WHAT, path, error))?;
    Ok(header_of(bytes, record_bytes(setting)))
}

/// The bytes of a file with one scan that holds zeros.
fn encode(setting: &ScanSetting) -> Result<Vec<u8>, Error> {
    let mut file = NcFileBuilder::new();
    add_attributes(&mut file, setting)?;
    let point = file.add_dimension("point", setting.layout.ranges.len() as u64)?;
    let time = file.add_unlimited_dimension("time")?;
    add_lines_of_sight(&mut file, &setting.layout, point)?;
    add_instants(&mut file, setting, time)?;
    add_points(&mut file, setting.layout.ranges.len(), [time, point])?;
    // Nobody knows how far it grows.
    Ok(file.to_vec(NcWriteOptions::offset64())?.1)
}

fn add_attributes(file: &mut NcFileBuilder, setting: &ScanSetting) -> Result<(), Error> {
    let ScanSetting { case, run, turbine, sensor, values, layout, helix, .. } = setting;
    let title = format!("scans of {sensor} on {turbine}: wind speed along lines of sight");
    let words = [
        ("Conventions", "CF-1.8"),
        ("title", &title),
        ("source", concat!("wakemix ", env!("CARGO_PKG_VERSION"))),
        ("case", case),
        ("run", run),
        ("turbine", turbine),
        ("sensor", sensor),
        (
            "comment",
            "downwind, left, up: from the centre of the undeflected rotor, level axes that turn with the nacelle, left looking downwind; x, y, z: farm frame, x downwind, y to the left, z upward from the ground; a point without a speed is not a number, quality says why",
        ),
    ];
    for (name, word) in words {
        file.add_attribute(name, text(word))?;
    }
    let mut number = |name: &str, values: &[f64]| {
        file.add_attribute(name, NcAttrValue::Doubles(values.to_vec()))
    };
    number("hub_m", &setting.hub)?;
    number("rotor_diameter_m", &[setting.rotor_diameter])?;
    number("wind_speed_m_s", &[setting.wind_speed])?;
    number("measuring_rate_hz", &[layout.rate])?;
    number("n_ranges", &[layout.n_ranges as f64])?;
    if let Some(helix) = helix {
        number("helix_rate_rad_s", &[helix.rate])?;
        file.add_attribute("helix_sense", text(&helix.sense.to_string()))?;
    }
    for (key, value) in values.iter() {
        let value = match value {
            Value::Number(number) => NcAttrValue::Doubles(vec![*number]),
            Value::Whole(number) => NcAttrValue::Doubles(vec![*number as f64]),
            Value::Numbers(numbers) if !numbers.is_empty() => NcAttrValue::Doubles(numbers.clone()),
            Value::Text(word) if !word.is_empty() => text(word),
            _ => continue,
        };
        file.add_attribute(format!("lidar_{key}"), value)?;
    }
    Ok(())
}

/// Adds what of the points does not change.
fn add_lines_of_sight(
    file: &mut NcFileBuilder,
    layout: &ScanLayout,
    point: DimensionId,
) -> Result<(), Error> {
    let component = |axis: usize| layout.directions.iter().map(move |d| d[axis]).collect();
    let described: [(&str, &str, &str, Vec<f64>); 4] = [
        ("range", "m", "distance from the lidar along the line of sight", layout.ranges.clone()),
        (
            "beam_downwind",
            "1",
            "line of sight in the axes of what the lidar rides on: downwind",
            component(0),
        ),
        ("beam_left", "1", "the same, to the left looking downwind", component(1)),
        ("beam_up", "1", "the same, upward", component(2)),
    ];
    for (name, unit, long_name, values) in described {
        let variable = file.add_variable::<f64>(name, &[point])?;
        file.add_variable_attribute(variable, "units", text(unit))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        file.write_variable(variable, &values)?;
    }
    Ok(())
}

/// Adds what a scan has one value of, in the order in which [`ScanWriter::write`] has them.
fn add_instants(
    file: &mut NcFileBuilder,
    setting: &ScanSetting,
    time: DimensionId,
) -> Result<(), Error> {
    let phase =
        "phase of the frame that turns with the helix: its rate times the time, wrapped to a turn";
    let described = [
        ("time", "s", "time since the start of the run at which the controller saw the scan"),
        ("azimuth", "rad", "azimuth of blade 1, clockwise looking downwind, 0 is up"),
        ("helix_phase", "rad", phase),
    ];
    let n_there = if setting.helix.is_some() { 3 } else { 2 };
    for (name, unit, long_name) in &described[..n_there] {
        let variable = file.add_variable::<f64>(*name, &[time])?;
        file.add_variable_attribute(variable, "units", text(unit))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        if *name == "time" {
            file.add_variable_attribute(variable, "axis", text("T"))?;
        }
        file.write_variable(variable, &[0.0])?;
    }
    Ok(())
}

/// Adds what a scan has one value of at each of `n` points, in the order of [`ScanWriter::write`].
fn add_points(file: &mut NcFileBuilder, n: usize, over: [DimensionId; 2]) -> Result<(), Error> {
    let measured = file.add_variable::<f64>(MEASURED, &over)?;
    file.add_variable_attribute(measured, "units", text("s"))?;
    let long_name = "time since the start of the run at which the point was measured last";
    file.add_variable_attribute(measured, "long_name", text(long_name))?;
    file.write_variable(measured, &vec![0.0; n])?;
    let described = [
        (SPEED, "m s-1", "wind speed along the line of sight, away from the lidar"),
        (PLACES[0], "m", "place of the point downwind of the rotor's centre"),
        (PLACES[1], "m", "place of the point to the left of the rotor's centre, looking downwind"),
        (PLACES[2], "m", "place of the point above the rotor's centre"),
        ("x", "m", "place of the point downwind of the first turbine"),
        ("y", "m", "place of the point to the left of the first turbine, looking downwind"),
        ("z", "m", "height of the point above the ground"),
    ];
    for (name, unit, long_name) in described {
        let variable = file.add_variable::<f32>(name, &over)?;
        file.add_variable_attribute(variable, "units", text(unit))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        if name == SPEED {
            let standard = "radial_velocity_of_scatterers_away_from_instrument";
            file.add_variable_attribute(variable, "standard_name", text(standard))?;
            file.set_variable_fill_value(variable, f32::NAN)?;
            let coordinates = "measured_at range downwind left up x y z";
            file.add_variable_attribute(variable, "coordinates", text(coordinates))?;
            file.add_variable_attribute(variable, "ancillary_variables", text("quality"))?;
        }
        file.write_variable(variable, &vec![0.0_f32; n])?;
    }
    let quality = file.add_variable::<i8>("quality", &over)?;
    file.add_variable_attribute(quality, "standard_name", text("quality_flag"))?;
    let long_name = "whether the point has a speed, its beam was lost, or it was not measured yet";
    file.add_variable_attribute(quality, "long_name", text(long_name))?;
    file.add_variable_attribute(quality, "flag_values", NcAttrValue::Bytes(vec![0, 1, 2]))?;
    file.add_variable_attribute(quality, "flag_meanings", text("valid lost not_measured"))?;
    file.write_variable(quality, &vec![0_i8; n])
}

#[cfg(test)]
mod tests;
