//! How well a model reproduces a record: simulation, one-step prediction, variance accounted for.

use crate::{Channel, IdentificationError, Record};
use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};
use lti::matrices::StateSpace;
use lti::matrices::dense::blocks;

/// Growth or decay of the free response beyond which it says no more of the state at the start (–).
const RANGE: f64 = 1e12;

/// The state at the record's first sample with which the simulated outputs come closest to the measured ones
/// in least squares, each output in its own unit.
///
/// # Errors
/// [`IdentificationError::Sizes`] where the record's channels are not those of the system.
pub fn initial_state(
    system: &StateSpace,
    record: &Record,
) -> Result<Vec<f64>, IdentificationError> {
    check_sizes(system, record)?;
    let order = system.order();
    if order == 0 {
        return Ok(Vec::new());
    }
    let forced = stepped(system, record.inputs(), &vec![0.0; order]);
    let mut free: Vec<Mat<f64>> = vec![system.c.clone()];
    let reference = system.c.norm_max();
    while free.len() < record.n_samples() {
        let next = &free[free.len() - 1] * &system.a;
        let size = next.norm_max();
        if size > RANGE * reference || size * RANGE < reference {
            break;
        }
        free.push(next);
    }
    let outputs = system.outputs();
    let rows = outputs * free.len().max(order);
    let observability = Mat::from_fn(rows, order, |row, state| {
        free.get(row / outputs).map_or(0.0, |block| block[(row % outputs, state)])
    });
    let missing = Mat::from_fn(rows, 1, |row, _| {
        let (k, output) = (row / outputs, row % outputs);
        let measured = record.outputs()[output].samples.get(k);
        measured.map_or(0.0, |measured| measured - forced[output][k])
    });
    let state = observability.qr().solve_lstsq(missing);
    Ok((0..order).map(|index| state[(index, 0)]).collect())
}

/// Outputs of the system for the record's inputs from [`initial_state`] on, in the outputs' units.
///
/// # Errors
/// As [`initial_state`].
pub fn simulated(
    system: &StateSpace,
    record: &Record,
) -> Result<Vec<Vec<f64>>, IdentificationError> {
    let start = initial_state(system, record)?;
    Ok(stepped(system, record.inputs(), &start))
}

/// Outputs predicted from all inputs up to now and all outputs up to the sample before:
/// x(k+1) = (A − K C) x + (B − K D) u + K y, ŷ = C x + D u.
///
/// # Errors
/// As [`initial_state`].
pub fn predicted(
    system: &StateSpace,
    gain: &Mat<f64>,
    record: &Record,
) -> Result<Vec<Vec<f64>>, IdentificationError> {
    check_sizes(system, record)?;
    let driven = &system.b - gain * &system.d;
    let predictor = StateSpace::new(
        &system.a - gain * &system.c,
        blocks(&[&[&driven, gain]]),
        system.c.clone(),
        blocks(&[&[&system.d, &Mat::zeros(system.outputs(), system.outputs())]]),
        system.interval,
    );
    let all = record.inputs().iter().chain(record.outputs()).cloned().collect();
    let joint = Record::new(all, record.outputs().to_vec(), record.interval())?;
    simulated(&predictor, &joint)
}

/// Variance accounted for (%), one figure for each output: 100 (1 − var(y − ŷ)/var y), zero at least.
///
/// # Errors
/// [`IdentificationError::Sizes`] where `modelled` has other channels or samples than the record.
pub fn variance_accounted_for(
    record: &Record,
    modelled: &[Vec<f64>],
) -> Result<Vec<f64>, IdentificationError> {
    same("outputs modelled", modelled.len(), record.outputs().len())?;
    let mut figures = Vec::new();
    for (output, modelled) in record.outputs().iter().zip(modelled) {
        same("samples modelled", modelled.len(), record.n_samples())?;
        let errors: Vec<f64> = output.samples.iter().zip(modelled).map(|(y, m)| y - m).collect();
        let share = variance(&errors) / variance(&output.samples);
        figures.push(100.0 * (1.0 - share).max(0.0));
    }
    Ok(figures)
}

fn variance(samples: &[f64]) -> f64 {
    let n_samples = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n_samples;
    samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n_samples
}

fn same(what: &'static str, found: usize, expected: usize) -> Result<(), IdentificationError> {
    if found == expected {
        return Ok(());
    }
    Err(IdentificationError::Sizes { what, found, expected })
}

fn check_sizes(system: &StateSpace, record: &Record) -> Result<(), IdentificationError> {
    same("inputs of the record", record.inputs().len(), system.inputs())?;
    same("outputs of the record", record.outputs().len(), system.outputs())
}

/// Outputs from a state at the start on.
fn stepped(system: &StateSpace, inputs: &[Channel], start: &[f64]) -> Vec<Vec<f64>> {
    let n_samples = inputs[0].samples.len();
    let mut outputs = vec![Vec::with_capacity(n_samples); system.outputs()];
    let (mut state, mut next) = (start.to_vec(), start.to_vec());
    let dot = |matrix: MatRef<'_, f64>, i: usize, of: &dyn Fn(usize) -> f64| {
        (0..matrix.ncols()).map(|j| matrix[(i, j)] * of(j)).sum::<f64>()
    };
    for k in 0..n_samples {
        let of_state = |j: usize| state[j];
        let of_input = |j: usize| inputs[j].samples[k];
        for (i, output) in outputs.iter_mut().enumerate() {
            let seen = dot(system.c.as_ref(), i, &of_state);
            output.push(seen + dot(system.d.as_ref(), i, &of_input));
        }
        for (i, value) in next.iter_mut().enumerate() {
            let kept = dot(system.a.as_ref(), i, &of_state);
            *value = kept + dot(system.b.as_ref(), i, &of_input);
        }
        std::mem::swap(&mut state, &mut next);
    }
    outputs
}

#[cfg(test)]
mod tests;
