//! Input signals for experiments.

use crate::error::within;
use crate::{IdentificationError, filter};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Share of the band over which the filter falls at either edge, inside the band (–).
const EDGE: f64 = 0.25;

/// Rate at which the binary noise may change sign, in highest frequencies of the band (–): higher ones spend
/// power outside it, lower ones leave the band's end weak.
const CLOCK: f64 = 3.0;

/// `n_samples` of binary noise every `interval` (s), filtered to lie between the frequencies of `band` (Hz),
/// whose largest modulus is `amplitude` (any unit). The same `seed` gives the same signal; others give
/// independent ones.
///
/// Signs are drawn three times per period of the band's highest frequency, or with every sample. The filter
/// is a symmetric finite impulse response, 74 dB down outside the band; none where the band ends at zero or
/// at half the sampling rate. Source: Ljung, "System identification", 2nd ed., 1999, section 13.3.
///
/// # Errors
/// [`IdentificationError::OutOfRange`] for a band that is empty or not below half the sampling rate, and for
/// an amplitude that is not positive; [`IdentificationError::TooFewSamples`] where the filter is longer than
/// the signal.
pub fn pseudo_random_binary(
    seed: u64,
    n_samples: usize,
    interval: f64,
    band: (f64, f64),
    amplitude: f64,
) -> Result<Vec<f64>, IdentificationError> {
    within("the interval (s)", interval, f64::MIN_POSITIVE, f64::MAX)?;
    within("the amplitude", amplitude, f64::MIN_POSITIVE, f64::MAX)?;
    within("the band's highest frequency (Hz)", band.1, f64::MIN_POSITIVE, 0.5 / interval)?;
    within("the band's lowest frequency (Hz)", band.0, 0.0, band.1)?;
    // Cycles per sample.
    let (low, high) = (band.0 * interval, band.1 * interval);
    let width = EDGE * (high - low);
    within("the band's width (cycles per sample)", width, f64::MIN_POSITIVE, 0.5)?;
    let filtered = low > 0.0 || high < 0.5;
    let needed = if filtered { filter::taps_for(width) } else { 1 };
    if n_samples < needed {
        let (found, purpose) = (n_samples, "a band as narrow as this");
        return Err(IdentificationError::TooFewSamples { found, needed, purpose });
    }
    let taps = taps(low, high, width, needed);
    let held = (1.0 / (CLOCK * high)).floor().max(1.0) as usize;
    let signal = filter::valid(&binary(seed, n_samples + taps.len() - 1, held), &taps);
    let largest = signal.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    Ok(signal.iter().map(|x| x * amplitude / largest).collect())
}

/// Taps of the band-pass filter; its edges fall over `width` inside the band. All in cycles per sample.
fn taps(low: f64, high: f64, width: f64, n_taps: usize) -> Vec<f64> {
    let mut taps = vec![0.0; n_taps];
    if high < 0.5 {
        taps = filter::low_pass(high - 0.5 * width, n_taps);
    } else {
        taps[n_taps / 2] = 1.0;
    }
    if low > 0.0 {
        let below = filter::low_pass(low + 0.5 * width, n_taps);
        taps.iter_mut().zip(below).for_each(|(tap, below)| *tap -= below);
    }
    taps
}

/// Plus and minus one at random, each held over `held` samples.
fn binary(seed: u64, n_samples: usize, held: usize) -> Vec<f64> {
    let mut seeded = ChaCha8Rng::seed_from_u64(seed);
    let signs = std::iter::repeat_with(|| if seeded.next_u32() & 1 == 0 { 1.0 } else { -1.0 });
    signs.flat_map(|sign| std::iter::repeat_n(sign, held)).take(n_samples).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lti::Complex64;
    use rustfft::FftPlanner;
    use std::f64::consts::PI;

    /// Share of a signal's power between two frequencies (Hz).
    fn share(signal: &[f64], interval: f64, band: (f64, f64)) -> f64 {
        let n_samples = signal.len();
        let window = |i: usize| (PI * (i as f64 + 0.5) / n_samples as f64).sin().powi(2);
        let mut values: Vec<Complex64> =
            signal.iter().enumerate().map(|(i, x)| Complex64::from(x * window(i))).collect();
        FftPlanner::new().plan_fft_forward(n_samples).process(&mut values);
        let step = 1.0 / (n_samples as f64 * interval);
        let power = |index: usize| values[index].norm_sqr();
        let inside = (0..=n_samples / 2).filter(|index| {
            // The window smears over two frequencies.
            let (frequency, smear) = (*index as f64 * step, 2.0 * step);
            frequency >= band.0 - smear && frequency <= band.1 + smear
        });
        inside.map(power).sum::<f64>() / (0..=n_samples / 2).map(power).sum::<f64>()
    }

    #[test]
    fn power_lies_in_the_band_and_fills_it() {
        for (interval, band) in [(1.0, (0.0, 0.03)), (0.5, (0.1, 0.4)), (1.0, (0.2, 0.5))] {
            let signal = pseudo_random_binary(7, 9000, interval, band, 1.5).expect("a band");
            assert_eq!(signal.len(), 9000);
            let largest = signal.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            assert!((largest - 1.5).abs() < 1e-12);
            assert!(share(&signal, interval, band) > 0.999, "{band:?}");
            // The middle half of the band holds nearly its share.
            let (middle, half) = (0.5 * (band.0 + band.1), 0.25 * (band.1 - band.0));
            let found = share(&signal, interval, (middle - half, middle + half));
            assert!((0.45..0.75).contains(&found), "{band:?} {found}");
        }
    }

    #[test]
    fn the_whole_band_is_binary() {
        let signal = pseudo_random_binary(7, 1000, 0.5, (0.0, 1.0), 2.0).expect("a band");
        assert!(signal.iter().all(|x| x.abs() == 2.0));
        let mean = signal.iter().sum::<f64>() / 1000.0;
        assert!(mean.abs() < 0.25, "{mean}");
    }

    #[test]
    fn seeds_repeat_and_differ() {
        let made = |seed| pseudo_random_binary(seed, 6000, 1.0, (0.0, 0.05), 1.0).expect("a band");
        let (first, other) = (made(1), made(2));
        assert_eq!(first, made(1));
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let correlation =
            product(&first, &other) / (product(&first, &first) * product(&other, &other)).sqrt();
        // Some 600 independent values.
        assert!(correlation.abs() < 0.15, "{correlation}");
    }

    #[test]
    fn impossible_bands_are_refused() {
        let made = |n_samples, band| pseudo_random_binary(1, n_samples, 1.0, band, 1.0);
        assert!(made(1000, (0.0, 0.6)).is_err());
        assert!(made(1000, (0.1, 0.1)).is_err());
        assert!(made(1000, (0.2, 0.1)).is_err());
        assert!(made(100, (0.0, 0.01)).is_err_and(|e| e.to_string().contains("2201 are needed")));
    }
}
