//! One sine in a record: its amplitude, frequency and phase, finer than the record's own frequency grid.

use crate::{AnalysisError, statistics::mean};
use basis::{Matrix3, Vector3};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Fewest samples for the fit of a sine (–).
pub const FEWEST_SAMPLES: usize = 16;

/// One frequency of a record, `amplitude` cos(2π `frequency` t + `phase`) with t from the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Amplitude, (unit of the record).
    pub amplitude: f64,
    /// Frequency (Hz); negative for a vector that turns the negative way.
    pub frequency: f64,
    /// Phase at the first sample (rad, [−π, π]).
    pub phase: f64,
}

/// The strongest sine in `samples` (any unit, every `interval` s), the mean aside.
///
/// The record's Hann-windowed spectrum shows where to look; a least-squares fit of mean, cosine and sine,
/// weighted by the same window, gives amplitude and phase, and the frequency is the one whose fit leaves
/// least behind. Exact for a pure sine, whether or not whole periods fit the record.
///
/// Source: IEEE Std 1057-2017, Annex B (four-parameter sine fit), with a window against neighbouring lines.
/// Limits: at least three periods; a second line closer than four periods per record biases the first.
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than [`FEWEST_SAMPLES`] samples.
///
/// ```
/// // 3.7 periods of amplitude 2 around 5
/// let sine = |i: usize| 5.0 + 2.0 * (std::f64::consts::TAU * 3.7 * i as f64 / 500.0).cos();
/// let samples: Vec<f64> = (0..500).map(sine).collect();
/// let line = analysis::line::strongest(&samples, 0.1)?;
/// assert!((line.amplitude - 2.0).abs() < 1e-6 && (line.frequency - 3.7 / 50.0).abs() < 1e-6);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn strongest(samples: &[f64], interval: f64) -> Result<Line, AnalysisError> {
    let spectrum = windowed_spectrum(samples)?;
    let strength: Vec<f64> = spectrum.iter().map(|value| value.norm()).collect();
    let peak = 1 + highest(&strength[1..]);
    let cycles = refined(peak as f64, |cycles| fit_sine(samples, cycles).1);
    let (sine, _) = fit_sine(samples, cycles);
    let frequency = cycles / (samples.len() as f64 * interval);
    Ok(Line { amplitude: sine.norm(), frequency, phase: sine.arg() })
}

/// The strongest rotation in the vector with components `first` and `second` (one unit, every `interval` s),
/// its mean aside: `first` ≈ A cos(2π f t + φ), `second` ≈ A sin(2π f t + φ) with f of either sign.
///
/// Found as [`strongest`] finds a sine.
///
/// # Errors
/// [`AnalysisError::TooShort`] as there, [`AnalysisError::UnequalLengths`].
pub fn strongest_rotation(
    first: &[f64],
    second: &[f64],
    interval: f64,
) -> Result<Line, AnalysisError> {
    if first.len() != second.len() {
        let (first, second) = (first.len(), second.len());
        return Err(AnalysisError::UnequalLengths { first, second });
    }
    let (x, y) = (windowed_spectrum(first)?, windowed_spectrum(second)?);
    let i = Complex64::i();
    // The spectrum of x + i y at both signs, from the spectra of the real x and y.
    let forward: Vec<f64> = x.iter().zip(&y).map(|(x, y)| (x + i * y).norm()).collect();
    let backward: Vec<f64> =
        x.iter().zip(&y).map(|(x, y)| (x.conj() + i * y.conj()).norm()).collect();
    let (ahead, behind) = (1 + highest(&forward[1..]), 1 + highest(&backward[1..]));
    let (peak, sign) =
        if forward[ahead] >= backward[behind] { (ahead, 1.0) } else { (behind, -1.0) };
    let turned: Vec<f64> = second.iter().map(|y| sign * y).collect();
    let cycles = refined(peak as f64, |cycles| fit_rotation(first, &turned, cycles).1);
    let (rotation, _) = fit_rotation(first, &turned, cycles);
    let frequency = sign * cycles / (first.len() as f64 * interval);
    Ok(Line { amplitude: rotation.norm(), frequency, phase: sign * rotation.arg() })
}

/// Weight of sample `index` of `n_samples` (–), Hann's window with neither end at zero.
fn hann(index: usize, n_samples: usize) -> f64 {
    0.5 - 0.5 * (TAU * (index as f64 + 0.5) / n_samples as f64).cos()
}

fn windowed_spectrum(samples: &[f64]) -> Result<Vec<Complex64>, AnalysisError> {
    let n_samples = samples.len();
    if n_samples < FEWEST_SAMPLES {
        return Err(AnalysisError::TooShort { n_samples, needed: FEWEST_SAMPLES });
    }
    let mean = mean(samples);
    let mut windowed: Vec<f64> =
        samples.iter().enumerate().map(|(i, x)| (x - mean) * hann(i, n_samples)).collect();
    let transform = RealFftPlanner::new().plan_fft_forward(n_samples);
    let mut spectrum = transform.make_output_vec();
    transform
        .process(&mut windowed, &mut spectrum)
        .expect("input and output have the lengths that the plan asks for");
    Ok(spectrum)
}

fn highest(values: &[f64]) -> usize {
    values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index)
}

/// Where `explained` is greatest within a cycle per record of `peak`, by golden section.
fn refined(peak: f64, explained: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = ((peak - 1.0).max(0.5), peak + 1.0);
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_a, mut at_b) = (explained(a), explained(b));
    // 45 sections reach the square root of the rounding error, all that a maximum can give.
    for _ in 0..45 {
        if at_a > at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - golden * (high - low);
            at_a = explained(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + golden * (high - low);
            at_b = explained(b);
        }
    }
    0.5 * (low + high)
}

/// Weighted least-squares fit of a mean and Re(a e^{iθ}), θ = 2π `cycles` n / N: the complex amplitude a and
/// the weighted sum of squares that the fit explains.
fn fit_sine(samples: &[f64], cycles: f64) -> (Complex64, f64) {
    let n_samples = samples.len();
    let (mut normal, mut right) = (Matrix3::ZERO, Vector3::ZERO);
    for (index, sample) in samples.iter().enumerate() {
        let (sine, cosine) = (TAU * cycles * index as f64 / n_samples as f64).sin_cos();
        let row = Vector3::new(1.0, cosine, -sine);
        let weighted = hann(index, n_samples) * row;
        normal += Matrix3::from_cols(weighted * row.x, weighted * row.y, weighted * row.z);
        right += *sample * weighted;
    }
    let fit = normal.inverse() * right;
    (Complex64::new(fit.y, fit.z), fit.dot(right))
}

/// Weighted least-squares fit of a constant and a e^{iθ}, θ = 2π `cycles` n / N, to `first` + i `second`: the
/// complex amplitude a and the weighted sum of squares that it explains beyond the constant.
fn fit_rotation(first: &[f64], second: &[f64], cycles: f64) -> (Complex64, f64) {
    let n_samples = first.len();
    let (mut weights, mut cross) = (0.0, Complex64::default());
    let (mut constant, mut turning) = (Complex64::default(), Complex64::default());
    for (index, (x, y)) in first.iter().zip(second).enumerate() {
        let (sine, cosine) = (TAU * cycles * index as f64 / n_samples as f64).sin_cos();
        let (weight, wave) = (hann(index, n_samples), Complex64::new(cosine, sine));
        let value = Complex64::new(*x, *y);
        weights += weight;
        cross += weight * wave;
        constant += weight * value;
        turning += weight * value * wave.conj();
    }
    let determinant = weights * weights - cross.norm_sqr();
    let amplitude = (weights * turning - cross.conj() * constant) / determinant;
    (amplitude, amplitude.norm_sqr() * determinant / weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_pure_sine_is_found_between_the_bins(
            amplitude in 0.01..10.0_f64, cycles in 3.0..150.0_f64, phase in -3.0..3.0_f64,
            mean in -5.0..5.0_f64,
        ) {
            let samples: Vec<f64> = (0..400)
                .map(|i| mean + amplitude * (TAU * cycles * f64::from(i) / 400.0 + phase).cos())
                .collect();
            let line = strongest(&samples, 0.25).unwrap();
            prop_assert!((line.amplitude / amplitude - 1.0).abs() < 1e-6);
            prop_assert!((line.frequency * 100.0 - cycles).abs() < 1e-5);
            prop_assert!((line.phase - phase).abs() < 1e-4);
        }

        #[test]
        fn a_rotation_is_found_with_its_sense(
            amplitude in 0.01..10.0_f64, cycles in 3.0..150.0_f64, phase in -3.0..3.0_f64,
            mean in -5.0..5.0_f64, forward: bool,
        ) {
            let sign = if forward { 1.0 } else { -1.0 };
            let angle = |i: i32| sign * TAU * cycles * f64::from(i) / 400.0 + phase;
            let first: Vec<f64> = (0..400).map(|i| mean + amplitude * angle(i).cos()).collect();
            let second: Vec<f64> = (0..400).map(|i| amplitude * angle(i).sin() - mean).collect();
            let line = strongest_rotation(&first, &second, 0.25).unwrap();
            prop_assert!((line.amplitude / amplitude - 1.0).abs() < 1e-6);
            prop_assert!((line.frequency * 100.0 - sign * cycles).abs() < 1e-5);
            prop_assert!((line.phase - phase).abs() < 1e-4);
        }
    }

    #[test]
    fn the_stronger_of_two_lines_wins() {
        let samples: Vec<f64> = (0..1000)
            .map(|i| {
                let turn = TAU * f64::from(i) / 1000.0;
                (20.3 * turn).sin() + 0.4 * (45.0 * turn).sin()
            })
            .collect();
        let line = strongest(&samples, 1.0).expect("long enough");
        assert!((line.frequency - 0.0203).abs() < 1e-6 && (line.amplitude - 1.0).abs() < 1e-4);
    }

    #[test]
    fn short_records_are_refused() {
        assert!(strongest(&[0.0; 15], 1.0).is_err());
        assert!(strongest_rotation(&[0.0; 20], &[0.0; 21], 1.0).is_err());
    }
}
