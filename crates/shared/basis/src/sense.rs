//! Which way a helix winds.

use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// Which way the helix winds, defined by the frequency in the blade's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sense {
    /// Clockwise: blades pitch at rotor minus excitation frequency.
    #[serde(rename = "cw")]
    Clockwise,
    /// Counter-clockwise: blades pitch at rotor plus excitation frequency.
    #[serde(rename = "ccw")]
    CounterClockwise,
}

impl Sense {
    /// Lead of the yaw component over the tilt component (rad): π/2 for ccw, −π/2 for cw.
    pub fn yaw_lead(self) -> f64 {
        match self {
            Self::Clockwise => -FRAC_PI_2,
            Self::CounterClockwise => FRAC_PI_2,
        }
    }
}

impl fmt::Display for Sense {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Clockwise => "cw",
            Self::CounterClockwise => "ccw",
        })
    }
}
