//! The frame that turns with a helix: what winds with it stands still there.

use crate::Sense;
use serde::{Deserialize, Serialize};

/// A frame for tilt and yaw components that turns with a helix.
///
/// Source: Chen, van Vondelen, van Wingerden (2026), "Lidar-enhanced closed-loop active helix approach", Wind
/// Energ. Sci. 11, 1871, Eqs. B2 and B3, which are those of a ccw helix; of a cw one the turn is the other
/// way. Time zero is where both frames are one, so that an open helix tilt = A sin(ω t), yaw = ±A cos(ω t)
/// has the constant components 0 and ±A (upper sign: ccw).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixFrame {
    /// Which way the helix winds.
    pub sense: Sense,
    /// Excitation rate ω (rad/s).
    pub rate: f64,
}

impl HelixFrame {
    /// Tilt and yaw components in this frame at `time` (s) of those in the fixed frame.
    pub fn of_fixed(&self, time: f64, fixed: [f64; 2]) -> [f64; 2] {
        turned(self.angle(time), fixed)
    }

    /// Tilt and yaw components in the fixed frame at `time` (s) of those in this frame.
    pub fn to_fixed(&self, time: f64, own: [f64; 2]) -> [f64; 2] {
        turned(-self.angle(time), own)
    }

    /// What an open helix of `amplitude` (any unit) and `phase` (rad) of its tilt at time zero is in this
    /// frame.
    pub fn open_helix(&self, amplitude: f64, phase: f64) -> [f64; 2] {
        let (sine, cosine) = phase.sin_cos();
        match self.sense {
            Sense::CounterClockwise => [amplitude * sine, amplitude * cosine],
            Sense::Clockwise => [amplitude * sine, -amplitude * cosine],
        }
    }

    /// Angle by which the components of the fixed frame are turned (rad), from tilt to yaw.
    fn angle(&self, time: f64) -> f64 {
        match self.sense {
            Sense::CounterClockwise => self.rate * time,
            Sense::Clockwise => -self.rate * time,
        }
    }
}

/// `components` turned by `angle` (rad), the first towards the second.
fn turned(angle: f64, [first, second]: [f64; 2]) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * first - sine * second, sine * first + cosine * second]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_open_helix_stands_still_and_the_way_back_is_exact(
            time in -1e3..1e3_f64, phase in -3.0..3.0_f64, other in prop::array::uniform2(-5.0..5.0_f64),
        ) {
            for sense in [Sense::CounterClockwise, Sense::Clockwise] {
                let frame = HelixFrame { sense, rate: 0.15 };
                let angle = frame.rate * time + phase;
                let fixed = [3.0 * angle.sin(), 3.0 * (angle + sense.yaw_lead()).sin()];
                let (found, expected) = (frame.of_fixed(time, fixed), frame.open_helix(3.0, phase));
                let back = frame.to_fixed(time, frame.of_fixed(time, other));
                for axis in 0..2 {
                    prop_assert!((found[axis] - expected[axis]).abs() < 1e-12);
                    prop_assert!((back[axis] - other[axis]).abs() < 1e-12);
                }
            }
        }
    }
}
