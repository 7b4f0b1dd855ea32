//! What a correction leaves of the readings over: the intensity of the noise in them, whatever the interval.
//!
//! The residual of a reading after the correction tells the variance of its noise. White noise has the
//! variance of its intensity over the interval, but what a model leaves over lasts longer than the interval
//! between two readings. So residuals are averaged over a fixed time before they are squared: the mean of n
//! readings has the variance of the intensity over n intervals, and both kinds of noise tell one intensity at
//! any interval up to that time. Readings further apart stand for themselves.

use basis::PerBlade;
use serde::{Deserialize, Serialize};

/// Time over which residuals are averaged (s): the interval of the trials from which the default noise comes.
const WINDOW: f64 = 0.1;
/// Share of an interval by which a window may end early (–), since intervals rarely divide it.
const EARLY: f64 = 0.5;

/// Residuals since the last window ended, blade by blade.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Leftover {
    /// Sum of the residuals (N m), and their number (–).
    sums: PerBlade<f64>,
    counts: PerBlade<f64>,
    /// Sum of the variances that the states leave in the readings (N² m²), and of the nominal variances of
    /// their noise.
    spreads: PerBlade<f64>,
    nominal: PerBlade<f64>,
    /// Time since the window began (s).
    elapsed: f64,
}

impl Leftover {
    pub(super) fn new(n_blades: usize) -> Self {
        let zero = PerBlade::splat(n_blades, 0.0);
        Self { sums: zero, counts: zero, spreads: zero, nominal: zero, elapsed: 0.0 }
    }

    /// Takes in the `residual` (N m) of `blade` after a correction, the variance that the states leave in its
    /// reading, `spread`, and the nominal variance of its noise (N² m²).
    pub(super) fn add(&mut self, blade: usize, residual: f64, spread: f64, nominal: f64) {
        self.sums[blade] += residual;
        self.counts[blade] += 1.0;
        self.spreads[blade] += spread;
        self.nominal[blade] += nominal;
    }

    /// Ends the window when it is over, an `interval` (s) after the last reading where they are `usual` (s)
    /// apart: its length (s), and the intensity of the noise over the nominal one (–), mean of the blades.
    pub(super) fn take(&mut self, interval: f64, usual: f64) -> Option<(f64, f64)> {
        self.elapsed += interval;
        if self.elapsed < WINDOW - EARLY * usual {
            return None;
        }
        let (mut left, mut n_blades) = (0.0, 0.0);
        for blade in 0..self.sums.len() {
            let count = self.counts[blade];
            if count > 0.0 {
                let [mean, spread, nominal] =
                    [self.sums[blade], self.spreads[blade], self.nominal[blade]]
                        .map(|sum| sum / count);
                // The mean of the readings is that much less noisy. A correction has followed each reading
                // by its gain, spread over noise, so that the residuals hold that much less of it.
                left += (mean * mean + spread / count) * count / nominal;
                n_blades += 1.0;
            }
        }
        let found = (n_blades > 0.0).then(|| (self.elapsed, left / n_blades));
        *self = Self::new(self.sums.len());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of what windows tell of the readings `of` three blades, `interval` (s) apart, of nominal
    /// intensity one.
    fn told(interval: f64, mut of: impl FnMut(f64) -> f64) -> f64 {
        let mut leftover = Leftover::new(3);
        let (mut sum, mut n) = (0.0, 0.0);
        for step in 0..60_000 {
            let time = f64::from(step) * interval;
            (0..3).for_each(|blade| leftover.add(blade, of(time), 0.0, 1.0 / interval));
            if let Some((_, left)) = leftover.take(interval, interval) {
                sum += left;
                n += 1.0;
            }
        }
        sum / n
    }

    #[test]
    fn white_noise_and_what_lasts_tell_one_intensity_at_every_interval() {
        for interval in [0.02, 0.05, 0.1] {
            let mut state = 9_u64;
            let mut uniform = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            };
            // Readings of intensity one have the variance 1/interval; a uniform number a twelfth.
            let white = told(interval, |_| (12.0 / interval).sqrt() * uniform());
            assert!((white - 1.0).abs() < 0.05, "{interval}: {white}");
            // A swing of some seconds, of variance one half, has half the window's length.
            let lasting = told(interval, |time| (0.9 * time).sin());
            assert!((lasting / (0.5 * WINDOW) - 1.0).abs() < 0.01, "{interval}: {lasting}");
        }
    }

    #[test]
    fn what_the_corrections_took_is_given_back_once() {
        // Of a filter with a steady gain of k on a still state: posterior variance k R, residuals
        // (1 − k) of innovations. Noise of intensity one, readings as often as this.
        for interval in [0.01_f64, 0.02, 0.05, 0.1] {
            let mut state = 5_u64;
            let mut uniform = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            };
            let variance = 1.0 / interval;
            // A random walk of intensity 25 under it: the filter's steady state, a Riccati equation in one
            // unknown.
            let drift = 25.0 * interval;
            let before = 0.5 * (drift + (drift * drift + 4.0 * drift * variance).sqrt());
            let gain = before / (before + variance);
            let (mut walk, mut estimate, mut leftover) = (0.0_f64, 0.0_f64, Leftover::new(1));
            let (mut sum, mut n) = (0.0, 0.0);
            for _ in 0..200_000 {
                walk += (12.0 * drift).sqrt() * uniform();
                let reading = walk + (12.0 * variance).sqrt() * uniform();
                estimate += gain * (reading - estimate);
                leftover.add(0, reading - estimate, gain * variance, variance);
                if let Some((_, left)) = leftover.take(interval, interval) {
                    sum += left;
                    n += 1.0;
                }
            }
            let left: f64 = sum / n;
            assert!((left - 1.0).abs() < 0.1, "{left} with readings {interval} s apart");
        }
    }

    #[test]
    fn blades_without_a_reading_do_not_count() {
        let mut leftover = Leftover::new(3);
        leftover.add(1, 2.0, 0.5, 10.0);
        assert_eq!(leftover.take(WINDOW, WINDOW), Some((WINDOW, 0.45)));
        assert_eq!(leftover.take(WINDOW, WINDOW), None);
    }
}
