//! The nacelle: where it stands while nothing bends, and the drive that turns it.

use crate::rotor::Frame;
use crate::structure::Yaw;
use basis::Vector3;
use lti::lag::kept;
use serde::{Deserialize, Serialize};

/// Time in which the drive takes up a commanded rate, to 63 % (s): its motors start and stop softly. Without
/// it every start would strike the yaw bearing.
const DRIVE_LAG: f64 = 1.0;

/// Where rotor and nacelle stand while nothing bends and the nacelle faces −x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    /// A point of the axis about which the nacelle turns (m).
    pub(super) axis: Vector3,
    /// The rotor.
    pub(super) rotor: Frame,
    /// Where the nacelle's drag acts (m).
    pub(super) drag: Vector3,
}

impl Facing {
    /// The rotor at a turn of `yaw` (rad), and where the nacelle's drag acts then (m).
    pub(super) fn turned(&self, yaw: f64) -> (Frame, Vector3) {
        let drag = Frame { hub: self.drag, ..self.rotor }.turned(self.axis, yaw).hub;
        (self.rotor.turned(self.axis, yaw), drag)
    }
}

/// Turn of the nacelle, counter-clockwise seen from above.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct NacelleState {
    /// From facing −x (rad).
    pub(super) angle: f64,
    /// Its rate (rad/s).
    pub(super) rate: f64,
}

impl NacelleState {
    /// Advances by `step` (s) under a commanded `rate` (rad/s), which the drive follows with a lag of first
    /// order, exactly for any step; gives the turn in the middle of the step.
    pub(super) fn advance(&mut self, step: f64, rate: f64) -> Yaw {
        let before = *self;
        if rate != 0.0 || before.rate != 0.0 {
            let (missing, kept) = (before.rate - rate, kept(step, DRIVE_LAG));
            self.rate = rate + missing * kept;
            self.angle += rate * step + missing * DRIVE_LAG * (1.0 - kept);
        }
        Yaw {
            angle: 0.5 * (before.angle + self.angle),
            rate: (self.angle - before.angle) / step,
            acceleration: (self.rate - before.rate) / step,
        }
    }

    /// The turn now.
    pub(super) fn now(self) -> Yaw {
        Yaw { angle: self.angle, rate: self.rate, acceleration: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drive_follows_its_rate_by_the_closed_form_of_a_lag() {
        let (rate, step) = (0.3_f64.to_radians(), 0.02);
        let mut nacelle = NacelleState { angle: 0.1, rate: 0.0 };
        for index in 1..=500 {
            nacelle.advance(step, rate);
            let time = f64::from(index) * step;
            let expected = 0.1 + rate * (time - DRIVE_LAG * (1.0 - (-time / DRIVE_LAG).exp()));
            assert!((nacelle.angle - expected).abs() < 1e-12);
        }
        // In one step as in many.
        let mut at_once = NacelleState { angle: 0.1, rate: 0.0 };
        at_once.advance(500.0 * step, rate);
        assert!((at_once.angle - nacelle.angle).abs() < 1e-12);
    }

    #[test]
    fn a_nacelle_at_rest_keeps_every_bit() {
        let mut nacelle = NacelleState { angle: 0.123_456_789, rate: 0.0 };
        let yaw = nacelle.advance(0.02, 0.0);
        assert_eq!(yaw, Yaw { angle: 0.123_456_789, rate: 0.0, acceleration: 0.0 });
        assert_eq!(nacelle.now(), yaw);
    }
}
