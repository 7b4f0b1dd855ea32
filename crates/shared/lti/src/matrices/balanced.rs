//! Balanced truncation.

use super::dense::{singular_decomposition, square_root_factor};
use super::{MatrixError, StateSpace};
use faer::Mat;

/// Hankel singular value, as a share of the largest, below which a state is not there.
const NOT_THERE: f64 = 1e-14;

/// A system of lower order, and what tells how much is lost.
#[derive(Clone, Debug)]
pub struct Balanced {
    /// In balanced coordinates: both its Gramians are the diagonal of the first Hankel singular values.
    pub system: StateSpace,
    /// Hankel singular values of the whole system, largest first (–).
    pub hankel_singular_values: Vec<f64>,
    /// Twice the sum of the Hankel singular values that were left out: an upper bound of the H-infinity
    /// norm of the difference (–).
    pub error_bound: f64,
}

/// Balanced truncation of a stable system to `order`, or to what the system has where that is less.
///
/// By the square-root method: Laub, Heath, Paige and Ward, IEEE Trans. Automatic Control 32, 1987; the
/// bound is Glover's (Int. J. Control 39, 1984) and Enns's.
pub fn balanced_truncation(system: &StateSpace, order: usize) -> Result<Balanced, MatrixError> {
    let moved = square_root_factor(&system.controllability_gramian()?)?;
    let seen = square_root_factor(&system.observability_gramian()?)?;
    let (left, values, right) = singular_decomposition(&(seen.transpose() * &moved))?;
    let least = NOT_THERE * values.first().copied().unwrap_or(0.0);
    let there = values.iter().take_while(|value| **value > least).count();
    let kept = order.min(there);
    let scaled = |factor: &Mat<f64>, vectors: &Mat<f64>| {
        let kept_vectors =
            Mat::from_fn(values.len(), kept, |i, j| vectors[(i, j)] / values[j].sqrt());
        factor * kept_vectors
    };
    let (into, out) = (scaled(&seen, &left), scaled(&moved, &right));
    let system = StateSpace::new(
        into.transpose() * &system.a * &out,
        into.transpose() * &system.b,
        &system.c * &out,
        system.d.clone(),
        system.interval,
    );
    let error_bound = 2.0 * values[kept..].iter().sum::<f64>();
    Ok(Balanced { system, hankel_singular_values: values, error_bound })
}
