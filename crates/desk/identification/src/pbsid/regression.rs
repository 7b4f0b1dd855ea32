//! Least squares of outputs on regressors through their triangular factor, with and without a penalty.

use super::Regularisation;
use crate::IdentificationError;
use faer::{Mat, MatRef};

/// Steps of the search for a penalty: coarse ones over the whole range, then fine ones about the best.
const COARSE: usize = 57;
const FINE: usize = 40;

/// Least penalty tried, as a share of the largest squared singular value (–).
const LEAST: f64 = 1e-14;

/// Coefficients of a linear regression with how well they are known.
pub(super) struct Regression {
    /// Regressors × outputs.
    pub(super) coefficients: Mat<f64>,
    /// Standard deviations of the coefficients under white residuals, regressors × outputs.
    pub(super) deviations: Mat<f64>,
    /// Covariance of the residuals, outputs × outputs.
    pub(super) covariance: Mat<f64>,
}

/// The regressors' singular values and what of the outputs lies along them.
struct Rotated {
    singular: Vec<f64>,
    /// Left vectors' shares of the outputs, regressors × outputs.
    along: Mat<f64>,
    /// Residual sums of squares of the outputs that no coefficient can lower.
    beyond: Vec<f64>,
    rows: f64,
}

impl Rotated {
    /// How much of a coefficient along a singular value a `penalty` leaves (–). Without one, what is no
    /// larger than rounding is left out.
    fn kept(&self, index: usize, penalty: f64) -> f64 {
        let square = self.singular[index].powi(2);
        let rounding = self.singular[0] * self.singular.len() as f64 * 4.0 * f64::EPSILON;
        if penalty > 0.0 {
            square / (square + penalty)
        } else if self.singular[index] > rounding {
            1.0
        } else {
            0.0
        }
    }

    /// Coefficients that the data settle, in effect (–): the trace of the projection on the regressors.
    fn degrees(&self, penalty: f64) -> f64 {
        (0..self.singular.len()).map(|index| self.kept(index, penalty)).sum()
    }

    /// N times the mean square of the residuals over the square of the share of degrees left.
    fn cross_validation(&self, output: usize, penalty: f64) -> f64 {
        let residual: f64 = (0..self.singular.len())
            .map(|index| ((1.0 - self.kept(index, penalty)) * self.along[(index, output)]).powi(2))
            .sum();
        (self.beyond[output] + residual) / (self.rows - self.degrees(penalty)).powi(2)
    }

    /// The penalty of least cross-validation, zero where none is better.
    fn best_penalty(&self, output: usize) -> f64 {
        let scale = self.singular[0].powi(2);
        let penalty = |log: f64| scale * log.exp();
        let step = -LEAST.ln() / (COARSE - 1) as f64;
        let cost = |log: f64| self.cross_validation(output, penalty(log));
        let coarse = (0..COARSE).map(|index| LEAST.ln() + step * index as f64);
        let log = coarse.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).expect("some were tried");
        let log = golden(log - step, log + step, cost);
        if self.cross_validation(output, 0.0) <= cost(log) { 0.0 } else { penalty(log) }
    }
}

/// Where `cost` is least between two ends, by golden sections.
fn golden(mut low: f64, mut high: f64, cost: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..FINE {
        let (left, right) = (high - share * (high - low), low + share * (high - low));
        if cost(left) < cost(right) {
            high = right;
        } else {
            low = left;
        }
    }
    0.5 * (low + high)
}

/// From the triangular `factor` of \[Z Y\] with `columns` regressors in Z and `rows` samples.
pub(super) fn regression(
    factor: MatRef<'_, f64>,
    columns: usize,
    rows: usize,
    regularisation: Regularisation,
) -> Result<Regression, IdentificationError> {
    let outputs = factor.ncols() - columns;
    let decomposition = factor
        .submatrix(0, 0, columns, columns)
        .thin_svd()
        .map_err(|_| IdentificationError::NotConverged { what: "regression's singular values" })?;
    let beyond = factor.submatrix(columns, columns, outputs, outputs);
    let rotated = Rotated {
        singular: (0..columns).map(|index| decomposition.S()[index]).collect(),
        along: decomposition.U().transpose() * factor.submatrix(0, columns, columns, outputs),
        beyond: (0..outputs).map(|output| beyond.col(output).squared_norm_l2()).collect(),
        rows: rows as f64,
    };
    let penalties: Vec<f64> = (0..outputs)
        .map(|output| match regularisation {
            Regularisation::Exact => 0.0,
            Regularisation::CrossValidated => rotated.best_penalty(output),
        })
        .collect();
    Ok(solved(&rotated, decomposition.V(), beyond, &penalties))
}

/// Coefficients, their deviations and the residuals' covariance under one penalty for each output.
fn solved(
    rotated: &Rotated,
    right: MatRef<'_, f64>,
    beyond: MatRef<'_, f64>,
    penalties: &[f64],
) -> Regression {
    let (columns, outputs) = (rotated.singular.len(), penalties.len());
    let per_unit = |index: usize, output: usize| {
        let kept = rotated.kept(index, penalties[output]);
        if kept > 0.0 { kept / rotated.singular[index] } else { 0.0 }
    };
    let along = Mat::from_fn(columns, outputs, |index, output| {
        per_unit(index, output) * rotated.along[(index, output)]
    });
    let left = Mat::from_fn(columns, outputs, |index, output| {
        (1.0 - rotated.kept(index, penalties[output])) * rotated.along[(index, output)]
    });
    let degrees = penalties.iter().map(|p| rotated.degrees(*p)).sum::<f64>() / outputs as f64;
    let free = (rotated.rows - degrees).max(1.0);
    let products = left.transpose() * &left + beyond.transpose() * beyond;
    let covariance = Mat::from_fn(outputs, outputs, |i, j| products[(i, j)] / free);
    let deviations = Mat::from_fn(columns, outputs, |column, output| {
        let squares = (0..columns).map(|i| (right[(column, i)] * per_unit(i, output)).powi(2));
        (covariance[(output, output)] * squares.sum::<f64>()).sqrt()
    });
    Regression { coefficients: right * along, deviations, covariance }
}

#[cfg(test)]
mod tests;
