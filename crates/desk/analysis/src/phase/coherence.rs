//! Coherence, gain and phase error of one record against another at one frequency.

use crate::AnalysisError;
use crate::statistics::{mean, student_97_5};
use realfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// 97.5 % point of the normal distribution (–).
const NORMAL_97_5: f64 = 1.959_963_984_540_054;
/// Correlation of the spectra of neighbouring segments, half overlapped, under Hann's window, squared (–).
const OVERLAP: f64 = 1.0 / 36.0;

/// Estimate against truth at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coherence {
    /// Magnitude-squared coherence (–, [0, 1]).
    pub coherence: f64,
    /// Its 95 % interval (–).
    pub coherence_95: [f64; 2],
    /// Coherence that unrelated records exceed one time in twenty (–); a smaller one is not significant.
    pub floor_95: f64,
    /// Phase of the estimate minus that of the truth (rad, [−π, π]): positive when the estimate is ahead.
    pub phase_error: f64,
    /// Half width of its 95 % interval (rad); π where nothing is known.
    pub phase_error_half_width_95: f64,
    /// Amplitude of the estimate over that of the truth it follows (–).
    pub gain: f64,
    /// Segments behind it (–).
    pub n_segments: usize,
}

/// How `estimated` follows `truth` (one unit each, every `interval` s) at `frequency` (Hz), from segments of
/// `n_segment` samples that overlap by half under Hann's window.
///
/// The cross-spectrum is taken at `frequency` itself, not at the nearest of a grid. A segment should hold at
/// least three periods; with p periods it tells the frequency from others a share 2/p of it away. Two pure
/// sines are coherent whatever their phases; here coherence is reduced by amplitudes and phases that change
/// differently from segment to segment.
///
/// The interval of the phase error is that of Student's t for 2 (n − 1) degrees of freedom, n the segments
/// counted for as many as are independent: sin of its half width = t √((1 − γ²)/(γ² 2 (n − 1))).
///
/// Source: Welch (1967); Bendat and Piersol, "Random Data", 4th ed., 2010, §9.2 (error of coherence);
/// Koopmans, "The Spectral Analysis of Time Series", 1974, §8.5 (interval of the phase); Harris, Proc. IEEE
/// 66, 1978, Eq. 17 (independent segments).
///
/// # Errors
/// [`AnalysisError::UnequalLengths`]; [`AnalysisError::TooShort`] with fewer than two segments;
/// [`AnalysisError::NotPositive`] for the interval; [`AnalysisError::AboveNyquist`];
/// [`AnalysisError::NotFinite`].
pub fn coherence(
    estimated: &[f64],
    truth: &[f64],
    interval: f64,
    frequency: f64,
    n_segment: usize,
) -> Result<Coherence, AnalysisError> {
    check(estimated, truth, interval, frequency, n_segment)?;
    let waves: Vec<(Complex64, f64)> = (0..n_segment)
        .map(|index| {
            let weight = 0.5 - 0.5 * (TAU * index as f64 / n_segment as f64).cos();
            let turned = -TAU * frequency * index as f64 * interval;
            (Complex64::from_polar(weight, turned), weight)
        })
        .collect();
    let weights: f64 = waves.iter().map(|wave| wave.1).sum();
    let transform = |segment: &[f64]| -> Complex64 {
        // Weighted like this, the mean leaves nothing to leak.
        let mean = segment.iter().zip(&waves).map(|(x, wave)| x * wave.1).sum::<f64>() / weights;
        segment.iter().zip(&waves).map(|(x, wave)| (x - mean) * wave.0).sum()
    };
    let (mut of_estimate, mut of_truth, mut cross) = (0.0, 0.0, Complex64::default());
    let mut n_segments = 0;
    for start in (0..=truth.len() - n_segment).step_by((n_segment / 2).max(1)) {
        let x = transform(&truth[start..start + n_segment]);
        let y = transform(&estimated[start..start + n_segment]);
        of_truth += x.norm_sqr();
        of_estimate += y.norm_sqr();
        cross += x.conj() * y;
        n_segments += 1;
    }
    let product = of_truth * of_estimate;
    let coherence = if product > 0.0 { (cross.norm_sqr() / product).min(1.0) } else { 0.0 };
    let n = n_segments as f64;
    let n_independent = n * n / (n + 2.0 * (n - 1.0) * OVERLAP);
    let half_width = NORMAL_97_5 / (2.0 * n_independent).sqrt();
    let ends = [-half_width, half_width].map(|off| {
        // Beyond 1 − 10⁻¹² only rounding tells coherence from one.
        let moved = coherence.sqrt().min(1.0 - 1e-12).atanh() + off;
        moved.max(0.0).tanh().powi(2)
    });
    // Few segments leave few degrees of freedom, 2 (n − 1).
    let freedom = (2.0 * (n_independent - 1.0)).max(1.0);
    let unexplained = (1.0 - coherence) / coherence.max(f64::MIN_POSITIVE);
    let sine = student_97_5(freedom.floor() as usize) * (unexplained / freedom).sqrt();
    let phase_half_width = if sine < 1.0 { sine.asin() } else { std::f64::consts::PI };
    Ok(Coherence {
        coherence,
        coherence_95: ends,
        floor_95: 1.0 - 0.05_f64.powf(1.0 / (n_independent - 1.0)),
        phase_error: cross.arg(),
        phase_error_half_width_95: phase_half_width,
        gain: if of_truth > 0.0 { cross.norm() / of_truth } else { 0.0 },
        n_segments,
    })
}

fn check(
    estimated: &[f64],
    truth: &[f64],
    interval: f64,
    frequency: f64,
    n_segment: usize,
) -> Result<(), AnalysisError> {
    if estimated.len() != truth.len() {
        let (first, second) = (estimated.len(), truth.len());
        return Err(AnalysisError::UnequalLengths { first, second });
    }
    if interval.is_nan() || interval <= 0.0 {
        let quantity = "the sampling interval";
        return Err(AnalysisError::NotPositive { quantity, value: interval });
    }
    let nyquist = 0.5 / interval;
    if frequency.is_nan() || frequency.abs() >= nyquist {
        return Err(AnalysisError::AboveNyquist { frequency, nyquist });
    }
    // Two segments that overlap by half.
    let needed = n_segment.max(crate::line::FEWEST_SAMPLES) + n_segment / 2;
    if n_segment < crate::line::FEWEST_SAMPLES || truth.len() < needed {
        return Err(AnalysisError::TooShort { n_samples: truth.len().min(n_segment), needed });
    }
    let finite = [mean(estimated), mean(truth)].iter().all(|mean| mean.is_finite());
    if finite {
        return Ok(());
    }
    let index = estimated.iter().zip(truth).position(|(a, b)| !(a + b).is_finite()).unwrap_or(0);
    Err(AnalysisError::NotFinite { index })
}
