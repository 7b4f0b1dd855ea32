//! A transfer function of one input and one output, and its state space.

use super::{MatrixError, StateSpace};
use faer::Mat;

/// Numerator over denominator, coefficients of the highest power first, of s (rad/s) or z (–).
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    /// Coefficients, the highest power first (–).
    pub numerator: Vec<f64>,
    /// Coefficients, the highest power first (–).
    pub denominator: Vec<f64>,
    /// Time between samples (s); `None` in continuous time.
    pub interval: Option<f64>,
}

impl TransferFunction {
    /// In the controllable form.
    ///
    /// Refused where the numerator's degree is above the denominator's, or where the denominator is zero.
    pub fn state_space(&self) -> Result<StateSpace, MatrixError> {
        let (numerator, denominator) = (trimmed(&self.numerator), trimmed(&self.denominator));
        if numerator.iter().chain(denominator).any(|value| !value.is_finite()) {
            return Err(MatrixError::NotFinite);
        }
        let Some((&leading, lower)) = denominator.split_first() else {
            return Err(MatrixError::Singular("the denominator"));
        };
        let order = lower.len();
        if numerator.len() > order + 1 {
            let what = "the numerator's degree";
            return Err(MatrixError::Size { what, found: numerator.len() - 1, expected: order });
        }
        // b(s)/a(s) = d + (b − d a)/a with a monic; entry j of the first companion row belongs to
        // s^(n−1−j).
        let mut padded = vec![0.0; order + 1 - numerator.len()];
        padded.extend(numerator.iter().map(|value| value / leading));
        let monic: Vec<f64> = lower.iter().map(|value| value / leading).collect();
        let direct = padded[0];
        let a = Mat::from_fn(order, order, |i, j| match i {
            0 => -monic[j],
            _ => f64::from(u8::from(j + 1 == i)),
        });
        let b = Mat::from_fn(order, 1, |i, _| f64::from(u8::from(i == 0)));
        let c = Mat::from_fn(1, order, |_, j| padded[j + 1] - direct * monic[j]);
        Ok(StateSpace::new(a, b, c, Mat::from_fn(1, 1, |_, _| direct), self.interval))
    }
}

/// Without leading zeros.
fn trimmed(coefficients: &[f64]) -> &[f64] {
    let zeros = coefficients.iter().take_while(|value| **value == 0.0).count();
    &coefficients[zeros..]
}
