//! Low-pass filters: of first order, and of first or second as is wanted.

use crate::SecondOrder;
use serde::{Deserialize, Serialize};

/// A first-order low-pass filter; its input is held over each interval, and its step response is exact.
///
/// ```
/// let mut filter = lti::LowPass::settled(2.0, 0.0);
/// // A step of one, half a second later: 1 − e^(−2 rad/s · 0.5 s).
/// assert!((filter.update(0.5, 1.0) - (1.0 - (-1.0_f64).exp())).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowPass {
    corner: f64,
    value: f64,
}

impl LowPass {
    /// A filter with its −3 dB point at `corner` (rad/s) that has settled at `value`.
    pub fn settled(corner: f64, value: f64) -> Self {
        Self { corner, value }
    }

    /// The filter's output after `interval` (s) of `input`; an input that is no number leaves it as it was.
    pub fn update(&mut self, interval: f64, input: f64) -> f64 {
        if !self.value.is_finite() {
            self.value = input;
        } else if input.is_finite() {
            self.value += -(-self.corner * interval).exp_m1() * (input - self.value);
        }
        self.value
    }

    /// The filter's output.
    pub fn value(&self) -> f64 {
        self.value
    }
}

/// A low-pass filter of first order, or of second where it has a damping ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Smoother {
    /// Of first order.
    First(LowPass),
    /// Of second order.
    Second(SecondOrder),
}

impl Smoother {
    /// A filter with `corner` (rad/s) that has settled at `value`; of second order where there is a `damping`
    /// ratio (–).
    pub fn settled(corner: f64, damping: Option<f64>, value: f64) -> Self {
        match damping {
            None => Self::First(LowPass::settled(corner, value)),
            Some(damping) => Self::Second(SecondOrder::low_pass(corner, damping, value)),
        }
    }

    /// The filter's output after `interval` (s) of `input`; an input that is no number leaves it as it was.
    pub fn update(&mut self, interval: f64, input: f64) -> f64 {
        match self {
            Self::First(filter) => filter.update(interval, input),
            Self::Second(filter) => filter.update(interval, input),
        }
    }

    /// The filter's output.
    pub fn value(&self) -> f64 {
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

    #[test]
    fn what_is_no_number_is_passed_over() {
        let mut filter = LowPass::settled(1.5, 0.8);
        assert_eq!(filter.update(0.1, f64::NAN), 0.8);
        let mut unknown = LowPass::settled(1.5, f64::NAN);
        assert_eq!(unknown.update(0.1, 3.0), 3.0);
    }

    #[test]
    fn the_damping_ratio_chooses_the_order() {
        let (mut first, mut second) =
            (Smoother::settled(2.0, None, 1.0), Smoother::settled(2.0, Some(0.7), 1.0));
        assert_eq!(first.update(0.1, 2.0), LowPass::settled(2.0, 1.0).update(0.1, 2.0));
        assert_eq!(second.update(0.1, 2.0), SecondOrder::low_pass(2.0, 0.7, 1.0).update(0.1, 2.0));
        assert!(first.value() > second.value());
    }
}
