//! Wakes in planes of velocity: profiles, disc averages, wake centres, momentum deficit, turbulence.
//!
//! A free stream is given as its speed (m/s) over height (m), so that sheared wind has no deficit of its own.

mod centre;
mod disc;
mod phase_average;
mod profile;
mod recentred;
mod swing;

pub use centre::{centre, centre_line, middle_of_deficit};
pub use disc::{Disc, disc_average};
pub use phase_average::{PhaseAverage, PhasePlane};
pub use profile::{Profile, along_first, along_second, velocity_at};
pub use recentred::recentred_deficit;
pub use swing::{Orbit, Swing, orbit, swing};

use crate::AnalysisError;
use basis::records::{Plane, PlaneAxes};

/// Momentum that the wake lacks, over density: ∫ u (U − u) dA (m⁴/s²), over the crosswind `plane` with the
/// free stream U(z) = `free_stream` (z).
///
/// Far enough downstream for the pressure to have recovered, and without change of the free stream, this is
/// thrust over density. Source: Tennekes and Lumley, "A First Course in Turbulence", 1972, §4.1.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] unless the plane lies across the wind.
pub fn momentum_deficit(
    plane: &Plane,
    free_stream: impl Fn(f64) -> f64,
) -> Result<f64, AnalysisError> {
    expect_axes(plane, &[PlaneAxes::Crosswind], "one across the wind")?;
    let [n_first, n_second] = plane.n_points;
    let mut sum = 0.0;
    for row in 0..n_second {
        let speed = free_stream(plane.origin[2] + row as f64 * plane.spacing[1]);
        let in_row = &plane.velocity[0][row * n_first..(row + 1) * n_first];
        sum += in_row.iter().map(|u| f64::from(*u)).map(|u| u * (speed - u)).sum::<f64>();
    }
    Ok(sum * plane.spacing[0] * plane.spacing[1])
}

/// Standard deviation over time of each velocity component (m/s) at each point of `planes`, which are
/// instants of one plane; `velocity` of the result holds the deviations, `averaged` the time that the
/// instants span.
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than two instants, [`AnalysisError::UnequalLengths`] when they
/// differ in their points.
pub fn fluctuation(planes: &[Plane]) -> Result<Plane, AnalysisError> {
    let [first, .., last] = planes else {
        return Err(AnalysisError::TooShort { n_samples: planes.len(), needed: 2 });
    };
    let n_points = first.velocity[0].len();
    if let Some(odd) =
        planes.iter().find(|plane| plane.velocity.iter().any(|v| v.len() != n_points))
    {
        return Err(AnalysisError::UnequalLengths {
            first: n_points,
            second: odd.velocity[0].len(),
        });
    }
    let n_planes = planes.len() as f64;
    let deviation = |component: usize, point: usize| {
        let values = planes.iter().map(|plane| f64::from(plane.velocity[component][point]));
        let mean = values.clone().sum::<f64>() / n_planes;
        (values.map(|u| (u - mean).powi(2)).sum::<f64>() / n_planes).sqrt() as f32
    };
    let velocity =
        [0, 1, 2].map(|component| (0..n_points).map(|point| deviation(component, point)).collect());
    Ok(Plane { time: last.time, averaged: last.time - first.time, velocity, ..first.clone() })
}

fn expect_axes(
    plane: &Plane,
    allowed: &[PlaneAxes],
    needed: &'static str,
) -> Result<(), AnalysisError> {
    if allowed.contains(&plane.axes) {
        Ok(())
    } else {
        Err(AnalysisError::WrongPlane { name: plane.name.clone(), found: plane.axes, needed })
    }
}

#[cfg(test)]
mod phase_tests;
#[cfg(test)]
mod tests;
