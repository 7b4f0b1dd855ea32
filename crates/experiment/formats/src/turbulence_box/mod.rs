//! Turbulence boxes in files: HAWC2's three binaries with a header, TurbSim's full field, Bladed's.
//!
//! In memory a box lies in the farm frame (x downwind, y left looking downwind, z up); each format converts
//! on its way in and out. Time runs against x: of a box that stands with x index 0 at the inlet at time zero,
//! the planes n_x − 1, n_x − 2, … arrive next. Formats that count in order of arrival therefore hold plane
//! (n_x − i) mod n_x at place i. [`read`] takes a whole box into memory, [`open`] gives its planes one at a
//! time, however long it is, and [`convert`] writes them as they come: no writer holds more than a [`Source`]
//! gives it.

mod bladed;
mod blocks;
mod hawc;
mod maker;
mod of_planes;
mod packed;
mod recorder;
mod source;
mod turbsim;

pub use bladed::{open as open_bladed, read as read_bladed, write as write_bladed};
pub use hawc::{Axis, open as open_hawc, read as read_hawc, write as write_hawc};
pub use maker::{KAIMAL, maker_with_divergence};
pub use of_planes::{Origin, check_once, write_planes};
pub use recorder::{Carried, WindRecorder};
pub use source::{Outline, Source};
pub use turbsim::{open as open_turbsim, read as read_turbsim, write as write_turbsim};

use crate::{FileError, leftovers};
use flow::inflow::{InflowError, PlaneGrid, Planes, TurbulenceBox};
use std::path::{Path, PathBuf};

/// Fastest wind that a file may hold (m/s); beyond it the bytes mean something else.
const FASTEST: f32 = 200.0;

/// A box with what is needed to put it into the wind it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredBox {
    /// The fluctuations.
    pub turbulence: TurbulenceBox,
    /// Speed with which the box is carried along (m/s).
    pub hub_speed: f64,
    /// Height of that speed (m).
    pub hub_height: f64,
    /// Height of the lowest row of points (m).
    pub lowest_height: f64,
    /// Mean speed along x at each row of points, lowest first (m/s), n_z values.
    pub mean_speeds: Vec<f64>,
    /// Where it comes from, in words.
    pub description: String,
}

/// Reads the box at `path`: a HAWC2-style header (`.toml`) or one of its binaries (`.bin`), a full field of
/// TurbSim (`.bts`) or of Bladed (`.wnd`).
///
/// # Errors
/// [`FileError`] names file, place and fix: a cut or overlong file, the wrong byte order, values that are not
/// numbers or no wind, a header that does not fit.
pub fn read(path: &Path) -> Result<StoredBox, FileError> {
    match kind(path)? {
        Kind::Hawc(header) => hawc::read(&header),
        Kind::TurbSim => turbsim::read(path),
        Kind::Bladed => bladed::read(path),
    }
}

/// Planes of the box at `path` in order of arrival, the mean wind included, read one at a time.
///
/// # Errors
/// As [`read`].
pub fn open(path: &Path) -> Result<Box<dyn Planes>, FileError> {
    Ok(match kind(path)? {
        Kind::Hawc(header) => Box::new(hawc::open(&header)?),
        Kind::TurbSim => Box::new(turbsim::open(path)?),
        Kind::Bladed => Box::new(bladed::open(path)?),
    })
}

/// Hub height of the box at `path` (m).
///
/// # Errors
/// As [`read`].
pub fn hub_height(path: &Path) -> Result<f64, FileError> {
    match kind(path)? {
        Kind::Hawc(header) => hawc::hub_height(&header),
        Kind::TurbSim => turbsim::hub_height(path),
        Kind::Bladed => bladed::hub_height(path),
    }
}

/// Paths of all files that the box at `path` is read from: its own first, then those that belong to it.
///
/// # Errors
/// [`FileError`] for a name that is none of a box, and for a header that cannot be read.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, FileError> {
    Ok(match kind(path)? {
        Kind::Hawc(header) => hawc::files(&header)?,
        Kind::TurbSim => vec![path.to_owned()],
        Kind::Bladed => {
            let summary = path.with_extension("sum");
            let summary = summary.exists().then_some(summary);
            std::iter::once(path.to_owned()).chain(summary).collect()
        }
    })
}

/// Writes `stored` to `path`, whose extension chooses the format as in [`read`].
///
/// # Errors
/// [`FileError`]; files appear whole or not at all, the header last.
pub fn write(path: &Path, mut stored: &StoredBox) -> Result<(), FileError> {
    write_from(path, &mut stored)
}

/// Writes the box at `from` to `to`, whose extensions choose the formats as in [`read`]: the same files as
/// [`write()`] makes of what [`read`] gives. However long it is, a few planes at a time are in memory; they
/// come once more for mean speeds that `from` does not tell, and for what the header of `to` tells of all of
/// them.
///
/// # Errors
/// As [`read`] and [`write()`]; where `from` cannot be read to its end, what was at `to` before still stands.
pub fn convert(from: &Path, to: &Path) -> Result<(), FileError> {
    check_name(to)?;
    match kind(from)? {
        Kind::Hawc(header) => write_from(to, &mut hawc::stream(&header)?),
        Kind::TurbSim => write_from(to, &mut turbsim::stream(from)?),
        Kind::Bladed => write_from(to, &mut bladed::stream(from)?),
    }
}

/// Writes the box of `source` as [`write()`] does; what killed processes have left of it goes.
fn write_from(path: &Path, source: &mut dyn Source) -> Result<(), FileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    // A folder that is not there is told by the writer.
    for file in files_of(path)?.iter().filter(|_| folder.is_dir()) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        leftovers::remove_abandoned(folder, Some(&name))?;
    }
    match kind(path)? {
        Kind::Hawc(header) => hawc::write(&header, source),
        Kind::TurbSim => turbsim::write(path, source),
        Kind::Bladed => bladed::write(path, source),
    }
}

/// Whether a box can be written under the name `path`, before the work of making one.
///
/// # Errors
/// [`FileError::Content`] when its ending names no format.
pub fn check_name(path: &Path) -> Result<(), FileError> {
    kind(path).map(|_| ())
}

/// The files that [`write()`] makes for a box called `path`.
///
/// # Errors
/// Those of [`check_name`].
pub fn files_of(path: &Path) -> Result<Vec<PathBuf>, FileError> {
    Ok(match kind(path)? {
        Kind::Hawc(header) => hawc::files_of(&header),
        Kind::TurbSim => vec![path.to_owned()],
        Kind::Bladed => vec![path.to_owned(), path.with_extension("sum")],
    })
}

enum Kind {
    /// With the path of the header.
    Hawc(PathBuf),
    TurbSim,
    Bladed,
}

fn kind(path: &Path) -> Result<Kind, FileError> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => Ok(Kind::Hawc(path.to_owned())),
        Some("bin") => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let name = ["_u", "_v", "_w"].iter().find_map(|end| stem.strip_suffix(end));
            Ok(Kind::Hawc(path.with_file_name(format!("{}.toml", name.unwrap_or(&stem)))))
        }
        Some("bts") => Ok(Kind::TurbSim),
        Some("wnd") => Ok(Kind::Bladed),
        _ => Err(FileError::content(
            "a turbulence box",
            path,
            "its name ends neither in .toml nor in .bts, .wnd or .bin",
            "name it NAME.toml or NAME.bin (HAWC2-style binaries with their header), NAME.bts (TurbSim) or NAME.wnd (Bladed)",
        )),
    }
}

/// Distances of points that a file may hold (m); beyond them the bytes mean something else, and planes of
/// wind would crowd the memory.
const SPACINGS: std::ops::RangeInclusive<f64> = 1e-3..=1e5;

/// Heights of hubs and points that a file may hold (m).
const HEIGHTS: std::ops::RangeInclusive<f64> = -1e3..=1e4;

/// Makes sure that wind can come in over `grid`, which stands in the file of `what` at `path` with a hub at
/// `hub_height` (m).
fn sound(
    path: &Path,
    what: &'static str,
    grid: &PlaneGrid,
    hub_height: f64,
) -> Result<(), FileError> {
    let fix = "copy the file again, or make it again";
    let refusal = |problem: String| FileError::content(what, path, problem, fix);
    grid.check().map_err(|error| refusal(error.to_string()))?;
    if grid.speed > f64::from(FASTEST) {
        let problem = format!("its mean speed is {:?} m/s; {FASTEST} m/s are the most", grid.speed);
        return Err(refusal(problem));
    }
    for (name, height) in [("hub", hub_height), ("lowest row of points", grid.first[1])] {
        if !HEIGHTS.contains(&height) {
            let [least, most] = [HEIGHTS.start(), HEIGHTS.end()];
            return Err(refusal(format!(
                "its {name} stands at {height:?} m; {least} to {most} m is the range"
            )));
        }
    }
    let along = grid.speed * grid.interval;
    for (axis, spacing) in ["x", "y", "z"].iter().zip([along, grid.spacing[0], grid.spacing[1]]) {
        if !SPACINGS.contains(&spacing) {
            let [least, most] = [SPACINGS.start(), SPACINGS.end()];
            return Err(refusal(format!(
                "its points stand {spacing} m apart along {axis}; {least} to {most} m is the range"
            )));
        }
    }
    Ok(())
}

/// The error of a flow when plane `step` cannot be read.
fn plane_error(step: usize, error: &FileError) -> InflowError {
    let mut problem = error.to_string();
    if let Some(source) = std::error::Error::source(error) {
        problem = format!("{problem}: {source}");
    }
    InflowError::Plane { step, problem }
}

/// Plane of the box at place `place` in order of arrival, of `n_x`; the same the other way round.
fn in_order_of_arrival(place: usize, n_x: usize) -> usize {
    (n_x - place) % n_x
}

#[cfg(test)]
mod conversion_tests;
#[cfg(test)]
mod numbers_tests;
#[cfg(test)]
mod streaming_tests;
#[cfg(test)]
pub(crate) mod tests;
