//! Turbines in the project's own format: TOML, degrees and rpm where the key says so, a source for every
//! group of figures.

mod check;
mod controller;
mod document;
mod error;
mod operation;
mod ranges;
mod swashplate;
mod text;
mod write;
mod write_controller;

pub use controller::controller_of;
pub use document::{
    Airfoils, Blade, BladeStructure, Controller, Document, DriveTrain, Hub, IndividualPitch, Mode,
    Nacelle, PitchActuator, PitchFloor, PolarTable, Rotor, SetPointSmoothing, Station,
    TorqueControl, Tower, TowerDamping, Unsteady,
};
pub use error::TurbineFileError;
pub use operation::Operation;
pub use swashplate::Swashplate;
pub use write::{Written, write};

use crate::atomic;
use control::baseline::Constants;
use std::io;
use std::path::Path;
use turbine::Definition;

/// A turbine with its controller's constants and where every figure comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct TurbineFile {
    /// What the turbine is called in words.
    pub title: String,
    /// The machine.
    pub definition: Definition,
    /// Constants of its torque and pitch control.
    pub controller: Constants,
    /// Group of figures and its source, in the file's order.
    pub sources: Vec<(String, String)>,
}

/// The turbine in `text`, which errors call `file`.
///
/// # Errors
/// [`TurbineFileError`] naming file, line, key, what was expected there and how to fix it.
pub fn parse(file: &str, text: &str) -> Result<TurbineFile, TurbineFileError> {
    let document: Document =
        toml::from_str(text).map_err(|error| TurbineFileError::syntax(file, text, &error))?;
    check::check(&document, &error::Place { file, text })
}

/// The turbine of `document`, which errors call `file`.
///
/// # Errors
/// As [`parse`], without lines.
pub fn check(document: &Document, file: &str) -> Result<TurbineFile, TurbineFileError> {
    check::check(document, &error::Place { file, text: "" })
}

/// Nothing when `controller`, which does not come from a turbine file, holds what one may hold; errors call
/// it `file`.
///
/// # Errors
/// [`TurbineFileError::Value`] naming the key of a turbine file, without a line.
pub(crate) fn check_controller(
    controller: &Controller,
    file: &str,
) -> Result<(), TurbineFileError> {
    let place = error::Place { file, text: "" };
    ranges::check_controller(controller, &place)?;
    controller::check(controller, &place)
}

/// The turbine in the file at `path`.
///
/// # Errors
/// As [`parse`], and when the file cannot be read.
pub fn read(path: &Path) -> Result<TurbineFile, TurbineFileError> {
    let text = atomic::read_whole(path)
        .and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other))
        .map_err(|source| TurbineFileError::unreadable(path, source))?;
    parse(&path.display().to_string(), &text)
}

#[cfg(test)]
mod tests;
