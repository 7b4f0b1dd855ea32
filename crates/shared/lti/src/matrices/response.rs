//! Frequency response, gain at rest, relative gains.

use super::dense::{complex, complex_singular_values, solve_complex};
use super::{MatrixError, StateSpace};
use faer::{Mat, c64};
use num_complex::Complex64;

impl StateSpace {
    /// C (p I − A)⁻¹ B + D at `point` p of the plane of s (rad/s) or z (–): outputs × inputs.
    pub fn at(&self, point: Complex64) -> Result<Mat<c64>, MatrixError> {
        let shifted = Mat::from_fn(self.order(), self.order(), |i, j| {
            let on_diagonal = if i == j { point } else { Complex64::default() };
            on_diagonal - self.a[(i, j)]
        });
        let states = solve_complex(&shifted, &complex(&self.b))
            .ok_or(MatrixError::PoleAt { pole: point })?;
        Ok(complex(&self.c) * states + complex(&self.d))
    }

    /// Response at `frequency` (rad/s): at s = i ω, or z = exp(i ω T); outputs × inputs.
    pub fn response(&self, frequency: f64) -> Result<Mat<c64>, MatrixError> {
        self.at(match self.interval {
            None => Complex64::new(0.0, frequency),
            Some(interval) => Complex64::cis(frequency * interval),
        })
    }

    /// Singular values of the response at `frequency` (rad/s), largest first.
    pub fn singular_values(&self, frequency: f64) -> Result<Vec<f64>, MatrixError> {
        complex_singular_values(&self.response(frequency)?)
    }

    /// Gain at rest: outputs × inputs.
    pub fn gain_at_rest(&self) -> Result<Mat<f64>, MatrixError> {
        let gain = self.response(0.0)?;
        Ok(Mat::from_fn(gain.nrows(), gain.ncols(), |i, j| gain[(i, j)].re))
    }
}

/// Relative gain array G ∘ (G⁻¹)ᵀ of a square gain.
///
/// Source: Skogestad and Postlethwaite, "Multivariable Feedback Control", 2nd ed., 2005, Eq. 3.56.
pub fn relative_gain_array(gain: &Mat<c64>) -> Result<Mat<c64>, MatrixError> {
    let n = gain.nrows();
    if gain.ncols() != n {
        let what = "inputs for a relative gain array";
        return Err(MatrixError::Size { what, found: gain.ncols(), expected: n });
    }
    let inverse = solve_complex(gain, &Mat::identity(n, n))
        .ok_or(MatrixError::Singular("the gain of a relative gain array"))?;
    Ok(Mat::from_fn(n, n, |i, j| gain[(i, j)] * inverse[(j, i)]))
}
