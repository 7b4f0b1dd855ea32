//! Eigenvalues and vectors of Hermitian matrices.

use super::ModesError;
use faer::linalg::solvers::SelfAdjointEigen;
use faer::{Mat, Side};
use realfft::num_complex::Complex64;

/// Eigenvalues, greatest first and none below zero, with their vectors of length 1, one a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Eigen {
    pub(super) values: Vec<f64>,
    pub(super) vectors: Vec<Vec<Complex64>>,
}

/// Those of `matrix`, `n` × `n` in rows, of which the lower triangle is read; rounding that makes a value
/// of a positive matrix negative is taken off.
///
/// # Errors
/// [`ModesError::Eigenvalues`].
pub(super) fn eigen(matrix: &[Complex64], n: usize) -> Result<Eigen, ModesError> {
    let matrix = Mat::from_fn(n, n, |i, j| matrix[i * n + j]);
    let found = SelfAdjointEigen::new(matrix.as_ref(), Side::Lower);
    let found = found.map_err(|_| ModesError::Eigenvalues { n })?;
    let (values, vectors) = (found.S().column_vector(), found.U());
    // The library sorts them upwards.
    let downwards = || (0..n).rev();
    Ok(Eigen {
        values: downwards().map(|place| values[place].re.max(0.0)).collect(),
        vectors: downwards()
            .map(|place| (0..n).map(|row| vectors[(row, place)]).collect())
            .collect(),
    })
}
