//! How the filter's states go over from one instant to the next.

use super::filter::Filter;
use super::options::Eddies;
use super::rotor::WINDS;
use super::state_estimate::{MEAN_WIND, N_STATES, PASSING, RATE, StateEstimate, Vector, WAVE};

/// F of a step: the derivatives of the states after it by those before.
pub(super) type Transition = [Vector; N_STATES];

impl Filter {
    /// Derivatives of the states after [`Filter::predict`] over `interval` (s) by those of `estimate` before
    /// it.
    pub(super) fn transition(&self, interval: f64, estimate: &StateEstimate) -> Transition {
        let mut transition = match self.options.rate {
            Some(_) => self.turning(interval, &mut estimate.clone()),
            None => identity(),
        };
        if let Some(eddies) = self.options.eddies {
            let kept = self.kept(eddies, interval, estimate.mean[MEAN_WIND]);
            for index in [PASSING, PASSING + 1] {
                transition[index][index] *= kept;
            }
        }
        transition
    }

    /// Share of eddies that is left after `interval` (s) in a mean `wind` (m/s) (–).
    pub(super) fn kept(&self, eddies: Eddies, interval: f64, wind: f64) -> f64 {
        (-interval * wind.max(WINDS[0]) / (eddies.time_constant * self.diameter)).exp()
    }

    /// Turns the wave ahead for `interval` (s) by the difference of its rate from the nominal one.
    pub(super) fn turn(&self, interval: f64, estimate: &mut StateEstimate) {
        let transition = self.turning(interval, estimate);
        estimate.carry(&transition);
    }

    /// Turns the mean of the wave so; gives the derivatives of the states by those before.
    fn turning(&self, interval: f64, estimate: &mut StateEstimate) -> Transition {
        let form = self.options.form;
        let angle = estimate.mean[RATE] * interval;
        let mut transition = identity();
        form.turn(&mut estimate.mean[WAVE..WAVE + 4], angle);
        if form.is_phase(1) {
            transition[WAVE + 1][RATE] = interval;
            transition[WAVE + 2][RATE] = interval;
        } else {
            let (sine, cosine) = angle.sin_cos();
            for first in [WAVE, WAVE + 2] {
                transition[first][first] = cosine;
                transition[first][first + 1] = -sine;
                transition[first + 1][first] = sine;
                transition[first + 1][first + 1] = cosine;
                transition[first][RATE] = -estimate.mean[first + 1] * interval;
                transition[first + 1][RATE] = estimate.mean[first] * interval;
            }
        }
        transition
    }
}

/// The transition that changes nothing.
pub(super) fn identity() -> Transition {
    let mut transition = [[0.0; N_STATES]; N_STATES];
    for (index, row) in transition.iter_mut().enumerate() {
        row[index] = 1.0;
    }
    transition
}
