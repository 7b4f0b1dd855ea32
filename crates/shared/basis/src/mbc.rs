//! The multi-blade coordinate transformation between blades and the fixed frame.

use crate::PerBlade;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A quantity of the rotor in the fixed frame, in the unit of the blades' quantity.
///
/// Positive `tilt`: more on the upper rotor half. Positive `yaw`: more at azimuth 90°, which is
/// the right half looking downwind. Source: van Vondelen et al. (2025), Eq. 4 and its Fig. 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FixedFrame {
    /// Mean over the blades, collective (unit of the blades' quantity).
    pub average: f64,
    /// Cosine component (unit of the blades' quantity).
    pub tilt: f64,
    /// Sine component (unit of the blades' quantity).
    pub yaw: f64,
}

/// Azimuth (rad, not wrapped) of blade `blade` of `n_blades` when blade 1 stands at `azimuth` (rad).
///
/// Blades are numbered in the order in which they pass the top, blade 2 a blade spacing *ahead*
/// in azimuth, as in the blade numbering ψ_i = ψ + 2π (i−1)/n of van Vondelen et al. (2025).
pub fn blade_azimuth(azimuth: f64, blade: usize, n_blades: usize) -> f64 {
    azimuth + TAU * blade as f64 / n_blades as f64
}

/// From blades to the fixed frame, blade 1 at `azimuth` (rad):
/// (2/n) Σ xᵢ {1/2, cos ψᵢ, sin ψᵢ}. van Vondelen et al. (2025), Eq. 4, for any number of blades ≥ 3.
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
/// The azimuth offset of van Vondelen et al. (2025), Eq. 1, is added to `azimuth` (rad) by the caller.
pub fn to_blades(azimuth: f64, fixed: FixedFrame, n_blades: usize) -> PerBlade<f64> {
    PerBlade::from_fn(n_blades, |blade| {
        let (sine, cosine) = blade_azimuth(azimuth, blade, n_blades).sin_cos();
        fixed.average + fixed.tilt * cosine + fixed.yaw * sine
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: FixedFrame, b: FixedFrame) -> bool {
        [a.average - b.average, a.tilt - b.tilt, a.yaw - b.yaw].iter().all(|d| d.abs() < 1e-12)
    }

    proptest! {
        #[test]
        fn forward_after_inverse_is_the_identity(
            azimuth in -20.0..20.0_f64, average in -1.0..1.0_f64, tilt in -1.0..1.0_f64,
            yaw in -1.0..1.0_f64, n_blades in 3_usize..=6,
        ) {
            let fixed = FixedFrame { average, tilt, yaw };
            let back = to_fixed_frame(azimuth, &to_blades(azimuth, fixed, n_blades));
            prop_assert!(close(back, fixed));
        }

        /// With three blades nothing is lost the other way round either.
        #[test]
        fn inverse_after_forward_is_the_identity_for_three_blades(
            azimuth in -20.0..20.0_f64, values in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let blades = PerBlade::from_fn(3, |blade| values[blade]);
            let back = to_blades(azimuth, to_fixed_frame(azimuth, &blades), 3);
            for (value, back) in values.iter().zip(back.iter()) {
                prop_assert!((value - back).abs() < 1e-12);
            }
        }

        /// Renumbering the blades, a blade spacing further on, changes nothing.
        #[test]
        fn which_blade_is_the_first_does_not_matter(
            azimuth in -20.0..20.0_f64, n_blades in 3_usize..=6, seed in 0.0..1.0_f64,
        ) {
            let value = |blade: usize| (37.0 * (seed + blade as f64)).sin();
            let blades = PerBlade::from_fn(n_blades, value);
            let renumbered = PerBlade::from_fn(n_blades, |blade| value((blade + 1) % n_blades));
            let azimuth_of_second = blade_azimuth(azimuth, 1, n_blades);
            prop_assert!(close(
                to_fixed_frame(azimuth, &blades),
                to_fixed_frame(azimuth_of_second, &renumbered)
            ));
        }
    }

    /// A blade that stands up feels positive tilt, one that points to azimuth 90° positive yaw.
    #[test]
    fn signs_are_those_of_the_convention() {
        let quarter = TAU / 4.0;
        let tilt = FixedFrame { tilt: 1.0, ..FixedFrame::default() };
        assert!((to_blades(0.0, tilt, 3)[0] - 1.0).abs() < 1e-15);
        assert!(to_blades(quarter, tilt, 3)[0].abs() < 1e-15);
        let yaw = FixedFrame { yaw: 1.0, ..FixedFrame::default() };
        assert!((to_blades(quarter, yaw, 3)[0] - 1.0).abs() < 1e-15);
        let only_upper = PerBlade::from_fn(4, |blade| if blade == 0 { 1.0 } else { 0.0 });
        let fixed = to_fixed_frame(0.0, &only_upper);
        assert!((fixed.tilt - 0.5).abs() < 1e-15 && fixed.yaw.abs() < 1e-15);
        assert!((fixed.average - 0.25).abs() < 1e-15);
    }
}
