//! Marginal likelihood of observations under hyperparameters, and its derivatives.
//!
//! Source: Rasmussen and Williams (2006), Eqs. 5.8 and 5.9; an estimated mean, §2.7 with its generalised
//! least squares.

use crate::factor::{Factor, dot};
use crate::{Hyperparameters, Observations, Shape, SurrogateError};

/// Mean of the process far from observations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mean {
    /// Zero, as in van Vondelen et al. (2025): for differences to a reference.
    Zero,
    /// A constant, estimated by generalised least squares; its uncertainty is part of every band.
    #[default]
    Constant,
}

/// Observations under one set of hyperparameters.
#[derive(Clone, Debug)]
pub(crate) struct Likelihood {
    pub(crate) factor: Factor,
    /// The mean (unit of the values).
    pub(crate) mean: f64,
    /// K⁻¹ (y − mean).
    pub(crate) weights: Vec<f64>,
    /// K⁻¹ 1.
    pub(crate) of_ones: Vec<f64>,
    /// Natural logarithm of the marginal likelihood (–).
    pub(crate) log: f64,
}

impl Likelihood {
    pub(crate) fn new(
        shape: Shape,
        parameters: &Hyperparameters,
        observations: &Observations,
        mean: Mean,
    ) -> Result<Self, SurrogateError> {
        let factor = Factor::new(shape, parameters, observations)?;
        let of_ones = factor.solve(&vec![1.0; observations.len()]);
        let mean = match mean {
            Mean::Zero => 0.0,
            Mean::Constant => dot(&of_ones, &observations.values) / of_ones.iter().sum::<f64>(),
        };
        let residuals: Vec<f64> = observations.values.iter().map(|value| value - mean).collect();
        let weights = factor.solve(&residuals);
        let n_log_turn = observations.len() as f64 * std::f64::consts::TAU.ln();
        let log = -0.5 * (dot(&residuals, &weights) + factor.log_determinant() + n_log_turn);
        Ok(Self { factor, mean, weights, of_ones, log })
    }

    /// Derivatives of the logarithm by the logarithms of signal variance, lengths and noise variance, in that
    /// order.
    ///
    /// A constant mean is at its own optimum for every set, so that its movement adds nothing.
    pub(crate) fn slopes(
        &self,
        shape: Shape,
        parameters: &Hyperparameters,
        observations: &Observations,
    ) -> Vec<f64> {
        let n_lengths = parameters.lengths.len();
        let inverse = self.factor.inverse();
        let mut slopes = vec![0.0; n_lengths + 2];
        let mut of_lengths = vec![0.0; n_lengths];
        for row in 0..observations.len() {
            for column in 0..=row {
                let twice = if row == column { 0.5 } else { 1.0 };
                let factor =
                    twice * (self.weights[row] * self.weights[column] - inverse[(row, column)]);
                let (a, b) = (observations.input(row), observations.input(column));
                slopes[0] += factor * shape.slopes(parameters, a, b, &mut of_lengths);
                for (slope, of_length) in slopes[1..].iter_mut().zip(&of_lengths) {
                    *slope += factor * of_length;
                }
                if row == column {
                    slopes[n_lengths + 1] += factor * parameters.noise_variance;
                }
            }
        }
        slopes
    }
}
