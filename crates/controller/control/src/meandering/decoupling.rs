//! How cyclic pitch has to be turned so that tilt pitch answers in the tilt moment, and yaw pitch in the yaw
//! moment.

use basis::angle::wrap_to_half_turn;
use serde::{Deserialize, Serialize};

/// What a small helix does to the rotor's moments at one rate.
///
/// With the tilt command a sin θ, and the yaw command a quarter period away as the sense has it, the tilt
/// moment changes by −`gain` a sin(θ + `lead`): pitch to feather unloads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Moment lost per pitch (N m/rad).
    pub gain: f64,
    /// Lead of the loss over the pitch (rad), negative where it lags.
    pub lead: f64,
}

/// Pitch in the fixed frame, turned so that each axis answers for itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decoupling {
    /// Azimuth offset of the inverse multi-blade transformation (rad).
    pub azimuth_offset: f64,
    /// Time by which commands run ahead (s): what the load lags behind the pitch in the fixed frame.
    pub delay: f64,
    /// Moment lost per pitch (N m/rad), the same on both axes.
    pub gain: f64,
}

impl Decoupling {
    /// From what a counter-clockwise and a clockwise helix do at `rate` (rad/s).
    ///
    /// The rotor is taken to be alike in all directions: then moments follow pitch by one complex number per
    /// sense, −G e^(−jδ) (ccw) and −G e^(+jδ) (cw) on tilt + j yaw. An azimuth offset ψ turns pitch by
    /// e^(−jψ) and adds to δ of the one what it takes from the other; a command that runs ahead adds to both.
    /// Hence ψ is half the difference of the two leads, and half their sum is the lag that is left.
    pub fn from_senses(rate: f64, counter_clockwise: Answer, clockwise: Answer) -> Self {
        let difference = wrap_to_half_turn(clockwise.lead - counter_clockwise.lead);
        let middle = counter_clockwise.lead + 0.5 * difference;
        Self {
            azimuth_offset: 0.5 * difference,
            delay: -wrap_to_half_turn(middle) / rate,
            gain: 0.5 * (counter_clockwise.gain + clockwise.gain),
        }
    }
}

/// Element of the relative gain array (–) that pairs tilt pitch with the tilt moment, and yaw with yaw, when
/// the inverse multi-blade transformation has `azimuth_offset` (rad), from what either sense does; its real
/// part.
///
/// 1 where each axis answers for itself alone, 1/2 where both answer both, 0 where tilt pitch moves only the
/// yaw moment. For a rotor alike in all directions moments follow pitch by [[a, −b], [b, a]], of which
/// helices see a ∓ jb; the element is a² / (a² + b²). It cannot become 1 by any offset where the two senses
/// gain differently.
///
/// Source: Bristol, "On a new measure of interaction for multivariable process control", IEEE Trans. Autom.
/// Control 11, 1966.
pub fn relative_gain(counter_clockwise: Answer, clockwise: Answer, azimuth_offset: f64) -> f64 {
    let apart = 0.5 * wrap_to_half_turn(clockwise.lead - counter_clockwise.lead) - azimuth_offset;
    let (one, other) = (counter_clockwise.gain, clockwise.gain);
    let (sine, cosine) = apart.sin_cos();
    (((one + other) * cosine).powi(2) - ((other - one) * sine).powi(2)) / (4.0 * one * other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    #[test]
    fn the_offset_of_the_two_senses_makes_the_relative_gain_one() {
        let ccw = Answer { gain: 2.0, lead: -0.9 };
        let cw = Answer { gain: 2.0, lead: 0.1 };
        let found = Decoupling::from_senses(0.07, ccw, cw);
        assert!((found.azimuth_offset - 0.5).abs() < 1e-12, "{found:?}");
        assert!((relative_gain(ccw, cw, found.azimuth_offset) - 1.0).abs() < 1e-12);
        assert!((relative_gain(ccw, cw, 0.0) - 0.5f64.cos().powi(2)).abs() < 1e-12);
        let half = relative_gain(ccw, cw, found.azimuth_offset + FRAC_PI_4);
        assert!((half - 0.5).abs() < 1e-12, "{half}");
        // Gains of 3 and 1: (4)² / (4 · 3).
        let uneven = relative_gain(Answer { gain: 3.0, ..ccw }, Answer { gain: 1.0, ..cw }, 0.5);
        assert!((uneven - 4.0 / 3.0).abs() < 1e-12, "{uneven}");
    }
}
