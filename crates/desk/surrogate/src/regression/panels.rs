//! Cholesky factor of a large matrix in block columns, and its inverse tile by tile.
//!
//! The blocks are cut by the size of the matrix alone, and each is worked on by one thread with the library's
//! products of matrices: the same bits for any number of threads.
//!
//! Source: Golub and Van Loan, "Matrix Computations", 4th ed., 2013, §4.2.9 (block Cholesky).

use super::covariance::CHUNK;
use super::threads::share;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};
use std::ops::Range;

/// Width of a block column (–).
pub(crate) const BLOCK: usize = CHUNK;
/// Height of what a thread takes at once (–).
const STRIP: usize = 256;
/// Matrices up to this size are not worth a second thread (–).
const SMALL: usize = 384;

/// Block columns of a lower triangle: number k holds the rows from k [`BLOCK`] on.
#[derive(Clone, Debug)]
pub struct Panels {
    n: usize,
    n_threads: usize,
    columns: Vec<Mat<f64>>,
}

fn product(target: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>, factor: f64) {
    matmul(target, Accum::Add, a, b, factor, Par::Seq);
}

/// `matrix` in strips, the first row of each before it.
fn strips(matrix: MatMut<'_, f64>, first_row: usize) -> Vec<(usize, MatMut<'_, f64>)> {
    let (mut rest, mut row, mut found) = (matrix, first_row, Vec::new());
    while rest.nrows() > 0 {
        let (strip, below) = {
            let height = STRIP.min(rest.nrows());
            rest.split_at_row_mut(height)
        };
        let height = strip.nrows();
        found.push((row, strip));
        (row, rest) = (row + height, below);
    }
    found
}

impl Panels {
    fn zeros(n: usize, n_threads: usize) -> Self {
        let n_threads = if n <= SMALL { 1 } else { n_threads };
        let columns = (0..n.div_ceil(BLOCK))
            .map(|k| Mat::zeros(n - k * BLOCK, BLOCK.min(n - k * BLOCK)))
            .collect();
        Self { n, n_threads, columns }
    }

    /// Cholesky factor of the symmetric matrix of `n` rows that `fill` writes: its rows from the first given
    /// on, of one column, a [`CHUNK`] at most. None where the matrix is not positive definite.
    pub fn factor(
        n: usize,
        n_threads: usize,
        fill: impl Fn(Range<usize>, usize, &mut [f64]) + Sync,
    ) -> Option<Self> {
        let mut panels = Self::zeros(n, n_threads);
        panels.fill(fill);
        panels.factorise().then_some(panels)
    }

    fn fill(&mut self, fill: impl Fn(Range<usize>, usize, &mut [f64]) + Sync) {
        let mut tasks = Vec::new();
        for (k, panel) in self.columns.iter_mut().enumerate() {
            for (row, strip) in strips(panel.as_mut(), k * BLOCK) {
                tasks.push((row, k * BLOCK, strip));
            }
        }
        share(
            self.n_threads,
            tasks,
            || (),
            |(), (row, first, mut strip)| {
                for column in 0..strip.ncols() {
                    let target = strip.as_mut().col_mut(column).try_as_col_major_mut();
                    let target = target.expect("columns are contiguous").as_slice_mut();
                    fill(row..row + target.len(), first + column, target);
                }
            },
        );
    }

    /// Left to right: each block column less what stands to its left, its own block factorised, and what is
    /// below solved with it.
    fn factorise(&mut self) -> bool {
        for k in 0..self.columns.len() {
            let (done, rest) = self.columns.split_at_mut(k);
            let panel = &mut rest[0];
            let width = panel.ncols();
            let first = k * BLOCK;
            let tasks = strips(panel.as_mut(), first);
            share(
                self.n_threads,
                tasks,
                || (),
                |(), (row, mut strip)| {
                    for (j, left) in done.iter().enumerate() {
                        let own = left.subrows(row - j * BLOCK, strip.nrows());
                        let across = left.subrows(first - j * BLOCK, width);
                        product(strip.as_mut(), own, across.transpose(), -1.0);
                    }
                },
            );
            let (mut own, below) = panel.as_mut().split_at_row_mut(width);
            let Ok(factor) = own.as_ref().llt(Side::Lower) else { return false };
            let factor = factor.L();
            // A matrix that contains NaN factorises without an error.
            if (0..width).any(|index| !factor[(index, index)].is_finite()) {
                return false;
            }
            for column in 0..width {
                for row in 0..width {
                    own[(row, column)] = if row < column { 0.0 } else { factor[(row, column)] };
                }
            }
            let own = own.as_ref();
            share(
                self.n_threads,
                strips(below, first + width),
                || (),
                |(), (_, strip)| {
                    solve_lower_triangular_in_place(own, strip.transpose_mut(), Par::Seq);
                },
            );
        }
        true
    }

    /// Rows (–).
    pub(crate) fn n(&self) -> usize {
        self.n
    }

    /// ln |K|.
    pub fn log_determinant(&self) -> f64 {
        let diagonals = self
            .columns
            .iter()
            .map(|panel| (0..panel.ncols()).map(|index| panel[(index, index)].ln()).sum::<f64>());
        2.0 * diagonals.sum::<f64>()
    }

    /// Leaves L⁻¹ `right` in `right`.
    pub(crate) fn solve_lower(&self, mut right: MatMut<'_, f64>) {
        for (k, panel) in self.columns.iter().enumerate() {
            let (_, from) = right.as_mut().split_at_row_mut(k * BLOCK);
            let (mut own, below) = from.split_at_row_mut(panel.ncols());
            let (triangle, under) = panel.as_ref().split_at_row(panel.ncols());
            solve_lower_triangular_in_place(triangle, own.as_mut(), Par::Seq);
            product(below, under, own.as_ref(), -1.0);
        }
    }

    /// Leaves L⁻ᵀ `right` in `right`.
    pub(crate) fn solve_upper(&self, mut right: MatMut<'_, f64>) {
        for (k, panel) in self.columns.iter().enumerate().rev() {
            let (_, from) = right.as_mut().split_at_row_mut(k * BLOCK);
            let (mut own, below) = from.split_at_row_mut(panel.ncols());
            let (triangle, under) = panel.as_ref().split_at_row(panel.ncols());
            product(own.as_mut(), under.transpose(), below.as_ref(), -1.0);
            solve_upper_triangular_in_place(triangle.transpose(), own, Par::Seq);
        }
    }

    /// K⁻¹ `right`.
    pub fn solve(&self, right: &Mat<f64>) -> Mat<f64> {
        let mut solved = right.clone();
        self.solve_lower(solved.as_mut());
        self.solve_upper(solved.as_mut());
        solved
    }

    /// L⁻¹, block column by block column.
    pub(crate) fn inverse_factor(&self) -> Self {
        let mut inverse = Self::zeros(self.n, self.n_threads);
        let tasks: Vec<(usize, &mut Mat<f64>)> = inverse.columns.iter_mut().enumerate().collect();
        share(
            self.n_threads,
            tasks,
            || (),
            |(), (j, panel)| {
                let width = panel.ncols();
                (0..width).for_each(|index| panel[(index, index)] = 1.0);
                for (i, factor) in self.columns.iter().enumerate().skip(j) {
                    let (above, below) = panel.as_mut().split_at_row_mut((i - j) * BLOCK);
                    let (mut own, _) = below.split_at_row_mut(factor.ncols());
                    for (k, left) in self.columns[..i].iter().enumerate().skip(j) {
                        let left = left.subrows((i - k) * BLOCK, factor.ncols());
                        let done = above.as_ref().subrows((k - j) * BLOCK, left.ncols());
                        product(own.as_mut(), left, done, -1.0);
                    }
                    let triangle = factor.subrows(0, factor.ncols());
                    solve_lower_triangular_in_place(triangle, own, Par::Seq);
                }
            },
        );
        inverse
    }

    /// Of an [`inverse_factor`](Self::inverse_factor) L⁻¹ the tiles of K⁻¹ = L⁻ᵀ L⁻¹ on and below the
    /// diagonal: what `visit` makes of each, by its first row and column, in a fixed order.
    pub(crate) fn visit_inverse<S, T: Send>(
        &self,
        begin: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, usize, MatRef<'_, f64>) -> T + Sync,
    ) -> Vec<T> {
        let n_columns = self.columns.len();
        let places = (0..n_columns).flat_map(|j| (j..n_columns).map(move |i| (i, j)));
        let mut found: Vec<((usize, usize), Option<T>)> =
            places.map(|place| (place, None)).collect();
        let begin = || (begin(), Mat::<f64>::zeros(BLOCK, BLOCK));
        share(self.n_threads, found.iter_mut().collect(), begin, |(state, room), slot| {
            let ((i, j), slot) = (slot.0, &mut slot.1);
            let rows = &self.columns[i];
            let columns = self.columns[j].as_ref();
            let columns = columns.subrows((i - j) * BLOCK, rows.nrows());
            let mut tile = room.as_mut().submatrix_mut(0, 0, rows.ncols(), columns.ncols());
            tile.fill(0.0);
            for from in (0..rows.nrows()).step_by(BLOCK) {
                let height = BLOCK.min(rows.nrows() - from);
                let above = rows.subrows(from, height).transpose();
                product(tile.as_mut(), above, columns.subrows(from, height), 1.0);
            }
            *slot = Some(visit(state, i * BLOCK, j * BLOCK, tile.as_ref()));
        });
        found.into_iter().filter_map(|(_, slot)| slot).collect()
    }

    /// Of an inverse factor the entry of K⁻¹ at these places: the product of two columns of L⁻¹.
    pub(crate) fn inverse_entry(&self, a: usize, b: usize) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        let skipped = (high / BLOCK - low / BLOCK) * BLOCK;
        let [low, high] = [low, high].map(|at| self.columns[at / BLOCK].col(at % BLOCK));
        low.iter().skip(skipped).zip(high.iter()).map(|(a, b)| a * b).sum()
    }
}

#[cfg(test)]
mod tests;
