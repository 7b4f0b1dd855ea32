//! Observations behind a surrogate.

use crate::SurrogateError;

/// Observed values with their inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Observations {
    /// Inputs of all observations, `n × n_dimensions`, those of one together (any unit per dimension).
    pub inputs: Vec<f64>,
    /// Numbers in one input (–).
    pub n_dimensions: usize,
    /// Observed values, `n` (any unit).
    pub values: Vec<f64>,
    /// Known variance of each value, `n` or empty (unit of the values, squared).
    pub variances: Vec<f64>,
}

impl Observations {
    /// Values over one input, without known variances.
    pub fn of_curve(inputs: Vec<f64>, values: Vec<f64>) -> Self {
        Self { inputs, n_dimensions: 1, values, variances: Vec::new() }
    }

    /// The same with a known standard deviation of each value (unit of the values).
    pub fn with_deviations(self, deviations: &[f64]) -> Self {
        Self { variances: deviations.iter().map(|d| d * d).collect(), ..self }
    }

    /// Observations (–).
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Input of observation `index`.
    pub(crate) fn input(&self, index: usize) -> &[f64] {
        &self.inputs[index * self.n_dimensions..(index + 1) * self.n_dimensions]
    }

    /// Known variance of observation `index`; zero where none is known.
    pub(crate) fn variance(&self, index: usize) -> f64 {
        self.variances.get(index).copied().unwrap_or(0.0)
    }

    pub(crate) fn check(&self) -> Result<(), SurrogateError> {
        let n = self.len();
        if n == 0 {
            return Err(SurrogateError::TooFew { n, needed: 1 });
        }
        if self.n_dimensions == 0 || self.inputs.len() != n * self.n_dimensions {
            let needed = n * self.n_dimensions.max(1);
            return Err(SurrogateError::Lengths {
                what: "the inputs",
                found: self.inputs.len(),
                needed,
            });
        }
        if !self.variances.is_empty() && self.variances.len() != n {
            let found = self.variances.len();
            return Err(SurrogateError::Lengths { what: "the variances", found, needed: n });
        }
        let parts = [
            ("the inputs", &self.inputs),
            ("the values", &self.values),
            ("the variances", &self.variances),
        ];
        for (what, numbers) in parts {
            if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
                return Err(SurrogateError::NotFinite { what, index });
            }
        }
        match self.variances.iter().find(|variance| **variance < 0.0) {
            Some(variance) => {
                Err(SurrogateError::NotPositive { what: "a variance", value: *variance })
            }
            None => Ok(()),
        }
    }
}
