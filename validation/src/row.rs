//! One line of a validation: what was measured beside what was expected.

use serde::Serialize;

/// One measured figure with its expectation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What was measured, with its conditions.
    pub what: String,
    /// Measured value, in `unit`.
    pub measured: f64,
    /// Expected value from an independent source, in `unit`.
    pub expected: f64,
    /// Largest accepted distance of the two, in `unit`.
    pub tolerance: f64,
    /// Unit of all three.
    pub unit: &'static str,
}

impl Row {
    /// Whether measured and expected agree; never for a value that is not a number.
    pub fn passes(&self) -> bool {
        (self.measured - self.expected).abs() <= self.tolerance
    }
}
