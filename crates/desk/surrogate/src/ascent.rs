//! The highest place of a smooth function inside bounds: limited-memory BFGS over the logit of each
//! parameter's place between its bounds, so that no step leaves them.

use argmin::core::{CostFunction, Error, Executor, Gradient};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use faer::Mat;
use std::cell::RefCell;

/// A function of parameters with its derivatives; none where it cannot be worked out.
pub(crate) trait Objective {
    fn value_and_slopes(&self, parameters: &[f64]) -> Option<(f64, Vec<f64>)>;
}

/// Bounds of each parameter.
pub(crate) type Bounds = [[f64; 2]];

/// When a search ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    /// Steps at most (–).
    pub(crate) n_steps: u64,
    /// Length of the gradient in the search's own coordinates that is small enough.
    pub(crate) slope: f64,
}

/// Parameters at `place`, and how fast each moves with it.
pub(crate) fn inside(place: &[f64], bounds: &Bounds) -> (Vec<f64>, Vec<f64>) {
    let of_one = |(place, [low, high]): (&f64, &[f64; 2])| {
        let share = 1.0 / (1.0 + (-place).exp());
        (low + share * (high - low), (high - low) * share * (1.0 - share))
    };
    place.iter().zip(bounds).map(of_one).unzip()
}

/// The place at which a parameter is `share` of the way between its bounds.
pub(crate) fn place_of(share: f64) -> f64 {
    let share = share.clamp(1e-6, 1.0 - 1e-6);
    (share / (1.0 - share)).ln()
}

struct Search<'a, O> {
    objective: &'a O,
    bounds: &'a Bounds,
    start: &'a [f64],
    /// Coordinates of the search to those of the places.
    turn: Option<&'a Mat<f64>>,
    latest: RefCell<Option<Latest>>,
    best: RefCell<Option<(f64, Vec<f64>)>>,
}

struct Latest {
    at: Vec<f64>,
    cost: f64,
    gradient: Vec<f64>,
}

/// From the place `start`: the highest value found, and its place. With `turn` C the search goes over z, with
/// places start + C z.
pub(crate) fn climb<O: Objective>(
    objective: &O,
    bounds: &Bounds,
    start: &[f64],
    turn: Option<&Mat<f64>>,
    end: End,
) -> Option<(f64, Vec<f64>)> {
    let (latest, best) = (RefCell::new(None), RefCell::new(None));
    let search = Search { objective, bounds, start, turn, latest, best };
    // A search that stops early has still recorded its best place.
    if let Ok(solver) = LBFGS::new(MoreThuenteLineSearch::new(), 7).with_tolerance_grad(end.slope) {
        let _ = Executor::new(&search, solver)
            .configure(|state| state.param(vec![0.0; start.len()]).max_iters(end.n_steps))
            .timer(false)
            .run();
    }
    search.best.into_inner()
}

impl<O: Objective> Search<'_, O> {
    fn at(&self, z: &[f64]) -> (f64, Vec<f64>) {
        if let Some(latest) = &*self.latest.borrow()
            && latest.at == z
        {
            return (latest.cost, latest.gradient.clone());
        }
        let n = z.len();
        let moved = |row: usize| match self.turn {
            Some(turn) => (0..n).map(|column| turn[(row, column)] * z[column]).sum(),
            None => z[row],
        };
        let place: Vec<f64> = (0..n).map(|row| self.start[row] + moved(row)).collect();
        let (parameters, speeds) = inside(&place, self.bounds);
        // Where there is no value the line search turns back.
        let (mut cost, mut gradient) = (f64::MAX.sqrt(), vec![0.0; n]);
        if let Some((value, slopes)) = self.objective.value_and_slopes(&parameters) {
            cost = -value;
            let along: Vec<f64> =
                slopes.iter().zip(&speeds).map(|(slope, speed)| -slope * speed).collect();
            gradient = match self.turn {
                Some(turn) => (0..n)
                    .map(|column| (0..n).map(|row| turn[(row, column)] * along[row]).sum())
                    .collect(),
                None => along,
            };
            let mut best = self.best.borrow_mut();
            if best.as_ref().is_none_or(|(highest, _)| value > *highest) {
                *best = Some((value, place));
            }
        }
        let latest = Latest { at: z.to_vec(), cost, gradient: gradient.clone() };
        *self.latest.borrow_mut() = Some(latest);
        (cost, gradient)
    }
}

impl<O: Objective> CostFunction for &Search<'_, O> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, z: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.at(z).0)
    }
}

impl<O: Objective> Gradient for &Search<'_, O> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, z: &Vec<f64>) -> Result<Vec<f64>, Error> {
        Ok(self.at(z).1)
    }
}
