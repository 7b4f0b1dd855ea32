//! Spectra: distribution of a record's variance over frequency.

use crate::{AnalysisError, line::FEWEST_SAMPLES, statistics::mean};
use realfft::RealFftPlanner;
use std::f64::consts::TAU;

/// Values at equally spaced frequencies, the first at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Frequency step (Hz).
    pub frequency_step: f64,
    /// One value per frequency, in the unit that the function which made it names.
    pub values: Vec<f64>,
}

impl Spectrum {
    /// Frequency of value number `index` (Hz).
    pub fn frequency(&self, index: usize) -> f64 {
        index as f64 * self.frequency_step
    }
}

/// One-sided power spectral density of `samples` (any unit, every `interval` s), in unit²/Hz, whose integral
/// over frequency is the variance.
///
/// Segments of `n_segment` samples that overlap by half, mean removed from the whole record, Hann's window.
/// Source: Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio
/// Electroacoust. 15, 1967.
///
/// # Errors
/// [`AnalysisError::TooShort`] when a segment has fewer than [`FEWEST_SAMPLES`] samples or does not fit the
/// record; [`AnalysisError::NotPositive`] for the interval.
pub fn power_density(
    samples: &[f64],
    interval: f64,
    n_segment: usize,
) -> Result<Spectrum, AnalysisError> {
    let (mut values, weights) = mean_square_spectrum(samples, interval, n_segment)?;
    let weight: f64 = weights.iter().map(|w| w * w).sum();
    one_sided(&mut values, n_segment, interval / weight);
    Ok(Spectrum { frequency_step: 1.0 / (n_segment as f64 * interval), values })
}

/// Amplitude of the sine at each frequency of `samples` (any unit, every `interval` s), in their unit: a sine
/// of amplitude A shows a peak of A, at worst 1.5 % less, half-way between two frequencies.
///
/// One Hann-windowed transform of the whole record, mean removed, at frequencies a quarter of its resolution
/// apart. For the exact amplitude of one sine use [`strongest`](crate::line::strongest).
///
/// # Errors
/// As [`power_density`].
pub fn amplitude(samples: &[f64], interval: f64) -> Result<Spectrum, AnalysisError> {
    const FINER: usize = 4;
    let n_samples = samples.len();
    check(n_samples, n_samples, interval)?;
    let weights = hann(n_samples);
    let weight: f64 = weights.iter().sum();
    // Weighted like this, the mean leaves nothing at zero frequency to leak from.
    let mean = samples.iter().zip(&weights).map(|(x, w)| x * w).sum::<f64>() / weight;
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(FINER * n_samples);
    let (mut input, mut output) = (transform.make_input_vec(), transform.make_output_vec());
    for ((input, sample), weight) in input.iter_mut().zip(samples).zip(&weights) {
        *input = (sample - mean) * weight;
    }
    transform
        .process(&mut input, &mut output)
        .expect("input and output have the lengths that the plan asks for");
    let values = output.iter().map(|value| 2.0 * value.norm() / weight).collect();
    Ok(Spectrum { frequency_step: 1.0 / ((FINER * n_samples) as f64 * interval), values })
}

/// Folds negative frequencies onto positive ones and scales.
fn one_sided(values: &mut [f64], n_segment: usize, scale: f64) {
    for value in values.iter_mut() {
        *value *= 2.0 * scale;
    }
    values[0] *= 0.5;
    if n_segment.is_multiple_of(2) {
        values[n_segment / 2] *= 0.5;
    }
}

/// |transform|² of the windowed segments, averaged, and the window.
fn mean_square_spectrum(
    samples: &[f64],
    interval: f64,
    n_segment: usize,
) -> Result<(Vec<f64>, Vec<f64>), AnalysisError> {
    check(samples.len(), n_segment, interval)?;
    let weights = hann(n_segment);
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(n_segment);
    let (mut input, mut output) = (transform.make_input_vec(), transform.make_output_vec());
    let mean = mean(samples);
    let mut values = vec![0.0; output.len()];
    let starts: Vec<usize> = (0..=samples.len() - n_segment).step_by(n_segment / 2).collect();
    for start in &starts {
        for ((input, sample), weight) in input.iter_mut().zip(&samples[*start..]).zip(&weights) {
            *input = (sample - mean) * weight;
        }
        transform
            .process(&mut input, &mut output)
            .expect("input and output have the lengths that the plan asks for");
        for (value, output) in values.iter_mut().zip(&output) {
            *value += output.norm_sqr() / starts.len() as f64;
        }
    }
    Ok((values, weights))
}

/// Whether segments of `n_segment` samples fit into `n_samples`, `interval` s apart.
pub(crate) fn check(
    n_samples: usize,
    n_segment: usize,
    interval: f64,
) -> Result<(), AnalysisError> {
    if n_segment < FEWEST_SAMPLES || n_samples < n_segment {
        let needed = n_segment.max(FEWEST_SAMPLES);
        return Err(AnalysisError::TooShort { n_samples: n_samples.min(n_segment), needed });
    }
    if interval.is_nan() || interval <= 0.0 {
        let quantity = "the sampling interval";
        return Err(AnalysisError::NotPositive { quantity, value: interval });
    }
    Ok(())
}

/// Hann's window of `n` samples.
pub(crate) fn hann(n: usize) -> Vec<f64> {
    (0..n).map(|index| 0.5 - 0.5 * (TAU * index as f64 / n as f64).cos()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(cycles: f64, n_samples: usize) -> Vec<f64> {
        (0..n_samples)
            .map(|i| 3.0 + 2.0 * (TAU * cycles * i as f64 / n_samples as f64).sin())
            .collect()
    }

    #[test]
    fn density_integrates_to_the_variance() {
        // 64 periods in all, 8 in each segment of an eighth.
        let samples = sine(64.0, 4096);
        let spectrum = power_density(&samples, 0.1, 512).expect("long enough");
        let variance = spectrum.values.iter().sum::<f64>() * spectrum.frequency_step;
        assert!((variance - 2.0).abs() < 1e-12);
        let peak = spectrum.values.iter().copied().fold(0.0, f64::max);
        assert_eq!(spectrum.values[8], peak);
        assert!((spectrum.frequency(8) - 64.0 / 409.6).abs() < 1e-12);
    }

    #[test]
    fn white_noise_is_flat_at_twice_its_variance_times_the_interval() {
        // A multiplicative generator is noise enough for a mean over 1000 frequencies.
        let mut state = 12345_u64;
        let samples: Vec<f64> = (0..1 << 17)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
            .collect();
        let spectrum = power_density(&samples, 0.5, 1024).expect("long enough");
        let expected = 2.0 * 0.5 / 12.0;
        for part in spectrum.values[2..510].chunks_exact(127) {
            assert!((mean(part) / expected - 1.0).abs() < 0.03, "{}", mean(part) / expected);
        }
    }

    #[test]
    fn amplitude_of_a_sine_is_its_own() {
        for (n_samples, cycles) in [(400, 20.0), (401, 20.0), (400, 20.13), (1000, 37.5)] {
            let spectrum = amplitude(&sine(cycles, n_samples), 0.25).expect("long enough");
            let peak = (4.0 * cycles).round() as usize;
            assert!((spectrum.values[peak] - 2.0).abs() < 0.03, "{}", spectrum.values[peak]);
            assert!((spectrum.frequency(peak) - cycles / (0.25 * n_samples as f64)).abs() < 0.002);
            assert!(spectrum.values[peak + 60..].iter().all(|v| *v < 2e-3));
            assert!(spectrum.values.iter().all(|v| *v <= 2.0 + 1e-9));
        }
    }

    #[test]
    fn bad_records_are_refused() {
        assert!(power_density(&[0.0; 100], 1.0, 101).is_err());
        assert!(power_density(&[0.0; 100], 1.0, 8).is_err());
        assert!(amplitude(&[0.0; 100], 0.0).is_err());
    }
}
