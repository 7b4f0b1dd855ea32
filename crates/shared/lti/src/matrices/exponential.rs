//! Exponential and logarithm of a matrix.

use super::MatrixError;
use super::dense::{identity, inverse, is_finite};
use faer::Mat;

/// Norm (–) up to which the approximant of order 8 is exact to rounding.
const SMALL: f64 = 0.5;
/// Order of the approximant.
const ORDER: usize = 8;
/// Square roots that a logarithm takes at most.
const MOST_ROOTS: usize = 60;

/// e^A, by a Padé approximant of a 2^k-th part that is then squared k times.
///
/// Source: Golub and Van Loan, "Matrix Computations", 4th ed., 2013, §9.3.
pub fn exponential(matrix: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let n = matrix.nrows();
    if !is_finite(matrix) {
        return Err(MatrixError::NotFinite);
    }
    let size = matrix.norm_l2();
    let halvings = if size > SMALL { (size / SMALL).log2().ceil().min(1000.0) } else { 0.0 };
    let small = 0.5_f64.powf(halvings) * matrix;
    let (mut top, mut bottom) = (identity(n), identity(n));
    let (mut power, mut factor, mut sign) = (identity(n), 1.0, 1.0);
    for k in 1..=ORDER {
        factor *= (ORDER - k + 1) as f64 / (k * (2 * ORDER - k + 1)) as f64;
        sign = -sign;
        power = &small * &power;
        top += factor * &power;
        bottom += (sign * factor) * &power;
    }
    let solved = inverse(&bottom).ok_or(MatrixError::Singular("an exponential's denominator"))?;
    let mut whole = solved * top;
    for _ in 0..halvings as usize {
        whole = &whole * &whole;
    }
    if is_finite(&whole) { Ok(whole) } else { Err(MatrixError::NotFinite) }
}

/// The principal logarithm of a matrix without eigenvalues on the negative real axis, by square roots until
/// it is near the identity and a series from there.
///
/// Source: Higham, "Functions of Matrices", 2008, §6.3 (product form of the Denman-Beavers iteration) and
/// §11.5.
pub fn logarithm(matrix: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let one = identity(matrix.nrows());
    let mut root = matrix.clone();
    let mut doubled = 1.0;
    for _ in 0..MOST_ROOTS {
        if (&root - &one).norm_l2() <= 0.2 {
            break;
        }
        root = square_root(&root)?;
        doubled *= 2.0;
    }
    // ln(A) = 2 artanh((A − I)(A + I)⁻¹); the argument is at most 0.12, the last term below 1e-17.
    let solved = inverse(&(&root + &one)).ok_or(MatrixError::Singular("a logarithm's matrix"))?;
    let ratio = &solved * (&root - &one);
    let square = &ratio * &ratio;
    let (mut power, mut sum) = (ratio.clone(), ratio);
    for k in 1..=9 {
        power = &power * &square;
        sum += (1.0 / f64::from(2 * k + 1)) * &power;
    }
    let whole = (2.0 * doubled) * sum;
    if is_finite(&whole) { Ok(whole) } else { Err(MatrixError::NotConverged("a logarithm")) }
}

/// The principal square root.
fn square_root(matrix: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let none = || MatrixError::NotConverged("a matrix's square root");
    let one = identity(matrix.nrows());
    let (mut product, mut root) = (matrix.clone(), matrix.clone());
    for _ in 0..MOST_ROOTS {
        let turned = inverse(&product).ok_or_else(none)?;
        root = 0.5 * (&root * (&one + &turned));
        product = 0.5 * &one + 0.25 * (&product + &turned);
        let away = (&product - &one).norm_l2();
        if away <= 1e-15 * matrix.nrows() as f64 {
            return Ok(root);
        }
    }
    let left = (&root * &root - matrix).norm_l2();
    if left <= 1e-11 * matrix.norm_l2() { Ok(root) } else { Err(none()) }
}
