//! Planes out of the files that were written.

use super::{COMPONENTS, WHAT, spanned};
use crate::{FileError, atomic};
use basis::records::{Plane, PlaneAxes};
use netcdf_reader::{NcAttrValue, NcFile};
use std::path::Path;

const FIX: &str = "restore the file, or make the run again";

/// Reads the one plane of a mean or an instant.
///
/// # Errors
/// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else.
pub fn read_plane(path: &Path) -> Result<Plane, FileError> {
    let mut planes = read(path)?;
    match (planes.pop(), planes.is_empty()) {
        (Some((_, plane)), true) => Ok(plane),
        _ => Err(FileError::content(WHAT, path, "it does not hold one instant", FIX)),
    }
}

/// Reads planes at all their instants, in the order of time.
///
/// # Errors
/// Those of [`read_plane`].
pub fn read_planes(path: &Path) -> Result<Vec<Plane>, FileError> {
    Ok(read(path)?.into_iter().map(|(_, plane)| plane).collect())
}

/// Reads planes with their phases (rad), in the order of the phases.
///
/// # Errors
/// Those of [`read_plane`].
pub fn read_phases(path: &Path) -> Result<Vec<(f64, Plane)>, FileError> {
    let with_phase = |(phase, plane): (Option<f64>, Plane)| Some((phase?, plane));
    let planes: Option<Vec<_>> = read(path)?.into_iter().map(with_phase).collect();
    planes.ok_or_else(|| FileError::content(WHAT, path, lacks("phase"), FIX))
}

fn read(path: &Path) -> Result<Vec<(Option<f64>, Plane)>, FileError> {
    let bytes = atomic::read_bytes(path, WHAT)?;
    decode(&bytes).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

/// The planes in `bytes`, with their phases (rad) where they have some.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<(Option<f64>, Plane)>, String> {
    let most = bytes.len();
    let file = NcFile::from_bytes(bytes).map_err(|error| error.to_string())?;
    let attribute = |name: &str| {
        let attribute = file.global_attribute(name);
        attribute.map(|attribute| attribute.value.clone()).map_err(|_| lacks(name))
    };
    let text =
        |name: &str| attribute(name)?.as_string().ok_or_else(|| format!("`{name}` is no text"));
    let axes = text("axes")?;
    let axes = [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind]
        .into_iter()
        .find(|known| spanned(*known).0 == axes)
        .ok_or_else(|| format!("`axes` = \"{axes}\" is unknown"))?;
    let mut n_points = [0_usize; 2];
    for (count, axis) in n_points.iter_mut().zip(spanned(axes).1) {
        let name = ["x", "y", "z"][axis];
        let size = file.dimension(name).map_err(|_| lacks(name))?.size;
        *count = usize::try_from(size).map_err(|_| format!("`{name}` has {size} points"))?;
    }
    let times = variable(&file, "time", most)?;
    let phases =
        if file.dimension("phase").is_ok() { Some(variable(&file, "phase", most)?) } else { None };
    let n_planes = phases.as_ref().map_or(times.len(), Vec::len);
    let n_values = n_points[0].checked_mul(n_points[1]).filter(|n| *n > 0);
    let in_all = n_values.and_then(|n| n.checked_mul(n_planes));
    let in_all = in_all.filter(|n| *n <= most / size_of::<f32>());
    let (Some(n_values), Some(in_all)) = (n_values, in_all) else {
        return Err("it holds fewer values than it says".to_owned());
    };
    let velocity = velocities(&file, in_all)?;
    let like = Plane {
        name: text("plane")?,
        axes,
        origin: numbers(&attribute("origin_m")?, "origin_m")?,
        spacing: numbers(&attribute("spacing_m")?, "spacing_m")?,
        n_points,
        time: 0.0,
        averaged: numbers::<1>(&attribute("averaging_time_s")?, "averaging_time_s")?[0],
        velocity: Default::default(),
    };
    let plane = |index: usize| {
        let range = index * n_values..(index + 1) * n_values;
        // Phases share one time.
        let time = times[index.min(times.len() - 1)];
        let velocity = velocity.each_ref().map(|values| values[range.clone()].to_vec());
        let phase = phases.as_ref().map(|phases| phases[index]);
        (phase, Plane { time, velocity, ..like.clone() })
    };
    if n_planes > 0 && times.is_empty() {
        return Err("it tells no time".to_owned());
    }
    Ok((0..n_planes).map(plane).collect())
}

/// The components of the wind in `file`, of `n_values` values each.
fn velocities(file: &NcFile, n_values: usize) -> Result<[Vec<f32>; 3], String> {
    let mut velocity = [const { Vec::new() }; 3];
    for ((name, _), values) in COMPONENTS.iter().zip(&mut velocity) {
        let shape = file.variable(name).map_err(|_| lacks(name))?.shape();
        if shape.iter().try_fold(1_u64, |n, m| n.checked_mul(*m)) != Some(n_values as u64) {
            return Err(format!("`{name}` has the shape {shape:?} for {n_values} values"));
        }
        values.resize(n_values, 0.0_f32);
        file.read_variable_into::<f32>(name, values).map_err(|error| error.to_string())?;
    }
    Ok(velocity)
}

/// The values of the variable `name` in a file of `most` bytes.
pub(super) fn variable(file: &NcFile, name: &str, most: usize) -> Result<Vec<f64>, String> {
    let shape = file.variable(name).map_err(|_| lacks(name))?.shape();
    let size = shape.iter().try_fold(1_u64, |n, m| n.checked_mul(*m));
    let size = size.and_then(|size| usize::try_from(size).ok());
    let size = size.filter(|size| *size <= most / size_of::<f64>());
    let size = size.ok_or_else(|| format!("`{name}` has the shape {shape:?}"))?;
    let mut values = vec![0.0; size];
    file.read_variable_into::<f64>(name, &mut values).map_err(|error| error.to_string())?;
    Ok(values)
}

pub(super) fn lacks(name: &str) -> String {
    format!("it lacks `{name}`")
}

fn numbers<const N: usize>(value: &NcAttrValue, name: &str) -> Result<[f64; N], String> {
    let values = value.as_f64_vec().unwrap_or_default();
    values.try_into().map_err(|_| format!("`{name}` does not hold {N} numbers"))
}
