//! A fitted Gaussian process: predictions, bands, samples and leave-one-out validation.

use crate::factor::{Factor, dot};
use crate::fit;
use crate::likelihood::{Likelihood, Mean};
use crate::sample::Normals;
use crate::{FitSettings, Hyperparameters, Observations, Shape, SurrogateError};
use faer::Mat;

/// 97.5 % point of the normal distribution (–).
const NORMAL_97_5: f64 = 1.959_963_984_540_054;

/// Exact Gaussian-process regression.
///
/// Memory grows with the square of the number of observations and work with its cube: for up to a few
/// thousand.
#[derive(Clone, Debug)]
pub struct GaussianProcess {
    shape: Shape,
    parameters: Hyperparameters,
    observations: Observations,
    mean: Mean,
    likelihood: Likelihood,
}

/// Prediction at one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// Most probable value (unit of the values).
    pub mean: f64,
    /// Standard deviation of the curve (unit of the values).
    pub standard_deviation: f64,
    /// Standard deviation of one more observation with the estimated noise (unit of the values).
    pub observation_deviation: f64,
}

impl Prediction {
    /// 95 % interval of the curve (unit of the values), normal: known variances are taken as exact, and
    /// hyperparameters as known. [`GaussianProcess::curve`] takes in that variances are uncertain.
    pub fn band_95(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.mean + sign * NORMAL_97_5 * self.standard_deviation)
    }

    /// 95 % interval of one more observation (unit of the values).
    pub fn observation_band_95(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.mean + sign * NORMAL_97_5 * self.observation_deviation)
    }
}

/// An observation and its prediction from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeaveOneOut {
    /// Observed value (unit of the values).
    pub value: f64,
    /// Prediction from the others (unit of the values).
    pub mean: f64,
    /// Standard deviation of the prediction, noise included (unit of the values).
    pub standard_deviation: f64,
}

impl LeaveOneOut {
    /// Standardised residual: standard deviations that the observation lies above its prediction (–); beyond
    /// ±2 about one time in twenty.
    pub fn standardised(&self) -> f64 {
        (self.value - self.mean) / self.standard_deviation
    }
}

impl GaussianProcess {
    /// The process of kernel `shape` with the hyperparameters of maximum marginal likelihood for
    /// `observations`.
    ///
    /// # Errors
    /// [`SurrogateError::TooFew`] with fewer than three observations, too few to estimate a length;
    /// [`SurrogateError::Lengths`], [`SurrogateError::NotFinite`], [`SurrogateError::NotPositive`] for bad
    /// data; [`SurrogateError::NotPositiveDefinite`].
    pub fn fit(
        shape: Shape,
        observations: Observations,
        settings: &FitSettings,
    ) -> Result<Self, SurrogateError> {
        observations.check()?;
        shape.check()?;
        if observations.len() < 3 {
            return Err(SurrogateError::TooFew { n: observations.len(), needed: 3 });
        }
        let parameters = fit::hyperparameters(shape, &observations, settings)?;
        Self::new(shape, parameters, observations, settings.mean)
    }

    /// The process of kernel `shape` with hyperparameters that are known.
    ///
    /// # Errors
    /// As [`fit`](Self::fit); one observation is enough.
    pub fn new(
        shape: Shape,
        parameters: Hyperparameters,
        observations: Observations,
        mean: Mean,
    ) -> Result<Self, SurrogateError> {
        observations.check()?;
        shape.check()?;
        parameters.check(observations.n_dimensions)?;
        let likelihood = Likelihood::new(shape, &parameters, &observations, mean)?;
        Ok(Self { shape, parameters, observations, mean, likelihood })
    }

    /// The hyperparameters.
    pub fn hyperparameters(&self) -> &Hyperparameters {
        &self.parameters
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    pub(crate) fn kind_of_mean(&self) -> Mean {
        self.mean
    }

    /// The observations behind the process.
    pub fn observations(&self) -> &Observations {
        &self.observations
    }

    /// Mean of the process far from observations (unit of the values).
    pub fn mean(&self) -> f64 {
        self.likelihood.mean
    }

    /// Natural logarithm of the marginal likelihood (–).
    pub fn log_marginal_likelihood(&self) -> f64 {
        self.likelihood.log
    }

    /// Derivatives of [`log_marginal_likelihood`](Self::log_marginal_likelihood) by the logarithms of signal
    /// variance, lengths and noise variance, in that order; near zero where a fit ended inside its bounds.
    pub fn likelihood_slopes(&self) -> Vec<f64> {
        self.likelihood.slopes(self.shape, &self.parameters, &self.observations)
    }

    /// Prediction at `input`. Rasmussen and Williams (2006), Eqs. 2.25, 2.26, 2.41 and 2.42.
    ///
    /// # Errors
    /// [`SurrogateError::Lengths`] for an input of other dimensions.
    pub fn predict(&self, input: &[f64]) -> Result<Prediction, SurrogateError> {
        self.check_input(input)?;
        let covariances = self.covariances(input);
        let mean = self.likelihood.mean + dot(&covariances, &self.likelihood.weights);
        let explained = dot(&covariances, &self.likelihood.factor.solve(&covariances));
        let own = self.shape.covariance(&self.parameters, input, input);
        let variance = own - explained + self.mean_share(&covariances, &covariances);
        // Rounding may leave a variance below zero at an observation without noise.
        let variance = variance.max(0.0);
        Ok(Prediction {
            mean,
            standard_deviation: variance.sqrt(),
            observation_deviation: (variance + self.parameters.noise_variance).sqrt(),
        })
    }

    /// Leave-one-out predictions: each observation predicted from the others, hyperparameters unchanged.
    ///
    /// Source: Rasmussen and Williams (2006), Eqs. 5.10-5.12; with an estimated mean, Dubrule, "Cross
    /// validation of kriging in a unique neighborhood", Math. Geol. 15, 1983.
    pub fn leave_one_out(&self) -> Vec<LeaveOneOut> {
        let inverse = self.likelihood.factor.inverse();
        let of_ones = &self.likelihood.of_ones;
        let total: f64 = of_ones.iter().sum();
        let leave = |index: usize| {
            let lost = match self.mean {
                Mean::Zero => 0.0,
                Mean::Constant => of_ones[index] * of_ones[index] / total,
            };
            let precision = inverse[(index, index)] - lost;
            let value = self.observations.values[index];
            let mean = value - self.likelihood.weights[index] / precision;
            LeaveOneOut { value, mean, standard_deviation: precision.recip().sqrt() }
        };
        (0..self.observations.len()).map(leave).collect()
    }

    /// `n_samples` curves drawn from the process, each at all `inputs`: `n_samples × inputs`. The same `seed`
    /// gives the same curves.
    ///
    /// # Errors
    /// As [`predict`](Self::predict); [`SurrogateError::NotPositiveDefinite`] for a covariance that is not
    /// positive definite after rounding.
    pub fn samples(
        &self,
        inputs: &[Vec<f64>],
        n_samples: usize,
        seed: u64,
    ) -> Result<Vec<Vec<f64>>, SurrogateError> {
        let means: Vec<f64> = inputs
            .iter()
            .map(|input| self.predict(input).map(|found| found.mean))
            .collect::<Result<_, _>>()?;
        let covariances: Vec<Vec<f64>> =
            inputs.iter().map(|input| self.covariances(input)).collect();
        let solved: Vec<Vec<f64>> =
            covariances.iter().map(|column| self.likelihood.factor.solve(column)).collect();
        // A small diagonal term: neighbouring inputs of a smooth curve make the covariance nearly singular.
        let own = 1e-9 * self.parameters.signal_variance;
        let matrix = Mat::from_fn(inputs.len(), inputs.len(), |row, column| {
            let prior = self.shape.covariance(&self.parameters, &inputs[row], &inputs[column]);
            let explained = dot(&covariances[row], &solved[column]);
            let of_mean = self.mean_share(&covariances[row], &covariances[column]);
            prior - explained + of_mean + if row == column { own } else { 0.0 }
        });
        let factor = Factor::of(&matrix)?;
        let mut normals = Normals::new(seed);
        Ok((0..n_samples)
            .map(|_| {
                let draws: Vec<f64> = inputs.iter().map(|_| normals.next()).collect();
                let away = factor.lower_times(&draws);
                means.iter().zip(&away).map(|(mean, away)| mean + away).collect()
            })
            .collect())
    }

    fn check_input(&self, input: &[f64]) -> Result<(), SurrogateError> {
        let needed = self.observations.n_dimensions;
        if input.len() == needed {
            return Ok(());
        }
        Err(SurrogateError::Lengths { what: "an input", found: input.len(), needed })
    }

    fn covariances(&self, input: &[f64]) -> Vec<f64> {
        let covariance =
            |index| self.shape.covariance(&self.parameters, input, self.observations.input(index));
        (0..self.observations.len()).map(covariance).collect()
    }

    /// Contribution of the estimated mean's uncertainty to the covariance of two inputs with `first` and
    /// `second` covariances.
    fn mean_share(&self, first: &[f64], second: &[f64]) -> f64 {
        let of_ones = &self.likelihood.of_ones;
        match self.mean {
            Mean::Zero => 0.0,
            Mean::Constant => {
                (1.0 - dot(first, of_ones)) * (1.0 - dot(second, of_ones))
                    / of_ones.iter().sum::<f64>()
            }
        }
    }
}

#[cfg(test)]
mod tests;
