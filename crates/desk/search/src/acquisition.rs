//! Where the next evaluation is worth most.

use crate::SearchError;
use crate::model::Normal;
use crate::normal::{NORMAL_97_5, excess};
use crate::sum::Sum;

/// Deviations above the mean of the upper bound (–).
const BOUND: f64 = 2.0;
/// Candidates for which the gradient of knowledge is worked out, and points at which its effect is looked at
/// (–).
const N_ASKED: usize = 60;
const N_LOOKED_AT: usize = 150;
/// Processes of a mixture that it is worked out with (–).
const N_PROCESSES: usize = 3;
/// Values of a normal number of equal probability, over which it is averaged (–).
const N_LEVELS: usize = 15;

/// What is greatest at the next point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Acquisition {
    /// The expected improvement over the best mean, less where noise would hide it. Huang et al., "Global
    /// optimization of stochastic black-box systems via sequential kriging meta-models", J. Global Optim. 34,
    /// 2006 (augmented expected improvement); the curve itself is to improve, not a noisy reading.
    #[default]
    ExpectedImprovement,
    /// The expected rise of the best mean by one more evaluation. Frazier, Powell and Dayanik, "The
    /// knowledge-gradient policy for correlated normal beliefs", INFORMS J. Comput. 21, 2009.
    KnowledgeGradient,
    /// Two standard deviations above the mean. Srinivas et al., "Gaussian process optimization in the bandit
    /// setting", ICML 2010.
    UpperBound,
}

/// Where it is greatest.
pub(crate) struct Chosen {
    /// Number of the candidate.
    pub(crate) place: usize,
    /// Improvement over the best mean that is expected of it (unit of the sum).
    pub(crate) expected_gain: f64,
}

/// The best of `candidates` where `is_open`, of which `sum` is `values`; none where none is open.
///
/// # Errors
/// [`SearchError::Surrogate`].
pub(crate) fn choose(
    acquisition: Acquisition,
    sum: &Sum,
    candidates: &[Vec<f64>],
    values: &[Normal],
    is_open: &[bool],
) -> Result<Option<Chosen>, SearchError> {
    let best = values.iter().map(|value| value.mean).fold(f64::NEG_INFINITY, f64::max);
    let noise = sum.noise_variance();
    let improvement = |value: &Normal| {
        let seen = 1.0 - (noise / (value.deviation.powi(2) + noise).max(f64::MIN_POSITIVE)).sqrt();
        excess(value.mean, value.deviation, best) * seen
    };
    let open = || (0..candidates.len()).filter(|place| is_open[*place]);
    let greatest = |of: &dyn Fn(usize) -> f64| {
        let mut found: Option<(f64, usize)> = None;
        for place in open() {
            let value = of(place);
            if found.is_none_or(|(most, _)| value > most) {
                found = Some((value, place));
            }
        }
        found
    };
    let by_improvement = greatest(&|place| improvement(&values[place]));
    Ok(match acquisition {
        Acquisition::ExpectedImprovement => {
            by_improvement.map(|(expected_gain, place)| Chosen { place, expected_gain })
        }
        Acquisition::UpperBound => {
            let found = greatest(&|place| values[place].mean + BOUND * values[place].deviation);
            found.map(|(_, place)| Chosen { place, expected_gain: improvement(&values[place]) })
        }
        Acquisition::KnowledgeGradient => {
            let asked = leading(open().collect(), |place| improvement(&values[place]));
            knowledge(sum, candidates, values, &asked)?
        }
    })
}

/// The first [`N_ASKED`] of `places` by `of`.
fn leading(mut places: Vec<usize>, of: impl Fn(usize) -> f64) -> Vec<usize> {
    places.sort_by(|a, b| of(*b).total_cmp(&of(*a)).then(a.cmp(b)));
    places.truncate(N_ASKED);
    places
}

/// The candidate of those `asked` after which the best mean is expected to be highest.
fn knowledge(
    sum: &Sum,
    candidates: &[Vec<f64>],
    values: &[Normal],
    asked: &[usize],
) -> Result<Option<Chosen>, SearchError> {
    let mut places: Vec<usize> = (0..candidates.len()).collect();
    let bound = |place: usize| values[place].mean + NORMAL_97_5 * values[place].deviation;
    places.sort_by(|a, b| bound(*b).total_cmp(&bound(*a)).then(a.cmp(b)));
    places.truncate(N_LOOKED_AT);
    let at: Vec<Vec<f64>> = places.iter().map(|p| sum.place(&candidates[*p])).collect();
    let means: Vec<f64> = places.iter().map(|place| values[*place].mean).collect();
    let best = values.iter().map(|value| value.mean).fold(f64::NEG_INFINITY, f64::max);
    let mut found: Option<Chosen> = None;
    for place in asked {
        let moves = sum.moves(&sum.place(&candidates[*place]), &at)?;
        let of_level = |level: usize| {
            let z = level_of(level);
            let highest = means.iter().zip(&moves).map(|(mean, move_by)| mean + z * move_by);
            highest.fold(best, f64::max)
        };
        let expected_gain = (0..N_LEVELS).map(of_level).sum::<f64>() / N_LEVELS as f64 - best;
        if found.as_ref().is_none_or(|found| expected_gain > found.expected_gain) {
            found = Some(Chosen { place: *place, expected_gain });
        }
    }
    Ok(found)
}

/// The middle of the `level`-th of [`N_LEVELS`] parts of equal probability of a normal number.
fn level_of(level: usize) -> f64 {
    let share = (level as f64 + 0.5) / N_LEVELS as f64;
    let (mut low, mut high) = (-6.0, 6.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if crate::normal::probability(middle) < share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

impl Sum {
    /// How far the mean at each scaled place of `at` moves when an evaluation at the scaled `point` comes out
    /// one standard deviation above what is expected of it.
    fn moves(&self, point: &[f64], at: &[Vec<f64>]) -> Result<Vec<f64>, SearchError> {
        let mut covariances = vec![0.0; at.len()];
        let (mut own, mut noise) = (0.0, 0.0);
        for (model, weight) in self.parts() {
            let step = model.processes.len().div_ceil(N_PROCESSES);
            let some: Vec<_> = model.processes.iter().step_by(step).collect();
            for one in &some {
                let share = weight * weight / some.len() as f64;
                let before = one.process.predict(point)?;
                let of_noise = one.noise / self.n_blocks();
                let variance = before.standard_deviation.powi(2);
                // Seen one higher, the mean moves by covariance over variance with noise.
                let after = one.with(point, before.mean + 1.0, of_noise.max(1e-12 * variance))?;
                for (covariance, place) in covariances.iter_mut().zip(at) {
                    let moved = after.predict(place)?.mean - one.process.predict(place)?.mean;
                    *covariance += share * moved * (variance + of_noise);
                }
                own += share * variance;
                noise += share * of_noise;
            }
        }
        let deviation = (own + noise).sqrt().max(f64::MIN_POSITIVE);
        Ok(covariances.into_iter().map(|covariance| covariance / deviation).collect())
    }
}
