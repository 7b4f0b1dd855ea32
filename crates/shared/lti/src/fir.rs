//! Symmetric filters of finite response: linear phase, so that all that they pass is late by the same time,
//! half the filter.

use std::f64::consts::TAU;

/// What brings a sinc to its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// Narrower transition, stop band 53 dB down; what MATLAB's `fir1` takes. Its ends are not zero.
    Hamming,
    /// Wider transition, stop band 74 dB down. It reaches zero one tap beyond the ends.
    Blackman,
}

impl Window {
    /// Its share at `tap` of `n_taps` (–).
    fn at(self, tap: usize, n_taps: usize) -> f64 {
        match self {
            Self::Hamming if n_taps < 2 => 1.0,
            Self::Hamming => 0.54 - 0.46 * (TAU * tap as f64 / (n_taps - 1) as f64).cos(),
            Self::Blackman => {
                let turn = TAU * (tap as f64 + 1.0) / (n_taps as f64 + 1.0);
                0.42 - 0.5 * turn.cos() + 0.08 * (2.0 * turn).cos()
            }
        }
    }
}

/// The `n_taps` taps of a low-pass (–), of gain one at rest and half at `cut_off` (cycles a sample, above 0
/// and below 0.5): a sinc under a `window`.
///
/// Where the filter is too short for its cut-off, which is below one cycle over its length, the window alone
/// makes its band.
///
/// Source of the windows: Oppenheim and Schafer, "Discrete-time signal processing".
///
/// ```
/// use lti::fir::{Window, gain, low_pass};
/// let taps = low_pass(101, 0.1, Window::Hamming);
/// assert!((gain(&taps, 0.1 * std::f64::consts::TAU) - 0.5).abs() < 1e-3);
/// ```
pub fn low_pass(n_taps: usize, cut_off: f64, window: Window) -> Vec<f64> {
    let middle = 0.5 * (n_taps as f64 - 1.0);
    let mut taps: Vec<f64> = (0..n_taps)
        .map(|tap| {
            let from_middle = tap as f64 - middle;
            let angle = TAU * cut_off * from_middle;
            let sinc = if from_middle == 0.0 { 1.0 } else { angle.sin() / angle };
            sinc * window.at(tap, n_taps)
        })
        .collect();
    let total: f64 = taps.iter().sum();
    taps.iter_mut().for_each(|tap| *tap /= total);
    taps
}

/// Gain (–) of symmetric `taps` at `angle` (rad a sample), without their delay of half their length.
pub fn gain(taps: &[f64], angle: f64) -> f64 {
    let middle = 0.5 * (taps.len() as f64 - 1.0);
    taps.iter().enumerate().map(|(tap, h)| h * (angle * (tap as f64 - middle)).cos()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_symmetric_and_let_means_through() {
        for window in [Window::Hamming, Window::Blackman] {
            for n_taps in [1, 2, 8, 51] {
                let taps = low_pass(n_taps, 0.005, window);
                assert!((taps.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(taps.iter().zip(taps.iter().rev()).all(|(a, b)| (a - b).abs() < 1e-15));
                assert!((gain(&taps, 0.0) - 1.0).abs() < 1e-14);
            }
        }
    }

    /// With a cut-off far below what their length resolves, the sinc is 1 and the gain that of the window,
    /// which is sums of cosines: D(w) = sin(N w/2)/sin(w/2) at w and at bins to each side.
    #[test]
    fn their_gain_is_the_closed_form_of_the_window() {
        let sum = |n: f64, angle: f64| {
            if angle.abs() < 1e-12 { n } else { (0.5 * n * angle).sin() / (0.5 * angle).sin() }
        };
        let aside = |n: f64, bin: f64, angle: f64| sum(n, angle - bin) + sum(n, angle + bin);
        for angle in [0.0, 0.015, 0.063, 0.19, 0.63] {
            let bin = TAU / 50.0;
            let hamming = |w: f64| 0.54 * sum(51.0, w) + 0.23 * aside(51.0, bin, w);
            let taps = low_pass(51, 1e-7, Window::Hamming);
            assert!((gain(&taps, angle) - hamming(angle) / hamming(0.0)).abs() < 1e-9, "{angle}");
            // Its ends, one tap beyond, are zero: they may be counted.
            let bin = TAU / 52.0;
            let blackman = |w: f64| {
                0.42 * sum(53.0, w) + 0.25 * aside(53.0, bin, w) + 0.04 * aside(53.0, 2.0 * bin, w)
            };
            let taps = low_pass(51, 1e-7, Window::Blackman);
            assert!((gain(&taps, angle) - blackman(angle) / blackman(0.0)).abs() < 1e-9, "{angle}");
        }
    }

    /// The filter of Chen et al. (2026) on the hub vortex: order 50, 0.05 Hz at 10 Hz.
    #[test]
    fn a_filter_that_is_short_is_as_wide_as_its_window() {
        let taps = low_pass(51, 0.05 * 0.1, Window::Hamming);
        let at = |frequency: f64| gain(&taps, TAU * frequency * 0.1);
        assert!(at(0.0238) > 0.98);
        assert!((at(0.18) - 0.5).abs() < 0.02, "{}", at(0.18));
        assert!([0.6, 1.0, 2.3].iter().all(|frequency| at(*frequency).abs() < 0.004));
    }
}
