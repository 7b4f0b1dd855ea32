//! A sine through values over an angle, with its interval.

use crate::AnalysisError;
use crate::small::solved;
use crate::statistics::student_97_5;

/// Values over an angle φ: `mean` + `amplitude` sin(φ + `phase`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SineFit {
    /// Mean, in the unit of the values.
    pub mean: f64,
    /// Amplitude, in the unit of the values.
    pub amplitude: f64,
    /// Phase (rad, (−π, π]).
    pub phase: f64,
    /// Half widths of the 95 % intervals of the three, in their units.
    pub half_widths: [f64; 3],
    /// Standard deviation of what is left, in the unit of the values.
    pub scatter: f64,
    /// Values (–).
    pub n: usize,
}

/// The sine of one cycle a turn with the least squares through `values` at `angles` (rad).
///
/// Least squares of mean, sine and cosine; intervals by Student's t from what is left, those of amplitude and
/// phase carried over to first order. Limits: what is left is taken as independent from value to value.
/// Source: van der Hoek et al. (2024), Fig. 15, with the frequency held at the helix's own.
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than four values, or angles that do not tell mean, sine and cosine
/// apart; [`AnalysisError::UnequalLengths`].
pub fn sine_fit(angles: &[f64], values: &[f64]) -> Result<SineFit, AnalysisError> {
    if angles.len() != values.len() {
        return Err(AnalysisError::UnequalLengths { first: angles.len(), second: values.len() });
    }
    let too_short = AnalysisError::TooShort { n_samples: values.len(), needed: 4 };
    if values.len() < 4 {
        return Err(too_short);
    }
    let rows = || angles.iter().map(|angle| [1.0, angle.sin(), angle.cos()]);
    let mut normal = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for (row, value) in rows().zip(values) {
        for i in 0..3 {
            right[i] += row[i] * value;
            for j in 0..3 {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let unit = |column: usize| std::array::from_fn(|i| if i == column { 1.0 } else { 0.0 });
    let found = solved(normal, right);
    let inverse = [solved(normal, unit(0)), solved(normal, unit(1)), solved(normal, unit(2))];
    let (Some([mean, sine, cosine]), [Some(a), Some(b), Some(c)]) = (found, inverse) else {
        return Err(too_short);
    };
    let left: f64 = rows()
        .zip(values)
        .map(|(row, value)| (value - mean - sine * row[1] - cosine * row[2]).powi(2))
        .sum();
    let freedom = values.len() - 3;
    let variance = left / freedom as f64;
    let amplitude = sine.hypot(cosine);
    // Slopes of amplitude and phase along sine and cosine.
    let (s, k) = (sine / amplitude, cosine / amplitude);
    let of_amplitude = s * s * b[1] + 2.0 * s * k * b[2] + k * k * c[2];
    let of_phase = (k * k * b[1] - 2.0 * s * k * b[2] + s * s * c[2]) / amplitude.powi(2);
    let quantile = student_97_5(freedom);
    let half_width = |share: f64| quantile * (variance * share.max(0.0)).sqrt();
    Ok(SineFit {
        mean,
        amplitude,
        phase: cosine.atan2(sine),
        half_widths: [a[0], of_amplitude, of_phase].map(half_width),
        scatter: variance.sqrt(),
        n: values.len(),
    })
}
