//! Frequency responses straight from a record, without a model.

use crate::{IdentificationError, Record};
use faer::{Mat, c64};
use lti::Complex64;
use lti::matrices::MatrixError;
use lti::matrices::dense::solve_complex;
use rustfft::FftPlanner;
use std::f64::consts::TAU;

/// Squared correlation of neighbouring segments' transforms under Hann's window at half overlap (–).
/// Source: Welch, IEEE Trans. Audio Electroacoust. 15, 1967.
const NEIGHBOURS: f64 = 1.0 / 36.0;

/// Fewest samples in a segment (–).
const FEWEST: usize = 8;

/// Frequency responses from all inputs to all outputs with what they are worth.
///
/// Spectra are averages over segments that overlap by half, under Hann's window, means of the whole record
/// removed (Welch 1967). The response G = S_yu S_uu⁻¹ takes all disturbance to be on the outputs (the H1
/// estimator); it is biased where the input depends on the disturbance, as in a closed loop.
/// Source: Bendat and Piersol, "Random data", 4th ed., 2010, chapters 7 and 9.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyResponse {
    /// Frequencies (rad/s), from one to below half the sampling rate, equally spaced.
    pub frequencies: Vec<f64>,
    /// Outputs × inputs at each frequency, output unit per input unit.
    pub responses: Vec<Mat<c64>>,
    /// Root mean square of the modulus of each response's random error, as `responses`. One error in twenty
    /// is larger than √3 times this.
    pub deviations: Vec<Mat<f64>>,
    /// Multiple coherence γ² of each output with all inputs at each frequency (–): the share of its power
    /// that the inputs explain.
    pub coherences: Vec<Vec<f64>>,
    /// Standard deviation of each coherence (–), √2 (1 − γ²) γ/√n over n `averages`.
    pub coherence_deviations: Vec<Vec<f64>>,
    /// Independent segments that the averages amount to (–).
    pub averages: f64,
}

/// Products of all channels' transforms, inputs first.
type Spectra = Vec<Mat<c64>>;

impl FrequencyResponse {
    /// From segments of `n_segment` samples.
    ///
    /// # Errors
    /// [`IdentificationError::TooFewSamples`] where there are not two segments more than inputs;
    /// [`IdentificationError::Matrix`] where inputs cannot be told apart.
    pub fn new(record: &Record, n_segment: usize) -> Result<Self, IdentificationError> {
        let inputs = record.inputs().len();
        let hop = n_segment / 2;
        crate::error::within("the segment (samples)", n_segment as f64, FEWEST as f64, f64::MAX)?;
        record.long_enough(n_segment + (inputs + 1) * hop, "segments to average over")?;
        let n_segments = (record.n_samples() - n_segment) / hop + 1;
        let others = 2.0 * NEIGHBOURS * (n_segments - 1) as f64 / n_segments as f64;
        let mut found = Self {
            frequencies: Vec::new(),
            responses: Vec::new(),
            deviations: Vec::new(),
            coherences: Vec::new(),
            coherence_deviations: Vec::new(),
            averages: n_segments as f64 / (1.0 + others),
        };
        let step = TAU / (n_segment as f64 * record.interval());
        for (index, spectra) in spectra(record, n_segment, hop).iter().enumerate() {
            found.frequencies.push(step * (index + 1) as f64);
            found.add(spectra, inputs)?;
        }
        Ok(found)
    }

    /// One frequency more.
    fn add(&mut self, spectra: &Mat<c64>, inputs: usize) -> Result<(), IdentificationError> {
        let outputs = spectra.nrows() - inputs;
        let of_inputs = spectra.submatrix(0, 0, inputs, inputs).to_owned();
        let inverse = solve_complex(&of_inputs, &Mat::identity(inputs, inputs))
            .ok_or(MatrixError::Singular("the matrix of the inputs' spectra"))?;
        let response = spectra.submatrix(inputs, 0, outputs, inputs) * &inverse;
        let explained = &response * spectra.submatrix(0, inputs, inputs, outputs);
        let coherence: Vec<f64> = (0..outputs)
            .map(|i| explained[(i, i)].re / spectra[(inputs + i, inputs + i)].re)
            .map(|share| share.clamp(0.0, 1.0))
            .collect();
        // The mean square left over is larger by what the fit took up.
        let free = self.averages - inputs as f64;
        self.deviations.push(Mat::from_fn(outputs, inputs, |i, j| {
            let left = (1.0 - coherence[i]) * spectra[(inputs + i, inputs + i)].re;
            (left * inverse[(j, j)].re / free).max(0.0).sqrt()
        }));
        let deviation = |share: &f64| (2.0 * share / self.averages).sqrt() * (1.0 - share);
        self.coherence_deviations.push(coherence.iter().map(deviation).collect());
        self.coherences.push(coherence);
        self.responses.push(response);
        Ok(())
    }
}

/// Mean products of the segments' transforms, from the first frequency above zero to below half the rate.
fn spectra(record: &Record, n_segment: usize, hop: usize) -> Spectra {
    let channels: Vec<Vec<f64>> = record
        .inputs()
        .iter()
        .chain(record.outputs())
        .map(|channel| {
            let mean = channel.samples.iter().sum::<f64>() / channel.samples.len() as f64;
            channel.samples.iter().map(|x| x - mean).collect()
        })
        .collect();
    let window: Vec<f64> =
        (0..n_segment).map(|i| 0.5 - 0.5 * (TAU * i as f64 / n_segment as f64).cos()).collect();
    let transform = FftPlanner::new().plan_fft_forward(n_segment);
    let size = channels.len();
    let mut sums: Spectra = vec![Mat::zeros(size, size); (n_segment - 1) / 2];
    for start in (0..=record.n_samples() - n_segment).step_by(hop) {
        let transforms: Vec<Vec<Complex64>> = channels
            .iter()
            .map(|channel| {
                let weighted = channel[start..].iter().zip(&window).map(|(x, w)| x * w);
                let mut values: Vec<Complex64> = weighted.map(Complex64::from).collect();
                transform.process(&mut values);
                values
            })
            .collect();
        for (index, sum) in sums.iter_mut().enumerate() {
            for (i, first) in transforms.iter().enumerate() {
                for (j, second) in transforms.iter().enumerate() {
                    sum[(i, j)] += first[index + 1] * second[index + 1].conj();
                }
            }
        }
    }
    let n_segments = (record.n_samples() - n_segment) / hop + 1;
    sums.iter().map(|sum| faer::Scale(c64::from(1.0 / n_segments as f64)) * sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Noise, experiment, noise, oscillators, record, response};

    /// Errors of a known system's response are as large as their deviations say, and as seldom larger.
    #[test]
    fn errors_keep_to_their_bound() {
        let system = oscillators(2);
        let found =
            FrequencyResponse::new(&experiment(&system, 3, 1 << 16, Noise::White(10.0)), 1024)
                .expect("long enough");
        let (mut squares, mut beyond, mut count) = (0.0, 0, 0);
        for (index, frequency) in found.frequencies.iter().enumerate() {
            let known = system.response(*frequency).expect("no pole there");
            for i in 0..2 {
                for j in 0..2 {
                    let error = (found.responses[index][(i, j)] - known[(i, j)]).norm();
                    let share = error / found.deviations[index][(i, j)];
                    squares += share * share;
                    beyond += u32::from(share > 3.0_f64.sqrt());
                    count += 1;
                }
            }
        }
        let (mean, beyond) = (squares / f64::from(count), f64::from(beyond) / f64::from(count));
        assert!((mean - 1.0).abs() < 0.1, "{mean}");
        assert!((0.03..0.07).contains(&beyond), "{beyond}");
        assert!(found.frequencies[510] < std::f64::consts::PI);
    }

    /// Of y = u₁ + u₂ + n with variances 1, 1 and 2 half the power is explained.
    #[test]
    fn coherence_is_the_share_explained() {
        let (u, v, n) = (noise(1, 1 << 15), noise(2, 1 << 15), noise(3, 1 << 15));
        let y = (0..u.len()).map(|i| u[i] + v[i] + 2.0_f64.sqrt() * n[i]).collect();
        let found = FrequencyResponse::new(&record(vec![u, v], vec![y]), 256).expect("long enough");
        let all: Vec<f64> = found.coherences.iter().map(|shares| shares[0]).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        let spread = all.iter().map(|share| (share - 0.5).powi(2)).sum::<f64>() / all.len() as f64;
        let expected = found.coherence_deviations[50][0];
        assert!((spread.sqrt() / expected - 1.0).abs() < 0.3, "{} {expected}", spread.sqrt());
    }

    #[test]
    fn short_records_and_equal_inputs_are_refused() {
        let u = noise(1, 1000);
        let y = response(&oscillators(2), &[u.clone(), noise(2, 1000)]);
        let twice = record(vec![u.clone(), u], y);
        assert!(matches!(
            FrequencyResponse::new(&twice, 401),
            Err(IdentificationError::TooFewSamples { needed: 1001, .. })
        ));
        let equal = FrequencyResponse::new(&twice, 100);
        // Rounding can leave equal inputs a hair apart; then their responses are known as badly.
        assert!(equal.is_err() || equal.is_ok_and(|f| f.deviations[20][(0, 0)] > 1e3));
        assert!(FrequencyResponse::new(&twice, 4).is_err());
    }
}
