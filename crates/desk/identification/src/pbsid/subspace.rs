//! From a record to singular values and a state sequence.

use super::Settings;
use super::factor::{Regressors, check_excitation};
use super::realisation::{InnovationModel, States};
use super::regression::{Regression, regression};
use crate::error::within;
use crate::{IdentificationError, Record};
use faer::{Mat, MatRef, Side};
use lti::matrices::MatrixError;

/// Least innovation variance that rows are weighted with, as a share of the output's variance (–): data
/// without noise have none.
const LEAST_INNOVATION: f64 = 1e-8;

/// Least singular value that is told from rounding, as a share of the largest (–).
const LEAST_SINGULAR: f64 = 1e-10;

/// Deviations from zero within which a coefficient is taken for noise (–): one in 1700 that is zero is
/// beyond.
const NOISE: f64 = 3.44;

/// What a record says of a system before an order is chosen.
#[derive(Clone, Debug)]
pub struct Subspace {
    record: Record,
    /// Divided by their deviations.
    unit: Record,
    deviations: Vec<f64>,
    settings: Settings,
    coefficients: Mat<f64>,
    coefficient_deviations: Mat<f64>,
    /// Inverse root of the innovations' covariance, times the product of observability and controllability.
    product: Mat<f64>,
    /// Left singular vectors of `product` on the past.
    left: Mat<f64>,
    singular_values: Vec<f64>,
}

impl Subspace {
    /// Of a record without means and trends ([`Record::detrended`]).
    ///
    /// # Errors
    /// [`IdentificationError::OutOfRange`] for the windows, [`IdentificationError::TooFewSamples`] where the
    /// record has fewer samples than the past needs, [`IdentificationError::Excitation`] where an input
    /// moves in too few ways of its own.
    pub fn new(record: &Record, settings: Settings) -> Result<Self, IdentificationError> {
        let Settings { past, future, feedthrough, regularisation } = settings;
        within("the past window (samples)", past as f64, 2.0, f64::MAX)?;
        within("the future window (samples)", future as f64, 2.0, past as f64)?;
        let (unit, deviations) = record.to_unit_deviation();
        let regressors = Regressors::new(&unit, past, feedthrough);
        let outputs = record.outputs().len();
        let needed = past + regressors.columns() + 2 * outputs;
        record.long_enough(needed, "the past window")?;
        check_excitation(&unit, past)?;
        let factor = regressors.triangular_factor();
        let (columns, rows) = (regressors.columns(), regressors.rows());
        let found = regression(factor.as_ref(), columns, rows, regularisation)?;
        let product = shifted_product(&found, &regressors, past, future)?;
        let past_factor = factor.submatrix(0, 0, regressors.lagged(), regressors.lagged());
        let effect = &product * past_factor.transpose();
        let decomposition = effect
            .thin_svd()
            .map_err(|_| IdentificationError::NotConverged { what: "states' singular values" })?;
        let scale = 1.0 / (rows as f64).sqrt();
        let singular_values = decomposition.S().column_vector().iter().map(|s| s * scale).collect();
        let left = decomposition.U().to_owned();
        Ok(Self {
            record: record.clone(),
            unit,
            deviations,
            settings,
            coefficients: found.coefficients,
            coefficient_deviations: found.deviations,
            product,
            left,
            singular_values,
        })
    }

    /// Deviations of the states in the order of their weight (–): future × outputs values, falling.
    pub fn singular_values(&self) -> &[f64] {
        &self.singular_values
    }

    /// The order, no higher than `most`, after which singular values fall by the largest factor. The last of
    /// them falls to none, and is no order.
    pub fn largest_gap(&self, most: usize) -> usize {
        let floor = LEAST_SINGULAR * self.singular_values[0];
        let fall = |order: usize| {
            let below = self.singular_values.get(order).copied().unwrap_or(floor);
            self.singular_values[order - 1].max(floor) / below.max(floor)
        };
        let last = self.singular_values.len().saturating_sub(1).max(1);
        let orders = 1..=most.clamp(1, last);
        // The lowest of equal ones.
        orders.rev().max_by(|a, b| fall(*a).total_cmp(&fall(*b))).expect("at least one order")
    }

    /// Samples after which input number `input` moves output number `output`: the lag of the first
    /// coefficient of the vector autoregression that its own deviation cannot explain, `None` where there is
    /// none. Holds in a closed loop too. Lag 0 is looked at with feedthrough alone.
    ///
    /// # Panics
    /// Without such an input or output.
    pub fn delay(&self, input: usize, output: usize) -> Option<usize> {
        let inputs = self.record.inputs().len();
        assert!(input < inputs && output < self.record.outputs().len(), "channels of the record");
        let per_lag = inputs + self.record.outputs().len();
        let Settings { past, feedthrough, .. } = self.settings;
        let column = |lag: usize| {
            if lag == 0 { past * per_lag + input } else { (lag - 1) * per_lag + input }
        };
        (usize::from(!feedthrough)..=past).find(|lag| {
            let place = (column(*lag), output);
            self.coefficients[place].abs() > NOISE * self.coefficient_deviations[place]
        })
    }

    /// The model of `order` states.
    ///
    /// # Errors
    /// [`IdentificationError::OutOfRange`] for an order of zero, above the number of singular values, or that
    /// takes in states which are nothing but rounding.
    pub fn model(&self, order: usize) -> Result<InnovationModel, IdentificationError> {
        let floor = LEAST_SINGULAR * self.singular_values[0];
        let most = self.singular_values.iter().filter(|value| **value > floor).count();
        within("the order (–)", order as f64, 1.0, most as f64)?;
        let left = self.left.submatrix(0, 0, self.left.nrows(), order);
        let mut combinations = left.transpose() * &self.product;
        for (row, value) in self.singular_values[..order].iter().enumerate() {
            combinations.row_mut(row).iter_mut().for_each(|entry| *entry /= value.sqrt());
        }
        let Settings { past, feedthrough, .. } = self.settings;
        let sequence =
            Regressors::new(&self.unit, past, feedthrough).combined(combinations.as_ref());
        let states = States { sequence, unit: &self.unit, past, feedthrough };
        states.realised(&self.record, &self.deviations, &self.singular_values)
    }
}

/// L⁻¹ times the coefficients, block row j shifted by j lags; L Lᵀ is the innovations' covariance.
fn shifted_product(
    found: &Regression,
    regressors: &Regressors<'_>,
    past: usize,
    future: usize,
) -> Result<Mat<f64>, IdentificationError> {
    let outputs = found.covariance.nrows();
    let lagged = found.coefficients.submatrix(0, 0, regressors.lagged(), outputs);
    let weighted = weighting(found.covariance.as_ref())? * lagged.transpose();
    let channels = regressors.channels();
    Ok(Mat::from_fn(future * outputs, past * channels, |row, column| {
        let shifted = column + row / outputs * channels;
        if shifted < past * channels { weighted[(row % outputs, shifted)] } else { 0.0 }
    }))
}

/// Inverse of the Cholesky factor of a covariance of outputs of unit deviation.
fn weighting(covariance: MatRef<'_, f64>) -> Result<Mat<f64>, IdentificationError> {
    let outputs = covariance.nrows();
    let lifted = Mat::from_fn(outputs, outputs, |i, j| {
        covariance[(i, j)] + if i == j { LEAST_INNOVATION } else { 0.0 }
    });
    let singular = MatrixError::Singular("the innovations' covariance");
    let factor = lifted.llt(Side::Lower).map_err(|_| singular)?;
    let mut inverse = Mat::<f64>::identity(outputs, outputs);
    factor.L().solve_lower_triangular_in_place(inverse.as_mut());
    Ok(inverse)
}
