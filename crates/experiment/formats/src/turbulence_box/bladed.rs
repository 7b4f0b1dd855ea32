//! Bladed's binary full field (`.wnd`).
//!
//! Time steps in order of arrival; in each, rows of z upwards; in each, columns of y; in each, u, v, w as
//! 16-bit integers: thousandths of a standard deviation, u around the mean speed. Little-endian. Two headers
//! are in use: the old one of 16-bit integers, and the one that starts with −99 and a type of turbulence.
//! Only type 4 carries intensities; for others, and for the hub height, the repetition and the way in which
//! columns count, programs look into a summary beside the file (`NAME.sum`), as we do. Without one, columns
//! run from the right to the left looking downwind, v blows to the left, the record repeats and the hub is in
//! the middle of the grid; a file that carries no intensities is refused.
//!
//! Source: TurbSim user's guide 2.00, appendix E; headers as OpenFAST's InflowWind reads them (FlowField_IO).

mod header;

use super::packed::{PackedPlanes, Packing};
use super::source::{Outline, Source, each_plane, whole};
use super::{FASTEST, StoredBox, in_order_of_arrival};
use crate::FileError;
use crate::atomic::{self, AtomicFile};
use flow::inflow::{PlaneGrid, Planes};
use header::{Header, Summary};
use std::io::Write;
use std::path::Path;

const WHAT: &str = "a full field of Bladed";
const SUMMARY: &str = "the summary of a full field of Bladed";
/// Steps of an integer in a standard deviation.
const PER_DEVIATION: f64 = 1000.0;
/// Identifier of the new header, and its type that carries intensities.
const NEW: i16 = -99;
const IMPROVED_VON_KARMAN: i16 = 4;

/// Reads the full field at `path`.
///
/// The mean of u over time and width at each height goes to [`StoredBox::mean_speeds`], so that the
/// fluctuations have none.
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
    let (planes, hub_height) = start(path)?;
    let mut description = "a full field of Bladed".to_owned();
    if !planes.grid().repeats {
        description.push_str(" (does not repeat: its end meets its beginning with a jump)");
    }
    planes.into_source(hub_height, description)
}

/// Planes of the full field at `path`, read one at a time; the middle of its width stands at y = 0.
///
/// # Errors
/// As [`read`].
pub fn open(path: &Path) -> Result<impl Planes + use<>, FileError> {
    start(path).map(|(planes, _)| planes)
}

/// Hub height of the full field at `path` (m).
///
/// # Errors
/// As [`read`].
pub(super) fn hub_height(path: &Path) -> Result<f64, FileError> {
    start(path).map(|(_, hub_height)| hub_height)
}

/// Planes with the hub height (m).
fn start(path: &Path) -> Result<(PackedPlanes, f64), FileError> {
    let refused = |source| FileError::system("read", WHAT, path, source);
    let mut file = atomic::open(path).map_err(refused)?;
    let found = file.metadata().map_err(refused)?.len();
    let header = Header::read(path, &mut file, found)?;
    let summary = Summary::beside(path)?;
    let Some(intensities) = header.intensities.or(summary.intensities) else {
        return Err(FileError::content(
            WHAT,
            path,
            "its type of turbulence carries no intensities, and no summary beside it gives them",
            format!(
                "write {} with the lines `TI(u) = 10.0 %`, `TI(v) = 8.0 %`, `TI(w) = 5.0 %`, `90.0 Hub height [m]`",
                path.with_extension("sum").display()
            ),
        ));
    };
    let half = 0.5 * (header.n_z - 1) as f64 * header.spacing[2];
    let middle = summary
        .hub_height
        .map(|hub_height| hub_height - summary.height_offset)
        .or(header.middle_height)
        .unwrap_or(half);
    let speed = header.mean_speed;
    let scales = intensities.map(|intensity| speed * intensity / 100.0 / PER_DEVIATION);
    // Deviations, of which the integers are thousandths, and the mean are winds too.
    let fastest = scales.iter().map(|scale| scale * PER_DEVIATION).fold(speed, f64::max);
    if fastest > f64::from(FASTEST) {
        let problem = format!("speed {speed} m/s and intensities {intensities:?} % are not a wind");
        return Err(FileError::content(WHAT, path, problem, "make the file again"));
    }
    let packing = Packing {
        grid: PlaneGrid {
            n_y: header.n_y,
            n_z: header.n_z,
            spacing: [header.spacing[1], header.spacing[2]],
            first: [-0.5 * (header.n_y - 1) as f64 * header.spacing[1], middle - half],
            interval: header.spacing[0] / speed,
            speed,
            n_steps: header.n_steps,
            repeats: summary.repeats,
        },
        start: header.start,
        bytes_per_step: 6 * header.n_y * header.n_z,
        offsets: [speed, 0.0, 0.0],
        scales,
        from_left: summary.from_left,
    };
    let hub_height = summary.hub_height.unwrap_or(middle);
    super::sound(path, WHAT, &packing.grid, hub_height)?;
    Ok((PackedPlanes::new(file, path, WHAT, packing), hub_height))
}

/// Writes the box of `source` to `path` with the header of type 4, and `NAME.sum` beside it, which other
/// programs want.
///
/// Values are rounded to a thousandth of the deviation that scales them: that of the component, or a
/// thirtieth of its greatest distance from the mean speed where that is more. For these all planes are read
/// three times.
///
/// # Errors
/// [`FileError`]; each file appears whole or not at all, the summary last.
pub fn write(path: &Path, source: &mut dyn Source) -> Result<(), FileError> {
    let outline = source.outline();
    let n_x = outline.n_points[0];
    let speed = outline.hub_speed;
    let intensities = spreads(&outline, source)?.map(|Spread { deviation, greatest }| {
        (100.0 * deviation.max(greatest / 30.0).max(1e-4 * speed) / speed) as f32
    });
    let per_integer = intensities.map(|ti| f64::from(ti) / 100.0 * speed / PER_DEVIATION);
    let refused = |source| FileError::system("write", WHAT, path, source);
    let mut file = AtomicFile::create(path, WHAT)?;
    let mut bytes = header::bytes(path, &outline, intensities)?;
    file.write_all(&bytes).map_err(refused)?;
    for step in 0..n_x {
        let plane = source.plane(in_order_of_arrival(step, n_x))?;
        bytes.clear();
        let [u, v, w] = plane;
        for (point, ((u, v), w)) in u.iter().zip(v).zip(w).enumerate() {
            for (component, (value, per_integer)) in
                [u, v, w].into_iter().zip(per_integer).enumerate()
            {
                let above = above(&outline, component, point, *value);
                let integer = (above / per_integer).round();
                let integer = integer.clamp(f64::from(i16::MIN), f64::from(i16::MAX)) as i16;
                bytes.extend_from_slice(&integer.to_le_bytes());
            }
        }
        file.write_all(&bytes).map_err(refused)?;
    }
    file.commit()?;
    let summary = header::summary(&outline, intensities);
    atomic::write(&path.with_extension("sum"), SUMMARY, summary.as_bytes())
}

/// How far component 0 to 2 of the wind is above what the integer zero stands for (m/s): the hub speed for u,
/// none for v, w.
fn above(outline: &Outline, component: usize, point: usize, fluctuation: f32) -> f64 {
    let wind = outline.wind(component, point, fluctuation);
    if component == 0 { wind - outline.hub_speed } else { wind }
}

/// How far the values of a component spread.
#[derive(Clone, Copy, Debug)]
struct Spread {
    /// Standard deviation of the fluctuations (m/s): to the last bit that of a box in memory.
    deviation: f64,
    /// Greatest distance from what the integer zero stands for (m/s).
    greatest: f64,
}

/// Those of u, v, w in the box of `source`, which is as `outline` says; its planes are read twice.
fn spreads(outline: &Outline, source: &mut dyn Source) -> Result<[Spread; 3], FileError> {
    let n_values = outline.n_points.iter().product::<usize>() as f64;
    let mut means = [0.0_f64; 3];
    each_plane(source, |plane| {
        for (mean, values) in means.iter_mut().zip(plane) {
            *mean += values.iter().map(|value| f64::from(*value)).sum::<f64>();
        }
    })?;
    means.iter_mut().for_each(|mean| *mean /= n_values);
    let (mut squares, mut greatest) = ([0.0_f64; 3], [0.0_f64; 3]);
    each_plane(source, |plane| {
        for (component, values) in plane.into_iter().enumerate() {
            let square = |value: &f32| (f64::from(*value) - means[component]).powi(2);
            squares[component] += values.iter().map(square).sum::<f64>();
            for (point, value) in values.iter().enumerate() {
                let above = above(outline, component, point, *value);
                greatest[component] = greatest[component].max(above.abs());
            }
        }
    })?;
    Ok(std::array::from_fn(|component| Spread {
        deviation: (squares[component] / n_values).sqrt(),
        greatest: greatest[component],
    }))
}

#[cfg(test)]
#[path = "bladed_tests.rs"]
mod tests;
