//! TurbSim's binary full field (`.bts`).
//!
//! Time steps in order of arrival; in each, rows of z upwards, in each, y from the right to the left looking
//! downwind (TurbSim's own y, which like ours points left), in each, u, v, w as 16-bit integers: (integer −
//! intercept) / slope in m/s, the mean wind included. Source: TurbSim user's guide 2.00, appendix D; the
//! order of y was checked against the standard deviations by point in a summary file of TurbSim 2.

use super::packed::{PackedPlanes, Packing};
use super::source::{Outline, Source, each_plane, whole};
use super::{FASTEST, StoredBox, in_order_of_arrival};
use crate::FileError;
use crate::atomic::{self, AtomicFile};
use flow::inflow::{PlaneGrid, Planes};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

const WHAT: &str = "a TurbSim full field";
/// Identifier of a record that does not repeat.
const ONCE: i16 = 7;
/// Identifier of a record that repeats in time.
const PERIODIC: i16 = 8;
/// Bytes in front of the description.
const FIXED_HEADER: usize = 2 + 4 * 4 + 12 * 4 + 4;
/// Integers per m/s at most: a record that hardly changes has many.
const STEEPEST: f32 = 1e12;
/// Characters that TurbSim reserves for the description.
const LONGEST_DESCRIPTION: usize = 200;

struct Header {
    periodic: bool,
    n_z: usize,
    n_y: usize,
    n_tower: usize,
    n_steps: usize,
    spacing_z: f64,
    spacing_y: f64,
    interval: f64,
    hub_speed: f64,
    hub_height: f64,
    lowest_height: f64,
    slopes: [f32; 3],
    intercepts: [f32; 3],
    description_length: usize,
}

/// Reads the full field at `path`.
///
/// Planes stand U Δt apart, with U the hub speed of the file. The mean of u over time and width at each
/// height goes to [`StoredBox::mean_speeds`], so that the fluctuations have none; v and w keep theirs. Tower
/// points below the grid are passed over.
///
/// # Errors
/// [`FileError`] names file, place and fix.
pub fn read(path: &Path) -> Result<StoredBox, FileError> {
    whole(path, &mut stream(path)?)
}

/// The full field at `path` as a box, read plane by plane.
///
/// # Errors
/// As [`read`].
pub(super) fn stream(path: &Path) -> Result<impl Source + use<>, FileError> {
    let (planes, header, mut description) = start(path)?;
    if !header.periodic {
        description.push_str(" (does not repeat: its end meets its beginning with a jump)");
    }
    planes.into_source(header.hub_height, description)
}

/// Planes of the full field at `path`, read one at a time; the middle of its width stands at y = 0.
///
/// # Errors
/// As [`read`].
pub fn open(path: &Path) -> Result<impl Planes + use<>, FileError> {
    start(path).map(|(planes, ..)| planes)
}

/// Hub height of the full field at `path` (m).
///
/// # Errors
/// As [`read`].
pub(super) fn hub_height(path: &Path) -> Result<f64, FileError> {
    start(path).map(|(_, header, _)| header.hub_height)
}

/// Where the full field at `path` says that it comes from.
///
/// # Errors
/// As [`read`].
pub(super) fn description(path: &Path) -> Result<String, FileError> {
    start(path).map(|(_, _, description)| description)
}

fn start(path: &Path) -> Result<(PackedPlanes, Header, String), FileError> {
    let refused = |source| FileError::system("read", WHAT, path, source);
    let mut file = atomic::open(path).map_err(refused)?;
    let found = file.metadata().map_err(refused)?.len();
    let header = read_header(path, &mut file, found)?;
    let mut description = vec![0; header.description_length];
    file.read_exact(&mut description).map_err(refused)?;
    let description = String::from_utf8_lossy(&description).trim().to_owned();
    let n_points = header.n_y * header.n_z;
    let packing = Packing {
        grid: PlaneGrid {
            n_y: header.n_y,
            n_z: header.n_z,
            spacing: [header.spacing_y, header.spacing_z],
            first: [-0.5 * (header.n_y - 1) as f64 * header.spacing_y, header.lowest_height],
            interval: header.interval,
            speed: header.hub_speed,
            n_steps: header.n_steps,
            repeats: header.periodic,
        },
        start: (FIXED_HEADER + header.description_length) as u64,
        bytes_per_step: 6 * (n_points + header.n_tower),
        offsets: [0, 1, 2].map(|component| {
            -f64::from(header.intercepts[component]) / f64::from(header.slopes[component])
        }),
        scales: header.slopes.map(|slope| 1.0 / f64::from(slope)),
        from_left: false,
    };
    super::sound(path, WHAT, &packing.grid, header.hub_height)?;
    Ok((PackedPlanes::new(file, path, WHAT, packing), header, description))
}

/// Writes the box of `source` to `path`: interval = spacing along x over hub speed.
///
/// Values are rounded to 1/65535 of their range, a few 1e-5 of it, for which all planes are read twice; the
/// description to 200 characters of ASCII.
///
/// # Errors
/// [`FileError`]; the file appears whole or not at all.
pub fn write(path: &Path, source: &mut dyn Source) -> Result<(), FileError> {
    let outline = source.outline();
    let ranges = ranges(&outline, source)?;
    let [n_x, n_y, n_z] = outline.n_points;
    let [spacing_x, spacing_y, spacing_z] = outline.spacing;
    let grid = PlaneGrid {
        n_y,
        n_z,
        spacing: [spacing_y, spacing_z],
        first: [-0.5 * (n_y - 1) as f64 * spacing_y, outline.lowest_height],
        interval: spacing_x / outline.hub_speed,
        speed: outline.hub_speed,
        n_steps: n_x,
        repeats: outline.repeats,
    };
    let mut field = Field::create(path, &grid, outline.hub_height, ranges, &outline.description)?;
    for step in 0..n_x {
        let plane = source.plane(in_order_of_arrival(step, n_x))?;
        let wind = |point: usize| {
            [0, 1, 2].map(|component| outline.wind(component, point, plane[component][point]))
        };
        field.add((0..n_y * n_z).map(wind))?;
    }
    field.commit()
}

/// A full field that is written plane by plane.
pub(super) struct Field {
    file: AtomicFile,
    path: PathBuf,
    scales: [(f32, f32); 3],
    bytes: Vec<u8>,
}

impl Field {
    /// Begins the field that will stand at `path`, of planes as `grid` has them whose components lie within
    /// `ranges` (m/s).
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn create(
        path: &Path,
        grid: &PlaneGrid,
        hub_height: f64,
        ranges: [[f64; 2]; 3],
        description: &str,
    ) -> Result<Self, FileError> {
        let scales = ranges.map(scale);
        let description: String = description
            .chars()
            .filter(|character| character.is_ascii() && !character.is_ascii_control())
            .take(LONGEST_DESCRIPTION)
            .collect();
        let mut file = AtomicFile::create(path, WHAT)?;
        let identifier = if grid.repeats { PERIODIC } else { ONCE };
        let mut bytes = identifier.to_le_bytes().to_vec();
        for count in [grid.n_z, grid.n_y, 0, grid.n_steps] {
            let count = i32::try_from(count).map_err(|_| {
                FileError::content(
                    WHAT,
                    path,
                    format!("{count} points are more than the format counts"),
                    "make the box shorter",
                )
            })?;
            bytes.extend_from_slice(&count.to_le_bytes());
        }
        let [spacing_y, spacing_z] = grid.spacing;
        for value in [spacing_z, spacing_y, grid.interval, grid.speed, hub_height, grid.first[1]] {
            bytes.extend_from_slice(&(value as f32).to_le_bytes());
        }
        for (slope, intercept) in scales {
            bytes.extend_from_slice(&slope.to_le_bytes());
            bytes.extend_from_slice(&intercept.to_le_bytes());
        }
        bytes.extend_from_slice(&(description.len() as i32).to_le_bytes());
        bytes.extend_from_slice(description.as_bytes());
        let refused = |source| FileError::system("write", WHAT, path, source);
        file.write_all(&bytes).map_err(refused)?;
        Ok(Self { file, path: path.to_owned(), scales, bytes })
    }

    /// Adds a plane of wind (m/s), single precision.
    pub(super) fn write(&mut self, wind: &[[f32; 3]]) -> Result<(), FileError> {
        self.add(wind.iter().map(|wind| wind.map(f64::from)))
    }

    /// Adds a plane of wind (m/s).
    fn add(&mut self, wind: impl Iterator<Item = [f64; 3]>) -> Result<(), FileError> {
        self.bytes.clear();
        for point in wind {
            for (value, (slope, intercept)) in point.into_iter().zip(self.scales) {
                let scaled = f64::from(slope) * value + f64::from(intercept);
                // Rounding of slope and intercept may reach beyond the last integer by a hair.
                let integer = scaled.round().clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16;
                self.bytes.extend_from_slice(&integer.to_le_bytes());
            }
        }
        let refused = |source| FileError::system("write", WHAT, &self.path, source);
        self.file.write_all(&self.bytes).map_err(refused)
    }

    /// On return the file is there, whole.
    pub(super) fn commit(self) -> Result<(), FileError> {
        self.file.commit()
    }
}

/// Least and most of u, v, w (m/s), the mean included, in the box of `source`, which is as `outline` says.
fn ranges(outline: &Outline, source: &mut dyn Source) -> Result<[[f64; 2]; 3], FileError> {
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    each_plane(source, |plane| {
        for (component, (range, values)) in ranges.iter_mut().zip(plane).enumerate() {
            for (point, value) in values.iter().enumerate() {
                let wind = outline.wind(component, point, *value);
                *range = [range[0].min(wind), range[1].max(wind)];
            }
        }
    })?;
    Ok(ranges)
}

/// Slope and intercept that spread the range from `least` to `most` (m/s) over all integers.
fn scale([least, most]: [f64; 2]) -> (f32, f32) {
    let range = if most - least > 1e-6 { most - least } else { 1.0 };
    let slope = (f64::from(u16::MAX) / range) as f32;
    (slope, (f64::from(i16::MIN) - f64::from(slope) * least) as f32)
}

/// What is wrong with a file, and how to fix it.
type Wrong = (String, &'static str);

const COPY_AGAIN: &str = "copy the file again or run TurbSim again";

fn read_header(path: &Path, file: &mut impl Read, found: u64) -> Result<Header, FileError> {
    let wrong = |(problem, fix): Wrong| FileError::content(WHAT, path, problem, fix);
    if found < FIXED_HEADER as u64 {
        let problem = format!("it ends after {found} bytes, within the header of {FIXED_HEADER}");
        return Err(wrong((problem, COPY_AGAIN)));
    }
    let mut bytes = [0; FIXED_HEADER];
    file.read_exact(&mut bytes).map_err(|source| FileError::system("read", WHAT, path, source))?;
    let header = header_of(&bytes).map_err(wrong)?;
    check_length(&header, found).map_err(wrong)?;
    Ok(header)
}

fn header_of(bytes: &[u8; FIXED_HEADER]) -> Result<Header, Wrong> {
    let number =
        |index: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[18 + 4 * index + byte]));
    let periodic = is_periodic(i16::from_le_bytes([bytes[0], bytes[1]]))?;
    let [n_z, n_y, n_tower, n_steps, description_length] = counts_of(bytes)?;
    let names = ["spacing along z", "spacing along y", "time step", "hub speed", "hub height"];
    for (index, name) in names.into_iter().enumerate() {
        let value = number(index);
        if !(value.is_finite() && value > 0.0) {
            let problem = format!("byte {}: the {name} is {value}", 18 + 4 * index);
            return Err((problem, "run TurbSim again"));
        }
    }
    let slopes = [number(6), number(8), number(10)];
    let intercepts = [number(7), number(9), number(11)];
    check_scales(slopes, intercepts)?;
    Ok(Header {
        periodic,
        n_z,
        n_y,
        n_tower,
        n_steps,
        spacing_z: f64::from(number(0)),
        spacing_y: f64::from(number(1)),
        interval: f64::from(number(2)),
        hub_speed: f64::from(number(3)),
        hub_height: f64::from(number(4)),
        lowest_height: f64::from(number(5)),
        slopes,
        intercepts,
        description_length,
    })
}

fn is_periodic(identifier: i16) -> Result<bool, Wrong> {
    let swapped = identifier.swap_bytes();
    match identifier {
        PERIODIC => Ok(true),
        ONCE => Ok(false),
        _ if [ONCE, PERIODIC].contains(&swapped) => Err((
            format!(
                "byte 0: the identifier is {swapped} with its bytes swapped: the byte order is big-endian"
            ),
            "write the file in little-endian order",
        )),
        _ => Err((
            format!("byte 0: the identifier is {identifier}, not {ONCE} or {PERIODIC}"),
            "give a .bts file of TurbSim (WrADFF = True)",
        )),
    }
}

/// Points along z and y, points of the tower, steps, characters of description.
fn counts_of(bytes: &[u8; FIXED_HEADER]) -> Result<[usize; 5], Wrong> {
    let places = [2, 6, 10, 14, FIXED_HEADER - 4];
    let counts =
        places.map(|place| i32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place + byte])));
    let named = [
        ("points along z", 1),
        ("points along y", 1),
        ("tower points", 0),
        ("time steps", 1),
        ("characters of description", 0),
    ];
    for (value, (name, least)) in counts.into_iter().zip(named) {
        if value < least {
            return Err((format!("the header counts {value} {name}"), COPY_AGAIN));
        }
    }
    Ok(counts.map(|value| value as usize))
}

fn check_scales(slopes: [f32; 3], intercepts: [f32; 3]) -> Result<(), Wrong> {
    for (component, (slope, intercept)) in
        ["u", "v", "w"].iter().zip(slopes.into_iter().zip(intercepts))
    {
        let ends = [i16::MIN, i16::MAX].map(|end| (f32::from(end) - intercept) / slope);
        let is_slope = slope > 0.0 && slope <= STEEPEST;
        if !is_slope || !ends.iter().all(|end| end.abs() <= FASTEST) {
            let problem = format!(
                "slope {slope} and intercept {intercept} of {component} give winds of {} to {} m/s",
                ends[0], ends[1]
            );
            return Err((problem, "run TurbSim again"));
        }
    }
    Ok(())
}

/// Whether a file of `found` bytes holds what `header` counts.
fn check_length(header: &Header, found: u64) -> Result<(), Wrong> {
    let Header { n_z, n_y, n_tower, n_steps, description_length, .. } = *header;
    let per_step = 6 * (n_y as u128 * n_z as u128 + n_tower as u128);
    let start = (FIXED_HEADER + description_length) as u128;
    let needed = start + per_step * n_steps as u128;
    if u128::from(found) == needed {
        return Ok(());
    }
    let how = if u128::from(found) < needed {
        let step = u128::from(found).saturating_sub(start) / per_step + 1;
        format!("it ends within step {step} of {n_steps}")
    } else {
        "it goes on behind the last step".to_owned()
    };
    let problem = format!(
        "{found} bytes instead of {needed} for {n_steps} steps of {n_y} × {n_z} points: {how}"
    );
    Err((problem, COPY_AGAIN))
}
