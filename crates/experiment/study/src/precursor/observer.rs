//! Observing a precursor.

use super::cost::PrecursorEstimate;
use formats::records::Drift;

/// How far a precursor is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecursorProgress {
    /// Steps made (–).
    pub step: u64,
    /// Steps in all (–).
    pub n_steps: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Whether planes are recorded by now.
    pub records: bool,
    /// Cell updates a second since this process took it up (1/s).
    pub updates_per_second: f64,
    /// Wall time left (s).
    pub time_left: f64,
    /// Speed at hub height (m/s), as of the latest statistics.
    pub hub_speed: f64,
    /// Friction velocity (m/s), likewise.
    pub friction_velocity: f64,
}

/// Observes a precursor; every method may be left out.
pub trait PrecursorObserver {
    /// The cost, before the first step.
    fn estimated(&mut self, _estimate: &PrecursorEstimate) {}
    /// It moved on.
    fn advanced(&mut self, _progress: &PrecursorProgress) {}
    /// The spin-up is over, in whose end statistics changed by `drift`; the wind at hub height comes from
    /// `direction` (deg, clockwise from north), across which planes are recorded now.
    fn spun_up(&mut self, _drift: Option<&Drift>, _direction: f64) {}
    /// Something that a reader of the numbers must know.
    fn warned(&mut self, _warning: &str) {}
}

impl PrecursorObserver for crate::Silent {}
