//! The multi-blade coordinate transformation between blades and the fixed frame.

use crate::PerBlade;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A quantity of the rotor in the fixed frame, in the unit of the blades' quantity.
///
/// Positive `tilt`: more on the upper rotor half. Positive `yaw`: more at azimuth 90°, which is
/// the right half looking downwind. Source: seed document 000, Eq. 4 and its Fig. 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FixedFrame {
    /// Mean over the blades (collective).
    pub average: f64,
    /// Cosine component.
    pub tilt: f64,
    /// Sine component.
    pub yaw: f64,
}

/// Azimuth (rad, not wrapped) of blade `blade` of `n_blades` when blade 1 stands at `azimuth` (rad).
///
/// Blades are numbered in the order in which they pass the top, blade 2 a blade spacing *ahead*
/// in azimuth, as in the blade numbering ψ_i = ψ + 2π (i−1)/n of seed document 000.
pub fn blade_azimuth(azimuth: f64, blade: usize, n_blades: usize) -> f64 {
    azimuth + TAU * blade as f64 / n_blades as f64
}

/// From blades to the fixed frame, blade 1 at `azimuth` (rad):
/// (2/n) Σ xᵢ {1/2, cos ψᵢ, sin ψᵢ}. Seed document 000, Eq. 4, for any number of blades ≥ 3.
pub fn to_fixed_frame(azimuth: f64, blades: &PerBlade<f64>) -> FixedFrame {
    let n_blades = blades.len();
    let scale = 2.0 / n_blades as f64;
    let mut fixed = FixedFrame::default();
    for (blade, value) in blades.iter().enumerate() {
        let (sine, cosine) = blade_azimuth(azimuth, blade, n_blades).sin_cos();
        fixed.average += scale * 0.5 * value;
        fixed.tilt += scale * cosine * value;
        fixed.yaw += scale * sine * value;
    }
    fixed
}

/// From the fixed frame to `n_blades` blades: average + tilt cos ψᵢ + yaw sin ψᵢ.
///
/// The azimuth offset of seed document 000, Eq. 1, is added to `azimuth` (rad) by the caller.
pub fn to_blades(azimuth: f64, fixed: FixedFrame, n_blades: usize) -> PerBlade<f64> {
    PerBlade::from_fn(n_blades, |blade| {
        let (sine, cosine) = blade_azimuth(azimuth, blade, n_blades).sin_cos();
        fixed.average + fixed.tilt * cosine + fixed.yaw * sine
    })
}
