//! Prescribed wind as a flow: the rotors do not change it.

mod window;

use super::{InflowError, PlaneGrid, Planes};
use crate::{FlowError, FlowSolver, Inflow, WindField};
use basis::{PointForce, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use window::Window;

/// Wind that does not feel the rotors: their induction is left to whoever samples it.
///
/// Over planes: wind at x, y, z and time t is that of the planes at time t − (x − `origin_x`)/U, linear in
/// time and bilinear in y and z, as other programs of the field read their planes. Outside the grid along y
/// and z the wind of its edge blows; ask [`covers`](Self::covers) before the run.
pub struct PrescribedWind {
    source: Source,
    clock: Clock,
}

enum Source {
    Everywhere(Arc<dyn Inflow>),
    Planes(Window),
}

/// How planes are laid into the farm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where the first plane stands at time zero (m along x). Upwind of it at that time stand the next
    /// planes. OpenFAST's InflowWind has 0 for records that repeat, and half the width of the grid for those
    /// that do not.
    pub origin_x: f64,
    /// Shift of the grid along y (m): where its middle comes to lie, given that it was at 0.
    pub shift_y: f64,
    /// Least and greatest x (m) at which the wind will be sampled; planes between them stay in memory.
    pub extent: [f64; 2],
}

/// Time as a count of equal steps, so that long runs do not drift.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Time (s) when the present duration of steps began.
    since: f64,
    /// Steps since.
    n_steps: u64,
    /// Their duration (s).
    interval: f64,
}

impl Clock {
    /// Time (s).
    pub fn time(&self) -> f64 {
        self.since + self.n_steps as f64 * self.interval
    }

    /// The same in bytes, little-endian: time of the first step, steps, their duration.
    pub fn to_bytes(self) -> [u8; 24] {
        let words = [self.since.to_bits(), self.n_steps, self.interval.to_bits()];
        let mut bytes = [0; 24];
        for (place, word) in bytes.chunks_exact_mut(8).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    /// The clock that [`to_bytes`](Self::to_bytes) wrote.
    pub fn from_bytes(bytes: [u8; 24]) -> Self {
        let (words, _) = bytes.as_chunks::<8>();
        let [since, n_steps, interval] = [0, 1, 2].map(|index| u64::from_le_bytes(words[index]));
        Self { since: f64::from_bits(since), n_steps, interval: f64::from_bits(interval) }
    }

    fn advance(&mut self, duration: f64) {
        if duration != self.interval {
            *self = Self { since: self.time(), n_steps: 0, interval: duration };
        }
        self.n_steps += 1;
    }
}

impl PrescribedWind {
    /// `inflow`, which is known everywhere and for all time.
    pub fn everywhere(inflow: Arc<dyn Inflow>) -> Self {
        Self { source: Source::Everywhere(inflow), clock: Clock::default() }
    }

    /// `planes`, of which no more are held than `placement` needs.
    ///
    /// # Errors
    /// [`InflowError`] when the grid makes no sense, the planes in between take more memory than there is, or
    /// the first ones cannot be had.
    pub fn over_planes(planes: Box<dyn Planes>, placement: Placement) -> Result<Self, InflowError> {
        let window = Window::new(planes, placement)?;
        Ok(Self { source: Source::Planes(window), clock: Clock::default() })
    }

    /// Whether the wind is known all over the box between the corners `lowest` and `highest` (m, farm frame)
    /// for `duration` (s) from the start. Below the grid's lowest row is no objection: the ground is there,
    /// and the row's wind stands in.
    ///
    /// # Errors
    /// [`InflowError::Outside`] or [`InflowError::Ended`] says what is missing.
    pub fn covers(
        &self,
        lowest: Vector3,
        highest: Vector3,
        duration: f64,
    ) -> Result<(), InflowError> {
        match &self.source {
            Source::Everywhere(_) => Ok(()),
            Source::Planes(window) => window.covers(lowest, highest, duration),
        }
    }

    /// The grid of the planes in the farm frame, shifted as placed; none where the wind is known everywhere.
    pub fn grid(&self) -> Option<PlaneGrid> {
        match &self.source {
            Source::Everywhere(_) => None,
            Source::Planes(window) => Some(window.grid()),
        }
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// All that must be kept to go on from here: planes are read again.
    pub fn state(&self) -> Clock {
        self.clock
    }

    /// On return the wind is where it was when `state` was taken of this wind or of one made alike.
    ///
    /// # Errors
    /// [`InflowError`] when planes cannot be had; then nothing is restored.
    pub fn restore(&mut self, state: Clock) -> Result<(), InflowError> {
        if let Source::Planes(window) = &mut self.source {
            window.load(state.time())?;
        }
        self.clock = state;
        Ok(())
    }
}

impl WindField for PrescribedWind {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        match &self.source {
            Source::Everywhere(inflow) => inflow.sample(self.time(), positions, velocities),
            Source::Planes(window) => window.sample(positions, velocities),
        }
    }
}

impl FlowSolver for PrescribedWind {
    /// Forces leave no trace: prescribed wind does not feel them.
    fn advance(&mut self, duration: f64, _forces: &[PointForce]) -> Result<(), FlowError> {
        let mut clock = self.clock;
        clock.advance(duration);
        self.restore(clock)?;
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        false
    }
}

#[cfg(test)]
#[path = "prescribed_tests.rs"]
mod tests;
