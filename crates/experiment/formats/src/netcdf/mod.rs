//! Planes, scans of lidars, statistics over time and height, and temperatures of recorded wind, as NetCDF
//! files that xarray, ParaView and MATLAB open as they are; they come back, too.
//!
//! The classic format (64-bit offsets where needed), which needs no HDF5 on either side. Velocity stands over
//! `time` or `phase`, `z`, `y`, `x`, the axis across the plane having one point, so that a plane lies where
//! it was taken. Beside it stand the turbines and the wind in which it was, [`PlaneSetting`].

mod grid;
mod growing;
mod instants;
mod phase_averages;
mod phase_averages_writer;
mod read;
mod scans;
mod setting;
mod statistics;
mod stored_scans;
mod temperature;

pub(crate) use grid::{even, numbers_of};
pub use instants::InstantWriter;
pub use phase_averages::{StoredPhaseAverages, is_phase_averages, phase_averages_bytes};
pub use phase_averages_writer::{PhaseAveragesWriter, write_phase_averages};
pub use read::{read_phases, read_plane, read_planes};
pub use scans::{ScanInstant, ScanSetting, ScanWriter, scan_bytes};
pub use setting::{PlacedTurbine, PlaneSetting};
pub use statistics::{Column, StoredStatistics, TimeHeight, read_statistics, write_statistics};
pub use stored_scans::{StoredScans, read_scans};
pub use temperature::{TemperatureReader, TemperatureWriter, plane_bytes as temperature_bytes};

use crate::{FileError, atomic};
use basis::records::{Plane, PlaneAxes};
use netcdf_writer::{DimensionId, Error, NcAttrValue, NcFileBuilder, NcWriteOptions};
use std::io;
use std::path::Path;

const WHAT: &str = "a plane of velocities (NetCDF)";
/// Velocity components: name, meaning.
const COMPONENTS: [(&str, &str); 3] = [
    ("u", "velocity downwind"),
    ("v", "velocity to the left looking downwind"),
    ("w", "velocity upward"),
];

/// Names of the axes that a plane spans, and their places among x, y, z.
fn spanned(axes: PlaneAxes) -> (&'static str, [usize; 2]) {
    match axes {
        PlaneAxes::Horizontal => ("horizontal", [0, 1]),
        PlaneAxes::Streamwise => ("streamwise", [0, 2]),
        PlaneAxes::Crosswind => ("crosswind", [1, 2]),
    }
}

/// The plane at one phase of the excitation.
#[derive(Clone, Copy, Debug)]
pub struct AtPhase<'a> {
    /// The phase (rad).
    pub phase: f64,
    /// Instants behind it (–).
    pub n_instants: u64,
    /// Their mean.
    pub plane: &'a Plane,
}

/// Writes `plane` of a run in `setting` to `path`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_plane(path: &Path, setting: &PlaneSetting, plane: &Plane) -> Result<(), FileError> {
    commit(path, encode(setting, plane, &Over::Time { grows: false }))
}

/// Writes the planes of a run in `setting` at phases of its excitation to `path`, over the dimension `phase`.
///
/// # Errors
/// [`FileError::System`].
///
/// # Panics
/// When `phases` is empty, or its planes are not of one size.
pub fn write_phases(
    path: &Path,
    setting: &PlaneSetting,
    phases: &[AtPhase],
) -> Result<(), FileError> {
    commit(path, encode(setting, phases[0].plane, &Over::Phase(phases)))
}

fn commit(path: &Path, encoded: Result<Vec<u8>, Error>) -> Result<(), FileError> {
    atomic::write(path, WHAT, &encoded.map_err(|error| unwritable(path, error))?)
}

fn unwritable(path: &Path, error: Error) -> FileError {
    unwritable_as(WHAT, path, error)
}

fn unwritable_as(what: &'static str, path: &Path, error: Error) -> FileError {
    FileError::system("write", what, path, io::Error::new(io::ErrorKind::InvalidInput, error))
}

/// The first dimension of velocities.
enum Over<'a> {
    /// One instant, or the first of those to come.
    Time { grows: bool },
    /// Phases of an excitation.
    Phase(&'a [AtPhase<'a>]),
}

fn text(text: &str) -> NcAttrValue {
    NcAttrValue::Chars(text.to_owned())
}

/// The bytes of a file with `plane` in `setting`, or over all that `over` holds.
fn encode(setting: &PlaneSetting, plane: &Plane, over: &Over) -> Result<Vec<u8>, Error> {
    let (axes, along) = spanned(plane.axes);
    let mut file = NcFileBuilder::new();
    let what = match over {
        Over::Phase(_) => "phase-averaged",
        Over::Time { .. } if plane.averaged > 0.0 => "mean",
        Over::Time { .. } => "instantaneous",
    };
    file.add_attribute("Conventions", text("CF-1.8"))?;
    let title = format!("{what} wind velocity on the plane {}", plane.name);
    file.add_attribute("title", text(&title))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    setting.add_attributes(&mut file)?;
    file.add_attribute("plane", text(&plane.name))?;
    file.add_attribute("axes", text(axes))?;
    file.add_attribute("origin_m", NcAttrValue::Doubles(plane.origin.to_vec()))?;
    file.add_attribute("spacing_m", NcAttrValue::Doubles(plane.spacing.to_vec()))?;
    file.add_attribute("averaging_time_s", NcAttrValue::Doubles(vec![plane.averaged]))?;
    setting.add_turbines(&mut file)?;

    let mut dimensions = add_axes(&mut file, plane, along)?;
    dimensions.insert(0, add_first(&mut file, plane, over)?);
    let method = match over {
        Over::Phase(_) => "time: mean (over instants of equal phase)",
        Over::Time { .. } if plane.averaged > 0.0 => "time: mean",
        Over::Time { .. } => "time: point",
    };
    for (component, (name, long_name)) in COMPONENTS.iter().enumerate() {
        let variable = file.add_variable::<f32>(*name, &dimensions)?;
        file.add_variable_attribute(variable, "units", text("m s-1"))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        file.add_variable_attribute(variable, "cell_methods", text(method))?;
        match over {
            Over::Time { .. } => file.write_variable(variable, &plane.velocity[component])?,
            Over::Phase(phases) => {
                let values = phases.iter().flat_map(|one| &one.plane.velocity[component]);
                file.write_variable(variable, &values.copied().collect::<Vec<f32>>())?;
            }
        }
    }
    // Offsets of 64 bits where a file grows: nobody knows how far.
    let options = match over {
        Over::Time { grows: true } => NcWriteOptions::offset64(),
        _ => NcWriteOptions::default(),
    };
    Ok(file.to_vec(options)?.1)
}

/// Adds z, y and x of `plane`, which spans those in `along`; gives their dimensions.
fn add_axes(
    file: &mut NcFileBuilder,
    plane: &Plane,
    along: [usize; 2],
) -> Result<Vec<DimensionId>, Error> {
    let mut coordinates = plane.origin.map(|start| vec![start]);
    for (axis, (spacing, count)) in along.into_iter().zip(plane.spacing.iter().zip(plane.n_points))
    {
        coordinates[axis] = (0..count).map(|i| plane.origin[axis] + i as f64 * spacing).collect();
    }
    let [x, y, z] = &coordinates;
    let described: [(&str, &[f64], &str, &str); 3] = [
        ("z", z, "Z", "height above the ground"),
        ("y", y, "Y", "distance to the left of the first turbine looking downwind"),
        ("x", x, "X", "distance downwind of the first turbine"),
    ];
    let mut dimensions = Vec::with_capacity(described.len() + 1);
    for (name, values, axis, long_name) in described {
        let dimension = file.add_dimension(name, values.len() as u64)?;
        let variable = file.add_variable::<f64>(name, &[dimension])?;
        file.add_variable_attribute(variable, "units", text("m"))?;
        file.add_variable_attribute(variable, "axis", text(axis))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        if name == "z" {
            file.add_variable_attribute(variable, "positive", text("up"))?;
        }
        file.write_variable(variable, values)?;
        dimensions.push(dimension);
    }
    Ok(dimensions)
}

/// Adds the first dimension of velocities with its coordinate.
fn add_first(file: &mut NcFileBuilder, plane: &Plane, over: &Over) -> Result<DimensionId, Error> {
    let time = match over {
        Over::Time { grows: true } => vec![file.add_unlimited_dimension("time")?],
        Over::Time { grows: false } => vec![file.add_dimension("time", 1)?],
        // One instant for all: the end of the averaging.
        Over::Phase(_) => Vec::new(),
    };
    let variable = file.add_variable::<f64>("time", &time)?;
    file.add_variable_attribute(variable, "units", text("s"))?;
    if let Over::Time { .. } = over {
        file.add_variable_attribute(variable, "axis", text("T"))?;
    }
    let long_name = match over {
        Over::Time { .. } if plane.averaged == 0.0 => "time since the start of the run",
        _ => "time since the start of the run, at the end of the averaging",
    };
    file.add_variable_attribute(variable, "long_name", text(long_name))?;
    file.write_variable(variable, &[plane.time])?;
    let phases = match over {
        Over::Time { .. } => return Ok(time[0]),
        Over::Phase(phases) => phases,
    };
    let dimension = file.add_dimension("phase", phases.len() as u64)?;
    let variable = file.add_variable::<f64>("phase", &[dimension])?;
    file.add_variable_attribute(variable, "units", text("rad"))?;
    let long_name =
        "phase of the excitation of the first helix, its angle over time wrapped to a turn";
    file.add_variable_attribute(variable, "long_name", text(long_name))?;
    file.write_variable(variable, &phases.iter().map(|one| one.phase).collect::<Vec<f64>>())?;
    let variable = file.add_variable::<i32>("n_instants", &[dimension])?;
    file.add_variable_attribute(variable, "units", text("1"))?;
    file.add_variable_attribute(variable, "long_name", text("instants that were averaged"))?;
    let counts = phases.iter().map(|one| i32::try_from(one.n_instants).unwrap_or(i32::MAX));
    file.write_variable(variable, &counts.collect::<Vec<i32>>())?;
    Ok(dimension)
}

#[cfg(test)]
mod tests;
