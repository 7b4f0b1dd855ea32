//! Filters of first and second order for steps of any length.

use serde::{Deserialize, Serialize};

/// Corner times interval (rad) from which on a filter of second order lets everything pass: beyond what is sampled.
const FASTEST: f64 = 3.0;

/// A first-order low-pass filter; its input is held over each interval, and its step response is exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LowPass {
    corner: f64,
    value: f64,
}

impl LowPass {
    /// A filter with its −3 dB point at `corner` (rad/s) that has settled at `value`.
    pub(crate) fn settled(corner: f64, value: f64) -> Self {
        Self { corner, value }
    }

    /// The filter's output after `interval` (s) of `input`; an input that is no number leaves it as it was.
    pub(crate) fn update(&mut self, interval: f64, input: f64) -> f64 {
        if !self.value.is_finite() {
            self.value = input;
        } else if input.is_finite() {
            self.value += -(-self.corner * interval).exp_m1() * (input - self.value);
        }
        self.value
    }

    /// The filter's output.
    pub(crate) fn value(&self) -> f64 {
        self.value
    }
}

/// (s² n₂ + 2 ζₙ ω s + ω²) / (s² + 2 ζ ω s + ω²): a low-pass (n₂ = ζₙ = 0) or a notch (n₂ = 1) of second order.
///
/// Discretised by the bilinear rule, exact at the frequency ω.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct SecondOrder {
    frequency: f64,
    damping: f64,
    notch: Option<f64>,
    inputs: [f64; 2],
    outputs: [f64; 2],
}

impl SecondOrder {
    /// A low-pass filter of natural `frequency` (rad/s) and `damping` ratio (–) that has settled at `value`.
    pub(crate) fn low_pass(frequency: f64, damping: f64, value: f64) -> Self {
        Self { frequency, damping, notch: None, inputs: [value; 2], outputs: [value; 2] }
    }

    /// A notch at `frequency` (rad/s), damping ratios of numerator and denominator (–), that has settled at `value`.
    pub(crate) fn notch(frequency: f64, numerator: f64, denominator: f64, value: f64) -> Self {
        let notch = Some(numerator);
        Self { frequency, damping: denominator, notch, inputs: [value; 2], outputs: [value; 2] }
    }

    /// The filter's output after `interval` (s), at whose end the input is `input`; an input that is no number leaves it
    /// as it was.
    pub(crate) fn update(&mut self, interval: f64, input: f64) -> f64 {
        if !input.is_finite() {
            return self.outputs[0];
        }
        if !self.outputs[0].is_finite() {
            (self.inputs, self.outputs) = ([input; 2], [input; 2]);
        }
        let angle = self.frequency * interval;
        let output = if angle > 0.0 && angle < FASTEST {
            // s = ω/t (z − 1)/(z + 1) with t = tan(ω T/2), numerator and denominator times t²/ω².
            let t = (0.5 * angle).tan();
            let of = |square: f64, damping: f64| {
                let (middle, t2) = (2.0 * damping * t, t * t);
                [square + middle + t2, 2.0 * (t2 - square), square - middle + t2]
            };
            let [b0, b1, b2] = of(self.notch.map_or(0.0, |_| 1.0), self.notch.unwrap_or(0.0));
            let [a0, a1, a2] = of(1.0, self.damping);
            let [u1, u2] = self.inputs;
            let [y1, y2] = self.outputs;
            (b0 * input + b1 * u1 + b2 * u2 - a1 * y1 - a2 * y2) / a0
        } else {
            input
        };
        self.inputs = [input, self.inputs[0]];
        self.outputs = [output, self.outputs[0]];
        output
    }

    /// The filter's output.
    pub(crate) fn value(&self) -> f64 {
        self.outputs[0]
    }
}

/// A low-pass filter of first order, or of second where it has a damping ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Smoother {
    First(LowPass),
    Second(SecondOrder),
}

impl Smoother {
    /// A filter with `corner` (rad/s) that has settled at `value`; of second order where there is a `damping` ratio (–).
    pub(crate) fn settled(corner: f64, damping: Option<f64>, value: f64) -> Self {
        match damping {
            None => Self::First(LowPass::settled(corner, value)),
            Some(damping) => Self::Second(SecondOrder::low_pass(corner, damping, value)),
        }
    }

    /// The filter's output after `interval` (s) of `input`; an input that is no number leaves it as it was.
    pub(crate) fn update(&mut self, interval: f64, input: f64) -> f64 {
        match self {
            Self::First(filter) => filter.update(interval, input),
            Self::Second(filter) => filter.update(interval, input),
        }
    }

    /// The filter's output.
    pub(crate) fn value(&self) -> f64 {
        match self {
            Self::First(filter) => filter.value(),
            Self::Second(filter) => filter.value(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_response_is_exact_at_any_interval() {
        for interval in [0.05, 0.1, 0.3] {
            let mut filter = LowPass::settled(1.5, 0.0);
            for step in 1..=20 {
                let expected = 1.0 - (-1.5 * interval * f64::from(step)).exp();
                assert!((filter.update(interval, 1.0) - expected).abs() < 1e-13);
            }
        }
    }

    /// Amplitude of the response to a sine of `rate` (rad/s), long after it began.
    fn gain(mut filter: SecondOrder, rate: f64, interval: f64) -> f64 {
        let n = (400.0 / interval) as usize;
        let tail = (0..n).map(|k| filter.update(interval, (rate * interval * k as f64).sin()));
        tail.skip(n / 2).fold(0.0, |most: f64, value| most.max(value.abs()))
    }

    #[test]
    fn gains_of_second_order_are_those_of_the_transfer_function() {
        // At its natural frequency a low-pass has the gain 1/(2ζ), a notch that of its dampings' ratio; both exact.
        for interval in [0.02, 0.1, 0.3] {
            let low = gain(SecondOrder::low_pass(1.0, 0.7, 0.0), 1.0, interval);
            assert!((low - 1.0 / 1.4).abs() < 2e-2 * interval + 1e-4, "{low} at {interval} s");
            let notch = gain(SecondOrder::notch(1.5, 0.05, 0.25, 0.0), 1.5, interval);
            assert!((notch - 0.2).abs() < 1e-2 * interval + 1e-4, "{notch} at {interval} s");
            let beside = gain(SecondOrder::notch(1.5, 0.05, 0.25, 0.0), 0.05, interval);
            assert!((beside - 1.0).abs() < 2e-3, "{beside} at {interval} s");
        }
    }

    #[test]
    fn settled_filters_stay_and_pass_what_they_cannot_resolve() {
        let mut filter = SecondOrder::notch(1.5, 0.0, 0.25, 0.8);
        for _ in 0..100 {
            assert!((filter.update(0.1, 0.8) - 0.8).abs() < 1e-12);
        }
        assert!((filter.update(0.1, f64::NAN) - 0.8).abs() < 1e-12);
        assert_eq!(SecondOrder::low_pass(20.0, 0.7, 0.0).update(0.3, 5.0), 5.0);
    }
}
