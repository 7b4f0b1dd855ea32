//! Turbulence boxes in files: HAWC2's three binaries with a header, TurbSim's full field.
//!
//! In memory a box lies in the farm frame (x downwind, y left looking downwind, z up); each format converts on its way in
//! and out. Time runs against x: of a box that stands with x index 0 at the inlet at time zero, the planes
//! n_x − 1, n_x − 2, … arrive next. Formats that count in order of arrival therefore hold plane (n_x − i) mod n_x
//! at place i.

mod hawc;
mod turbsim;

pub use hawc::{Axis, read as read_hawc, write as write_hawc};
pub use turbsim::{read as read_turbsim, write as write_turbsim};

use crate::FileError;
use flow::inflow::TurbulenceBox;
use std::path::Path;

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

/// Reads the box at `path`: a HAWC2-style header (`.toml`) or a TurbSim full field (`.bts`).
///
/// # Errors
/// [`FileError`] names file, place and fix: a cut or overlong file, the wrong byte order, values that are not numbers
/// or no wind, a header that does not fit.
pub fn read(path: &Path) -> Result<StoredBox, FileError> {
    match kind(path)? {
        Kind::Hawc => hawc::read(path),
        Kind::TurbSim => turbsim::read(path),
    }
}

/// Writes `stored` to `path`, whose extension chooses the format as in [`read`].
///
/// # Errors
/// [`FileError`]; files appear whole or not at all, the header last.
pub fn write(path: &Path, stored: &StoredBox) -> Result<(), FileError> {
    match kind(path)? {
        Kind::Hawc => hawc::write(path, stored),
        Kind::TurbSim => turbsim::write(path, stored),
    }
}

/// Whether a box can be written under the name `path`, before the work of making one.
///
/// # Errors
/// [`FileError::Content`] when its ending names no format.
pub fn check_name(path: &Path) -> Result<(), FileError> {
    kind(path).map(|_| ())
}

enum Kind {
    Hawc,
    TurbSim,
}

fn kind(path: &Path) -> Result<Kind, FileError> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("toml") => Ok(Kind::Hawc),
        Some("bts") => Ok(Kind::TurbSim),
        _ => Err(FileError::content(
            "a turbulence box",
            path,
            "its name ends neither in .toml nor in .bts",
            "name it NAME.toml (header of HAWC2-style binaries) or NAME.bts (TurbSim)",
        )),
    }
}

/// Plane of the box at place `place` in order of arrival, of `n_x`; the same the other way round.
fn in_order_of_arrival(place: usize, n_x: usize) -> usize {
    (n_x - place) % n_x
}

#[cfg(test)]
mod tests;
