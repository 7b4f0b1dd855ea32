//! From a state sequence to a model.

use super::riccati::stabilising_gain;
use crate::{IdentificationError, Record, fit};
use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};
use lti::matrices::StateSpace;
use lti::matrices::dense::{blocks, eigenvalues, part};

/// Innovation variance below which data are taken as free of noise, as a share of the output's variance (–).
const NOISELESS: f64 = 1e-14;

/// x(k+1) = A x + B u + K e, y = C x + D u + e, with white innovations e.
#[derive(Clone, Debug, PartialEq)]
pub struct InnovationModel {
    /// From inputs to outputs, in the units of the record.
    pub system: StateSpace,
    /// Kalman gain K, order × outputs, state per unit of output. Zero where the record has no noise.
    pub gain: Mat<f64>,
    /// Covariance of e, outputs × outputs, in the outputs' units squared.
    pub innovation_covariance: Mat<f64>,
    /// Deviations of all states before the order was chosen (–), falling.
    pub singular_values: Vec<f64>,
    /// The state at the record's first sample, of least squares (–).
    pub initial_state: Vec<f64>,
}

/// A state sequence beside the record that it was found in.
pub(super) struct States<'a> {
    /// One row for each sample from `past` to one after the last.
    pub(super) sequence: Mat<f64>,
    /// The record, channels divided by their deviations.
    pub(super) unit: &'a Record,
    pub(super) past: usize,
    pub(super) feedthrough: bool,
}

/// Matrices between channels of unit deviation.
struct Matrices {
    a: Mat<f64>,
    b: Mat<f64>,
    c: Mat<f64>,
    d: Mat<f64>,
    gain: Mat<f64>,
    covariance: Mat<f64>,
}

impl States<'_> {
    /// The model in the units of `record`, whose channels have these `deviations`.
    pub(super) fn realised(
        &self,
        record: &Record,
        deviations: &[f64],
        singular_values: &[f64],
    ) -> Result<InnovationModel, IdentificationError> {
        let Matrices { a, b, c, d, gain, covariance } = self.matrices()?;
        let (of_inputs, of_outputs) = deviations.split_at(self.unit.inputs().len());
        let (order, inputs, outputs) = (a.nrows(), of_inputs.len(), of_outputs.len());
        let scaled = |rows: usize, columns: usize, entry: &dyn Fn(usize, usize) -> f64| {
            Mat::from_fn(rows, columns, entry)
        };
        let system = StateSpace::new(
            a,
            scaled(order, inputs, &|i, j| b[(i, j)] / of_inputs[j]),
            scaled(outputs, order, &|i, j| of_outputs[i] * c[(i, j)]),
            scaled(outputs, inputs, &|i, j| of_outputs[i] * d[(i, j)] / of_inputs[j]),
            Some(record.interval()),
        );
        let initial_state = fit::initial_state(&system, record)?;
        Ok(InnovationModel {
            initial_state,
            system,
            gain: scaled(order, outputs, &|i, j| gain[(i, j)] / of_outputs[j]),
            innovation_covariance: scaled(outputs, outputs, &|i, j| {
                of_outputs[i] * covariance[(i, j)] * of_outputs[j]
            }),
            singular_values: singular_values.to_vec(),
        })
    }

    /// Least squares of outputs on states and inputs, then of next states on states, inputs and innovations.
    fn matrices(&self) -> Result<Matrices, IdentificationError> {
        let (order, rows) = (self.sequence.ncols(), self.sequence.nrows() - 1);
        let (inputs, outputs) = (self.unit.inputs().len(), self.unit.outputs().len());
        let now = part(&self.sequence, 0, 0, rows, order);
        let next = self.sequence.submatrix(1, 0, rows, order);
        let driven = blocks(&[&[&now, &self.channels(self.unit.inputs(), rows)]]);
        let measured = self.channels(self.unit.outputs(), rows);
        let seen = if self.feedthrough { &driven } else { &now };
        let output_map = seen.qr().solve_lstsq(&measured);
        let innovations = &measured - seen * &output_map;
        let products = innovations.transpose() * &innovations;
        let free = (rows - seen.ncols()).max(1) as f64;
        let covariance = Mat::from_fn(outputs, outputs, |i, j| products[(i, j)] / free);
        let noisy = (0..outputs).all(|i| covariance[(i, i)] > NOISELESS);
        let steered = if noisy { blocks(&[&[&driven, &innovations]]) } else { driven.clone() };
        let state_map = steered.qr().solve_lstsq(next);
        let transposed = |map: MatRef<'_, f64>, from: usize, count: usize| {
            map.submatrix(from, 0, count, map.ncols()).transpose().to_owned()
        };
        let a = transposed(state_map.as_ref(), 0, order);
        let b = transposed(state_map.as_ref(), order, inputs);
        let c = transposed(output_map.as_ref(), 0, order);
        let d = if self.feedthrough {
            transposed(output_map.as_ref(), order, inputs)
        } else {
            Mat::zeros(outputs, inputs)
        };
        let gain = if noisy {
            let gain = transposed(state_map.as_ref(), order + inputs, outputs);
            let deterministic = state_map.submatrix(0, 0, order + inputs, order);
            let disturbances = next - &driven * deterministic;
            settled_gain(&a, &c, gain, &disturbances, &innovations)?
        } else {
            Mat::zeros(order, outputs)
        };
        Ok(Matrices { a, b, c, d, gain, covariance })
    }

    /// Samples from the end of the first past on, one column for each channel.
    fn channels(&self, channels: &[crate::Channel], rows: usize) -> Mat<f64> {
        Mat::from_fn(rows, channels.len(), |row, c| channels[c].samples[self.past + row])
    }
}

/// `gain` where the predictor with it is stable, otherwise the Kalman gain that the covariances of
/// disturbances on the states and of innovations give.
fn settled_gain(
    a: &Mat<f64>,
    c: &Mat<f64>,
    gain: Mat<f64>,
    disturbances: &Mat<f64>,
    innovations: &Mat<f64>,
) -> Result<Mat<f64>, IdentificationError> {
    let poles = eigenvalues(&(a - &gain * c))?;
    if poles.iter().all(|pole| pole.norm() < 1.0) {
        return Ok(gain);
    }
    let rows = innovations.nrows() as f64;
    let covariance = |x: &Mat<f64>, y: &Mat<f64>| faer::Scale(1.0 / rows) * (x.transpose() * y);
    stabilising_gain(
        a,
        c,
        &covariance(disturbances, disturbances),
        &covariance(disturbances, innovations),
        &covariance(innovations, innovations),
    )
}
