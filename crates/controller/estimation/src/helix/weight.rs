//! Root moments by gravity and centrifugal force: the same on all blades, and so equivalent to a change of
//! the mean wind.
//!
//! The shaft is tilted, so that gravity has a component along it; the blades are coned and prebent upwind, so
//! that centrifugal force straightens them. On a rotor of 15 MW both together are a fifth of the aerodynamic
//! moment.
//!
//! ```text
//! M = g sin τ ∫ μ s ds + Ω² ∫ μ r x ds   μ mass per length, s span from the root, r distance from the shaft
//!                                        x distance upwind of the root, τ tilt of the shaft, Ω rotor speed
//! ```
//!
//! The part of gravity that varies once per revolution is a constant tilt or yaw of the moments, for which
//! the filter has states.

use super::flap::{between, mass_at};
use turbine::Definition;
use turbine::structure::GRAVITY;

/// Points of the integrals over a blade (–).
const N_POINTS: usize = 200;

/// Integrals of a blade.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weight {
    /// Moment of gravity (N m).
    still: f64,
    /// Moment of centrifugal force over the square of the rotor speed (kg m²).
    turning: f64,
}

impl Weight {
    pub(super) fn new(definition: &Definition) -> Self {
        let length = definition.blade_length();
        let (sine, cosine) = definition.rotor.precone.sin_cos();
        let width = length / N_POINTS as f64;
        let (mut still, mut turning) = (0.0, 0.0);
        for point in 0..N_POINTS {
            let span = length * (point as f64 + 0.5) / N_POINTS as f64;
            let prebend = between(definition.blade.iter().map(|row| (row.span, row.prebend)), span);
            let mass = width * mass_at(definition, span);
            let radius =
                definition.distance_from_shaft(definition.rotor.hub_radius + span, prebend);
            still += mass * span;
            turning += mass * radius * (span * sine + prebend * cosine);
        }
        Self { still: GRAVITY * definition.rotor.shaft_tilt.sin() * still, turning }
    }

    /// Moment at each blade's root (N m), positive downwind, at `rotor_speed` (rad/s).
    pub(super) fn moment(&self, rotor_speed: f64) -> f64 {
        self.still + rotor_speed * rotor_speed * self.turning
    }
}
