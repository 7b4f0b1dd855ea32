//! A low-pass filter of finite response: linear phase, so that all that is slow is late by the same time.

use crate::EstimationError;
use std::f64::consts::TAU;

/// Coefficients of a low-pass filter of finite response.
///
/// A sinc of the cut-off within a Hamming window, of gain 1 at rest: what MATLAB's `fir1` designs. So short a
/// filter as that of the source, 50 samples at 10 Hz, is wider than its cut-off of 0.05 Hz says: the window
/// alone sets its band, −6 dB at 0.18 Hz.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LowPassFir {
    /// Newest sample first.
    coefficients: Vec<f64>,
    /// Time between samples (s).
    interval: f64,
}

impl LowPassFir {
    /// A filter of `order` (–), one less than its samples, with its cut-off at `cut_off` (Hz) for samples
    /// `interval` (s) apart.
    ///
    /// # Errors
    /// [`EstimationError::Setting`] for a cut-off that is not between zero and half the sampling rate.
    pub(super) fn new(order: usize, cut_off: f64, interval: f64) -> Result<Self, EstimationError> {
        if !(cut_off > 0.0 && cut_off * interval < 0.5) {
            return Err(EstimationError::Setting {
                name: "cut-off of the low-pass filter (Hz)",
                value: cut_off,
                expected: "take one above zero and below half the sampling rate",
            });
        }
        let middle = 0.5 * order as f64;
        let shape = |index: usize| {
            let from_middle = index as f64 - middle;
            let angle = TAU * cut_off * interval * from_middle;
            let sinc = if from_middle == 0.0 { 1.0 } else { angle.sin() / angle };
            let window = if order == 0 {
                1.0
            } else {
                0.54 - 0.46 * (TAU * index as f64 / order as f64).cos()
            };
            sinc * window
        };
        let mut coefficients: Vec<f64> = (0..=order).map(shape).collect();
        let total: f64 = coefficients.iter().sum();
        coefficients.iter_mut().for_each(|coefficient| *coefficient /= total);
        Ok(Self { coefficients, interval })
    }

    /// Coefficients, newest sample first (–).
    pub(super) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Gain at `rate` (rad/s), without the delay (–).
    pub(super) fn gain(&self, rate: f64) -> f64 {
        let middle = 0.5 * (self.coefficients.len() - 1) as f64;
        let terms = self.coefficients.iter().enumerate();
        terms.map(|(k, h)| h * (rate * self.interval * (k as f64 - middle)).cos()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_symmetric_and_lets_means_through() {
        for order in [0, 1, 7, 50] {
            let fir = LowPassFir::new(order, 0.05, 0.1).expect("such a filter can be");
            let h = fir.coefficients();
            assert!((h.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(h.iter().zip(h.iter().rev()).all(|(a, b)| (a - b).abs() < 1e-16));
        }
    }

    /// With a cut-off far below what its length resolves, the sinc is 1 and the gain that of the window,
    /// which is three sums of cosines: D(w) = sin(N w/2)/sin(w/2) at w and a bin to each side.
    #[test]
    fn its_gain_is_the_closed_form_of_the_window() {
        let (order, interval) = (50, 0.1);
        let fir = LowPassFir::new(order, 1e-6, interval).expect("such a filter can be");
        let n = order as f64 + 1.0;
        let sum = |angle: f64| {
            if angle.abs() < 1e-12 { n } else { (0.5 * n * angle).sin() / (0.5 * angle).sin() }
        };
        let bin = TAU / order as f64;
        let window = |angle: f64| 0.54 * sum(angle) + 0.23 * (sum(angle - bin) + sum(angle + bin));
        for frequency in [0.0, 0.0238, 0.1, 0.3, 1.0] {
            let rate = TAU * frequency;
            let expected = window(rate * interval) / window(0.0);
            assert!((fir.gain(rate) - expected).abs() < 1e-9, "{frequency} Hz");
        }
    }

    #[test]
    fn the_filter_of_the_source_keeps_the_helix_and_drops_what_is_fast() {
        let fir = LowPassFir::new(50, 0.05, 0.1).expect("such a filter can be");
        assert!(fir.gain(TAU * 0.0238) > 0.98);
        assert!((fir.gain(TAU * 0.18) - 0.5).abs() < 0.02, "{}", fir.gain(TAU * 0.18));
        assert!([0.6, 1.0, 2.3].iter().all(|f| fir.gain(TAU * f).abs() < 0.004));
    }

    #[test]
    fn a_cut_off_that_cannot_be_is_refused() {
        for cut_off in [0.0, -1.0, 5.0, f64::NAN] {
            let error = LowPassFir::new(50, cut_off, 0.1).expect_err("refused").to_string();
            assert!(error.contains("cut-off"), "{error}");
        }
    }
}
