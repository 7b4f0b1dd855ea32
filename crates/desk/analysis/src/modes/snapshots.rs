//! Instants of a field, of which any part can be read.

use faer::linalg::solvers::SelfAdjointEigen;
use faer::{Mat, Side, c64};
use std::ops::Range;
use thiserror::Error;

/// Numbers that a part of a field holds at most, unless one place alone has more (–): 128 MiB.
const MOST_NUMBERS: usize = 1 << 24;

/// Instants of a field, evenly spaced, of which any part can be read.
pub trait Snapshots {
    /// Why a part cannot be read.
    type Error: std::error::Error + 'static;

    /// Instants (–).
    fn n_instants(&self) -> usize;

    /// Values of an instant (–): points times components.
    fn n_values(&self) -> usize;

    /// On return `values` holds those in `range` of all instants, instant by instant; not a number where
    /// there is a hole.
    ///
    /// # Errors
    /// What the reader says.
    fn read(&self, range: Range<usize>, values: &mut Vec<f64>) -> Result<(), Self::Error>;
}

/// Why there are no modes.
#[derive(Debug, Error)]
pub enum ModesError<E: std::error::Error + 'static> {
    /// The field cannot be read.
    #[error(transparent)]
    Read(#[from] E),
    /// Too few instants.
    #[error("{n_instants} instants are too few for modes; {needed} are needed")]
    TooFew {
        /// Instants (–).
        n_instants: usize,
        /// Fewest that are enough (–).
        needed: usize,
    },
    /// A setting that cannot be.
    #[error("{what}")]
    Setting {
        /// What is wrong, and what may be, in words.
        what: String,
    },
    /// Nothing varies, or every place has a hole.
    #[error(
        "of {n_values} values {n_masked} have holes, and the others do not vary: there is no mode"
    )]
    Nothing {
        /// Values of an instant (–).
        n_values: usize,
        /// Those with a hole at some instant (–).
        n_masked: usize,
    },
    /// The eigenvalues of the correlations were not found.
    #[error("the eigenvalues of the correlations between instants were not found")]
    Eigenvalues,
}

/// Instants in memory, one after another.
#[derive(Clone, Debug, PartialEq)]
pub struct InMemory {
    /// Values of an instant (–).
    pub n_values: usize,
    /// All values, instant by instant.
    pub values: Vec<f64>,
}

impl Snapshots for InMemory {
    type Error = std::convert::Infallible;

    fn n_instants(&self) -> usize {
        self.values.len() / self.n_values.max(1)
    }

    fn n_values(&self) -> usize {
        self.n_values
    }

    fn read(&self, range: Range<usize>, values: &mut Vec<f64>) -> Result<(), Self::Error> {
        values.clear();
        for instant in self.values.chunks_exact(self.n_values) {
            values.extend(&instant[range.clone()]);
        }
        Ok(())
    }
}

/// A part of a field: all instants of some places, the mean of each taken off, those with holes at zero.
pub(super) struct Part {
    /// The places.
    pub(super) range: Range<usize>,
    /// Deviations from the mean, instant by instant.
    pub(super) values: Vec<f64>,
    /// Mean of each place; not a number where there is a hole.
    pub(super) means: Vec<f64>,
}

/// Hands `take` all parts of `field`, one after another.
pub(super) fn in_parts<S: Snapshots>(
    field: &S,
    mut take: impl FnMut(&Part),
) -> Result<(), ModesError<S::Error>> {
    let (n_instants, n_values) = (field.n_instants(), field.n_values());
    let n_each = (MOST_NUMBERS / n_instants.max(1)).max(1);
    let mut values = Vec::new();
    for start in (0..n_values).step_by(n_each) {
        let range = start..n_values.min(start + n_each);
        field.read(range.clone(), &mut values)?;
        let n = range.len();
        let mut means = vec![0.0; n];
        for instant in values.chunks_exact(n) {
            for (mean, value) in means.iter_mut().zip(instant) {
                *mean += value;
            }
        }
        for mean in &mut means {
            *mean /= n_instants as f64;
        }
        for instant in values.chunks_exact_mut(n) {
            for (value, mean) in instant.iter_mut().zip(&means) {
                *value = if mean.is_finite() { *value - mean } else { 0.0 };
            }
        }
        let part = Part { range, values: std::mem::take(&mut values), means };
        take(&part);
        values = part.values;
    }
    Ok(())
}

/// Eigenvalues of a Hermitian matrix, the greatest first, with their vectors in columns.
pub(super) fn eigen<E: std::error::Error + 'static>(
    matrix: &Mat<c64>,
) -> Result<(Vec<f64>, Mat<c64>), ModesError<E>> {
    let found = SelfAdjointEigen::new(matrix.as_ref(), Side::Lower);
    let found = found.map_err(|_| ModesError::Eigenvalues)?;
    let n = matrix.nrows();
    let values = (0..n).rev().map(|place| found.S().column_vector()[place].re.max(0.0)).collect();
    let vectors = found.U();
    Ok((values, Mat::from_fn(n, n, |row, column| vectors[(row, n - 1 - column)])))
}
