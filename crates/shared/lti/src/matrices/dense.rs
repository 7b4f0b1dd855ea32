//! Dense matrices: blocks, inverses, eigenvalues and factors, of any size down to none.

use super::MatrixError;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side, c64};
use num_complex::Complex64;

/// Reciprocal condition (–) below which a matrix counts as singular.
const SMALLEST_CONDITION: f64 = 1e-15;

/// A matrix of blocks, row after row of them.
///
/// # Panics
/// Where the blocks' sizes do not fit one another.
pub fn blocks(rows: &[&[&Mat<f64>]]) -> Mat<f64> {
    let height = rows.iter().map(|row| row.first().map_or(0, |block| block.nrows())).sum();
    let width = rows.first().map_or(0, |row| row.iter().map(|block| block.ncols()).sum());
    let mut whole = Mat::zeros(height, width);
    let mut top = 0;
    for row in rows {
        let (mut left, tall) = (0, row.first().map_or(0, |block| block.nrows()));
        for block in *row {
            assert_eq!(block.nrows(), tall, "blocks in a row are equally tall");
            whole.submatrix_mut(top, left, tall, block.ncols()).copy_from(block);
            left += block.ncols();
        }
        assert_eq!(left, width, "rows of blocks are equally wide");
        top += tall;
    }
    whole
}

/// The part of `rows` rows from `top` and `columns` columns from `left`.
///
/// # Panics
/// Where that is outside the matrix.
pub fn part(matrix: &Mat<f64>, top: usize, left: usize, rows: usize, columns: usize) -> Mat<f64> {
    matrix.submatrix(top, left, rows, columns).to_owned()
}

/// The identity of size `n`.
pub fn identity(n: usize) -> Mat<f64> {
    Mat::identity(n, n)
}

/// The transpose as a matrix of its own.
pub fn transposed(matrix: &Mat<f64>) -> Mat<f64> {
    matrix.transpose().to_owned()
}

/// Half the sum of a square matrix and its transpose.
pub fn symmetric(matrix: &Mat<f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| 0.5 * (matrix[(i, j)] + matrix[(j, i)]))
}

/// Whether all entries are finite numbers.
pub fn is_finite(matrix: &Mat<f64>) -> bool {
    (0..matrix.ncols()).all(|j| (0..matrix.nrows()).all(|i| matrix[(i, j)].is_finite()))
}

/// Whether all entries are finite numbers.
fn is_finite_complex(matrix: &Mat<c64>) -> bool {
    (0..matrix.ncols()).all(|j| (0..matrix.nrows()).all(|i| matrix[(i, j)].is_finite()))
}

/// Inverse of a square matrix, or `None` where it is singular to working precision.
pub fn inverse(matrix: &Mat<f64>) -> Option<Mat<f64>> {
    if matrix.nrows() == 0 {
        return Some(matrix.clone());
    }
    if !is_finite(matrix) {
        return None;
    }
    let inverse = matrix.partial_piv_lu().inverse();
    let condition = inverse.norm_l2() * matrix.norm_l2();
    (is_finite(&inverse) && condition * SMALLEST_CONDITION < matrix.nrows() as f64)
        .then_some(inverse)
}

/// Solution X of A X = B for complex matrices, or `None` where A is singular.
pub fn solve_complex(a: &Mat<c64>, b: &Mat<c64>) -> Option<Mat<c64>> {
    if a.nrows() == 0 || b.ncols() == 0 {
        return Some(b.clone());
    }
    let solution = a.partial_piv_lu().solve(b);
    is_finite_complex(&solution).then_some(solution)
}

/// A real matrix as a complex one.
pub fn complex(matrix: &Mat<f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| c64::new(matrix[(i, j)], 0.0))
}

/// Eigenvalues of a square matrix, in no particular order.
pub fn eigenvalues(matrix: &Mat<f64>) -> Result<Vec<Complex64>, MatrixError> {
    if matrix.nrows() == 0 {
        return Ok(Vec::new());
    }
    if !is_finite(matrix) {
        return Err(MatrixError::NotFinite);
    }
    matrix.eigenvalues().map_err(|_| MatrixError::NotConverged("the search for eigenvalues"))
}

/// Eigenvalues of a square complex matrix, in no particular order.
pub fn complex_eigenvalues(matrix: &Mat<c64>) -> Result<Vec<Complex64>, MatrixError> {
    if !is_finite_complex(matrix) {
        return Err(MatrixError::NotFinite);
    }
    matrix.eigenvalues().map_err(|_| MatrixError::NotConverged("the search for eigenvalues"))
}

/// Eigenvalues of a symmetric matrix, smallest first, and its eigenvectors as columns.
pub fn symmetric_eigen(matrix: &Mat<f64>) -> Result<(Vec<f64>, Mat<f64>), MatrixError> {
    if matrix.nrows() == 0 {
        return Ok((Vec::new(), matrix.clone()));
    }
    if !is_finite(matrix) {
        return Err(MatrixError::NotFinite);
    }
    let eigen = matrix
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| MatrixError::NotConverged("the search for eigenvalues"))?;
    let values = eigen.S().column_vector();
    Ok(((0..matrix.nrows()).map(|i| values[i]).collect(), eigen.U().to_owned()))
}

/// A factor L of a positive semidefinite matrix, L Lᵀ; what rounding left below zero counts as zero.
pub fn square_root_factor(matrix: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let (values, vectors) = symmetric_eigen(&symmetric(matrix))?;
    Ok(Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        vectors[(i, j)] * values[j].max(0.0).sqrt()
    }))
}

/// U, s and V of a singular value decomposition.
pub type SingularDecomposition = (Mat<f64>, Vec<f64>, Mat<f64>);

/// Singular value decomposition A = U diag(s) Vᵀ with square U and V: U, s (largest first), V.
pub fn singular_decomposition(matrix: &Mat<f64>) -> Result<SingularDecomposition, MatrixError> {
    let (rows, columns) = (matrix.nrows(), matrix.ncols());
    if rows == 0 || columns == 0 {
        return Ok((identity(rows), Vec::new(), identity(columns)));
    }
    if !is_finite(matrix) {
        return Err(MatrixError::NotFinite);
    }
    let svd =
        matrix.svd().map_err(|_| MatrixError::NotConverged("the singular value decomposition"))?;
    let values = svd.S().column_vector();
    let values = (0..rows.min(columns)).map(|i| values[i]).collect();
    Ok((svd.U().to_owned(), values, svd.V().to_owned()))
}

/// Largest singular value, 0 for a matrix without entries.
pub fn largest_singular_value(matrix: &Mat<c64>) -> Result<f64, MatrixError> {
    Ok(complex_singular_values(matrix)?.first().copied().unwrap_or(0.0))
}

/// Singular values of a complex matrix, largest first.
pub fn complex_singular_values(matrix: &Mat<c64>) -> Result<Vec<f64>, MatrixError> {
    if matrix.nrows() == 0 || matrix.ncols() == 0 {
        return Ok(Vec::new());
    }
    if !is_finite_complex(matrix) {
        return Err(MatrixError::NotFinite);
    }
    let values = matrix
        .singular_values()
        .map_err(|_| MatrixError::NotConverged("the singular value decomposition"))?;
    Ok(values)
}
