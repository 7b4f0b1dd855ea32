//! Predictions of what was left out.

use super::marginal::Marginal;
use super::process::{Posterior, Regression};
use super::search::shuffled;
use crate::{LeaveOneOut, SurrogateError};

/// 97.5 % point of the normal distribution (–).
const NORMAL_97_5: f64 = 1.959_963_984_540_054;

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
    /// True values inside their 95 % band of observations (%).
    pub covered_95: f64,
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
            f64::from((pair.value - pair.mean).abs() <= NORMAL_97_5 * pair.standard_deviation)
        };
        Some(Self {
            n: pairs.len(),
            root_mean_square: square.sqrt(),
            root_mean_square_percentage: 100.0 * percentage.sqrt(),
            explained: 1.0 - square / spread,
            covered_95: 100.0 * mean(&is_inside),
        })
    }
}

impl Regression {
    /// Leave-one-out predictions: the mean of the replicates at each input predicted from all other inputs,
    /// hyperparameters unchanged. None through inducing points.
    ///
    /// Source: Rasmussen and Williams (2006), Eqs. 5.10-5.12; with an estimated trend, Dubrule, "Cross
    /// validation of kriging in a unique neighborhood", Math. Geol. 15, 1983.
    pub fn leave_one_out(&self) -> Option<Vec<LeaveOneOut>> {
        let Posterior::Exact(found) = &self.posterior else { return None };
        let diagonal = found.factor.inverse_factor().inverse_diagonal();
        let of_trend = &found.of_basis * &found.covariance;
        let scaling = &self.problem.scaling;
        let one = |(index, diagonal): (usize, &f64)| {
            let lost: f64 = (0..of_trend.ncols())
                .map(|column| of_trend[(index, column)] * found.of_basis[(index, column)])
                .sum();
            let precision = diagonal - lost;
            let value = self.problem.values[index];
            let mean = value - found.weights[(index, 0)] / precision;
            LeaveOneOut {
                value: scaling.centre + scaling.scale * value,
                mean: scaling.centre + scaling.scale * mean,
                standard_deviation: scaling.scale * precision.sqrt().recip(),
            }
        };
        Some(diagonal.iter().enumerate().map(one).collect())
    }

    /// Predictions of each of `n_folds` parts of the inputs from all others, hyperparameters unchanged; the
    /// parts are drawn with `seed`, and the predictions stand in the order of the observations.
    ///
    /// # Errors
    /// [`SurrogateError::TooFew`] where parts would be empty, [`SurrogateError::NotPositiveDefinite`].
    pub fn folds(&self, n_folds: usize, seed: u64) -> Result<Vec<LeaveOneOut>, SurrogateError> {
        let n = self.problem.len();
        if n_folds < 2 || n < n_folds {
            return Err(SurrogateError::TooFew { n, needed: n_folds.max(2) });
        }
        let order = shuffled(n, seed);
        let mut found: Vec<Option<LeaveOneOut>> = vec![None; n];
        for fold in 0..n_folds {
            let is_left = |place: usize| place % n_folds == fold;
            let pick = |left: bool| -> Vec<usize> {
                let places = (0..n).filter(|place| is_left(*place) == left);
                places.map(|place| order[place]).collect()
            };
            let (kept, left) = (pick(false), pick(true));
            let others = self.of_some(&kept)?;
            let asked = self.problem.subset(&left);
            let inputs = asked.scaling.rows(&asked.inputs);
            let predictions = others.predict(&inputs, 0)?;
            let scaling = &self.problem.scaling;
            for (place, (index, prediction)) in left.iter().zip(predictions).enumerate() {
                let own = asked.variance(place, &self.noise) / asked.counts[place];
                let noise = scaling.scale * scaling.scale * own;
                found[*index] = Some(LeaveOneOut {
                    value: scaling.centre + scaling.scale * asked.values[place],
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
