//! Hyperparameters of maximum marginal likelihood: limited-memory BFGS from several starts, inside bounds.

use crate::ascent::{End, Objective, climb, inside, place_of};
use crate::likelihood::{Likelihood, Mean};
use crate::sample::Normals;
use crate::{Hyperparameters, Observations, Shape, SurrogateError};

/// Whether a noise variance is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Noise {
    /// One variance for all observations is estimated, in addition to the known ones.
    #[default]
    Estimated,
    /// Only the known variances; without them the curve goes through every value.
    Known,
}

/// How a process is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Mean of the process far from observations.
    pub mean: Mean,
    /// Whether a noise variance is estimated.
    pub noise: Noise,
    /// Starts of the search (–); the first is fixed, the others drawn.
    pub n_starts: usize,
    /// Seed of the starts.
    pub seed: u64,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self { mean: Mean::default(), noise: Noise::default(), n_starts: 8, seed: 1 }
    }
}

/// Steps of one search at most, since a handful of parameters settle within a few dozen.
const END: End = End { n_steps: 200, slope: 1.5e-8 };

/// The hyperparameters of maximum marginal likelihood for `observations`.
///
/// Each is searched between bounds that are wide against the data: the signal's variance within 10⁻⁴ to 10⁴
/// of the values' own, lengths from a hundredth of the inputs' range to a hundred times it (0.05 to 50 for a
/// periodic kernel), the noise's variance within 10⁻⁸ to 10² of the values'. The search runs over the logit
/// of each logarithm's place between its bounds, so that no step leaves them.
pub(crate) fn hyperparameters(
    shape: Shape,
    observations: &Observations,
    settings: &FitSettings,
) -> Result<Hyperparameters, SurrogateError> {
    let search = Search::new(shape, observations, settings);
    let mut normals = Normals::new(settings.seed);
    let n_parameters = search.bounds.len();
    let mut best: Option<(f64, Vec<f64>)> = None;
    for start in 0..settings.n_starts.max(1) {
        let place = match start {
            0 => search.first_place(),
            _ => (0..n_parameters).map(|_| normals.next()).collect(),
        };
        let Some(found) = climb(&search, &search.bounds, &place, None, END) else { continue };
        if best.as_ref().is_none_or(|(log, _)| found.0 > *log) {
            best = Some(found);
        }
    }
    let n = observations.len();
    best.map(|(_, place)| search.parameters(&inside(&place, &search.bounds).0))
        .ok_or(SurrogateError::NotPositiveDefinite { n })
}

struct Search<'a> {
    shape: Shape,
    observations: &'a Observations,
    mean: Mean,
    /// Logarithms of the bounds of each parameter.
    bounds: Vec<[f64; 2]>,
    /// Noise variance where none is estimated.
    fixed_noise: Option<f64>,
}

impl<'a> Search<'a> {
    fn new(shape: Shape, observations: &'a Observations, settings: &FitSettings) -> Self {
        let n = observations.len() as f64;
        let values = &observations.values;
        let center = match settings.mean {
            Mean::Zero => 0.0,
            Mean::Constant => values.iter().sum::<f64>() / n,
        };
        let spread = values.iter().map(|value| (value - center).powi(2)).sum::<f64>() / n;
        // Values that are all the same still have a scale.
        let spread = if spread > 0.0 { spread } else { 1e-12 * center * center + 1e-24 };
        let mut bounds = vec![[1e-4 * spread, 1e4 * spread]];
        for dimension in 0..observations.n_dimensions {
            let along =
                observations.inputs.iter().skip(dimension).step_by(observations.n_dimensions);
            let (low, high) = along
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), input| {
                    (low.min(*input), high.max(*input))
                });
            let range = if high > low { high - low } else { 1.0 };
            bounds.push(match shape {
                Shape::Periodic { .. } => [0.05, 50.0],
                _ => [1e-2 * range, 1e2 * range],
            });
        }
        let fixed_noise = match settings.noise {
            Noise::Estimated => {
                bounds.push([1e-8 * spread, 1e2 * spread]);
                None
            }
            // Enough to factorise, too little to matter.
            Noise::Known => Some(1e-10 * spread),
        };
        let bounds = bounds.into_iter().map(|ends| ends.map(f64::ln)).collect();
        Self { shape, observations, mean: settings.mean, bounds, fixed_noise }
    }

    /// Signal as large as the spread, lengths of a third of the range (one for a periodic kernel), noise of a
    /// hundredth.
    fn first_place(&self) -> Vec<f64> {
        let shares = |index: usize, [low, high]: [f64; 2]| {
            let wanted = match (index, self.shape) {
                (0, _) => 0.5,
                (index, Shape::Periodic { .. }) if index <= self.observations.n_dimensions => {
                    -low / (high - low)
                }
                (index, _) if index <= self.observations.n_dimensions => 0.38,
                _ => 0.6,
            };
            place_of(wanted)
        };
        self.bounds.iter().enumerate().map(|(index, ends)| shares(index, *ends)).collect()
    }

    /// Parameters of their `logarithms`.
    fn parameters(&self, logarithms: &[f64]) -> Hyperparameters {
        let mut values: Vec<f64> = logarithms.iter().map(|log| log.exp()).collect();
        let noise_variance = self.fixed_noise.or_else(|| values.pop()).unwrap_or(0.0);
        let lengths = values.split_off(1);
        Hyperparameters { signal_variance: values[0], lengths, noise_variance }
    }
}

impl Objective for Search<'_> {
    fn value_and_slopes(&self, logarithms: &[f64]) -> Option<(f64, Vec<f64>)> {
        let parameters = self.parameters(logarithms);
        let found = Likelihood::new(self.shape, &parameters, self.observations, self.mean).ok()?;
        let mut slopes = found.slopes(self.shape, &parameters, self.observations);
        slopes.truncate(logarithms.len());
        found.log.is_finite().then_some((found.log, slopes))
    }
}
