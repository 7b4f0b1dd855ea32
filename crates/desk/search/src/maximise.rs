//! The loop: a first design, then propose, evaluate, learn.

use crate::acquisition::{Chosen, choose};
use crate::{Acquisition, Design, Evaluation, History, Optimum, SearchError, Shape, Space, Sum};

/// How a search is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Weight of each output in the sum that is maximised (–); an output of weight 0 is followed alone.
    pub weights: Vec<f64>,
    /// Covariance function of all processes.
    pub shape: Shape,
    /// How points are chosen after the first design.
    pub acquisition: Acquisition,
    /// The first design.
    pub design: Design,
    /// Points of a first design that is drawn (–).
    pub n_first: usize,
    /// Evaluations in all (–).
    pub budget: usize,
    /// Points that are proposed at a time after the first design (–).
    pub n_at_a_time: usize,
    /// Expected improvement below which the search ends before its budget is spent (unit of the sum).
    pub least_gain: Option<f64>,
    /// Whether block number b of all evaluations met the same conditions, so that they share its error.
    pub share_blocks: bool,
    /// Whether a point may be evaluated again: not where that gives the same once more.
    pub may_repeat: bool,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// What cheaper sources have told before, such as coarser simulations: each points with their
    /// evaluations, of the same outputs.
    pub cheaper: Vec<History>,
}

impl Settings {
    /// Settings for one output with noise that is new in each evaluation.
    pub fn of_one() -> Self {
        Self {
            weights: vec![1.0],
            shape: Shape::Matern32,
            acquisition: Acquisition::default(),
            design: Design::Hypercube,
            n_first: 6,
            budget: 20,
            n_at_a_time: 1,
            least_gain: None,
            share_blocks: false,
            may_repeat: true,
            seed: 1,
            cheaper: Vec::new(),
        }
    }
}

/// Points that are to be evaluated next.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// Number of the round, the first design being 0.
    pub round: usize,
    /// The points (units of the variables).
    pub points: Vec<Vec<f64>>,
    /// Improvement that was expected of the first of them (unit of the sum); none in the first design.
    pub expected_gain: Option<f64>,
}

/// What was known after a round.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was proposed in it.
    pub proposal: Proposal,
    /// Evaluations up to then (–).
    pub n_evaluations: usize,
    /// The optimum then.
    pub optimum: Optimum,
    /// The processes then.
    pub sum: Sum,
}

/// What came of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// The optimum.
    pub optimum: Optimum,
    /// The rounds.
    pub steps: Vec<Step>,
    /// All evaluations.
    pub history: History,
    /// The processes in the end.
    pub sum: Sum,
    /// Improvement that is expected of one more evaluation (unit of the sum); none where no point is left.
    pub expected_gain: Option<f64>,
    /// Whether it ended because little more was expected.
    pub is_settled: bool,
}

/// What is known, and what is best done next.
struct Known {
    sum: Sum,
    optimum: Optimum,
    next: Option<(Vec<Vec<f64>>, f64)>,
}

/// Maximises the sum of what `evaluate` gives: points with what each gave, those of the proposal, or others
/// in their place, such as those of an earlier search that goes on.
///
/// The same settings and evaluations give the same proposals.
///
/// # Errors
/// Those of `evaluate`; [`SearchError`] for settings that do not fit `space`.
pub fn maximise<E: From<SearchError>>(
    space: &Space,
    settings: &Settings,
    mut evaluate: impl FnMut(&Proposal) -> Result<Vec<(Vec<f64>, Evaluation)>, E>,
) -> Result<Found, E> {
    let mut history = History::default();
    let first = settings.design.points(space, settings.n_first, settings.seed)?;
    let mut proposal = Proposal { round: 0, points: first, expected_gain: None };
    let mut steps = Vec::new();
    loop {
        let evaluated = evaluate(&proposal)?;
        proposal.points = evaluated.iter().map(|(point, _)| point.clone()).collect();
        for (point, evaluation) in evaluated {
            history.add(point, evaluation, settings.weights.len())?;
        }
        let Known { sum, optimum, next } = learn(space, settings, &history)?;
        let round = proposal.round + 1;
        let (n_evaluations, then) = (history.len(), (optimum.clone(), sum.clone()));
        steps.push(Step { proposal, n_evaluations, optimum: then.0, sum: then.1 });
        let expected_gain = next.as_ref().map(|(_, gain)| *gain);
        let is_settled =
            settings.least_gain.zip(expected_gain).is_some_and(|(least, gain)| gain < least);
        match next {
            Some((points, gain)) if history.len() < settings.budget && !is_settled => {
                proposal = Proposal { round, points, expected_gain: Some(gain) };
            }
            _ => {
                return Ok(Found { optimum, steps, history, sum, expected_gain, is_settled });
            }
        }
    }
}

/// What `history` tells.
fn learn(space: &Space, settings: &Settings, history: &History) -> Result<Known, SearchError> {
    let seed = settings.seed;
    let making = (settings.shape, settings.share_blocks, seed);
    let sum = Sum::new(space, (history, &settings.cheaper), &settings.weights, making)?;
    let candidates = space.candidates(seed);
    let values = sum.at(&candidates)?;
    let optimum = Optimum::new(&sum, settings.weights.len(), &candidates, &values, seed)?;
    let mut is_open: Vec<bool> = candidates
        .iter()
        .map(|candidate| settings.may_repeat || !history.points.contains(candidate))
        .collect();
    let left = settings.budget.saturating_sub(history.len()).max(1);
    let (mut points, mut expected_gain) = (Vec::new(), 0.0);
    let (mut believed, mut values) = (sum.clone(), values);
    while points.len() < settings.n_at_a_time.min(left) {
        let found = choose(settings.acquisition, &believed, &candidates, &values, &is_open)?;
        let Some(Chosen { place, expected_gain: gain }) = found else { break };
        if points.is_empty() {
            expected_gain = gain;
        }
        is_open[place] = false;
        points.push(candidates[place].clone());
        if points.len() < settings.n_at_a_time.min(left) {
            believed = believed.believing(&candidates[place])?;
            values = believed.at(&candidates)?;
        }
    }
    let next = (!points.is_empty()).then_some((points, expected_gain));
    Ok(Known { sum, optimum, next })
}
