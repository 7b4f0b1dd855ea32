//! Cholesky factor of the covariance of observations.

use crate::{Hyperparameters, Observations, Shape, SurrogateError};
use faer::linalg::solvers::{DenseSolveCore, Llt, Solve};
use faer::{Mat, Side};

/// Cholesky factor of K = k(X, X) + noise, with solutions, inverse and determinant.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    cholesky: Llt<f64>,
    n: usize,
}

impl Factor {
    /// Of `observations` under a kernel.
    pub(crate) fn new(
        shape: Shape,
        parameters: &Hyperparameters,
        observations: &Observations,
    ) -> Result<Self, SurrogateError> {
        let n = observations.len();
        let matrix = Mat::from_fn(n, n, |row, column| {
            let (a, b) = (observations.input(row), observations.input(column));
            let covariance = shape.covariance(parameters, a, b);
            if row == column {
                covariance + parameters.noise_variance + observations.variance(row)
            } else {
                covariance
            }
        });
        Self::of(&matrix)
    }

    /// Of a symmetric matrix.
    pub(crate) fn of(matrix: &Mat<f64>) -> Result<Self, SurrogateError> {
        let n = matrix.nrows();
        let cholesky =
            matrix.llt(Side::Lower).map_err(|_| SurrogateError::NotPositiveDefinite { n })?;
        // A covariance that contains NaN factorises without an error.
        let finite = (0..n).all(|index| cholesky.L()[(index, index)].is_finite());
        finite.then_some(Self { cholesky, n }).ok_or(SurrogateError::NotPositiveDefinite { n })
    }

    /// K⁻¹ `right`.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let right = Mat::from_fn(self.n, 1, |row, _| right[row]);
        let solved = self.cholesky.solve(&right);
        (0..self.n).map(|row| solved[(row, 0)]).collect()
    }

    /// K⁻¹.
    pub(crate) fn inverse(&self) -> Mat<f64> {
        self.cholesky.inverse()
    }

    /// ln |K|.
    pub(crate) fn log_determinant(&self) -> f64 {
        let factor = self.cholesky.L();
        2.0 * (0..self.n).map(|index| factor[(index, index)].ln()).sum::<f64>()
    }

    /// L `vector`, with L Lᵀ = K.
    pub(crate) fn lower_times(&self, vector: &[f64]) -> Vec<f64> {
        let factor = self.cholesky.L();
        (0..self.n)
            .map(|row| (0..=row).map(|column| factor[(row, column)] * vector[column]).sum())
            .collect()
    }
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
