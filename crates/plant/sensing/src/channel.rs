//! One instrument at work on one quantity.

use crate::instrument::{Instrument, Lag};
use crate::noise::Draw;
use basis::angle::wrap_to_half_turn;
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
    /// What `instrument` shows of `truth` an `interval` (s) after the reading before, with the noise of `draw`.
    ///
    /// The truth is taken to go straight from reading to reading, and lags are exact for its value in the middle.
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
                let kept = (-interval / time_constant).exp();
                [input + kept * (self.lagged[0] - input), 0.0]
            }
            Lag::Second { frequency, damping } => {
                second_order(self.lagged, input, interval, frequency, damping)
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

/// Value and rate of y″ + 2 ζ ω y′ + ω² y = ω² u after `interval` (s) of constant `input` u: exact.
fn second_order(
    [value, rate]: [f64; 2],
    input: f64,
    interval: f64,
    frequency: f64,
    damping: f64,
) -> [f64; 2] {
    // Symbols: x distance from the input, sigma decay rate, c and s the free response's cosine and sine over its rate.
    let x = value - input;
    let sigma = damping * frequency;
    let square = frequency * frequency * (1.0 - damping * damping);
    let (c, s) = if square.abs() * interval * interval < 1e-8 {
        (1.0, interval)
    } else if square > 0.0 {
        let (sine, cosine) = (square.sqrt() * interval).sin_cos();
        (cosine, sine / square.sqrt())
    } else {
        let root = (-square).sqrt();
        ((root * interval).cosh(), (root * interval).sinh() / root)
    };
    let decay = (-sigma * interval).exp();
    [
        input + decay * (x * c + (rate + sigma * x) * s),
        decay * (rate * c - (frequency * frequency * x + sigma * rate) * s),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two half steps are one whole, whatever the damping; and a long one ends at the input.
    #[test]
    fn second_order_is_exact() {
        for damping in [0.0, 0.3, 0.999_999, 1.0, 1.000_001, 2.5] {
            let step = |state, interval| second_order(state, 1.0, interval, 3.0, damping);
            let whole = step([0.2, -0.5], 0.4);
            let halves = step(step([0.2, -0.5], 0.2), 0.2);
            for k in 0..2 {
                assert!((whole[k] - halves[k]).abs() < 1e-6, "{damping}: {whole:?} {halves:?}");
            }
            if damping > 0.0 {
                assert!((step([0.2, -0.5], 60.0)[0] - 1.0).abs() < 1e-3, "{damping}");
            }
        }
        let quarter = std::f64::consts::FRAC_PI_2 / 3.0;
        let [value, rate] = second_order([0.0, 0.0], 1.0, quarter, 3.0, 0.0);
        assert!((value - 1.0).abs() < 1e-12 && (rate - 3.0).abs() < 1e-12);
    }
}
