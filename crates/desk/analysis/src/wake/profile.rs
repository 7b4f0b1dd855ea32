//! Velocity at a point and along a line of a plane.

use crate::AnalysisError;
use basis::records::{Plane, PlaneAxes};

/// Streamwise velocity along a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Coordinate along the line, farm frame (m).
    pub positions: Vec<f64>,
    /// Streamwise velocity (m/s).
    pub velocities: Vec<f64>,
}

/// Velocity (m/s, farm frame) at the coordinates `first` and `second` (m, farm frame) of `plane`, bilinear
/// between its points.
///
/// # Errors
/// [`AnalysisError::OutsidePlane`] beyond its outermost points.
pub fn velocity_at(plane: &Plane, first: f64, second: f64) -> Result<[f64; 3], AnalysisError> {
    let [first_origin, second_origin] = origin(plane);
    let outside = || AnalysisError::OutsidePlane { name: plane.name.clone(), first, second };
    let (i, across) =
        cell(first - first_origin, plane.spacing[0], plane.n_points[0]).ok_or_else(outside)?;
    let (j, up) =
        cell(second - second_origin, plane.spacing[1], plane.n_points[1]).ok_or_else(outside)?;
    let next_i = (i + 1).min(plane.n_points[0] - 1);
    let next_j = (j + 1).min(plane.n_points[1] - 1);
    Ok([0, 1, 2].map(|component| {
        let at =
            |i: usize, j: usize| f64::from(plane.velocity[component][j * plane.n_points[0] + i]);
        let low = at(i, j) + across * (at(next_i, j) - at(i, j));
        let high = at(i, next_j) + across * (at(next_i, next_j) - at(i, next_j));
        low + up * (high - low)
    }))
}

/// Streamwise velocity along the first axis of `plane`, at `second` (m, farm frame) on its second axis.
///
/// # Errors
/// [`AnalysisError::OutsidePlane`] beyond its outermost points.
pub fn along_first(plane: &Plane, second: f64) -> Result<Profile, AnalysisError> {
    let positions: Vec<f64> = (0..plane.n_points[0])
        .map(|index| origin(plane)[0] + index as f64 * plane.spacing[0])
        .collect();
    let velocities = positions
        .iter()
        .map(|first| velocity_at(plane, *first, second).map(|velocity| velocity[0]))
        .collect::<Result<_, _>>()?;
    Ok(Profile { positions, velocities })
}

/// Streamwise velocity along the second axis of `plane`, at `first` (m, farm frame) on its first axis.
///
/// # Errors
/// [`AnalysisError::OutsidePlane`] beyond its outermost points.
pub fn along_second(plane: &Plane, first: f64) -> Result<Profile, AnalysisError> {
    let positions: Vec<f64> = (0..plane.n_points[1])
        .map(|index| origin(plane)[1] + index as f64 * plane.spacing[1])
        .collect();
    let velocities = positions
        .iter()
        .map(|second| velocity_at(plane, first, *second).map(|velocity| velocity[0]))
        .collect::<Result<_, _>>()?;
    Ok(Profile { positions, velocities })
}

/// Coordinates of the plane's first point along its own two axes (m).
pub(super) fn origin(plane: &Plane) -> [f64; 2] {
    let [x, y, z] = plane.origin;
    match plane.axes {
        PlaneAxes::Horizontal => [x, y],
        PlaneAxes::Streamwise => [x, z],
        PlaneAxes::Crosswind => [y, z],
    }
}

/// The point below `distance` (m) and the share of the way to the next; none outside the points.
fn cell(distance: f64, spacing: f64, n_points: usize) -> Option<(usize, f64)> {
    let place = distance / spacing;
    let last = n_points.checked_sub(1)? as f64;
    // A coordinate that was computed from the points themselves may miss the last by rounding.
    let slack = 1e-9 * (1.0 + last);
    if !(-slack..=last + slack).contains(&place) {
        return None;
    }
    let place = place.clamp(0.0, last);
    Some((place.floor() as usize, place.fract()))
}
