//! Which instants and measurements can be used.

use super::filter::Readings;
use basis::{Measurements, PerBlade};
use serde::{Deserialize, Serialize};

/// Share of the rated rotor speed below which the model is not valid (–).
const LEAST_SPEED: f64 = 0.2;

/// Share of the nominal interval below which an instant counts as repeated (–).
const LEAST_INTERVAL: f64 = 1e-3;
/// Longest interval of one prediction (s).
const LONGEST_INTERVAL: f64 = 3600.0;

/// State of the clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Clock {
    /// Time of the last update (s); none before the first.
    last: Option<f64>,
    /// Moments at the last control instant (N m): a reading that repeats to the last bit comes from a stuck
    /// instrument.
    moments: PerBlade<f64>,
    /// Control instants since the last update (–).
    waited: usize,
}

/// What an instant can be used for.
pub(super) enum Use {
    /// Nothing: no time has passed, or the next update is not yet due.
    Nothing,
    /// Prediction alone over the interval (s): the state of the rotor is not known.
    Blind(f64),
    /// Prediction over the interval (s) since the last update, and correction by the usable moments.
    Seen(f64, Readings),
}

impl Clock {
    pub(super) fn new(n_blades: usize) -> Self {
        Self { last: None, moments: PerBlade::splat(n_blades, 0.0), waited: 0 }
    }

    /// What `measurements` can be used for; updates are due at every `every`-th control instant, a `nominal`
    /// interval (s) apart, on a rotor with rated speed `rated_speed` (rad/s).
    pub(super) fn look(
        &mut self,
        measurements: &Measurements,
        every: usize,
        nominal: f64,
        rated_speed: f64,
    ) -> Use {
        let n_blades = self.moments.len();
        let readings = PerBlade::from_fn(n_blades, |blade| {
            let reading = measurements.flap_moments.get(blade).copied().unwrap_or(f64::NAN);
            if !reading.is_finite() || reading == self.moments[blade] {
                return None;
            }
            self.moments[blade] = reading;
            Some(reading)
        });
        let Measurements { time, azimuth, rotor_speed, pitch, .. } = measurements;
        if !time.is_finite() {
            return Use::Nothing;
        }
        self.waited += 1;
        let interval = match self.last {
            None => nominal * every as f64,
            Some(last) if time - last < LEAST_INTERVAL * nominal => return Use::Nothing,
            Some(_) if self.waited < every => return Use::Nothing,
            Some(last) => (time - last).min(LONGEST_INTERVAL),
        };
        self.waited = 0;
        self.last = Some(*time);
        let known = azimuth.is_finite()
            && *rotor_speed > LEAST_SPEED * rated_speed
            && rotor_speed.is_finite()
            && pitch.len() == n_blades
            && pitch.iter().all(|pitch| pitch.is_finite());
        if known { Use::Seen(interval, readings) } else { Use::Blind(interval) }
    }
}
