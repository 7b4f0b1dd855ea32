//! Skewed wake: more induction on the downwind side of the rotor, less on the upwind side.
//!
//! Source: Pitt and Peters, "Theoretical prediction of dynamic-inflow derivatives", Vertica 5, 1981; with the
//! wake's angle χ = (1 + 0.6 a) γ of Burton et al., "Wind energy handbook", 2nd ed., eq. 3.110, and the
//! factor 15π/32, as AeroDyn uses it: Moriarty, Hansen, "AeroDyn theory manual", NREL/TP-500-36881, 2005, eq.
//! 23.

use basis::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Growth of the correction with tan(χ/2) (–).
const FACTOR: f64 = 15.0 * PI / 32.0;

/// Change of induction over the rotor, linear across it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SkewedWake {
    /// Relative change of the axial induction per metre, in the rotor plane, towards the downwind side (1/m).
    gradient: Vector3,
}

impl SkewedWake {
    /// Wake of a rotor of `rotor_radius` (m) about the unit vector `shaft`, downwind, in `mean_wind` (m/s),
    /// with a mean axial induction of `mean_induction` (–).
    pub fn new(mean_wind: Vector3, shaft: Vector3, mean_induction: f64, rotor_radius: f64) -> Self {
        let axial = mean_wind.dot(shaft);
        let in_plane = mean_wind - shaft * axial;
        let across = in_plane.length();
        if across == 0.0 {
            return Self::default();
        }
        let angle = (1.0 + 0.6 * mean_induction) * across.atan2(axial);
        let slope = FACTOR * (0.5 * angle.clamp(0.0, FRAC_PI_2)).tan();
        Self { gradient: in_plane * (slope / (across * rotor_radius)) }
    }

    /// Axial induction over that without skew (–) at `position` (m), counted from the hub; never below zero.
    pub fn factor(&self, position: Vector3) -> f64 {
        1.0 + self.gradient.dot(position).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_correction_is_antisymmetric_and_vanishes_on_average() {
        let wind = Vector3::new(9.0, 2.0, -0.5);
        let wake = SkewedWake::new(wind, Vector3::X, 0.3, 60.0);
        let (mut sum, mut largest) = (0.0, 0.0_f64);
        for k in 0..360 {
            let azimuth = f64::from(k).to_radians();
            let position = Vector3::new(-1.0, -azimuth.sin(), azimuth.cos()) * 45.0;
            let factor = wake.factor(position);
            let opposite = wake.factor(Vector3::new(-45.0, -position.y, -position.z));
            assert!((factor + opposite - 2.0).abs() < 1e-12);
            sum += factor - 1.0;
            largest = largest.max(factor - 1.0);
        }
        assert!(sum.abs() < 1e-9);
        // Closed form at the downwind side.
        let skew = 4.25f64.sqrt().atan2(9.0);
        let expected = FACTOR * (0.5 * 1.18 * skew).tan() * 45.0 / 60.0;
        assert!((largest / expected - 1.0).abs() < 1e-3, "{largest} {expected}");
    }

    #[test]
    fn induction_grows_on_the_downwind_side() {
        // The upwind end of the shaft is raised: the wind drifts up along the rotor plane.
        let tilt: f64 = 0.1;
        let shaft = Vector3::new(tilt.cos(), 0.0, -tilt.sin());
        let wake = SkewedWake::new(Vector3::X * 10.0, shaft, 0.3, 60.0);
        assert!(wake.factor(Vector3::Z * 50.0) > 1.0 && wake.factor(Vector3::Z * -50.0) < 1.0);
        assert_eq!(SkewedWake::new(Vector3::X, Vector3::X, 0.3, 60.0), SkewedWake::default());
        let behind = SkewedWake::new(-Vector3::X + Vector3::Y, Vector3::X, 0.3, 60.0);
        assert!(
            behind.factor(Vector3::Y * 60.0) <= 2.0 && behind.factor(Vector3::Y * -60.0) >= 0.0
        );
    }
}
