//! The mean curve: a trend and covariances with weighted points.

use super::covariance::{CHUNK, Points};
use super::expression::Kernel;
use super::threads::{number, share};
use crate::vector::add_product;

/// Points that a thread works out at once (–).
const BATCH: usize = 256;

/// Mean curve in the user's units.
#[derive(Clone, Debug)]
pub struct MeanCurve {
    /// Middle of the inputs, so that differences of large numbers keep their digits.
    pub(crate) centres: Vec<f64>,
    pub(crate) kernel: Kernel,
    pub(crate) points: Points,
    pub(crate) weights: Vec<f64>,
    /// Constant, then slopes.
    pub(crate) coefficients: Vec<f64>,
}

/// `inputs`, those of one point together, as columns less `centres`.
pub(crate) fn centred(inputs: &[f64], centres: &[f64]) -> Vec<Vec<f64>> {
    let column = |(input, centre): (usize, &f64)| {
        inputs.iter().skip(input).step_by(centres.len()).map(|x| x - centre).collect()
    };
    centres.iter().enumerate().map(column).collect()
}

impl MeanCurve {
    /// The trend of `coefficients`, a constant and slopes or nothing, plus Σ weight × covariance with the
    /// points
    /// `inputs`, those of one together.
    pub fn new(
        kernel: Kernel,
        n_dimensions: usize,
        inputs: &[f64],
        weights: Vec<f64>,
        coefficients: Vec<f64>,
    ) -> Self {
        let n = weights.len().max(1) as f64;
        let centre = |input| inputs.iter().skip(input).step_by(n_dimensions).sum::<f64>() / n;
        let centres: Vec<f64> = (0..n_dimensions).map(centre).collect();
        let points = Points::new(&kernel, &centred(inputs, &centres));
        Self { centres, kernel, points, weights, coefficients }
    }

    /// Mean at each of `inputs`, those of one together, on `n_threads`; 0 for as many as the machine has.
    pub fn means(&self, inputs: &[f64], n_threads: usize) -> Vec<f64> {
        let (n_dimensions, n_threads) = (self.centres.len(), number(n_threads));
        let mut means = vec![0.0; inputs.len() / n_dimensions];
        let tasks: Vec<_> =
            means.chunks_mut(BATCH).zip(inputs.chunks(BATCH * n_dimensions)).collect();
        let n_points = self.weights.len();
        share(
            n_threads,
            tasks,
            || [0.0; CHUNK],
            |room, (means, inputs)| {
                let queries = Points::new(&self.kernel, &centred(inputs, &self.centres));
                for start in (0..n_points).step_by(CHUNK) {
                    let range = start..(start + CHUNK).min(n_points);
                    let weights = &self.weights[range.clone()];
                    for (index, mean) in means.iter_mut().enumerate() {
                        let room = &mut room[..range.len()];
                        self.points.covariances(range.clone(), &queries, index, room);
                        add_product(mean, room, weights);
                    }
                }
                for (mean, input) in means.iter_mut().zip(inputs.chunks(n_dimensions)) {
                    let mut functions = std::iter::once(&1.0).chain(input);
                    *mean += self
                        .coefficients
                        .iter()
                        .map(|coefficient| coefficient * functions.next().unwrap_or(&0.0))
                        .sum::<f64>();
                }
            },
        );
        means
    }
}
