//! Where the wake is: the place at which a Gaussian covers most of the velocity deficit.
//!
//! Source: Coudou, Moens, Marichal, Van Beeck, Bricteux, Chatelain, "Development of wake meandering detection
//! algorithms and their application to large eddy simulations of an isolated wind turbine and a wind farm",
//! J. Phys.: Conf. Ser. 1037, 072024, 2018; used in van Vondelen et al. (2025), §4.5.

use super::{expect_axes, profile::origin};
use crate::AnalysisError;
use basis::records::{Plane, PlaneAxes};

/// Wake centre (y and z, farm frame, m) in a crosswind `plane`.
///
/// The deficit U(z) − u is convolved with a Gaussian of standard deviation `width` (m, about half a rotor
/// radius); the centre is the maximum, by a parabola between the plane's points.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] unless the plane lies across the wind, [`AnalysisError::TooShort`] for a
/// plane without points.
pub fn centre(
    plane: &Plane,
    free_stream: impl Fn(f64) -> f64,
    width: f64,
) -> Result<[f64; 2], AnalysisError> {
    expect_axes(plane, &[PlaneAxes::Crosswind], "one across the wind")?;
    expect_points(plane)?;
    let [n_first, n_second] = plane.n_points;
    let start = origin(plane);
    // The Gaussian is a product, so that rows and then columns are convolved.
    let kernel = [0, 1].map(|axis| kernel(plane.n_points[axis], plane.spacing[axis], width));
    let mut rows = vec![0.0; n_first * n_second];
    for second in 0..n_second {
        let speed = free_stream(start[1] + second as f64 * plane.spacing[1]);
        let velocities = &plane.velocity[0][second * n_first..(second + 1) * n_first];
        let deficit: Vec<f64> = velocities.iter().map(|u| speed - f64::from(*u)).collect();
        rows[second * n_first..(second + 1) * n_first]
            .copy_from_slice(&convolved(&deficit, &kernel[0]));
    }
    let mut response = vec![0.0; n_first * n_second];
    for first in 0..n_first {
        let column: Vec<f64> = rows.iter().skip(first).step_by(n_first).copied().collect();
        for (second, value) in convolved(&column, &kernel[1]).into_iter().enumerate() {
            response[second * n_first + first] = value;
        }
    }
    let best = highest(&response);
    let (first, second) = (best % n_first, best / n_first);
    let row = &response[second * n_first..(second + 1) * n_first];
    let column: Vec<f64> = response.iter().skip(first).step_by(n_first).copied().collect();
    Ok([
        start[0] + summit(row, first) * plane.spacing[0],
        start[1] + summit(&column, second) * plane.spacing[1],
    ])
}

/// Middle of the velocity deficit U(z) − u (y and z, farm frame, m) within `radius` (m) of `around` (y and z)
/// in a crosswind `plane`: its first moment over its integral.
///
/// Where a jet blows through the wake's middle or its deficit is uneven, [`centre`] follows the deeper side;
/// this follows the whole. What lies beyond the circle it does not see.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] unless the plane lies across the wind, [`AnalysisError::OutsidePlane`] where
/// the circle holds no deficit.
pub fn middle_of_deficit(
    plane: &Plane,
    free_stream: impl Fn(f64) -> f64,
    around: [f64; 2],
    radius: f64,
) -> Result<[f64; 2], AnalysisError> {
    expect_axes(plane, &[PlaneAxes::Crosswind], "one across the wind")?;
    let [n_first, _] = plane.n_points;
    let start = origin(plane);
    let (mut moment, mut whole) = ([0.0; 2], 0.0);
    for (index, u) in plane.velocity[0].iter().enumerate() {
        let y = start[0] + (index % n_first) as f64 * plane.spacing[0];
        let z = start[1] + (index / n_first) as f64 * plane.spacing[1];
        let from = [y - around[0], z - around[1]];
        if from[0].hypot(from[1]) < radius {
            let deficit = free_stream(z) - f64::from(*u);
            whole += deficit;
            moment = [0, 1].map(|axis| moment[axis] + deficit * from[axis]);
        }
    }
    if whole <= 0.0 {
        let [first, second] = around;
        return Err(AnalysisError::OutsidePlane { name: plane.name.clone(), first, second });
    }
    Ok([0, 1].map(|axis| around[axis] + moment[axis] / whole))
}

/// Wake centre at each x of a horizontal or streamwise `plane`: pairs of x and y (or z), farm frame (m).
///
/// As [`centre`], in one dimension; upstream of the rotor the result means nothing.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] for a plane across the wind, [`AnalysisError::TooShort`] for one without
/// points.
pub fn centre_line(
    plane: &Plane,
    free_stream: impl Fn(f64) -> f64,
    width: f64,
) -> Result<Vec<[f64; 2]>, AnalysisError> {
    expect_axes(plane, &[PlaneAxes::Horizontal, PlaneAxes::Streamwise], "one along the wind")?;
    expect_points(plane)?;
    let [n_first, n_second] = plane.n_points;
    let start = origin(plane);
    let height = |second: usize| match plane.axes {
        PlaneAxes::Streamwise => start[1] + second as f64 * plane.spacing[1],
        PlaneAxes::Horizontal | PlaneAxes::Crosswind => plane.origin[2],
    };
    let speeds: Vec<f64> = (0..n_second).map(|second| free_stream(height(second))).collect();
    let kernel = kernel(n_second, plane.spacing[1], width);
    Ok((0..n_first)
        .map(|first| {
            let velocities = plane.velocity[0].iter().skip(first).step_by(n_first);
            let deficit: Vec<f64> =
                velocities.zip(&speeds).map(|(u, speed)| speed - f64::from(*u)).collect();
            let response = convolved(&deficit, &kernel);
            let place = summit(&response, highest(&response));
            [start[0] + first as f64 * plane.spacing[0], start[1] + place * plane.spacing[1]]
        })
        .collect())
}

fn expect_points(plane: &Plane) -> Result<(), AnalysisError> {
    match plane.n_points.iter().product() {
        0 => Err(AnalysisError::TooShort { n_samples: 0, needed: 1 }),
        _ => Ok(()),
    }
}

/// Values of the Gaussian at 0, 1, 2, … spacings from its middle; only the place of the maximum counts, so
/// not its scale.
fn kernel(n_points: usize, spacing: f64, width: f64) -> Vec<f64> {
    (0..n_points).map(|index| (-0.5 * (index as f64 * spacing / width).powi(2)).exp()).collect()
}

fn convolved(values: &[f64], kernel: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|at| values.iter().enumerate().map(|(i, v)| v * kernel[i.abs_diff(at)]).sum())
        .collect()
}

fn highest(values: &[f64]) -> usize {
    values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index)
}

/// Index of the maximum near `peak`, between points by a parabola through three of them.
fn summit(values: &[f64], peak: usize) -> f64 {
    if peak == 0 || peak + 1 >= values.len() {
        return peak as f64;
    }
    let (left, middle, right) = (values[peak - 1], values[peak], values[peak + 1]);
    let curvature = left - 2.0 * middle + right;
    if curvature < 0.0 { peak as f64 + 0.5 * (left - right) / curvature } else { peak as f64 }
}
