//! What every estimator says alike, whatever it is made of: where the slow swing of tilt and yaw stands now.

use serde::{Deserialize, Serialize};

/// What an estimator finds the swing of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Wind that meets the rotor (m/s), what the rotor's own pitch does to the moments taken off.
    Wind,
    /// Moments at the blade roots (N m) as they are: later than the wind by what blades and wake take, own pitch among them.
    Load,
}

/// Tilt A sin θ and yaw A' sin θ' of a [`Quantity`], each about a middle of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Oscillation {
    /// Of what.
    pub quantity: Quantity,
    /// Rate of both phases (rad/s).
    pub rate: f64,
    /// Phases θ of tilt and θ' of yaw now (rad, [0, 2π)).
    pub phases: [f64; 2],
    /// Amplitudes A of tilt and A' of yaw (m/s or N m).
    pub amplitudes: [f64; 2],
    /// How far the phases can be trusted (–), from 0, not at all, to 1; a loop that locks or does not knows these two alone.
    pub trust: f64,
    /// Whether the last measurements told nothing and the belief went on without them.
    pub held: bool,
}
