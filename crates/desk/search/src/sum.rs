//! The weighted sum of outputs, each with a process of its own.

use crate::history::{History, Observed};
use crate::model::{Model, Normal};
use crate::{SearchError, Space};
use surrogate::Shape;

/// Processes of all outputs, and their sum.
#[derive(Clone, Debug)]
pub struct Sum {
    /// One for each output.
    models: Vec<Model>,
    weights: Vec<f64>,
    space: Space,
    /// Deviation of the error that all evaluations of the sum share.
    shared: f64,
    /// Blocks of an evaluation (–).
    n_blocks: f64,
    /// Cheaper sources (–).
    n_sources: usize,
}

impl Sum {
    /// The processes of what `history` tells, of covariance function `shape`, and what `cheaper` sources tell
    /// beside it.
    ///
    /// Each source has a dimension of its own, in which its points lie one away from all others: how alike
    /// it is is a length like others, found from the data. Where it is another thing altogether its points
    /// say nothing. Such a dimension for the fidelity is that of Kandasamy et al., "Multi-fidelity Bayesian
    /// optimisation with continuous approximations", ICML 2017, with two places in it.
    ///
    /// # Errors
    /// [`SearchError::NoProcess`].
    pub fn new(
        space: &Space,
        (history, cheaper): (&History, &[History]),
        weights: &[f64],
        (shape, share_blocks, seed): (Shape, bool, u64),
    ) -> Result<Self, SearchError> {
        let n_sources = cheaper.len();
        let at = |source: Option<usize>| {
            move |point: &Vec<f64>| {
                let mut scaled = space.scaled(point);
                scaled.extend((0..n_sources).map(|own| f64::from(u8::from(source == Some(own)))));
                scaled
            }
        };
        let mut points: Vec<Vec<f64>> = history.points.iter().map(at(None)).collect();
        for (source, cheap) in cheaper.iter().enumerate() {
            points.extend(cheap.points.iter().map(at(Some(source))));
        }
        let of_output = |output: usize| {
            let only: Vec<f64> =
                (0..weights.len()).map(|o| f64::from(u8::from(o == output))).collect();
            let others = cheaper.iter().map(|cheap| cheap.observed(&only, share_blocks));
            let observed = history.observed(&only, share_blocks).followed_by(others.collect());
            let all = (points.as_slice(), n_sources);
            Model::new(shape, all, &observed, seed.wrapping_add(output as u64))
        };
        let models = (0..weights.len()).map(of_output).collect::<Result<_, _>>()?;
        let Observed { shared, counts, .. } = history.observed(weights, share_blocks);
        let n_blocks = counts.iter().sum::<f64>() / counts.len() as f64;
        let (weights, space) = (weights.to_vec(), space.clone());
        Ok(Self { models, weights, space, shared: shared.sqrt(), n_blocks, n_sources })
    }

    /// What is searched over.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Deviation of the error that all evaluations share (unit of the sum): it moves the whole curve.
    pub fn shared_deviation(&self) -> f64 {
        self.shared
    }

    /// Variance of the noise of one more evaluation.
    pub(crate) fn noise_variance(&self) -> f64 {
        let parts = self.models.iter().zip(&self.weights);
        parts.map(|(model, weight)| weight * weight * model.noise()).sum::<f64>() / self.n_blocks
    }

    fn scaled(&self, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
        points.iter().map(|point| self.place(point)).collect()
    }

    /// Where the processes have `point`, of no cheaper source.
    pub(crate) fn place(&self, point: &[f64]) -> Vec<f64> {
        let mut scaled = self.space.scaled(point);
        scaled.resize(scaled.len() + self.n_sources, 0.0);
        scaled
    }

    /// How alike the curves of cheaper source number `source` are to those that are searched: their
    /// correlation at one point, the mean over the parts of the sum (–).
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub fn likeness(&self, source: usize) -> Result<f64, SearchError> {
        let dimension = self.space.n_dimensions() + source;
        let all = self.parts().map(|(model, _)| model.likeness(dimension));
        let all = all.collect::<Result<Vec<f64>, SearchError>>()?;
        Ok(all.iter().sum::<f64>() / all.len() as f64)
    }

    /// Output number `output` at `points`.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`] for points of another number of variables.
    pub fn output(&self, output: usize, points: &[Vec<f64>]) -> Result<Vec<Normal>, SearchError> {
        self.models[output].at(&self.scaled(points))
    }

    /// The sum at `points`: means add up, and so do variances. van der Hoek et al., Eqs. 10 and 11.
    ///
    /// # Errors
    /// As [`output`](Self::output).
    pub fn at(&self, points: &[Vec<f64>]) -> Result<Vec<Normal>, SearchError> {
        let points = self.scaled(points);
        let mut means = vec![0.0; points.len()];
        let mut variances = vec![0.0; points.len()];
        for (model, weight) in self.parts() {
            for (place, found) in model.at(&points)?.into_iter().enumerate() {
                means[place] += weight * found.mean;
                variances[place] += (weight * found.deviation).powi(2);
            }
        }
        let one = |(mean, variance): (f64, f64)| Normal { mean, deviation: variance.sqrt() };
        Ok(means.into_iter().zip(variances).map(one).collect())
    }

    /// Models and weights of what the sum holds.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (&Model, f64)> {
        let parts = self.models.iter().zip(self.weights.iter().copied());
        parts.filter(|(_, weight)| *weight != 0.0)
    }

    /// The same as though `point` had given what is expected there.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub(crate) fn believing(&self, point: &[f64]) -> Result<Self, SearchError> {
        let scaled = self.place(point);
        let models = self.models.iter().map(|model| model.believing(&scaled, self.n_blocks));
        Ok(Self { models: models.collect::<Result<_, _>>()?, ..self.clone() })
    }

    /// The same with its hyperparameters as though evaluations at `points`, and no others, had given what is
    /// expected there: how well another choice of points would have told the sum.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub fn instead(&self, points: &[Vec<f64>]) -> Result<Self, SearchError> {
        let scaled = self.scaled(points);
        let models = self.models.iter().map(|model| model.instead(&scaled, self.n_blocks));
        Ok(Self { models: models.collect::<Result<_, _>>()?, ..self.clone() })
    }

    /// Blocks of an evaluation (–).
    pub(crate) fn n_blocks(&self) -> f64 {
        self.n_blocks
    }

    /// `n` curves of the sum at `points`, what all evaluations share left out.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub fn samples(
        &self,
        points: &[Vec<f64>],
        n: usize,
        seed: u64,
    ) -> Result<Vec<Vec<f64>>, SearchError> {
        let points = self.scaled(points);
        let mut sums = vec![vec![0.0; points.len()]; n];
        for (place, (model, weight)) in self.parts().enumerate() {
            let drawn = model.samples(&points, n, seed.wrapping_add(100 * (1 + place as u64)))?;
            for (sum, curve) in sums.iter_mut().zip(drawn) {
                sum.iter_mut().zip(curve).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        Ok(sums)
    }
}
