//! The process of one output, its hyperparameters uncertain.

use crate::SearchError;
use crate::draws::Draws;
use crate::history::Observed;
use crate::normal::NORMAL_97_5;
use surrogate::{GaussianProcess, Hyperparameters, Mean, Observations, Shape};

/// Hyperparameters drawn in each of two rounds (–).
const N_DRAWN: usize = 192;
/// Processes that are kept (–).
const N_KEPT: usize = 10;
/// Lengths over the range of a variable: median, and standard deviation of their logarithm (–).
const LENGTH: [f64; 2] = [0.4, 0.7];
/// The same of how alike a cheaper source is, which lies one away from the others: at the median their curves
/// have a correlation of 0.79 (Matérn 3/2); from next to none to all but one are within reach.
const LIKENESS: [f64; 2] = [2.0, 1.0];
/// Standard deviation of the logarithm of the signal's variance (–).
const SIGNAL: f64 = 1.5;
/// Range of the variance of noise over that of the values where no replicates tell it (–).
const NOISE: [f64; 2] = [1e-4, 1.0];
/// How much wider the second round draws than the first found (–).
const WIDER: f64 = 1.3;
/// Least standard deviation with which it draws (–).
const LEAST: f64 = 0.15;

/// Mean and standard deviation of what a process is at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Normal {
    /// Mean (unit of the values).
    pub mean: f64,
    /// Standard deviation of the curve, without the noise of another evaluation (unit of the values).
    pub deviation: f64,
}

impl Normal {
    /// 95 % interval (unit of the values).
    pub fn band_95(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.mean + sign * NORMAL_97_5 * self.deviation)
    }
}

/// A Gaussian process with a constant mean, as a mixture over its hyperparameters.
///
/// Few observations leave lengths and variances open, and the most likely ones make intervals too narrow. So
/// hyperparameters are drawn: lengths and the signal's variance from wide priors, over the ranges of the
/// variables and the spread of the values, the noise's variance from what replicates say of it. Draws count
/// with their marginal likelihood; a second round draws where the first found it, and of it a few processes
/// are kept. Cappé et al., "Population Monte Carlo", J. Comput. Graph. Stat. 13, 2004.
#[derive(Clone, Debug)]
pub struct Model {
    /// Each with the same weight.
    pub(crate) processes: Vec<Process>,
}

/// One process of the mixture.
#[derive(Clone, Debug)]
pub(crate) struct Process {
    pub(crate) shape: Shape,
    pub(crate) process: GaussianProcess,
    /// Variance of the noise of one block.
    pub(crate) noise: f64,
}

/// Logarithms of lengths, of the signal's variance and of the noise's, with mean and deviation of their
/// prior.
struct Prior {
    means: Vec<f64>,
    deviations: Vec<f64>,
    /// χ² behind the variance of the noise; 0 where the prior is a range.
    freedom: usize,
    noise: f64,
}

impl Prior {
    fn new(n_dimensions: usize, n_sources: usize, observed: &Observed) -> Self {
        let n = observed.means.len() as f64;
        let centre = observed.means.iter().sum::<f64>() / n;
        let spread = observed.means.iter().map(|value| (value - centre).powi(2)).sum::<f64>() / n;
        let of_mean = observed.noise * observed.counts.iter().map(|n| 1.0 / n).sum::<f64>() / n;
        let least = 1e-12 * centre * centre + 1e-18;
        let signal = spread.max(of_mean).max(least);
        let mut means = vec![LENGTH[0].ln(); n_dimensions - n_sources];
        let mut deviations = vec![LENGTH[1]; n_dimensions - n_sources];
        means.extend(vec![LIKENESS[0].ln(); n_sources]);
        deviations.extend(vec![LIKENESS[1]; n_sources]);
        means.push((2.0 * signal).ln());
        deviations.push(SIGNAL);
        let is_known = observed.freedom > 0 && observed.noise > 0.0;
        let noise = if is_known { observed.noise } else { signal };
        Self { means, deviations, freedom: if is_known { observed.freedom } else { 0 }, noise }
    }

    /// A variance of noise.
    fn noise(&self, draws: &mut Draws) -> f64 {
        if self.freedom == 0 {
            let [low, high] = NOISE.map(f64::ln);
            return self.noise * (low + (high - low) * draws.uniform()).exp();
        }
        self.noise * self.freedom as f64 / draws.chi_square(self.freedom).max(1e-12)
    }
}

/// Logarithm of the density of `values` under normal numbers, but for a constant.
fn log_density(values: &[f64], means: &[f64], deviations: &[f64]) -> f64 {
    let of_one = |((value, mean), deviation): ((&f64, &f64), &f64)| {
        -0.5 * ((value - mean) / deviation).powi(2) - deviation.ln()
    };
    values.iter().zip(means).zip(deviations).map(of_one).sum()
}

/// Weights that add up to one, of their `logarithms`.
fn weights(logarithms: &[f64]) -> Option<Vec<f64>> {
    let most = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !most.is_finite() {
        return None;
    }
    let raised: Vec<f64> = logarithms.iter().map(|log| (log - most).exp()).collect();
    let sum: f64 = raised.iter().sum();
    Some(raised.iter().map(|weight| weight / sum).collect())
}

/// Means and standard deviations of the `drawn` under `weights`.
fn moments(drawn: &[Vec<f64>], weights: &[f64]) -> [Vec<f64>; 2] {
    let n = drawn[0].len();
    let mean = |place: usize| drawn.iter().zip(weights).map(|(one, w)| w * one[place]).sum::<f64>();
    let means: Vec<f64> = (0..n).map(mean).collect();
    let deviation = |place: usize| {
        let square = |one: &Vec<f64>| (one[place] - means[place]).powi(2);
        let variance: f64 = drawn.iter().zip(weights).map(|(one, w)| w * square(one)).sum();
        (WIDER * variance.sqrt()).max(LEAST)
    };
    let deviations = (0..n).map(deviation).collect();
    [means, deviations]
}

impl Model {
    /// The process of covariance function `shape` over scaled `points` that gave what was `observed`; the
    /// last `n_sources` dimensions tell of which cheaper source a point is.
    ///
    /// # Errors
    /// [`SearchError::NoProcess`].
    pub(crate) fn new(
        shape: Shape,
        (points, n_sources): (&[Vec<f64>], usize),
        observed: &Observed,
        seed: u64,
    ) -> Result<Self, SearchError> {
        let failed = SearchError::NoProcess { n: points.len() };
        let n_dimensions = points.first().map_or(0, Vec::len);
        let prior = Prior::new(n_dimensions, n_sources, observed);
        let mut draws = Draws::new(seed, 2);
        let process = |drawn: &[f64], noise: f64| {
            let (lengths, signal) = drawn.split_at(n_dimensions);
            let parameters = Hyperparameters {
                signal_variance: signal[0].exp(),
                lengths: lengths.iter().map(|length| length.exp()).collect(),
                noise_variance: 0.0,
            };
            let observations = Observations {
                inputs: points.concat(),
                n_dimensions,
                values: observed.means.clone(),
                variances: observed.counts.iter().map(|count| noise / count).collect(),
            };
            GaussianProcess::new(shape, parameters, observations, Mean::Constant).ok()
        };
        let (mut centres, mut deviations) = (prior.means.clone(), prior.deviations.clone());
        let mut round = |centres: &[f64], deviations: &[f64]| {
            let (mut drawn, mut found, mut logarithms) = (Vec::new(), Vec::new(), Vec::new());
            for _ in 0..N_DRAWN {
                let one: Vec<f64> =
                    centres.iter().zip(deviations).map(|(c, d)| c + d * draws.normal()).collect();
                let noise = prior.noise(&mut draws);
                let Some(process) = process(&one, noise) else { continue };
                let ratio = log_density(&one, &prior.means, &prior.deviations)
                    - log_density(&one, centres, deviations);
                logarithms.push(process.log_marginal_likelihood() + ratio);
                found.push(Process { shape, process, noise });
                drawn.push(one);
            }
            weights(&logarithms).map(|weights| (drawn, found, weights))
        };
        let (drawn, _, weights) = round(&centres, &deviations).ok_or(failed.clone())?;
        [centres, deviations] = moments(&drawn, &weights);
        let (_, found, weights) = round(&centres, &deviations).ok_or(failed)?;
        // Systematic choice: as often as its weight asks for.
        let (mut processes, mut sum) = (Vec::with_capacity(N_KEPT), 0.0);
        for (process, weight) in found.into_iter().zip(weights) {
            sum += weight * N_KEPT as f64;
            while (processes.len() as f64) + 0.5 < sum {
                processes.push(process.clone());
            }
        }
        Ok(Self { processes })
    }

    /// The process at each of scaled `points`: mean and deviation of the mixture.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`] for points of other dimensions.
    pub(crate) fn at(&self, points: &[Vec<f64>]) -> Result<Vec<Normal>, SearchError> {
        let n = self.processes.len() as f64;
        let one = |point: &Vec<f64>| {
            let found = self.processes.iter().map(|one| one.process.predict(point));
            let found = found.collect::<Result<Vec<_>, _>>()?;
            let mean = found.iter().map(|one| one.mean).sum::<f64>() / n;
            let square = |one: &surrogate::Prediction| {
                one.standard_deviation.powi(2) + (one.mean - mean).powi(2)
            };
            let variance = found.iter().map(square).sum::<f64>() / n;
            Ok(Normal { mean, deviation: variance.sqrt() })
        };
        points.iter().map(one).collect()
    }

    /// Correlation of the curve with that of the source whose dimension is number `dimension`, the mean over
    /// the mixture (–).
    pub(crate) fn likeness(&self, dimension: usize) -> Result<f64, SearchError> {
        let mut sum = 0.0;
        for one in &self.processes {
            let lengths = &one.process.hyperparameters().lengths;
            let mut there = vec![0.0; lengths.len()];
            let here = there.clone();
            there[dimension] = 1.0;
            sum += one.shape.correlation(lengths, &here, &there)?;
        }
        Ok(sum / self.processes.len() as f64)
    }

    /// Variance of the noise of one block.
    pub(crate) fn noise(&self) -> f64 {
        self.processes.iter().map(|one| one.noise).sum::<f64>() / self.processes.len() as f64
    }

    /// The model had the scaled `point` given what is expected there, in `n_blocks`: with less uncertainty
    /// around it and the same mean.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub(crate) fn believing(&self, point: &[f64], n_blocks: f64) -> Result<Self, SearchError> {
        let one = |one: &Process| {
            let value = one.process.predict(point)?.mean;
            let process = one.with(point, value, one.noise / n_blocks)?;
            Ok::<_, SearchError>(Process { process, shape: one.shape, noise: one.noise })
        };
        Ok(Self { processes: self.processes.iter().map(one).collect::<Result<_, _>>()? })
    }

    /// The model with its hyperparameters, had scaled `points`, evaluated in `n_blocks` each, given what is
    /// expected there, and nothing else were known.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub(crate) fn instead(&self, points: &[Vec<f64>], n_blocks: f64) -> Result<Self, SearchError> {
        let values: Vec<f64> = self.at(points)?.iter().map(|value| value.mean).collect();
        let one = |one: &Process| {
            let observations = Observations {
                inputs: points.concat(),
                n_dimensions: one.process.observations().n_dimensions,
                values: values.clone(),
                variances: vec![one.noise / n_blocks; points.len()],
            };
            let parameters = one.process.hyperparameters().clone();
            let process =
                GaussianProcess::new(one.shape, parameters, observations, Mean::Constant)?;
            Ok::<_, SearchError>(Process { process, shape: one.shape, noise: one.noise })
        };
        Ok(Self { processes: self.processes.iter().map(one).collect::<Result<_, _>>()? })
    }

    /// `n` curves drawn from the mixture at scaled `points`, in random order.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub(crate) fn samples(
        &self,
        points: &[Vec<f64>],
        n: usize,
        seed: u64,
    ) -> Result<Vec<Vec<f64>>, SearchError> {
        let each = n.div_ceil(self.processes.len());
        let mut drawn = Vec::with_capacity(each * self.processes.len());
        for (place, one) in self.processes.iter().enumerate() {
            let seed = seed.wrapping_mul(1000).wrapping_add(place as u64);
            drawn.extend(one.process.samples(points, each, seed)?);
        }
        let order = Draws::new(seed, 4).order(drawn.len());
        Ok(order.into_iter().take(n).map(|place| std::mem::take(&mut drawn[place])).collect())
    }
}

impl Process {
    /// The process with a further observation.
    pub(crate) fn with(
        &self,
        point: &[f64],
        value: f64,
        variance: f64,
    ) -> Result<GaussianProcess, SearchError> {
        let before = self.process.observations();
        let observations = Observations {
            inputs: [before.inputs.as_slice(), point].concat(),
            n_dimensions: before.n_dimensions,
            values: [before.values.as_slice(), &[value]].concat(),
            variances: [before.variances.as_slice(), &[variance]].concat(),
        };
        let shape = self.shape;
        let parameters = self.process.hyperparameters().clone();
        Ok(GaussianProcess::new(shape, parameters, observations, Mean::Constant)?)
    }
}
