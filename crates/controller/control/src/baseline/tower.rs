//! Tower damping: collective pitch against the motion of the tower top.

use super::bounded;
use super::constants::TowerDamping;
use lti::LowPass;
use serde::{Deserialize, Serialize};

/// State of the tower damper.
///
/// Acceleration is integrated to velocity and pitch follows velocity: a tower top that moves downwind meets
/// more pitch, so less thrust. What is slower than the corner is forgotten, twice: once from the
/// acceleration, whose offset is an instrument's, and once from the velocity, which would otherwise keep what
/// the first let through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TowerDamper {
    offset: LowPass,
    /// Velocity downwind (m/s).
    velocity: f64,
}

impl TowerDamper {
    /// A damper at rest under `acceleration` (m/s²), which it takes for the instrument's offset.
    pub(super) fn settled(acceleration: f64, constants: &TowerDamping) -> Self {
        let offset = if acceleration.is_finite() { acceleration } else { 0.0 };
        Self { offset: LowPass::settled(constants.high_pass_corner, offset), velocity: 0.0 }
    }

    /// Pitch to add (rad) after `interval` (s), at whose end the tower top's `acceleration` (m/s²) downwind
    /// is measured.
    pub(super) fn update(
        &mut self,
        interval: f64,
        acceleration: f64,
        constants: &TowerDamping,
    ) -> f64 {
        if acceleration.is_finite() {
            let rest = acceleration - self.offset.update(interval, acceleration);
            let kept = (-constants.high_pass_corner * interval).exp();
            self.velocity = kept * self.velocity + interval * rest;
        }
        bounded(constants.gain * self.velocity, -constants.limit, constants.limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: TowerDamping = TowerDamping { gain: 0.05, high_pass_corner: 0.1, limit: 0.05 };

    #[test]
    fn pitch_follows_velocity_at_the_towers_frequency() {
        let (rate, interval) = (1.6, 0.05);
        let mut damper = TowerDamper::settled(0.0, &CONSTANTS);
        let (mut with, mut power) = (0.0, 0.0);
        for step in 0..8000 {
            let phase = rate * interval * f64::from(step);
            let pitch = damper.update(interval, rate * 0.2 * phase.cos(), &CONSTANTS);
            if step > 4000 {
                with += pitch * 0.2 * phase.sin();
                power += (0.2 * phase.sin()).powi(2);
            }
        }
        assert!((with / power / CONSTANTS.gain - 1.0).abs() < 0.02, "{}", with / power);
    }

    #[test]
    fn an_offset_of_the_instrument_is_forgotten() {
        let mut damper = TowerDamper::settled(0.0, &CONSTANTS);
        let mut pitch = 0.0;
        for _ in 0..4000 {
            pitch = damper.update(0.05, 0.3, &CONSTANTS);
        }
        assert!(pitch.abs() < 1e-6, "{pitch}");
        assert_eq!(TowerDamper::settled(0.3, &CONSTANTS).update(0.05, 0.3, &CONSTANTS), 0.0);
    }

    #[test]
    fn no_more_than_its_limit() {
        let mut damper = TowerDamper::settled(0.0, &CONSTANTS);
        let most = (0..100).map(|_| damper.update(0.05, 9.0, &CONSTANTS)).fold(0.0, f64::max);
        assert_eq!(most, CONSTANTS.limit);
        assert!(damper.update(0.05, f64::NAN, &CONSTANTS).is_finite());
    }
}
