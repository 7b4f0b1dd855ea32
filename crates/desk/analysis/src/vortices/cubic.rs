//! A cubic through values over a length, with its interval.

use crate::AnalysisError;
use crate::small::solved;
use crate::statistics::student_97_5;

/// Values over a length, by a polynomial of third order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicFit {
    middle: f64,
    half: f64,
    coefficients: [f64; 4],
    inverse: [[f64; 4]; 4],
    /// Student's quantile times the standard deviation of what is left.
    spread: f64,
    /// Values (–).
    pub n: usize,
}

/// Powers of a place over the half length about the middle.
fn powers(x: f64) -> [f64; 4] {
    [1.0, x, x * x, x * x * x]
}

impl CubicFit {
    /// The polynomial at `place`, and half the width of its interval of 95 %.
    pub fn at(&self, place: f64) -> (f64, f64) {
        let row = powers((place - self.middle) / self.half);
        let value = row.iter().zip(self.coefficients).map(|(a, b)| a * b).sum();
        let share: f64 =
            (0..4).map(|i| (0..4).map(|j| row[i] * self.inverse[i][j] * row[j]).sum::<f64>()).sum();
        (value, self.spread * share.max(0.0).sqrt())
    }
}

/// The polynomial of third order with the least squares through `values` at `places` (m).
///
/// Its interval is by Student's t from what is left. Limits: what is left is taken as independent from value
/// to value. Source: van der Hoek et al. (2024), Fig. 14.
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than five values, or places that do not tell the terms apart;
/// [`AnalysisError::UnequalLengths`].
pub fn cubic_fit(places: &[f64], values: &[f64]) -> Result<CubicFit, AnalysisError> {
    if places.len() != values.len() {
        return Err(AnalysisError::UnequalLengths { first: places.len(), second: values.len() });
    }
    let too_short = AnalysisError::TooShort { n_samples: values.len(), needed: 5 };
    if values.len() < 5 {
        return Err(too_short);
    }
    let least = places.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (middle, half) = (0.5 * (least + greatest), 0.5 * (greatest - least));
    let rows = || places.iter().map(|place| powers((place - middle) / half));
    let mut normal = [[0.0; 4]; 4];
    let mut right = [0.0; 4];
    for (row, value) in rows().zip(values) {
        for i in 0..4 {
            right[i] += row[i] * value;
            for j in 0..4 {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let mut inverse = [[0.0; 4]; 4];
    for (column, of) in inverse.iter_mut().enumerate() {
        let unit = std::array::from_fn(|i| if i == column { 1.0 } else { 0.0 });
        *of = solved(normal, unit).ok_or(too_short.clone())?;
    }
    let coefficients = solved(normal, right).ok_or(too_short)?;
    let left = rows().zip(values).map(|(row, value)| {
        (value - row.iter().zip(coefficients).map(|(a, b)| a * b).sum::<f64>()).powi(2)
    });
    let freedom = values.len() - 4;
    let deviation = (left.sum::<f64>() / freedom as f64).sqrt();
    let spread = student_97_5(freedom) * deviation;
    Ok(CubicFit { middle, half, coefficients, inverse, spread, n: values.len() })
}
