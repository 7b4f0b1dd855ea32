//! The estimate that knows the future: the filter forward over a record, then back.
//!
//! Source: Rauch, Tung, Striebel, "Maximum likelihood estimates of linear dynamic systems", AIAA J. 3 (1965)
//! 1445. The filter's own states are smoothed, with phases as angles; what it keeps beside them, the wake of
//! its rotor model and adapted noise, stays as it was on the way forward.

use super::HelixEstimator;
use super::clock::Use;
use super::estimate::{HelixEstimate, Status};
use super::filter::{Filter, FilterState};
use super::state_estimate::{N_STATES, StateEstimate, Vector, dot};
use super::transition::Transition;
use super::tuning::check_record;
use super::wave::Form;
use crate::{EstimationError, Estimator};
use basis::Measurements;
use basis::angle::wrap_to_half_turn;

/// Part of a state's variance that must be left of it, given the states before, to count as one of its own
/// (–).
const LEAST_OWN: f64 = 1e-13;

/// How a step came from the one before.
enum Link {
    /// Not at all: the filter began here.
    Beginning,
    /// Nothing happened.
    Same,
    /// By this transition to this prediction.
    Moved(Box<(Transition, StateEstimate)>),
}

/// What the filter knew at one instant.
struct Step {
    link: Link,
    filtered: FilterState,
    /// Angle of the excitation (rad).
    angle: f64,
    status: Status,
}

/// Estimates of `estimator` on the whole of `record`, one for each sample, which is one each `interval` (s):
/// the past and the future of an instant together tell its state.
///
/// In a linear world with the filter's noise this is the least-squares estimate from all of the record, and
/// its variances are those of its errors. Memory grows with the record, some 4 kB a sample.
///
/// # Errors
/// Those of [`check_record`].
pub fn smooth(
    estimator: &mut HelixEstimator,
    record: &[Measurements],
    interval: f64,
) -> Result<Vec<HelixEstimate>, EstimationError> {
    check_record(record, interval)?;
    let steps: Vec<Step> =
        record.iter().map(|measurements| forward(estimator, measurements)).collect();
    let filter = estimator.filter();
    let mut estimates = Vec::with_capacity(steps.len());
    // The smoothed state after the step, and what links it to the one before.
    let mut after: Option<(&Step, StateEstimate)> = None;
    for step in steps.iter().rev() {
        let smoothed = match &after {
            Some((next, smoothed)) => backward(filter.options.form, step, next, smoothed),
            None => step.filtered.estimate.clone(),
        };
        estimates.push(told(filter, step, &smoothed));
        after = Some((step, smoothed));
    }
    estimates.reverse();
    Ok(estimates)
}

/// Takes in `measurements` and tells how the filter moved.
fn forward(estimator: &mut HelixEstimator, measurements: &Measurements) -> Step {
    let link = match estimator.looks_at(measurements) {
        _ if estimator.status() == Status::Waiting => Link::Beginning,
        Use::Nothing => Link::Same,
        Use::Blind(interval) | Use::Seen(interval, _) => {
            let mut state = estimator.filter_state().clone();
            let transition = estimator.filter().transition(interval, &state.estimate);
            estimator.filter().predict(interval, &mut state);
            Link::Moved(Box::new((transition, state.estimate)))
        }
    };
    estimator.update(measurements);
    let status = estimator.status();
    let mut filtered = estimator.filter_state().clone();
    // Which amplitudes were turned over is told of a correction alone.
    if status == Status::Holding {
        filtered.turned = [false; 2];
    }
    let link = if status == Status::Restarted { Link::Beginning } else { link };
    let angle = estimator.filter().rate * measurements.time;
    Step { link, filtered, angle: if angle.is_finite() { angle } else { 0.0 }, status }
}

/// The smoothed state at `step`, where that at `next` is `smoothed`.
fn backward(form: Form, step: &Step, next: &Step, smoothed: &StateEstimate) -> StateEstimate {
    let filtered = &step.filtered.estimate;
    match &next.link {
        Link::Beginning => filtered.clone(),
        Link::Same => smoothed.clone(),
        Link::Moved(moved) => {
            let (transition, predicted) = moved.as_ref();
            // As the states stood before the correction of that step turned amplitudes over.
            let mut known = smoothed.clone();
            form.turn_over(next.filtered.turned, &mut known);
            back(filtered, transition, predicted, &known, |index| {
                (1..N_STATES).contains(&index) && index <= 4 && form.is_phase(index - 1)
            })
        }
    }
}

/// What `step` tells with the state `smoothed`.
fn told(filter: &Filter, step: &Step, smoothed: &StateEstimate) -> HelixEstimate {
    let mut state = step.filtered.clone();
    state.estimate = smoothed.clone();
    filter.options.form.tidy(&mut state.estimate);
    HelixEstimate::of(filter, &state, step.angle, step.status)
}

/// One step back: the state at an instant where `filtered` is known from the past, which went over by
/// `transition` to `predicted`, and turned out to be `next`. States for which `is_angle` holds differ by
/// angles.
fn back(
    filtered: &StateEstimate,
    transition: &Transition,
    predicted: &StateEstimate,
    next: &StateEstimate,
    is_angle: impl Fn(usize) -> bool,
) -> StateEstimate {
    // Symbols: P filtered covariance, P⁻ predicted, F transition, G = P Fᵀ (P⁻)⁻¹ gain.
    let factor = Factor::of(&predicted.covariance);
    let gain: Vec<Vector> = filtered
        .covariance
        .iter()
        .map(|row| factor.solve(std::array::from_fn(|state| dot(row, &transition[state]))))
        .collect();
    let difference: Vector = std::array::from_fn(|state| {
        let difference = next.mean[state] - predicted.mean[state];
        if is_angle(state) { wrap_to_half_turn(difference) } else { difference }
    });
    let mut smoothed = filtered.clone();
    for (mean, gain) in smoothed.mean.iter_mut().zip(&gain) {
        *mean += dot(gain, &difference);
    }
    // G (next − P⁻).
    let moved: Vec<Vector> = gain
        .iter()
        .map(|gain| {
            std::array::from_fn(|column| {
                let change =
                    |row: usize| next.covariance[row][column] - predicted.covariance[row][column];
                (0..N_STATES).map(|row| gain[row] * change(row)).sum()
            })
        })
        .collect();
    for row in 0..N_STATES {
        for column in 0..=row {
            let added = 0.5 * (dot(&moved[row], &gain[column]) + dot(&moved[column], &gain[row]));
            let mut value = filtered.covariance[row][column] + added;
            if row == column {
                // Rounding may leave a variance of less than nothing.
                value = value.max(0.0);
            }
            smoothed.covariance[row][column] = value;
            smoothed.covariance[column][row] = value;
        }
    }
    smoothed
}

/// Cholesky's factor of a covariance whose states are scaled to variance one; a state without a variance of
/// its own, given those before it, is left out.
struct Factor {
    lower: [Vector; N_STATES],
    /// One over the standard deviation of a state; zero where it is left out.
    scale: Vector,
}

impl Factor {
    fn of(covariance: &[Vector; N_STATES]) -> Self {
        let mut scale: Vector = std::array::from_fn(|state| {
            let variance = covariance[state][state];
            if variance > 0.0 { 1.0 / variance.sqrt() } else { 0.0 }
        });
        let mut lower = [[0.0; N_STATES]; N_STATES];
        for row in 0..N_STATES {
            for column in 0..=row {
                let scaled = covariance[row][column] * scale[row] * scale[column];
                let known: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
                let left = scaled - known;
                if row != column {
                    let pivot = lower[column][column];
                    lower[row][column] = if pivot > 0.0 { left / pivot } else { 0.0 };
                } else if left > LEAST_OWN {
                    lower[row][row] = left.sqrt();
                } else {
                    scale[row] = 0.0;
                    lower[row] = [0.0; N_STATES];
                }
            }
        }
        Self { lower, scale }
    }

    /// x for which the covariance times x is `right`; zero where a state is left out.
    fn solve(&self, right: Vector) -> Vector {
        let Self { lower, scale } = self;
        let mut x: Vector = std::array::from_fn(|state| right[state] * scale[state]);
        for row in 0..N_STATES {
            let known: f64 = (0..row).map(|k| lower[row][k] * x[k]).sum();
            let pivot = lower[row][row];
            x[row] = if pivot > 0.0 { (x[row] - known) / pivot } else { 0.0 };
        }
        for row in (0..N_STATES).rev() {
            let known: f64 = (row + 1..N_STATES).map(|k| lower[k][row] * x[k]).sum();
            let pivot = lower[row][row];
            x[row] = if pivot > 0.0 { (x[row] - known) / pivot } else { 0.0 };
        }
        std::array::from_fn(|state| x[state] * scale[state])
    }
}

#[cfg(test)]
mod tests;
