//! Profile likelihood of a problem under hyperparameters, and its derivatives: the marginal likelihood over
//! the curve, with the trend's coefficients not integrated over but at their optimum.
//!
//! Source: Rasmussen and Williams (2006), Eqs. 2.30, 5.8 and 5.9; trends, §2.7 with generalised least
//! squares.

use super::covariance::{CHUNK, Points, Room};
use super::expression::Kernel;
use super::panels::Panels;
use super::problem::Problem;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, MatRef, Side};
use std::f64::consts::TAU;

/// Shares of the kernel's variance that are tried on the diagonal, one after the other (–).
const JITTERS: [f64; 4] = [0.0, 1e-12, 1e-10, 1e-8];

/// A problem under hyperparameters.
#[derive(Clone, Debug)]
pub(crate) struct Marginal {
    pub(crate) points: Points,
    pub(crate) factor: Panels,
    /// Coefficients of the trend.
    pub(crate) coefficients: Mat<f64>,
    /// K⁻¹ (y − trend).
    pub(crate) weights: Mat<f64>,
    /// K⁻¹ H, H being the trend's functions.
    pub(crate) of_basis: Mat<f64>,
    /// (Hᵀ K⁻¹ H)⁻¹.
    pub(crate) covariance: Mat<f64>,
    /// Natural logarithm of the profile likelihood (–).
    pub(crate) log: f64,
    /// What was added to the diagonal, over the kernel's variance (–).
    pub(crate) jitter: f64,
}

/// Coefficients of generalised least squares, what they leave, and (Hᵀ K⁻¹ H)⁻¹.
pub(crate) struct Trended {
    pub(crate) coefficients: Mat<f64>,
    pub(crate) residuals: Mat<f64>,
    pub(crate) covariance: Mat<f64>,
}

impl Trended {
    /// Of `values` with functions `basis`, of which `of_basis` is K⁻¹ H. None where the functions are not
    /// independent.
    pub(crate) fn new(basis: &Mat<f64>, of_basis: &Mat<f64>, values: &Mat<f64>) -> Option<Self> {
        let n_coefficients = basis.ncols();
        if n_coefficients == 0 {
            let (coefficients, covariance) = (Mat::zeros(0, 1), Mat::zeros(0, 0));
            return Some(Self { coefficients, residuals: values.clone(), covariance });
        }
        let square = basis.transpose() * of_basis;
        let square = 0.5 * (&square + square.transpose());
        let factor = square.llt(Side::Lower).ok()?;
        let coefficients = factor.solve(of_basis.transpose() * values);
        let residuals = values - basis * &coefficients;
        Some(Self { coefficients, residuals, covariance: factor.inverse() })
    }
}

/// Σ a b.
pub(crate) fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    (0..a.nrows()).map(|row| a[(row, 0)] * b[(row, 0)]).sum()
}

/// `values` as a column.
pub(crate) fn column(values: &[f64]) -> Mat<f64> {
    Mat::from_fn(values.len(), 1, |row, _| values[row])
}

impl Marginal {
    /// Of `problem` with `kernel` and `noise`, scaled. Where K cannot be factorised as it is, and
    /// `with_jitter` says so, with the least of some shares of the kernel's variance on its diagonal. None
    /// where even that does not help.
    pub(crate) fn new(
        problem: &Problem,
        kernel: &Kernel,
        noise: &[f64],
        n_threads: usize,
        with_jitter: bool,
    ) -> Option<Self> {
        let points = Points::new(kernel, &problem.inputs);
        let n = problem.len();
        let tried = if with_jitter { &JITTERS[..] } else { &JITTERS[..1] };
        let factor = tried.iter().find_map(|jitter| {
            let fill = |rows: std::ops::Range<usize>, at: usize, target: &mut [f64]| {
                points.covariances(rows.clone(), &points, at, target);
                if rows.contains(&at) {
                    let own = problem.variance(at, noise) / problem.counts[at];
                    target[at - rows.start] += own + jitter * kernel.variance();
                }
            };
            Some((Panels::factor(n, n_threads, fill)?, *jitter))
        });
        let (factor, jitter) = factor?;
        let basis = problem.basis(&problem.inputs, n);
        let of_basis = factor.solve(&basis);
        let Trended { coefficients, residuals, covariance } =
            Trended::new(&basis, &of_basis, &column(&problem.values))?;
        let weights = factor.solve(&residuals);
        let square = dot(&residuals, &weights);
        let log = -0.5 * (square + factor.log_determinant() + n as f64 * TAU.ln())
            + problem.log_of_replicates(noise);
        let found =
            Self { points, factor, coefficients, weights, of_basis, covariance, log, jitter };
        log.is_finite().then_some(found)
    }

    /// Derivatives of the logarithm by the logarithms of the kernel's hyperparameters and the noise
    /// variances.
    ///
    /// A trend is at its own optimum for every set, so that its movement adds nothing.
    pub(crate) fn slopes(&self, problem: &Problem, kernel: &Kernel, noise: &[f64]) -> Vec<f64> {
        let n_kernel = kernel.logarithms().len();
        let inverse = self.factor.inverse_factor();
        let weights = &self.weights;
        let begin = || (Room::default(), [0.0; CHUNK]);
        let of_tile = |(room, factors): &mut (Room, [f64; CHUNK]),
                       row: usize,
                       first: usize,
                       tile: MatRef<'_, f64>| {
            let mut sums = vec![0.0; n_kernel + problem.n_groups];
            let rows = row..row + tile.nrows();
            // A tile on the diagonal has both its halves, another one stands for two.
            let twice = if row == first { 0.5 } else { 1.0 };
            for index in 0..tile.ncols() {
                let at = first + index;
                for (offset, factor) in factors[..tile.nrows()].iter_mut().enumerate() {
                    let own = weights[(row + offset, 0)] * weights[(at, 0)];
                    *factor = twice * (own - tile[(offset, index)]);
                }
                let factors = &factors[..tile.nrows()];
                self.points.add_slopes(rows.clone(), at, factors, room, &mut sums[..n_kernel]);
                if row == first
                    && let Some(noise) = noise.get(problem.groups[at])
                {
                    let own = factors[index] * noise / problem.counts[at];
                    sums[n_kernel + problem.groups[at]] += own;
                }
            }
            sums
        };
        let mut slopes = vec![0.0; n_kernel + problem.n_groups];
        slopes[n_kernel..].copy_from_slice(&problem.slopes_of_replicates(noise));
        for sums in inverse.visit_inverse(begin, of_tile) {
            slopes.iter_mut().zip(sums).for_each(|(slope, sum)| *slope += sum);
        }
        slopes
    }
}
