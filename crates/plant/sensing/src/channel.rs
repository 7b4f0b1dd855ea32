//! One instrument at work on one quantity.

use crate::instrument::{Instrument, Lag};
use crate::noise::Draw;
use basis::angle::wrap_to_half_turn;
use lti::lag;
use serde::{Deserialize, Serialize};

/// What an instrument remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Channel {
    started: bool,
    /// Truth at the last reading; an angle goes on beyond full turns.
    truth: f64,
    /// What the lag has let through, and its rate (1/s).
    lagged: [f64; 2],
    shown: f64,
}

impl Channel {
    /// What `instrument` shows of `truth` an `interval` (s) after the reading before, with the noise of
    /// `draw`.
    ///
    /// The truth is taken to go straight from reading to reading, and lags are exact for its value in the
    /// middle.
    pub(crate) fn read(
        &mut self,
        instrument: Instrument,
        interval: f64,
        truth: f64,
        draw: Draw,
    ) -> f64 {
        let first = !self.started;
        if first {
            *self = Self { started: true, truth, lagged: [truth, 0.0], shown: truth };
        }
        let input = 0.5 * (self.truth + truth);
        self.truth = truth;
        self.lagged = match instrument.lag {
            Lag::None => [truth, 0.0],
            Lag::First { time_constant } => {
                [lag::first(self.lagged[0], input, interval, time_constant), 0.0]
            }
            Lag::Second { frequency, damping } => {
                lag::second(self.lagged, input, interval, frequency, damping)
            }
        };
        let dropped = !first && draw.uniform() < instrument.dropout;
        if !dropped {
            let shown = self.lagged[0] + instrument.bias + instrument.noise * draw.normal();
            self.shown = if instrument.resolution > 0.0 {
                (shown / instrument.resolution).round() * instrument.resolution
            } else {
                shown
            };
        }
        self.shown
    }

    /// `angle` (rad) on the turn on which the last one stood, or the next: without a step.
    pub(crate) fn unrolled(&self, angle: f64) -> f64 {
        if self.started { self.truth + wrap_to_half_turn(angle - self.truth) } else { angle }
    }
}
