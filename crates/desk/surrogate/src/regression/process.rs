//! A fitted regression: predictions with bands, and what is told of it.

use super::covariance::Points;
use super::expression::{Kernel, Parameters};
use super::inducing::{Inducing, Sparse, covariances_with};
use super::marginal::Marginal;
use super::panels::Panels;
use super::predictor::MeanCurve;
use super::problem::{Collapsed, NoiseGroups, Problem, Trend};
use super::search::{self, SearchSettings, Searched};
use super::threads::{number, share};
use crate::{Observations, Prediction, SurrogateError};
use faer::Mat;

/// Points whose deviations a thread works out at once (–).
const BATCH: usize = 128;

/// How a regression is made.
#[derive(Clone, Debug, PartialEq)]
pub struct RegressionSettings {
    /// Mean of the curve far from observations.
    pub trend: Trend,
    /// Which observations share an estimated noise.
    pub noise: NoiseGroups,
    /// How hyperparameters are searched.
    pub search: SearchSettings,
    /// Observations up to which the process is exact, those of the same input, noise group and known
    /// variance as one (–). Beyond, the likelihood of all is never worked out in the search either.
    pub exact_up_to: usize,
    /// Inducing points beyond (–).
    pub n_inducing: usize,
}

impl Default for RegressionSettings {
    fn default() -> Self {
        Self {
            trend: Trend::default(),
            noise: NoiseGroups::default(),
            search: SearchSettings::default(),
            exact_up_to: 10_000,
            n_inducing: 1000,
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) enum Posterior {
    Exact(Box<Marginal>),
    Inducing(Box<Inducing>),
}

/// Gaussian-process regression: exact, or through inducing points where observations are many.
#[derive(Clone, Debug)]
pub struct Regression {
    pub(crate) parameters: Parameters,
    /// The same, scaled.
    pub(crate) kernel: Kernel,
    pub(crate) noise: Vec<f64>,
    pub(crate) problem: Problem,
    pub(crate) posterior: Posterior,
    pub(crate) n_threads: usize,
    predictor: MeanCurve,
    searched: Option<Searched>,
}

impl Regression {
    /// The regression of `observations` with a kernel of the form of `kernel` and the hyperparameters of
    /// maximum profile likelihood: that of the values, the trend's coefficients at their optimum.
    ///
    /// # Errors
    /// [`SurrogateError::TooFew`] with fewer than three observations at different inputs,
    /// [`SurrogateError::Constant`] for an input that is the same everywhere, [`SurrogateError::Lengths`],
    /// [`SurrogateError::NotFinite`], [`SurrogateError::NotPositive`], [`SurrogateError::EmptyGroup`] for bad
    /// data; [`SurrogateError::NotPositiveDefinite`].
    pub fn fit(
        kernel: &Kernel,
        observations: &Observations,
        settings: &RegressionSettings,
    ) -> Result<Self, SurrogateError> {
        let problem = Problem::new(observations, &settings.noise, kernel, settings.trend)?;
        let n = problem.len();
        let needed = 3.max(settings.trend.n_coefficients(problem.n_dimensions()) + 2);
        let n_inputs = problem.blocks().len();
        if n_inputs < needed {
            return Err(SurrogateError::TooFew { n: n_inputs, needed });
        }
        problem.check_replicates(settings.noise == NoiseGroups::Known)?;
        // Periods are given in the user's units.
        let scaled = kernel.in_units(&problem.scaling.scales, problem.scaling.scale);
        let is_exact = n <= settings.exact_up_to;
        let found = search::hyperparameters(&problem, &scaled, &settings.search, is_exact);
        let (kernel, noise, searched) = found.ok_or(SurrogateError::NotPositiveDefinite { n })?;
        let found = Self::of_problem(problem, kernel, noise, settings)?;
        Ok(Self { searched: Some(searched), ..found })
    }

    /// The regression with hyperparameters that are known.
    ///
    /// # Errors
    /// As [`fit`](Self::fit); one observation is enough.
    pub fn new(
        parameters: &Parameters,
        observations: &Observations,
        settings: &RegressionSettings,
    ) -> Result<Self, SurrogateError> {
        let kernel = &parameters.kernel;
        let problem = Problem::new(observations, &settings.noise, kernel, settings.trend)?;
        Self::known(parameters, problem, settings)
    }

    /// The regression of observations that were collapsed before, with known hyperparameters.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn restore(
        parameters: &Parameters,
        collapsed: &Collapsed,
        settings: &RegressionSettings,
    ) -> Result<Self, SurrogateError> {
        let problem = Problem::restore(collapsed, parameters, settings.trend)?;
        Self::known(parameters, problem, settings)
    }

    fn known(
        parameters: &Parameters,
        problem: Problem,
        settings: &RegressionSettings,
    ) -> Result<Self, SurrogateError> {
        let (found, needed) = (parameters.noise.len(), problem.n_groups);
        if found != needed {
            return Err(SurrogateError::Lengths { what: "the noise variances", found, needed });
        }
        if let Some(value) = parameters.noise.iter().find(|v| !(**v >= 0.0 && v.is_finite())) {
            let what = "a noise variance";
            return Err(SurrogateError::NotPositive { what, value: *value });
        }
        let scaling = &problem.scaling;
        let kernel = parameters.kernel.in_units(&scaling.scales, scaling.scale);
        let square = scaling.scale * scaling.scale;
        let noise: Vec<f64> = parameters.noise.iter().map(|noise| noise / square).collect();
        problem.check_replicates(noise.iter().all(|noise| *noise == 0.0))?;
        Self::of_problem(problem, kernel, noise, settings)
    }

    fn of_problem(
        problem: Problem,
        kernel: Kernel,
        noise: Vec<f64>,
        settings: &RegressionSettings,
    ) -> Result<Self, SurrogateError> {
        let (n, n_threads) = (problem.len(), number(settings.search.n_threads));
        let posterior = if n <= settings.exact_up_to {
            Marginal::new(&problem, &kernel, &noise, n_threads, true)
                .map(|found| Posterior::Exact(Box::new(found)))
        } else {
            let seed = settings.search.seed;
            Inducing::new(&problem, &kernel, &noise, settings.n_inducing, seed, n_threads)
                .map(|found| Posterior::Inducing(Box::new(found)))
        };
        let posterior = posterior.ok_or(SurrogateError::NotPositiveDefinite { n })?;
        let scaling = &problem.scaling;
        let back: Vec<f64> = scaling.scales.iter().map(|scale| 1.0 / scale).collect();
        let square = scaling.scale * scaling.scale;
        let parameters = Parameters {
            kernel: kernel.in_units(&back, 1.0 / scaling.scale),
            noise: noise.iter().map(|noise| noise * square).collect(),
        };
        let predictor = predictor(&problem, &parameters.kernel, &posterior);
        let searched = None;
        Ok(Self { parameters, kernel, noise, problem, posterior, n_threads, predictor, searched })
    }

    /// Another posterior under the same hyperparameters.
    pub(crate) fn with(&self, problem: Problem, posterior: Posterior) -> Self {
        let predictor = predictor(&problem, &self.parameters.kernel, &posterior);
        let (parameters, kernel) = (self.parameters.clone(), self.kernel.clone());
        let (noise, n_threads) = (self.noise.clone(), self.n_threads);
        let searched = self.searched.clone();
        Self { parameters, kernel, noise, problem, posterior, n_threads, predictor, searched }
    }

    /// The hyperparameters, in the user's units.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Constant of the trend and its slopes (unit of the values, and that over each input's); empty where the
    /// trend is zero.
    pub fn coefficients(&self) -> &[f64] {
        &self.predictor.coefficients
    }

    /// How the hyperparameters were found; none where they were given.
    pub fn searched(&self) -> Option<&Searched> {
        self.searched.as_ref()
    }

    /// Trend of the curve far from observations.
    pub fn trend(&self) -> Trend {
        self.problem.trend
    }

    /// Inputs (–).
    pub fn n_dimensions(&self) -> usize {
        self.problem.n_dimensions()
    }

    /// Different inputs that were observed (–).
    pub fn n_inputs(&self) -> usize {
        self.problem.blocks().len()
    }

    /// Points behind the mean curve, those of one together, and the weight of each: the mean is the trend
    /// plus Σ weight × covariance (unit of the inputs; 1 over that of the values).
    pub fn weighted_points(&self) -> (Vec<f64>, &[f64]) {
        let inputs = match &self.posterior {
            Posterior::Exact(_) => &self.problem.inputs,
            Posterior::Inducing(found) => &found.inputs,
        };
        (self.problem.scaling.rows(inputs), &self.predictor.weights)
    }

    /// The observations, replicates as one.
    pub fn collapsed(&self) -> Collapsed {
        self.problem.collapsed()
    }

    /// Natural logarithm of the profile likelihood (–) of the values in their own unit, the trend's
    /// coefficients at their generalised-least-squares optimum; without a trend it is the marginal
    /// likelihood. Through inducing points a lower bound on it.
    pub fn log_marginal_likelihood(&self) -> f64 {
        match &self.posterior {
            Posterior::Exact(found) => found.log,
            Posterior::Inducing(found) => found.bound,
        }
    }

    /// Derivatives of [`log_marginal_likelihood`](Self::log_marginal_likelihood) by the logarithms of the
    /// hyperparameters: of each term its variance, then of each part its lengths and its exponent, then the
    /// noise variances. None through inducing points.
    pub fn likelihood_slopes(&self) -> Option<Vec<f64>> {
        let Posterior::Exact(found) = &self.posterior else { return None };
        Some(found.slopes(&self.problem, &self.kernel, &self.noise))
    }

    /// What was added to the diagonal of the covariance so that it could be factorised (unit of the values,
    /// squared); 0 where nothing was.
    pub fn jitter(&self) -> f64 {
        let Posterior::Exact(found) = &self.posterior else { return 0.0 };
        found.jitter * self.parameters.kernel.variance()
    }

    /// What inducing points lose; none where the process is exact.
    pub fn sparse(&self) -> Option<Sparse> {
        let Posterior::Inducing(found) = &self.posterior else { return None };
        Some(found.told)
    }

    /// Mean curve at `inputs`, those of one point together (unit of the values).
    ///
    /// # Errors
    /// [`SurrogateError::Lengths`], [`SurrogateError::NotFinite`].
    pub fn means(&self, inputs: &[f64]) -> Result<Vec<f64>, SurrogateError> {
        self.check(inputs)?;
        Ok(self.predictor.means(inputs, self.n_threads))
    }

    /// Predictions at `inputs`, those of one point together; further observations are of the noise group
    /// `group`. Rasmussen and Williams (2006), Eqs. 2.25, 2.26, 2.41 and 2.42.
    ///
    /// # Errors
    /// As [`means`](Self::means), and [`SurrogateError::EmptyGroup`].
    pub fn predict(&self, inputs: &[f64], group: usize) -> Result<Vec<Prediction>, SurrogateError> {
        let means = self.means(inputs)?;
        let noise = match self.noise.get(group) {
            Some(noise) => *noise,
            None if self.noise.is_empty() => 0.0,
            None => return Err(SurrogateError::EmptyGroup { group }),
        };
        let variances = self.variances(inputs);
        let scale = self.problem.scaling.scale;
        let one = |(mean, variance): (f64, f64)| Prediction {
            mean,
            standard_deviation: scale * variance.sqrt(),
            observation_deviation: scale * (variance + noise).sqrt(),
        };
        Ok(means.into_iter().zip(variances).map(one).collect())
    }

    /// Scaled variance of the curve at `inputs`.
    fn variances(&self, inputs: &[f64]) -> Vec<f64> {
        let n_dimensions = self.n_dimensions();
        let mut variances = vec![0.0; inputs.len() / n_dimensions];
        let batches = variances.chunks_mut(BATCH).zip(inputs.chunks(BATCH * n_dimensions));
        share(
            self.n_threads,
            batches.collect(),
            || (),
            |(), (variances, inputs)| {
                let columns = self.problem.scaling.columns(inputs);
                let n = variances.len();
                let queries = Points::new(&self.kernel, &columns);
                let basis = self.problem.basis(&columns, n);
                let (points, of_basis, covariance) = match &self.posterior {
                    Posterior::Exact(found) => (&found.points, &found.of_basis, &found.covariance),
                    Posterior::Inducing(found) => {
                        (&found.points, &found.of_basis, &found.covariance)
                    }
                };
                let n_points = of_basis.nrows();
                let mut known = covariances_with(points, n_points, &queries, 0..n);
                let missing = &basis - known.transpose() * of_basis;
                let of_trend = &missing * covariance;
                let explained = |factor: &Panels, known: &mut Mat<f64>| -> Vec<f64> {
                    factor.solve_lower(known.as_mut());
                    known.col_iter().map(|column| column.squared_norm_l2()).collect()
                };
                let (explained, returned) = match &self.posterior {
                    Posterior::Exact(found) => (explained(&found.factor, &mut known), vec![0.0; n]),
                    Posterior::Inducing(found) => {
                        let [own, inner] = &found.factors;
                        let first = explained(own, &mut known);
                        (first, explained(inner, &mut known))
                    }
                };
                let prior = self.kernel.variance();
                for (index, variance) in variances.iter_mut().enumerate() {
                    let trend: f64 = (0..basis.ncols())
                        .map(|column| of_trend[(index, column)] * missing[(index, column)])
                        .sum();
                    // Rounding may leave a variance below zero at an observation without noise.
                    *variance = (prior - explained[index] + returned[index] + trend).max(0.0);
                }
            },
        );
        variances
    }

    fn check(&self, inputs: &[f64]) -> Result<(), SurrogateError> {
        let n_dimensions = self.n_dimensions();
        if !inputs.len().is_multiple_of(n_dimensions) {
            let (what, found) = ("the inputs", inputs.len());
            let needed = inputs.len().next_multiple_of(n_dimensions);
            return Err(SurrogateError::Lengths { what, found, needed });
        }
        match inputs.iter().position(|x| !x.is_finite()) {
            Some(index) => Err(SurrogateError::NotFinite { what: "the inputs", index }),
            None => Ok(()),
        }
    }
}

/// The mean curve in the user's units.
fn predictor(problem: &Problem, kernel: &Kernel, posterior: &Posterior) -> MeanCurve {
    let scaling = &problem.scaling;
    let (inputs, weights, coefficients) = match posterior {
        Posterior::Exact(found) => (&problem.inputs, &found.weights, &found.coefficients),
        Posterior::Inducing(found) => (&found.inputs, &found.weights, &found.coefficients),
    };
    let weights = weights.col(0).iter().map(|weight| weight / scaling.scale).collect();
    let scaled: Vec<f64> = coefficients.col(0).iter().copied().collect();
    let coefficients = scaling.coefficients(&scaled);
    MeanCurve::new(
        kernel.clone(),
        problem.n_dimensions(),
        &scaling.rows(inputs),
        weights,
        coefficients,
    )
}
