//! Symmetric finite impulse responses, which shift no phase when their middle lies on the sample.

use lti::fir::{self, Window};

/// Width of the Blackman window's transition, from pass to stop band, in units of 1/taps (cycles per sample).
/// Source: Oppenheim and Schafer, "Discrete-time signal processing", table of windows.
const TRANSITION: f64 = 5.5;

/// An odd number of taps whose transition from pass to stop band is no wider than `width` (cycles per
/// sample).
pub(crate) fn taps_for(width: f64) -> usize {
    (TRANSITION / width).ceil() as usize | 1
}

/// A low-pass of gain one at frequency zero, half at `cut` (cycles per sample, below 0.5), 74 dB down in the
/// stop band.
pub(crate) fn low_pass(cut: f64, n_taps: usize) -> Vec<f64> {
    fir::low_pass(n_taps, cut, Window::Blackman)
}

/// The samples that a filter of an odd number of taps gives where all of its taps lie on `signal`: shorter by
/// one less than the taps, and centred.
pub(crate) fn valid(signal: &[f64], taps: &[f64]) -> Vec<f64> {
    // The taps are symmetric: correlation is convolution.
    signal
        .windows(taps.len())
        .map(|window| window.iter().zip(taps).map(|(sample, tap)| sample * tap).sum())
        .collect()
}

/// As long as `signal`, which is continued past its ends by turning it about its end points.
pub(crate) fn zero_phase(signal: &[f64], taps: &[f64]) -> Vec<f64> {
    let (half, last) = (taps.len() / 2, signal.len() - 1);
    let reach = |distance: usize| distance.min(last);
    let before = (1..=half).rev().map(|i| 2.0 * signal[0] - signal[reach(i)]);
    let after = (1..=half).map(|i| 2.0 * signal[last] - signal[last - reach(i)]);
    let extended: Vec<f64> = before.chain(signal.iter().copied()).chain(after).collect();
    valid(&extended, taps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn gain(taps: &[f64], frequency: f64) -> f64 {
        fir::gain(taps, TAU * frequency)
    }

    #[test]
    fn bands_pass_and_stop() {
        let (cut, width) = (0.1, 0.05);
        let taps = low_pass(cut, taps_for(width));
        assert!((gain(&taps, cut) - 0.5).abs() < 1e-3);
        for step in 0..=100 {
            let below = step as f64 / 100.0 * (cut - 0.5 * width);
            assert!((gain(&taps, below) - 1.0).abs() < 2e-3, "{below}");
            let above = cut + 0.5 * width + step as f64 / 100.0 * (0.5 - cut - 0.5 * width);
            assert!(gain(&taps, above).abs() < 1e-3, "{above}");
        }
    }

    #[test]
    fn a_line_stays_a_line_to_its_ends() {
        let line: Vec<f64> = (0..200).map(|i| 3.0 - 0.5 * i as f64).collect();
        for (found, expected) in zero_phase(&line, &low_pass(0.1, 51)).iter().zip(&line) {
            assert!((found - expected).abs() < 1e-10);
        }
    }
}
