//! Records without what is fast, and without delay.

use crate::AnalysisError;
use std::f64::consts::{LN_2, TAU};

/// Deviations of the weights beyond which a sample does not count (–).
const REACH: f64 = 4.0;

/// `samples` (any unit, every `interval` s) without what lies above `corner` (Hz): means with the weights of
/// a normal distribution, which delay nothing. Half of the amplitude at the corner is left, and 93 % at a
/// third of it. Near an end, and beside a sample that is not a number, the others count alone.
///
/// # Errors
/// [`AnalysisError::NotPositive`] for the interval; [`AnalysisError::AboveNyquist`] for a corner that cannot
/// be sampled.
pub fn smoothed(samples: &[f64], interval: f64, corner: f64) -> Result<Vec<f64>, AnalysisError> {
    if interval.is_nan() || interval <= 0.0 {
        let quantity = "the sampling interval";
        return Err(AnalysisError::NotPositive { quantity, value: interval });
    }
    let nyquist = 0.5 / interval;
    if corner.is_nan() || corner <= 0.0 || corner >= nyquist {
        return Err(AnalysisError::AboveNyquist { frequency: corner, nyquist });
    }
    // exp(−(2π f s)²/2) = 1/2 at the corner.
    let deviation = (2.0 * LN_2).sqrt() / (TAU * corner * interval);
    let reach = (REACH * deviation).ceil() as usize;
    let weights: Vec<f64> =
        (0..=reach).map(|distance| (-0.5 * (distance as f64 / deviation).powi(2)).exp()).collect();
    let mean = |index: usize| {
        let first = index.saturating_sub(reach);
        let near = samples[first..(index + reach + 1).min(samples.len())].iter().enumerate();
        let (mut sum, mut total) = (0.0, 0.0);
        for (place, sample) in near.filter(|(_, sample)| sample.is_finite()) {
            let weight = weights[(first + place).abs_diff(index)];
            sum += weight * sample;
            total += weight;
        }
        sum / total
    };
    Ok((0..samples.len()).map(mean).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64) -> Vec<f64> {
        (0..4000).map(|index| 3.0 + (TAU * frequency * 0.1 * f64::from(index)).sin()).collect()
    }

    #[test]
    fn half_is_left_at_the_corner_almost_all_below_and_nothing_above() {
        for (frequency, left) in [(0.05, 0.5), (0.05 / 3.0, 0.926), (0.2, 1.5e-5)] {
            let raw = sine(frequency);
            let smooth = smoothed(&raw, 0.1, 0.05).expect("a sound record");
            // No delay: what is left is in phase.
            let off = smooth[400..3600].iter().zip(&raw[400..3600]);
            let off = off.map(|(smooth, raw)| (smooth - 3.0 - left * (raw - 3.0)).abs());
            assert!(off.fold(0.0, f64::max) < 1e-3, "{frequency} Hz");
        }
    }

    #[test]
    fn a_constant_stays_beside_gaps_and_ends() {
        let mut samples = vec![2.0; 100];
        samples[40] = f64::NAN;
        let smooth = smoothed(&samples, 0.1, 0.5).expect("a sound record");
        assert!(smooth.iter().all(|value| (value - 2.0).abs() < 1e-12));
    }

    #[test]
    fn what_cannot_be_sampled_is_refused() {
        assert!(smoothed(&[0.0; 10], 0.1, 5.0).is_err());
        assert!(smoothed(&[0.0; 10], 0.0, 0.5).is_err());
        assert!(smoothed(&[0.0; 10], 0.1, f64::NAN).is_err());
    }
}
