//! Many observations through few inducing points.
//!
//! Source: Titsias, "Variational learning of inducing variables in sparse Gaussian processes", AISTATS 2009,
//! Eqs. 6, 9 and 10; here with a noise of its own for each observation. Points are chosen one after the other
//! where the curve is least known from the others (pivoted Cholesky).

use super::covariance::{CHUNK, Points};
use super::expression::Kernel;
use super::marginal::dot;
use super::panels::Panels;
use super::problem::Problem;
use super::search::drawn;
use crate::vector::add_scaled;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use std::f64::consts::TAU;

/// Observations among which each inducing point is chosen (–).
const CANDIDATES: usize = 5;
/// Share of the kernel's variance on the diagonal of the inducing points' covariance (–).
const JITTER: f64 = 1e-10;
/// Share of the kernel's variance below which another inducing point says nothing (–).
const LEAST: f64 = 1e-9;

/// What inducing points lose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sparse {
    /// Inducing points (–).
    pub n_points: usize,
    /// By how much the bound on the logarithm of the likelihood lies below that of the approximate process
    /// because the points leave some variance of the curve unexplained (–).
    pub lost: f64,
}

/// A problem through inducing points.
#[derive(Clone, Debug)]
pub(crate) struct Inducing {
    /// Scaled inputs of the inducing points, a column for each input.
    pub(crate) inputs: Vec<Vec<f64>>,
    pub(crate) points: Points,
    pub(crate) weights: Mat<f64>,
    pub(crate) of_basis: Mat<f64>,
    pub(crate) coefficients: Mat<f64>,
    pub(crate) covariance: Mat<f64>,
    /// Of the covariance of the points, and of I + A Aᵀ.
    pub(crate) factors: [Panels; 2],
    /// Lower bound on the logarithm of the profile likelihood (–).
    pub(crate) bound: f64,
    pub(crate) told: Sparse,
}

/// Numbers of at most `n` of the problem's observations, chosen greedily.
fn chosen(problem: &Problem, kernel: &Kernel, n: usize, seed: u64) -> Vec<usize> {
    let candidates = drawn(problem.len(), CANDIDATES * n, seed);
    let inputs = problem.subset(&candidates).inputs;
    let points = Points::new(kernel, &inputs);
    let n_candidates = candidates.len();
    let mut left = vec![kernel.variance(); n_candidates];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut found = Vec::new();
    while found.len() < n.min(n_candidates) {
        let best = (0..n_candidates).max_by(|a, b| left[*a].total_cmp(&left[*b])).unwrap_or(0);
        if left[best] < LEAST * kernel.variance() {
            break;
        }
        let mut own = vec![0.0; n_candidates];
        for start in (0..n_candidates).step_by(CHUNK) {
            let range = start..(start + CHUNK).min(n_candidates);
            points.covariances(range.clone(), &points, best, &mut own[range]);
        }
        columns.iter().for_each(|column| add_scaled(&mut own, column, -column[best]));
        let scale = left[best].sqrt().recip();
        own.iter_mut().for_each(|value| *value *= scale);
        left.iter_mut().zip(&own).for_each(|(left, value)| *left -= value * value);
        left[best] = 0.0;
        columns.push(own);
        found.push(candidates[best]);
    }
    found
}

impl Inducing {
    pub(crate) fn new(
        problem: &Problem,
        kernel: &Kernel,
        noise: &[f64],
        n_points: usize,
        seed: u64,
        n_threads: usize,
    ) -> Option<Self> {
        let inputs = problem.subset(&chosen(problem, kernel, n_points, seed)).inputs;
        let points = Points::new(kernel, &inputs);
        let n_points = inputs[0].len();
        let own = Panels::factor(n_points, n_threads, |rows, at, target| {
            points.covariances(rows.clone(), &points, at, target);
            if rows.contains(&at) {
                target[at - rows.start] += JITTER * kernel.variance();
            }
        })?;
        let n = problem.len();
        let q = problem.trend.n_coefficients(problem.n_dimensions());
        let variances: Vec<f64> =
            (0..n).map(|index| problem.variance(index, noise) / problem.counts[index]).collect();
        let Sums { square, of_right, right_square, unexplained } =
            Sums::new(problem, kernel, &points, &own, &variances);
        let inner = Panels::factor(n_points, n_threads, |rows, at, target| {
            target.iter_mut().zip(rows).for_each(|(value, row)| *value = square[(row, at)]);
        })?;
        // By Woodbury: Rᵀ (Q + Λ)⁻¹ R = RᵀΛ⁻¹R − (A R)ᵀ B⁻¹ (A R).
        let solved = inner.solve(&of_right);
        let inverse_square = &right_square - of_right.transpose() * &solved;
        let (coefficients, covariance, fitted) = trend(&inverse_square)?;
        let mut weights = Mat::from_fn(n_points, 1 + q, |row, column| solved[(row, column)]);
        own.solve_upper(weights.as_mut());
        let of_basis = Mat::from_fn(n_points, q, |row, column| weights[(row, 1 + column)]);
        let of_values = Mat::from_fn(n_points, 1, |row, _| weights[(row, 0)]);
        let weights = of_values - &of_basis * &coefficients;
        let log_noise: f64 = variances.iter().map(|variance| variance.ln()).sum();
        let log = -0.5
            * (inverse_square[(0, 0)] - fitted
                + inner.log_determinant()
                + log_noise
                + n as f64 * TAU.ln());
        let lost = 0.5 * unexplained.max(0.0);
        let bound = log - lost + problem.log_of_replicates(noise);
        let told = Sparse { n_points, lost };
        let factors = [own, inner];
        bound.is_finite().then_some(Self {
            inputs,
            points,
            weights,
            of_basis,
            coefficients,
            covariance,
            factors,
            bound,
            told,
        })
    }
}

/// Of [y, H]ᵀ (Q + Λ)⁻¹ [y, H] the trend's coefficients, (Hᵀ (Q + Λ)⁻¹ H)⁻¹, and what the trend fits.
fn trend(square: &Mat<f64>) -> Option<(Mat<f64>, Mat<f64>, f64)> {
    let q = square.nrows() - 1;
    if q == 0 {
        return Some((Mat::zeros(0, 1), Mat::zeros(0, 0), 0.0));
    }
    let of_basis = Mat::from_fn(q, q, |row, column| square[(1 + row, 1 + column)]);
    let with_values = Mat::from_fn(q, 1, |row, _| square[(1 + row, 0)]);
    let factor = of_basis.llt(Side::Lower).ok()?;
    let coefficients = factor.solve(&with_values);
    let fitted = dot(&coefficients, &with_values);
    Some((coefficients, factor.solve(Mat::<f64>::identity(q, q)), fitted))
}

/// Sums over all observations, with A = L⁻¹ K_uf Λ^(−1/2) and R = Λ^(−1/2) [y, H].
struct Sums {
    /// I + A Aᵀ.
    square: Mat<f64>,
    /// A R.
    of_right: Mat<f64>,
    /// Rᵀ R.
    right_square: Mat<f64>,
    /// Variance that the points leave, over that of the noise.
    unexplained: f64,
}

impl Sums {
    /// Of inducing `points` with the factor `own`, and observations of these `variances`.
    fn new(
        problem: &Problem,
        kernel: &Kernel,
        points: &Points,
        own: &Panels,
        variances: &[f64],
    ) -> Self {
        let (n, n_points) = (problem.len(), own.n());
        let basis = problem.basis(&problem.inputs, n);
        let q = basis.ncols();
        let all = Points::new(kernel, &problem.inputs);
        let mut square = Mat::<f64>::identity(n_points, n_points);
        let mut of_right = Mat::<f64>::zeros(n_points, 1 + q);
        let mut right_square = Mat::<f64>::zeros(1 + q, 1 + q);
        let mut unexplained = 0.0;
        for first in (0..n).step_by(CHUNK) {
            let width = CHUNK.min(n - first);
            let mut a = covariances_with(points, n_points, &all, first..first + width);
            own.solve_lower(a.as_mut());
            let right = Mat::from_fn(width, 1 + q, |row, column| {
                let at = first + row;
                let value = if column == 0 { problem.values[at] } else { basis[(at, column - 1)] };
                value / variances[at].sqrt()
            });
            for (index, variance) in variances[first..first + width].iter().enumerate() {
                let explained = a.col(index).squared_norm_l2();
                unexplained += (kernel.variance() - explained) / variance;
                let scale = variance.sqrt().recip();
                a.col_mut(index).iter_mut().for_each(|value| *value *= scale);
            }
            square += &a * a.transpose();
            of_right += &a * &right;
            right_square += right.transpose() * &right;
        }
        Self { square, of_right, right_square, unexplained }
    }
}

/// Covariances of all `n` `points` with those of `others` in `range`, a column for each of the latter.
pub(crate) fn covariances_with(
    points: &Points,
    n: usize,
    others: &Points,
    range: std::ops::Range<usize>,
) -> Mat<f64> {
    let mut found = Mat::zeros(n, range.len());
    for (column, other) in range.enumerate() {
        let target = found.col_mut(column).try_as_col_major_mut();
        let target = target.expect("columns are contiguous").as_slice_mut();
        for start in (0..n).step_by(CHUNK) {
            let rows = start..(start + CHUNK).min(n);
            points.covariances(rows.clone(), others, other, &mut target[rows]);
        }
    }
    found
}
