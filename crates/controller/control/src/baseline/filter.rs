//! First-order low-pass filter for steps of any length.

use serde::{Deserialize, Serialize};

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
        if input.is_finite() {
            self.value += -(-self.corner * interval).exp_m1() * (input - self.value);
        }
        self.value
    }

    /// The filter's output.
    pub(crate) fn value(&self) -> f64 {
        self.value
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
}
