//! Deficits about the wake's own centre, so that its swing does not pass for mixing.
//!
//! Source: van Vondelen et al. (2025), §4.5 and Fig. 17.

use super::{PhasePlane, along_second, centre_line, expect_axes, velocity_at};
use crate::AnalysisError;
use basis::records::{Plane, PlaneAxes};

/// Mean velocity deficit (m/s) at `offsets` (m, positive to the left) from the wake's centre, at the distance
/// `x` (m) of the horizontal `planes`.
///
/// At each phase the centre is found as in [`centre_line`], with a Gaussian of `width` (m), and the profile
/// shifted by it; phases weigh as many instants as they hold.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] unless planes are horizontal; [`AnalysisError::OutsidePlane`] where a
/// shifted profile leaves its plane; [`AnalysisError::TooShort`] without planes.
pub fn recentred_deficit(
    planes: &[PhasePlane],
    free_stream: impl Fn(f64) -> f64,
    width: f64,
    x: f64,
    offsets: &[f64],
) -> Result<Vec<f64>, AnalysisError> {
    let n_instants: u64 = planes.iter().map(|phase| phase.n_instants).sum();
    if n_instants == 0 {
        return Err(AnalysisError::TooShort { n_samples: 0, needed: 1 });
    }
    let mut deficits = vec![0.0; offsets.len()];
    for PhasePlane { n_instants: own, plane, .. } in planes {
        expect_axes(plane, &[PlaneAxes::Horizontal], "a horizontal one")?;
        let centre = centre_at(plane, &free_stream, width, x)?;
        let share = *own as f64 / n_instants as f64;
        let speed = free_stream(plane.origin[2]);
        for (deficit, offset) in deficits.iter_mut().zip(offsets) {
            *deficit += share * (speed - velocity_at(plane, x, centre + offset)?[0]);
        }
    }
    Ok(deficits)
}

/// The wake's centre (y, m) at `x` (m), from the profile there alone.
fn centre_at(
    plane: &Plane,
    free_stream: impl Fn(f64) -> f64,
    width: f64,
    x: f64,
) -> Result<f64, AnalysisError> {
    let column: Vec<f32> =
        along_second(plane, x)?.velocities.into_iter().map(|speed| speed as f32).collect();
    let profile = Plane {
        name: plane.name.clone(),
        origin: [x, plane.origin[1], plane.origin[2]],
        n_points: [1, plane.n_points[1]],
        velocity: [column, Vec::new(), Vec::new()],
        ..*plane
    };
    Ok(centre_line(&profile, free_stream, width)?[0][1])
}
