//! Proper orthogonal decomposition by the method of snapshots.

use super::snapshots::{ModesError, Snapshots, eigen, in_parts};
use faer::{Mat, c64};

/// Modes of a field, the strongest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pod {
    /// Mean of each value; not a number where there is a hole.
    pub mean: Vec<f64>,
    /// Energy of every mode: mean square of its coefficient.
    pub energies: Vec<f64>,
    /// The modes that are kept, each of unit size; zero at values with holes.
    pub modes: Vec<Vec<f64>>,
    /// Their coefficients at each instant.
    pub coefficients: Vec<Vec<f64>>,
    /// Values with a hole at some instant, which play no part (–).
    pub n_masked: usize,
}

/// The modes of `field`, `n_modes` of them kept, with the inner product Σ `weight` a b over all values.
///
/// Coefficients times modes, summed over all, give the field less its mean. The sign of a mode is that which
/// makes its greatest coefficient positive.
/// Source: Sirovich (1987), Quart. Appl. Math. 45, 561.
///
/// # Errors
/// [`ModesError`].
pub fn pod<S: Snapshots>(
    field: &S,
    weight: f64,
    n_modes: usize,
) -> Result<Pod, ModesError<S::Error>> {
    let (n, n_values) = (field.n_instants(), field.n_values());
    if n < 2 {
        return Err(ModesError::TooFew { n_instants: n, needed: 2 });
    }
    let mut correlations = Mat::<f64>::zeros(n, n);
    let mut found = Pod::default();
    in_parts(field, |part| {
        let width = part.range.len();
        // Rows are instants: a product of the matrix with its transpose.
        let matrix = faer::MatRef::from_row_major_slice(&part.values, n, width);
        correlations += matrix * matrix.transpose();
        found.n_masked += part.means.iter().filter(|mean| !mean.is_finite()).count();
        found.mean.extend(&part.means);
    })?;
    let scale = weight / n as f64;
    let hermitian = Mat::from_fn(n, n, |i, j| c64::new(scale * correlations[(i, j)], 0.0));
    let (energies, vectors) = eigen::<S::Error>(&hermitian)?;
    if energies[0] <= 0.0 {
        return Err(ModesError::Nothing { n_values, n_masked: found.n_masked });
    }
    // What the mean leaves of rounding is no mode.
    let n_sound = energies.iter().filter(|energy| **energy > 1e-12 * energies[0]).count();
    let kept = n_modes.min(n_sound);
    for mode in 0..kept {
        let size = (n as f64 * energies[mode]).sqrt();
        let column: Vec<f64> = (0..n).map(|i| vectors[(i, mode)].re * size).collect();
        let greatest = column.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let sign = greatest.unwrap_or(1.0).signum();
        found.coefficients.push(column.into_iter().map(|value| sign * value).collect());
    }
    found.modes = vec![Vec::with_capacity(n_values); kept];
    in_parts(field, |part| {
        let width = part.range.len();
        for (mode, values) in found.modes.iter_mut().enumerate() {
            let over = n as f64 * energies[mode];
            let start = values.len();
            values.resize(start + width, 0.0);
            for (instant, share) in part.values.chunks_exact(width).zip(&found.coefficients[mode]) {
                for (sum, value) in values[start..].iter_mut().zip(instant) {
                    *sum += share * value / over;
                }
            }
        }
    })?;
    found.energies = energies;
    Ok(found)
}
