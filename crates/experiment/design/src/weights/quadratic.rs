//! Weights of a linear quadratic problem.

use super::{OneOrEach, WeightProblem};
use faer::Mat;
use serde::Deserialize;

/// Weights of outputs and controls, and the noises on inputs and measurements, each for all channels or one
/// by one.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Quadratic {
    outputs: OneOrEach<f64>,
    controls: OneOrEach<f64>,
    /// Of the integrated errors, with integral action.
    integrals: OneOrEach<f64>,
    /// Variances.
    input_noise: OneOrEach<f64>,
    measurement_noise: OneOrEach<f64>,
}

impl Default for Quadratic {
    fn default() -> Self {
        Self {
            outputs: OneOrEach::One(1.0),
            controls: OneOrEach::One(1.0),
            integrals: OneOrEach::One(0.01),
            input_noise: OneOrEach::One(1.0),
            measurement_noise: OneOrEach::One(1.0),
        }
    }
}

/// The weights as diagonal matrices, a row for each channel.
#[derive(Clone, Debug)]
pub(crate) struct Diagonals {
    pub(crate) outputs: Mat<f64>,
    pub(crate) controls: Mat<f64>,
    pub(crate) integrals: Mat<f64>,
    pub(crate) input_noise: Mat<f64>,
    pub(crate) measurement_noise: Mat<f64>,
}

impl Quadratic {
    /// It, on `n_outputs` and `n_inputs` channels.
    ///
    /// # Errors
    /// [`WeightProblem`] naming the key.
    pub(super) fn on(&self, [n_outputs, n_inputs]: [usize; 2]) -> Result<Diagonals, WeightProblem> {
        Ok(Diagonals {
            outputs: diagonal("outputs", &self.outputs, n_outputs, false)?,
            controls: diagonal("controls", &self.controls, n_inputs, true)?,
            integrals: diagonal("integrals", &self.integrals, n_outputs, true)?,
            input_noise: diagonal("input_noise", &self.input_noise, n_inputs, false)?,
            measurement_noise: diagonal(
                "measurement_noise",
                &self.measurement_noise,
                n_outputs,
                true,
            )?,
        })
    }
}

/// `numbers` on `n` channels, which are above zero where they are to be `definite`, and not below otherwise.
fn diagonal(
    key: &'static str,
    numbers: &OneOrEach<f64>,
    n: usize,
    definite: bool,
) -> Result<Mat<f64>, WeightProblem> {
    let numbers = match numbers {
        OneOrEach::One(number) => vec![*number; n],
        OneOrEach::Each(numbers) => numbers.clone(),
    };
    if numbers.len() != n {
        return Err(WeightProblem::Numbers { key, found: numbers.len(), channels: n });
    }
    for value in &numbers {
        if !value.is_finite() {
            return Err(WeightProblem::NotFinite { key });
        }
        if *value < 0.0 || (definite && *value == 0.0) {
            return Err(WeightProblem::OutOfRange { key, value: *value });
        }
    }
    Ok(Mat::from_fn(n, n, |i, j| if i == j { numbers[i] } else { 0.0 }))
}
