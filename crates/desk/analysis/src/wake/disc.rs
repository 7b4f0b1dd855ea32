//! Averages over a rotor's disc.

use super::{expect_axes, velocity_at};
use crate::AnalysisError;
use basis::records::{Plane, PlaneAxes};
use std::f64::consts::TAU;

/// Rings and points per ring of the quadrature; every point stands for the same area.
const N_RINGS: usize = 32;
const N_POINTS_PER_RING: usize = 72;

/// Streamwise velocity over a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Mean (m/s).
    pub mean: f64,
    /// Speed of the uniform wind that carries the same energy through the disc, (∫ u³ dA / A)^{1/3} (m/s).
    pub rotor_equivalent: f64,
}

/// Streamwise velocity over the disc of `radius` (m) around `centre` (y and z, farm frame, m) in a crosswind
/// `plane`.
///
/// Midpoint rule over rings of equal area, bilinear between the plane's points.
/// Source of the rotor-equivalent speed: IEC 61400-12-1:2017, Annex Q, without veer.
///
/// # Errors
/// [`AnalysisError::WrongPlane`] unless the plane lies across the wind, [`AnalysisError::OutsidePlane`] where
/// the disc reaches beyond it.
pub fn disc_average(plane: &Plane, centre: [f64; 2], radius: f64) -> Result<Disc, AnalysisError> {
    expect_axes(plane, &[PlaneAxes::Crosswind], "one across the wind")?;
    let (mut sum, mut cubes) = (0.0, 0.0);
    for ring in 0..N_RINGS {
        let distance = radius * ((ring as f64 + 0.5) / N_RINGS as f64).sqrt();
        for point in 0..N_POINTS_PER_RING {
            let angle = TAU * (point as f64 + 0.5) / N_POINTS_PER_RING as f64;
            let (y, z) = (centre[0] + distance * angle.cos(), centre[1] + distance * angle.sin());
            let u = velocity_at(plane, y, z)?[0];
            sum += u;
            cubes += u.powi(3);
        }
    }
    let n_points = (N_RINGS * N_POINTS_PER_RING) as f64;
    Ok(Disc { mean: sum / n_points, rotor_equivalent: (cubes / n_points).cbrt() })
}
