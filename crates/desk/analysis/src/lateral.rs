//! Coherence of the wind at points side by side.

use crate::AnalysisError;
use crate::spectra::{self, hann};
use crate::statistics::mean;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

/// Coherence of points side by side over their distance, at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LateralCoherence {
    /// Frequency (Hz).
    pub frequency: f64,
    /// Modulus of the cross-spectrum over the spectrum, not its square (–), of points no, one, two, …
    /// distances apart.
    pub values: Vec<f64>,
}

/// Coherence of `points`, records side by side at equal distances (one unit, every `interval` s), at the
/// frequencies nearest to `frequencies` (Hz) that segments of `n_segment` samples tell apart, up to
/// `n_distances` distances.
///
/// Spectrum and cross-spectrum are means over all points and pairs, which are taken for alike, and over
/// segments that overlap by half, under Hann's window (Welch 1967). IEC 61400-1 has a model of this coherence
/// (2005, eq. B.16).
///
/// # Errors
/// [`AnalysisError::UnequalLengths`]; [`AnalysisError::TooShort`] where a segment does not fit;
/// [`AnalysisError::NotPositive`] for the interval; [`AnalysisError::AboveNyquist`].
pub fn lateral_coherence(
    points: &[Vec<f64>],
    interval: f64,
    frequencies: &[f64],
    n_segment: usize,
    n_distances: usize,
) -> Result<Vec<LateralCoherence>, AnalysisError> {
    check(points, interval, frequencies, n_segment)?;
    let step = 1.0 / (n_segment as f64 * interval);
    let bins: Vec<usize> = frequencies.iter().map(|f| (f / step).round() as usize).collect();
    let n_distances = n_distances.min(points.len().saturating_sub(1));
    let mut sums = vec![vec![(Complex64::default(), 0_usize); n_distances + 1]; bins.len()];
    let n_samples = points.first().map_or(0, Vec::len);
    let starts: Vec<usize> = (0..=n_samples - n_segment).step_by(n_segment / 2).collect();
    let mut transform = Transform::new(n_segment, &bins);
    for start in &starts {
        let waves: Vec<Vec<Complex64>> = points
            .iter()
            .map(|samples| transform.of(&samples[*start..start + n_segment], mean(samples)))
            .collect();
        for (place, sums) in sums.iter_mut().enumerate() {
            for (distance, (sum, count)) in sums.iter_mut().enumerate() {
                for pair in waves.windows(distance + 1) {
                    *sum += pair[0][place].conj() * pair[distance][place];
                    *count += 1;
                }
            }
        }
    }
    let coherence = |(bin, sums): (&usize, Vec<(Complex64, usize)>)| {
        let means: Vec<f64> = sums.iter().map(|(sum, count)| sum.norm() / *count as f64).collect();
        let own = means.first().copied().unwrap_or(0.0);
        let values = means.iter().map(|mean| if own > 0.0 { mean / own } else { 0.0 }).collect();
        LateralCoherence { frequency: *bin as f64 * step, values }
    };
    Ok(bins.iter().zip(sums).map(coherence).collect())
}

/// Fourier transforms of segments at some frequencies.
struct Transform<'a> {
    plan: std::sync::Arc<dyn realfft::RealToComplex<f64>>,
    weights: Vec<f64>,
    bins: &'a [usize],
    input: Vec<f64>,
    output: Vec<Complex64>,
}

impl<'a> Transform<'a> {
    fn new(n: usize, bins: &'a [usize]) -> Self {
        let plan = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        Self {
            weights: hann(n),
            bins,
            input: plan.make_input_vec(),
            output: plan.make_output_vec(),
            plan,
        }
    }

    /// That of `segment`, from whose samples `mean` is taken off.
    fn of(&mut self, segment: &[f64], mean: f64) -> Vec<Complex64> {
        for ((input, sample), weight) in self.input.iter_mut().zip(segment).zip(&self.weights) {
            *input = (sample - mean) * weight;
        }
        self.plan
            .process(&mut self.input, &mut self.output)
            .expect("input and output have the lengths that the plan asks for");
        self.bins.iter().map(|bin| self.output[*bin]).collect()
    }
}

fn check(
    points: &[Vec<f64>],
    interval: f64,
    frequencies: &[f64],
    n_segment: usize,
) -> Result<(), AnalysisError> {
    let first = points.first().map_or(0, Vec::len);
    if let Some(other) = points.iter().find(|other| other.len() != first) {
        return Err(AnalysisError::UnequalLengths { first, second: other.len() });
    }
    spectra::check(first, n_segment, interval)?;
    let nyquist = 0.5 / interval;
    match frequencies.iter().find(|frequency| !(0.0..nyquist).contains(*frequency)) {
        Some(&frequency) => Err(AnalysisError::AboveNyquist { frequency, nyquist }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise that follows from `seed` (splitmix64).
    fn noise(seed: u64, n: usize) -> Vec<f64> {
        // No multiple of the step: the records would be shifts of each other.
        let mut state = seed.wrapping_mul(0xd134_2543_de82_ef95);
        let next = || {
            let number = basis::mixed(state);
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            (number >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        std::iter::repeat_with(next).take(n).collect()
    }

    #[test]
    fn points_that_share_a_part_of_their_power_are_so_coherent() {
        // Neighbours share a record: half of the power of each is that of the one on its left.
        let shared: Vec<Vec<f64>> = (0..25).map(|point| noise(point, 1 << 14)).collect();
        let points: Vec<Vec<f64>> = shared
            .windows(2)
            .map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| 3.0 + a + b).collect())
            .collect();
        let found = lateral_coherence(&points, 0.5, &[0.1, 0.4], 256, 3).unwrap();
        for one in &found {
            assert_eq!(one.values[0], 1.0);
            assert!((one.values[1] - 0.5).abs() < 0.05, "{one:?}");
            assert!(one.values[2].max(one.values[3]) < 0.06, "{one:?}");
        }
        assert!((found[0].frequency - 0.1).abs() < 0.5 / 128.0);
        let same = vec![points[0].clone(); 4];
        let found = lateral_coherence(&same, 0.5, &[0.1], 256, 9).unwrap();
        assert_eq!(found[0].values.len(), 4);
        assert!(found[0].values.iter().all(|value| (value - 1.0).abs() < 1e-12));
    }

    #[test]
    fn bad_records_are_refused() {
        let short = vec![vec![0.0; 100]; 3];
        assert!(lateral_coherence(&short, 1.0, &[0.1], 200, 2).is_err());
        assert!(lateral_coherence(&short, 0.0, &[0.1], 50, 2).is_err());
        assert!(lateral_coherence(&short, 1.0, &[0.5], 50, 2).is_err());
        let uneven = [vec![0.0; 100], vec![0.0; 99]];
        assert!(lateral_coherence(&uneven, 1.0, &[0.1], 50, 2).is_err());
    }
}
