//! Predictions of what was left out.

use super::coverage::{Coverage, NORMAL_97_5};
use super::marginal::{Marginal, column};
use super::process::{Posterior, Regression};
use super::search::shuffled;
use crate::{LeaveOneOut, SurrogateError};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// Predictions beside what came true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validation {
    /// Pairs (–).
    pub n: usize,
    /// Root mean square of the errors (unit of the values).
    pub root_mean_square: f64,
    /// Root mean square of the errors over the true values (%); not finite where one of them is zero.
    pub root_mean_square_percentage: f64,
    /// Share of the variance of the true values that is explained (–).
    pub explained: f64,
    /// True values inside their 95 % band of observations; none where their noise is not known.
    pub covered_95: Option<Coverage>,
}

impl Validation {
    /// Of predictions beside their true `value`; none without any.
    pub fn of(pairs: &[LeaveOneOut]) -> Option<Self> {
        if pairs.is_empty() {
            return None;
        }
        let n = pairs.len() as f64;
        let mean = |of: &dyn Fn(&LeaveOneOut) -> f64| pairs.iter().map(of).sum::<f64>() / n;
        let centre = mean(&|pair| pair.value);
        let square = mean(&|pair| (pair.mean - pair.value).powi(2));
        let spread = mean(&|pair| (pair.value - centre).powi(2));
        let percentage = mean(&|pair| ((pair.mean - pair.value) / pair.value).powi(2));
        let is_inside = |pair: &LeaveOneOut| {
            (pair.value - pair.mean).abs() <= NORMAL_97_5 * pair.standard_deviation
        };
        let n_inside = pairs.iter().filter(|pair| is_inside(pair)).count();
        Some(Self {
            n: pairs.len(),
            root_mean_square: square.sqrt(),
            root_mean_square_percentage: 100.0 * percentage.sqrt(),
            explained: 1.0 - square / spread,
            covered_95: Some(Coverage::new(n_inside, pairs.len())),
        })
    }
}

impl Regression {
    /// Leave-one-out predictions: the mean of all replicates at each input predicted from all other inputs,
    /// hyperparameters unchanged, in the order in which inputs were observed first. None through inducing
    /// points, or where the others do not determine the trend.
    ///
    /// With P = K⁻¹ − K⁻¹H (HᵀK⁻¹H)⁻¹ HᵀK⁻¹ the errors of the observations I at one input are
    /// (P_II)⁻¹ (P y)_I, and their covariance is (P_II)⁻¹.
    ///
    /// Source: Rasmussen and Williams (2006), Eqs. 5.10-5.12; with an estimated trend and for blocks,
    /// Dubrule, "Cross validation of kriging in a unique neighborhood", Math. Geol. 15, 1983.
    pub fn leave_one_out(&self) -> Option<Vec<LeaveOneOut>> {
        let Posterior::Exact(found) = &self.posterior else { return None };
        let inverse = found.factor.inverse_factor();
        let of_trend = &found.of_basis * &found.covariance;
        let one = |block: &Vec<usize>| {
            let own = Mat::from_fn(block.len(), block.len(), |i, j| {
                let (i, j) = (block[i], block[j]);
                let lost: f64 = (0..of_trend.ncols())
                    .map(|at| of_trend[(i, at)] * found.of_basis[(j, at)])
                    .sum();
                inverse.inverse_entry(i, j) - lost
            });
            let shares = self.problem.shares(block);
            let solved = own.llt(Side::Lower).ok()?.solve(&column(&shares));
            let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
                (0..block.len()).map(|place| of(place) * solved[(place, 0)]).sum()
            };
            let error = sum(&|place| found.weights[(block[place], 0)]);
            let variance = sum(&|place| shares[place]);
            let value = self.value_of(block);
            let scale = self.problem.scaling.scale;
            let standard_deviation = scale * variance.sqrt();
            Some(LeaveOneOut { value, mean: value - scale * error, standard_deviation })
        };
        self.problem.blocks().iter().map(one).collect()
    }

    /// Mean of all replicates of the observations `block`, which share an input (unit of the values).
    fn value_of(&self, block: &[usize]) -> f64 {
        let shares = self.problem.shares(block);
        let values = block.iter().map(|index| self.problem.values[*index]);
        let mean: f64 = shares.iter().zip(values).map(|(share, value)| share * value).sum();
        self.problem.scaling.centre + self.problem.scaling.scale * mean
    }

    /// Predictions of each of `n_folds` parts of the different inputs from all others, hyperparameters
    /// unchanged; the parts are drawn with `seed`, and the predictions stand in the order in which inputs
    /// were observed first.
    ///
    /// # Errors
    /// [`SurrogateError::TooFew`] where parts would be empty, [`SurrogateError::NotPositiveDefinite`].
    pub fn folds(&self, n_folds: usize, seed: u64) -> Result<Vec<LeaveOneOut>, SurrogateError> {
        let blocks = self.problem.blocks();
        let n = blocks.len();
        if n_folds < 2 || n < n_folds {
            return Err(SurrogateError::TooFew { n, needed: n_folds.max(2) });
        }
        let order = shuffled(n, seed);
        let scale = self.problem.scaling.scale;
        let mut found: Vec<Option<LeaveOneOut>> = vec![None; n];
        for fold in 0..n_folds {
            let pick = |is_left: bool| -> Vec<usize> {
                let places = (0..n).filter(|place| (place % n_folds == fold) == is_left);
                places.map(|place| order[place]).collect()
            };
            let kept: Vec<usize> =
                pick(false).iter().flat_map(|block| &blocks[*block]).copied().collect();
            let left = pick(true);
            let firsts: Vec<usize> = left.iter().map(|block| blocks[*block][0]).collect();
            let inputs = self.problem.scaling.rows(&self.problem.subset(&firsts).inputs);
            let predictions = self.of_some(&kept)?.predict(&inputs, 0)?;
            for (block, prediction) in left.iter().zip(predictions) {
                let noise =
                    scale * scale * self.problem.variance_of_mean(&blocks[*block], &self.noise);
                found[*block] = Some(LeaveOneOut {
                    value: self.value_of(&blocks[*block]),
                    mean: prediction.mean,
                    standard_deviation: (prediction.standard_deviation.powi(2) + noise).sqrt(),
                });
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// The regression of the observations `kept` alone.
    fn of_some(&self, kept: &[usize]) -> Result<Self, SurrogateError> {
        let problem = self.problem.subset(kept);
        let n = problem.len();
        let found = Marginal::new(&problem, &self.kernel, &self.noise, self.n_threads, true);
        let found = found.ok_or(SurrogateError::NotPositiveDefinite { n })?;
        Ok(self.with(problem, Posterior::Exact(Box::new(found))))
    }
}

#[cfg(test)]
mod tests;
