//! The common part of every estimate: phase, rate and amplitude of the slow oscillation of tilt and yaw.

use serde::{Deserialize, Serialize};

/// The oscillating quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Wind at the rotor (m/s); the effect of the rotor's own pitch on the moments is removed.
    Wind,
    /// Moments at the blade roots (N m) as measured: with the lag of blades and wake, and with the effect of
    /// the rotor's own pitch.
    Load,
}

/// Tilt A sin θ and yaw A' sin θ' of a [`Quantity`], each about an offset of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Oscillation {
    /// The oscillating quantity.
    pub quantity: Quantity,
    /// Rate of both phases (rad/s).
    pub rate: f64,
    /// Phases θ of tilt and θ' of yaw now (rad, [0, 2π)).
    pub phases: [f64; 2],
    /// Amplitudes A of tilt and A' of yaw (m/s or N m).
    pub amplitudes: [f64; 2],
    /// Confidence in the phases (–), from 0 to 1; a phase-locked loop gives 1 in lock and 0 otherwise.
    pub trust: f64,
    /// Whether the last measurements were unusable and the estimate was only predicted.
    pub held: bool,
}
