//! The past of a record as a matrix of regressors, and its triangular factor.

use crate::{IdentificationError, Record};
use faer::{Mat, MatRef, Side};

/// Rows taken into the factor at a time, in widths of the matrix: each block costs a factor of one more
/// width.
const BLOCK: usize = 4;

/// Longest window over which the inputs' movements are counted (samples).
const DEPTH: usize = 100;

/// Independent movements within the window that an input must add to the others' (–): three sines' worth.
const MOVEMENTS: usize = 6;

/// Least share of the strongest movement that counts as another one, in power (–).
const LEAST_POWER: f64 = 1e-13;

/// For every sample k from `past` on: z(k−1), …, z(k−past), each inputs before outputs, then u(k) if wanted.
pub(super) struct Regressors<'a> {
    /// Inputs, then outputs.
    channels: Vec<&'a [f64]>,
    inputs: usize,
    past: usize,
    feedthrough: bool,
}

impl<'a> Regressors<'a> {
    pub(super) fn new(record: &'a Record, past: usize, feedthrough: bool) -> Self {
        let channels = record.inputs().iter().chain(record.outputs());
        let channels = channels.map(|channel| channel.samples.as_slice()).collect();
        Self { channels, inputs: record.inputs().len(), past, feedthrough }
    }

    /// Channels of z.
    pub(super) fn channels(&self) -> usize {
        self.channels.len()
    }

    /// Columns that hold the past.
    pub(super) fn lagged(&self) -> usize {
        self.past * self.channels.len()
    }

    /// Columns in all.
    pub(super) fn columns(&self) -> usize {
        self.lagged() + if self.feedthrough { self.inputs } else { 0 }
    }

    /// Rows in all.
    pub(super) fn rows(&self) -> usize {
        self.channels[0].len() - self.past
    }

    /// Upper triangular R with RᵀR = \[Z Y\]ᵀ\[Z Y\], Y the outputs at k. Householder reflections block by
    /// block: the matrix itself is never stored whole, and small singular values keep their digits, which
    /// they would not in a matrix of products.
    pub(super) fn triangular_factor(&self) -> Mat<f64> {
        let outputs = &self.channels[self.inputs..];
        let width = self.columns() + outputs.len();
        let samples = self.channels[0].len();
        let mut factor = Mat::<f64>::zeros(width, width);
        for start in (self.past..samples).step_by(BLOCK * width) {
            let end = samples.min(start + BLOCK * width);
            let mut stacked = Mat::<f64>::zeros(width + end - start, width);
            for column in 0..width {
                let target = stacked.col_mut(column).try_as_col_major_mut();
                let target = target.expect("a matrix's columns are contiguous").as_slice_mut();
                let (top, below) = target.split_at_mut(width);
                for (row, value) in top.iter_mut().enumerate().take(column + 1) {
                    *value = factor[(row, column)];
                }
                below.copy_from_slice(self.column(column, start, end));
            }
            let reflected = stacked.qr();
            factor = reflected.thin_R().to_owned();
        }
        upper(factor.as_ref())
    }

    /// Column `column` of \[Z Y\] for the samples from `start` to `end`.
    fn column(&self, column: usize, start: usize, end: usize) -> &'a [f64] {
        if column < self.lagged() {
            let (lag, channel) = (column / self.channels.len() + 1, column % self.channels.len());
            return &self.channels[channel][start - lag..end - lag];
        }
        let present = column - self.lagged();
        let skipped = if self.feedthrough { 0 } else { self.inputs };
        &self.channels[present + skipped][start..end]
    }

    /// `combinations` (rows × past columns) of the past before each sample from `past` to one after the last.
    pub(super) fn combined(&self, combinations: MatRef<'_, f64>) -> Mat<f64> {
        let (count, samples) = (self.channels.len(), self.channels[0].len());
        let mut sums = Mat::<f64>::zeros(self.rows() + 1, combinations.nrows());
        for row in 0..combinations.nrows() {
            let target = sums.col_mut(row).try_as_col_major_mut();
            let target = target.expect("a matrix's columns are contiguous").as_slice_mut();
            for column in 0..self.lagged() {
                let (lag, channel) = (column / count + 1, column % count);
                let weight = combinations[(row, column)];
                let lagged = &self.channels[channel][self.past - lag..=samples - lag];
                for (sum, x) in target.iter_mut().zip(lagged) {
                    *sum += weight * x;
                }
            }
        }
        sums
    }
}

/// Refuses inputs of which one does not move in enough ways that the others do not.
pub(super) fn check_excitation(record: &Record, past: usize) -> Result<(), IdentificationError> {
    let (depth, needed) = (past.min(DEPTH), past.div_ceil(2).min(MOVEMENTS));
    let (inputs, rows) = (record.inputs(), record.n_samples() - depth);
    let lagged = Mat::from_fn(rows, depth * inputs.len(), |row, column| {
        inputs[column / depth].samples[row + column % depth]
    });
    let products = lagged.transpose() * &lagged;
    let all = rank(&products)?;
    for (index, input) in inputs.iter().enumerate() {
        let place = |i: usize| if i < index * depth { i } else { i + depth };
        let size = (inputs.len() - 1) * depth;
        let others = Mat::from_fn(size, size, |i, j| products[(place(i), place(j))]);
        let found = all - rank(&others)?.min(all);
        if found < needed {
            let name = input.name.clone();
            return Err(IdentificationError::Excitation { name, depth, found, needed });
        }
    }
    Ok(())
}

/// Independent movements in a matrix of products of inputs of unit deviation (–).
fn rank(products: &Mat<f64>) -> Result<usize, IdentificationError> {
    if products.nrows() == 0 {
        return Ok(0);
    }
    let powers = products
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| IdentificationError::NotConverged { what: "powers of the inputs" })?;
    let strongest = powers.iter().copied().fold(0.0, f64::max);
    Ok(powers.iter().filter(|power| **power > LEAST_POWER * strongest).count())
}

/// The upper triangle, zeros below.
fn upper(matrix: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| if i <= j { matrix[(i, j)] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::noise;
    use crate::{Channel, Record};

    /// The factor's products are those of the whole matrix, over several blocks.
    #[test]
    fn the_factor_has_the_products_of_the_whole() {
        let inputs = vec![Channel::new("u", noise(1, 200))];
        let outputs = vec![Channel::new("y", noise(2, 200)), Channel::new("v", noise(3, 200))];
        let record = Record::new(inputs, outputs, 1.0).expect("a good record");
        let regressors = Regressors::new(&record, 3, true);
        let factor = regressors.triangular_factor();
        let whole = Mat::from_fn(197, 12, |row, column| regressors.column(column, 3, 200)[row]);
        assert_eq!(regressors.columns(), 10);
        let difference = factor.transpose() * &factor - whole.transpose() * &whole;
        assert!(difference.norm_max() < 1e-10, "{}", difference.norm_max());
        let combinations = Mat::from_fn(2, 9, |i, j| (i + 2 * j) as f64);
        let sums = regressors.combined(combinations.as_ref());
        let expected = whole.submatrix(0, 0, 197, 9) * combinations.transpose();
        assert!((sums.submatrix(0, 0, 197, 2) - expected).norm_max() < 1e-10);
    }

    #[test]
    fn narrow_excitation_is_refused() {
        let sine: Vec<f64> = (0..300).map(|i| (0.3 * i as f64).sin()).collect();
        let made = |first: Vec<f64>, second: Vec<f64>| {
            let first_length = first.len();
            let inputs = vec![Channel::new("u", first), Channel::new("v", second)];
            let outputs = vec![Channel::new("y", noise(2, first_length))];
            check_excitation(&Record::new(inputs, outputs, 1.0).expect("a good record"), 20)
        };
        let refused = |result: Result<(), IdentificationError>| match result {
            Err(IdentificationError::Excitation { name, found, .. }) => (name, found),
            other => panic!("{other:?}"),
        };
        let white = noise(1, 300);
        assert_eq!(refused(made(noise(1, 300), sine)), ("v".to_owned(), 2));
        // Equal inputs, and one that is the other a sample later.
        assert_eq!(refused(made(white.clone(), white.clone())), ("u".to_owned(), 0));
        assert_eq!(refused(made(white[1..].to_vec(), white[..299].to_vec())), ("u".to_owned(), 1));
        assert_eq!(made(white, noise(5, 300)), Ok(()));
    }
}
