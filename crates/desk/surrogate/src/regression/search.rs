//! Hyperparameters of maximum profile likelihood: several starts on few observations, the best of them on
//! more, and a few steps on all.

use super::expression::Kernel;
use super::marginal::Marginal;
use super::problem::{Problem, Trend};
use crate::Shape;
use crate::ascent::{End, Objective, climb, inside, place_of};
use crate::sample::Normals;
use faer::{Mat, Side};
use std::cell::Cell;

/// Observations on which starts are compared, and on which the best is followed (–).
const FEW: usize = 400;
/// Steps of a start on few observations, and of the best on more (–).
const STEPS: [u64; 2] = [60, 200];
/// Least second derivative that is taken for one (–): along a flatter way a first step is as long as it
/// allows.
const LEAST_BEND: f64 = 1e-2;
/// Searches at the end at most (–).
const MOST_POLISHES: usize = 4;
/// A noise variance this close to a bound counts as there (–): close to it searches come to rest.
const NEAR: f64 = 10.0;
/// A step in the coordinates of the search along which curvature is measured (–).
const STEP: f64 = 1e-3;

/// How hyperparameters are searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// Starts (–); the first two are fixed, the others drawn.
    pub n_starts: usize,
    /// Seed of the starts and of the observations that are searched on first.
    pub seed: u64,
    /// Observations that are searched on before all are taken (–).
    pub n_first: usize,
    /// Steps on all observations, where they are more and the process is exact (–).
    pub n_steps_on_all: u64,
    /// Threads (–); 0 for as many as the machine has. The result does not depend on it.
    pub n_threads: usize,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { n_starts: 16, seed: 1, n_first: 1000, n_steps_on_all: 3, n_threads: 0 }
    }
}

/// How hyperparameters were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    /// Observations of the largest set whose likelihood was worked out, replicates as one (–).
    pub n_largest: usize,
    /// Lengths, exponents and variances that were estimated, those of the noise among them (–).
    pub n_hyperparameters: usize,
    /// Noise groups whose variance was found at the lower bound of the search, within a factor of ten.
    pub noise_at_lower: Vec<usize>,
    /// The same at the upper bound.
    pub noise_at_upper: Vec<usize>,
}

/// Likelihood of a problem over the logarithms of hyperparameters.
struct OfProblem<'a> {
    problem: &'a Problem,
    kernel: &'a Kernel,
    n_threads: usize,
    /// Observations of the largest problem so far (–).
    largest: &'a Cell<usize>,
}

impl OfProblem<'_> {
    fn parameters(&self, logarithms: &[f64]) -> (Kernel, Vec<f64>) {
        let (kernel, noise) = self.kernel.with(logarithms);
        (kernel, noise.iter().map(|log| log.exp()).collect())
    }
}

impl Objective for OfProblem<'_> {
    fn value_and_slopes(&self, parameters: &[f64]) -> Option<(f64, Vec<f64>)> {
        self.largest.set(self.largest.get().max(self.problem.len()));
        let (kernel, noise) = self.parameters(parameters);
        let found = Marginal::new(self.problem, &kernel, &noise, self.n_threads, false)?;
        let slopes = found.slopes(self.problem, &kernel, &noise);
        slopes.iter().all(|slope| slope.is_finite()).then_some((found.log, slopes))
    }
}

/// Logarithms of the bounds of each hyperparameter, scaled, and the share of the way at which a first start
/// begins: variances within 10⁻⁴ to 10⁴ of the values' own, lengths from a hundredth of an input's range to a
/// hundred times it (0.05 to 50 for a periodic shape), exponents from 10⁻² to 10³, noise within 10⁻⁸ to 10²
/// of the values' variance.
fn bounds(problem: &Problem, kernel: &Kernel) -> (Vec<[f64; 2]>, Vec<f64>) {
    let mut found = Vec::new();
    let mut add = |[low, high]: [f64; 2], share: f64| found.push(([low.ln(), high.ln()], share));
    let spread = {
        let n = problem.n_observations();
        let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
            let counted = problem.values.iter().zip(&problem.counts);
            counted.map(|(value, count)| count * of(*value)).sum()
        };
        let centre = match problem.trend {
            Trend::Zero => 0.0,
            _ => sum(&|value| value) / n,
        };
        let within: f64 = problem.within.iter().sum();
        let spread = (sum(&|value| (value - centre).powi(2)) + within) / n;
        if spread > 0.0 { spread } else { 1e-12 }
    };
    let range = |input: usize| {
        let ends = problem.inputs[input].iter();
        let ends = ends
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
        if ends[1] > ends[0] { ends[1] - ends[0] } else { 1.0 }
    };
    // Of many inputs each has a long length.
    let share = if problem.n_dimensions() > 3 { 0.5 } else { 0.38 };
    for term in &kernel.terms {
        add([1e-4 * spread, 1e4 * spread], 0.5);
        for part in &term.parts {
            for input in &part.inputs {
                match part.shape {
                    Shape::Periodic { .. } => add([0.05, 50.0], 0.434),
                    _ => add([1e-2 * range(*input), 1e2 * range(*input)], share),
                }
            }
            if let Shape::RationalQuadratic { .. } = part.shape {
                add([1e-2, 1e3], 0.4);
            }
        }
    }
    (0..problem.n_groups).for_each(|_| add([1e-8 * spread, 1e2 * spread], 0.6));
    found.into_iter().unzip()
}

/// Numbers of `n` observations out of `total`, drawn with `seed`, in order.
pub(crate) fn drawn(total: usize, n: usize, seed: u64) -> Vec<usize> {
    let mut chosen = shuffled(total, seed);
    chosen.truncate(n);
    chosen.sort_unstable();
    chosen
}

/// The numbers below `total` in an order of `seed`.
pub fn shuffled(total: usize, seed: u64) -> Vec<usize> {
    let mut normals = Normals::new(seed);
    let mut keyed: Vec<(f64, usize)> = (0..total).map(|index| (normals.next(), index)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    keyed.into_iter().map(|(_, index)| index).collect()
}

/// Kernel and noise of maximum profile likelihood, scaled; none where no place has a likelihood. Where the
/// process is not to be exact, `settings.n_first` observations say it all.
pub(crate) fn hyperparameters(
    problem: &Problem,
    kernel: &Kernel,
    settings: &SearchSettings,
    is_exact: bool,
) -> Option<(Kernel, Vec<f64>, Searched)> {
    let (bounds, shares) = bounds(problem, kernel);
    let n_threads = super::threads::number(settings.n_threads);
    let n = problem.len();
    let largest = Cell::new(0);
    let of = |problem| OfProblem { problem, kernel, n_threads, largest: &largest };
    let subset = |most: usize| problem.subset(&drawn(n, most, settings.seed));
    let [few, more] = [FEW.min(settings.n_first), settings.n_first].map(subset);
    let whole = End { n_steps: STEPS[1], slope: 1e-5 };
    let quick = if few.len() < n { End { n_steps: STEPS[0], slope: 0.1 } } else { whole };
    let mut place = best_start(&of(&few), &bounds, &shares, settings, quick)?;
    if few.len() < n {
        let of_more = of(&more);
        let end = End { n_steps: STEPS[1], slope: if more.len() < n { 0.05 } else { 1e-5 } };
        place = climb(&of_more, &bounds, &place, None, end).map_or(place, |best| best.1);
        if more.len() < n && is_exact && settings.n_steps_on_all > 0 {
            let turn = turn(&of_more, &bounds, &place, n as f64 / more.len() as f64);
            let end = End { n_steps: settings.n_steps_on_all, slope: 0.3 };
            let on_all = climb(&of(problem), &bounds, &place, turn.as_ref(), end);
            place = on_all.map_or(place, |best| best.1);
        }
    }
    let of_all = of(problem);
    if n <= settings.n_first && is_exact {
        place = polished(&of_all, &bounds, place);
    }
    let found = inside(&place, &bounds).0;
    let (kernel, noise) = of_all.parameters(&found);
    let n_kernel = found.len() - problem.n_groups;
    let near = |end: usize| -> Vec<usize> {
        let groups = (0..problem.n_groups).filter(|group| {
            let place = n_kernel + group;
            (found[place] - bounds[place][end]).abs() < NEAR.ln()
        });
        groups.collect()
    };
    let searched = Searched {
        n_largest: largest.get(),
        n_hyperparameters: found.len(),
        noise_at_lower: near(0),
        noise_at_upper: near(1),
    };
    Some((kernel, noise, searched))
}

/// The highest place that `settings.n_starts` searches find.
fn best_start(
    of: &OfProblem<'_>,
    bounds: &[[f64; 2]],
    shares: &[f64],
    settings: &SearchSettings,
    end: End,
) -> Option<Vec<f64>> {
    let mut normals = Normals::new(settings.seed);
    let mut ends: Vec<(f64, Vec<f64>)> = Vec::new();
    for start in 0..settings.n_starts.max(1) {
        let place: Vec<f64> = match start {
            0 => shares.iter().map(|share| place_of(*share)).collect(),
            // Long lengths, much noise: little but the trend.
            1 => shares.iter().map(|share| place_of(share + 0.15)).collect(),
            _ => shares.iter().map(|_| normals.next()).collect(),
        };
        ends.extend(climb(of, bounds, &place, None, end));
    }
    ends.sort_by(|a, b| b.0.total_cmp(&a.0));
    Some(ends.into_iter().next()?.1)
}

/// The end of searches from `place` in coordinates that bend alike: along a ridge steps in others come to
/// rest too early.
fn polished(of: &OfProblem<'_>, bounds: &[[f64; 2]], mut place: Vec<f64>) -> Vec<f64> {
    let end = End { n_steps: STEPS[0], slope: 1e-5 };
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..MOST_POLISHES {
        let Some(turn) = turn(of, bounds, &place, 1.0) else { break };
        let Some((value, better)) = climb(of, bounds, &place, Some(&turn), end) else { break };
        let gain = value - highest;
        (highest, place) = (value, better);
        if gain < 1e-6 {
            break;
        }
    }
    place
}

/// Coordinates in which the likelihood of `ratio` times as many observations bends alike along all: with the
/// negative second derivatives V Λ Vᵀ of fewer, V (ratio Λ)^(−1/2).
fn turn(fewer: &OfProblem<'_>, bounds: &[[f64; 2]], place: &[f64], ratio: f64) -> Option<Mat<f64>> {
    let n = place.len();
    let slopes = |place: &[f64]| {
        let (parameters, speeds) = inside(place, bounds);
        let (_, slopes) = fewer.value_and_slopes(&parameters)?;
        Some(slopes.iter().zip(speeds).map(|(a, b)| a * b).collect::<Vec<f64>>())
    };
    let mut bend = Mat::<f64>::zeros(n, n);
    for column in 0..n {
        let at = |sign: f64| {
            let mut place = place.to_vec();
            place[column] += sign * STEP;
            slopes(&place)
        };
        let (ahead, behind) = (at(1.0)?, at(-1.0)?);
        for row in 0..n {
            bend[(row, column)] = -(ahead[row] - behind[row]) / (2.0 * STEP);
        }
    }
    let bend = 0.5 * (&bend + bend.transpose());
    let found = bend.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, vectors) = (found.S(), found.U());
    let scale = |column: usize| (ratio * values[column].abs().max(LEAST_BEND)).sqrt().recip();
    Some(Mat::from_fn(n, n, |row, column| vectors[(row, column)] * scale(column)))
}

#[cfg(test)]
mod tests;
