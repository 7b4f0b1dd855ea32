//! Wake steering: the nacelle turns out of the wind, so that the wake passes beside the turbines behind.

mod kind;

pub use kind::STEERING;

use crate::excitation::Excitation;
use basis::{Measurements, PerBlade};
use serde::{Deserialize, Serialize};

/// Time in which what is left of the turn would be made at the commanded rate, once that is below the limit
/// (s): the nacelle comes to rest softly, several times slower than its drive takes up a rate.
const APPROACH: f64 = 5.0;

/// Steering as it runs on one turbine: a turn of the nacelle at a limited rate. It pitches nothing, so that
/// what pitches may go on top of it.
///
/// It has no state: what is left to turn follows from the measured yaw.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Steering {
    /// Turn from facing the mean wind that is aimed at, counter-clockwise seen from above (rad).
    pub yaw: f64,
    /// Greatest rate of the turn (rad/s).
    pub maximum_rate: f64,
    /// Time from which it turns (s).
    pub start: f64,
}

impl Excitation for Steering {
    fn add_to(&mut self, _pitch: &mut PerBlade<f64>, _measurements: &Measurements) {}

    fn yaw_rate(&self, measurements: &Measurements) -> f64 {
        if measurements.time < self.start {
            return 0.0;
        }
        let rate = (self.yaw - measurements.yaw) / APPROACH;
        rate.max(-self.maximum_rate).min(self.maximum_rate)
    }

    fn describe(&self) -> String {
        format!("steering {:+.1}°", self.yaw.to_degrees())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEERING: Steering = Steering { yaw: 0.35, maximum_rate: 0.005, start: 60.0 };

    /// Yaw at the end of each of `n_steps` steps of `interval` (s), whose drive lags by a second.
    fn turned(steering: &Steering, interval: f64, n_steps: u32) -> Vec<f64> {
        let (mut yaw, mut rate) = (0.0, 0.0);
        (0..n_steps)
            .map(|step| {
                let time = f64::from(step) * interval;
                let measured = Measurements { time, interval, yaw, ..Measurements::at_rest(3) };
                rate += (steering.yaw_rate(&measured) - rate) * (1.0 - (-interval).exp());
                yaw += rate * interval;
                yaw
            })
            .collect()
    }

    #[test]
    fn the_nacelle_turns_at_its_limit_and_stays_where_it_is_aimed() {
        for interval in [0.02, 0.5] {
            let n = |time: f64| (time / interval) as usize;
            for sign in [1.0, -1.0] {
                let steering = Steering { yaw: sign * STEERING.yaw, ..STEERING };
                let yaw = turned(&steering, interval, (200.0 / interval) as u32);
                assert!(yaw[..n(60.0)].iter().all(|yaw| *yaw == 0.0), "it waits for its start");
                let rate = (yaw[n(110.0)] - yaw[n(80.0)]) / 30.0;
                assert!((rate - sign * 0.005).abs() < 1e-4, "{rate}");
                let last = yaw[yaw.len() - 1];
                assert!((last - steering.yaw).abs() < 1e-4, "{last}");
                assert!(yaw.iter().all(|yaw| yaw.abs() < 0.35 + 1e-6), "it never turns too far");
            }
        }
    }

    #[test]
    fn a_yaw_that_is_no_number_asks_for_no_more_than_the_limit() {
        let lost = Measurements { time: 90.0, yaw: f64::NAN, ..Measurements::at_rest(3) };
        assert!(STEERING.yaw_rate(&lost).abs() <= STEERING.maximum_rate);
    }
}
