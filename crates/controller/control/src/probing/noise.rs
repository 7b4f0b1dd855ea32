//! Pseudo-random binary noise within a band, sample by sample.

use basis::mixed;
use lti::SecondOrder;
use serde::{Deserialize, Serialize};

/// Damping ratios of the two halves of a Butterworth low-pass of fourth order (–).
const BUTTERWORTH: [f64; 2] = [0.923_879_532_511_286_7, 0.382_683_432_365_089_8];

/// Signs of a maximal-length shift register (x³¹ + x²⁸ + 1, period 2³¹ − 1), held for half a period of the
/// band's upper end and then filtered: two Butterworth filters leave what lies within the band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct BinaryNoise {
    register: u32,
    /// Time for which the present sign still holds (s).
    left: f64,
    /// Time for which a sign holds (s).
    hold: f64,
    low_passes: [SecondOrder; 2],
    high_pass: Option<SecondOrder>,
}

impl BinaryNoise {
    /// Noise within `band` (rad/s, lower and upper end; 0: down to a steady value), another one for each
    /// `seed` and `channel`.
    pub(super) fn new(seed: u64, channel: u64, [lower, upper]: [f64; 2]) -> Self {
        let register = mixed(seed ^ mixed(channel)) as u32 & REGISTER;
        Self {
            // All zeros would stay zeros.
            register: register.max(1),
            left: 0.0,
            hold: std::f64::consts::PI / upper,
            low_passes: BUTTERWORTH.map(|damping| SecondOrder::low_pass(upper, damping, 0.0)),
            high_pass: (lower > 0.0).then(|| SecondOrder::high_pass(lower, BUTTERWORTH_2, 0.0)),
        }
    }

    /// Noise after `interval` (s), about 1 in size.
    pub(super) fn next(&mut self, interval: f64) -> f64 {
        // What is left of a sum of intervals may be a rounding short of nothing.
        if self.left <= 1e-9 * interval {
            let bit = (self.register >> 30 ^ self.register >> 27) & 1;
            self.register = (self.register << 1 | bit) & REGISTER;
            self.left += self.hold;
        }
        self.left -= interval;
        let sign = if self.register & 1 == 1 { 1.0 } else { -1.0 };
        let passed =
            self.low_passes.iter_mut().fold(sign, |value, filter| filter.update(interval, value));
        match &mut self.high_pass {
            Some(filter) => filter.update(interval, passed),
            None => passed,
        }
    }
}

/// The register's bits.
const REGISTER: u32 = 0x7fff_ffff;

/// Damping ratio of a Butterworth filter of second order (–).
const BUTTERWORTH_2: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const INTERVAL: f64 = 0.1;

    fn noise(seed: u64, channel: u64, band: [f64; 2], n: usize) -> Vec<f64> {
        let mut noise = BinaryNoise::new(seed, channel, band);
        (0..n).map(|_| noise.next(INTERVAL)).collect()
    }

    /// Mean square of what `samples` hold beyond `rate` (rad/s), over that of all, by a running mean's
    /// complement being too crude: by projection on sines below it.
    fn share_beyond(samples: &[f64], rate: f64) -> f64 {
        let duration = samples.len() as f64 * INTERVAL;
        let power: f64 = samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64;
        let within: f64 = (0..)
            .map(|line| line as f64 * TAU / duration)
            .take_while(|line| *line <= rate)
            .map(|line| {
                let sums = samples.iter().enumerate().fold([0.0, 0.0], |[c, s], (k, x)| {
                    let (sine, cosine) = (line * k as f64 * INTERVAL).sin_cos();
                    [c + x * cosine, s + x * sine]
                });
                let mean_square =
                    (sums[0].powi(2) + sums[1].powi(2)) / (samples.len() as f64).powi(2);
                if line == 0.0 { mean_square } else { 2.0 * mean_square }
            })
            .sum();
        1.0 - within / power
    }

    #[test]
    fn it_lies_within_its_band_and_channels_have_nothing_in_common() {
        let upper = 0.03 * TAU;
        let first = noise(3, 0, [0.0, upper], 60_000);
        let second = noise(3, 1, [0.0, upper], 60_000);
        let power = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64;
        assert!((0.4..1.0).contains(&power(&first)), "{}", power(&first));
        assert!(share_beyond(&first[..9000], 1.5 * upper) < 0.02);
        let common =
            first.iter().zip(&second).map(|(a, b)| a * b).sum::<f64>() / first.len() as f64;
        // 360 signs: a correlation of two independent channels stays within three standard deviations.
        assert!(common.abs() / power(&first) < 3.0 / 360.0_f64.sqrt(), "{common}");
        assert_ne!(noise(4, 0, [0.0, upper], 500), first[..500]);
        assert_eq!(noise(3, 0, [0.0, upper], 500), first[..500]);
    }

    #[test]
    fn a_lower_end_takes_slow_changes_out() {
        let samples = noise(1, 0, [0.02 * TAU, 0.05 * TAU], 60_000);
        let mean = samples.iter().sum::<f64>() / samples.len() as f64;
        assert!(mean.abs() < 2e-3, "{mean}");
        let slow = 1.0 - share_beyond(&samples[..20_000], 0.01 * TAU);
        assert!(slow < 0.05, "{slow}");
    }
}
