//! How cyclic pitch has to be turned so that tilt pitch answers in the tilt moment, and yaw pitch in the yaw moment.

use basis::angle::wrap_to_half_turn;
use serde::{Deserialize, Serialize};

/// What a small helix does to the rotor's moments at one rate.
///
/// With the tilt command a sin θ, and the yaw command a quarter period away as the sense has it, the tilt moment changes by
/// −`gain` a sin(θ + `lead`): pitch to feather unloads.
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
    /// The rotor is taken to be alike in all directions: then moments follow pitch by one complex number per sense,
    /// −G e^(−jδ) (ccw) and −G e^(+jδ) (cw) on tilt + j yaw. An azimuth offset ψ turns pitch by e^(−jψ) and adds to δ of the
    /// one what it takes from the other; a command that runs ahead adds to both. Hence ψ is half the difference of the two
    /// leads, and half their sum is the lag that is left.
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
