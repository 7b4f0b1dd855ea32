//! The air: prescribed inflow and solvers that feel forces.
//!
//! The air feels point forces, not rotors: nothing here knows what a turbine is.

pub mod fields;
pub mod inflow;
pub mod lattice;
mod numerics;
mod pool;
mod simd;
pub mod vortex;

pub use numerics::numerics;

use basis::{Answer, PointForce, Vector3};
use thiserror::Error;

/// A wind field that can be sampled.
pub trait WindField {
    /// Writes the wind (m/s, farm frame) at each of `positions` (m, farm frame) into `velocities`, of the
    /// same length.
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]);
}

/// A wind field that moves on in time and feels the machines in it.
pub trait FlowSolver: WindField {
    /// Moves the air on by `duration` (s) under `forces`, which act throughout.
    ///
    /// # Errors
    /// [`FlowError::Diverged`] when the field is no longer finite or leaves the speeds that the solver can
    /// carry.
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError>;

    /// Whether sampled velocities already contain the rotors' induction.
    fn resolves_induction(&self) -> bool;

    /// How the wind at the blade elements of `turbine`, its place among the farm's machines, answers to their
    /// circulation within the step ahead; none where the air feels forces alone, or has not met the turbine
    /// yet.
    fn answer(&self, turbine: usize) -> Option<Answer<'_>> {
        let _ = turbine;
        None
    }
}

impl<Field: WindField + ?Sized> WindField for Box<Field> {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        (**self).sample(positions, velocities);
    }
}

impl<Flow: FlowSolver + ?Sized> FlowSolver for Box<Flow> {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        (**self).advance(duration, forces)
    }

    fn resolves_induction(&self) -> bool {
        (**self).resolves_induction()
    }

    fn answer(&self, turbine: usize) -> Option<Answer<'_>> {
        (**self).answer(turbine)
    }
}

/// Wind prescribed everywhere and for all time: what enters a solver's inlet, or is the wind where no flow is
/// resolved.
pub trait Inflow: Send + Sync {
    /// Writes the wind (m/s) at `time` (s) at each of `positions` (m, farm frame) into `velocities`, of the
    /// same length.
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]);

    /// The same for potential temperature (K) into `temperatures`. False, and nothing is written, where it is
    /// not known: the air has the temperature of its height in the atmosphere's profile then.
    fn sample_temperature(
        &self,
        time: f64,
        positions: &[Vector3],
        temperatures: &mut [f64],
    ) -> bool {
        let _ = (time, positions, temperatures);
        false
    }
}

/// Why a solver could not go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FlowError {
    /// The prescribed wind could not be had.
    #[error(transparent)]
    Inflow(#[from] inflow::InflowError),
    /// The field is no longer physical.
    #[error("the flow diverged at {time:.2} s near x {x:.0} m, y {y:.0} m, z {z:.0} m (speed {speed} m/s)", x = position.x, y = position.y, z = position.z, speed = told_speed(*speed))]
    Diverged {
        /// Simulated time (s).
        time: f64,
        /// Where it was noticed first, farm frame (m).
        position: Vector3,
        /// Speed there (m/s), possibly not a number.
        speed: f64,
    },
    /// A rotor turned so far in a step that what its blades leave behind is no helix.
    #[error(
        "a rotor turned by {turn:.0}° in the step up to {time:.2} s, at x {x:.0} m, y {y:.0} m, z {z:.0} m; the maximum is {most:.0}°",
        turn = turn.to_degrees(), most = most.to_degrees(),
        x = position.x, y = position.y, z = position.z
    )]
    TurnedTooFar {
        /// Simulated time at the end of the step (s).
        time: f64,
        /// Middle of the rotor, farm frame (m).
        position: Vector3,
        /// Angle (rad).
        turn: f64,
        /// Greatest angle (rad).
        most: f64,
    },
    /// A duration that is not a whole number of the solver's steps.
    #[error("cannot advance by {duration} s, which is not a whole number of steps of {step} s")]
    FractionalStep {
        /// Duration given (s).
        duration: f64,
        /// Step (s).
        step: f64,
    },
}

/// `speed` (m/s) of air that is no longer physical, in as many digits as say something: it may have forty
/// before the point.
fn told_speed(speed: f64) -> String {
    const MOST_WRITTEN_OUT: f64 = 1e5;
    if speed.abs() < MOST_WRITTEN_OUT { format!("{speed:.1}") } else { format!("{speed:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_that_cannot_be_are_told_in_few_digits() {
        let told = |speed| {
            let position = Vector3::new(1.4, -2.0, 90.0);
            FlowError::Diverged { time: 5.0, position, speed }.to_string()
        };
        for (speed, expected) in [
            (512.345678901234, "(speed 512.3 m/s)"),
            (1.23456789e38, "(speed 1.2e38 m/s)"),
            (f64::INFINITY, "(speed inf m/s)"),
            (f64::NAN, "(speed NaN m/s)"),
        ] {
            let text = told(speed);
            assert!(text.ends_with(expected), "{text}");
        }
    }
}
