//! A sine through values over an angle, with its interval.

use crate::AnalysisError;
use crate::small::solved;
use crate::statistics::student_97_5;
use basis::angle::wrap_to_half_turn;
use std::f64::consts::TAU;

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
    /// The largest angle between neighbouring values, in which nothing but the shape of a sine tells (rad).
    pub largest_gap: f64,
    /// Covariance of the mean and of what stands before sin φ and cos φ, times the square of Student's t.
    covariance: [[f64; 3]; 3],
}

impl SineFit {
    /// The sine at `angle` (rad), and half of its 95 % interval there.
    pub fn at(&self, angle: f64) -> [f64; 2] {
        let row = [1.0, angle.sin(), angle.cos()];
        let along = |column: [f64; 3]| (0..3).map(|i| row[i] * column[i]).sum::<f64>();
        let square = along(self.covariance.map(along));
        [self.mean + self.amplitude * (angle + self.phase).sin(), square.max(0.0).sqrt()]
    }
}

/// The sine of one cycle a turn with the least squares through `values` at `angles` (rad), each averaged over
/// a window of `window` (rad) about its angle; 0 for values that share nothing.
///
/// Least squares of mean, sine and cosine. What is left of two values is taken to be correlated as much as
/// their windows overlap; so are its variance, its degrees of freedom (Satterthwaite) and, by Student's t,
/// the intervals, those of amplitude and phase carried over to first order. Limits: chance of other kinds is
/// taken as independent from value to value. Source: van der Hoek et al. (2024), Fig. 15, with the frequency
/// held at the helix's own.
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than four values, or angles that do not tell mean, sine and cosine
/// apart; [`AnalysisError::UnequalLengths`].
pub fn sine_fit(angles: &[f64], values: &[f64], window: f64) -> Result<SineFit, AnalysisError> {
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
    let Some(chance) = Chance::of(angles, [a, b, c], window) else { return Err(too_short) };
    let variance = left / chance.left;
    let [a, b, c] = chance.shares;
    let amplitude = sine.hypot(cosine);
    // Slopes of amplitude and phase along sine and cosine.
    let (s, k) = (sine / amplitude, cosine / amplitude);
    let of_amplitude = s * s * b[1] + 2.0 * s * k * b[2] + k * k * c[2];
    let of_phase = (k * k * b[1] - 2.0 * s * k * b[2] + s * s * c[2]) / amplitude.powi(2);
    let quantile = student_97_5(chance.freedom);
    let half_width = |share: f64| quantile * (variance * share.max(0.0)).sqrt();
    Ok(SineFit {
        mean,
        amplitude,
        phase: cosine.atan2(sine),
        half_widths: [a[0], of_amplitude, of_phase].map(half_width),
        scatter: variance.sqrt(),
        n: values.len(),
        largest_gap: largest_gap(angles),
        covariance: chance.shares.map(|row| row.map(|share| quantile.powi(2) * variance * share)),
    })
}

/// The largest angle between neighbours of `angles`, around the turn (rad).
fn largest_gap(angles: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = angles.iter().map(|angle| angle.rem_euclid(TAU)).collect();
    sorted.sort_by(f64::total_cmp);
    let around = sorted[0] + TAU - sorted[sorted.len() - 1];
    sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f64::max)
}

/// What is left, of a variance of one, carried over to what was fitted.
struct Chance {
    /// Sum of squares that is left (–).
    left: f64,
    /// Degrees of freedom (–).
    freedom: usize,
    /// Covariance of mean, sine and cosine (–).
    shares: [[f64; 3]; 3],
}

impl Chance {
    /// Of values at `angles` whose windows overlap; `inverse` is that of the normal equations. None where
    /// nothing is left: all windows are one.
    fn of(angles: &[f64], inverse: [[f64; 3]; 3], window: f64) -> Option<Self> {
        let rows: Vec<[f64; 3]> =
            angles.iter().map(|angle| [1.0, angle.sin(), angle.cos()]).collect();
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // What each value gives to mean, sine and cosine.
        let gives: Vec<[f64; 3]> =
            rows.iter().map(|row| inverse.each_ref().map(|own| dot(own, row))).collect();
        let shared = |i: usize, j: usize| {
            let apart = wrap_to_half_turn(angles[i] - angles[j]).abs();
            match i == j {
                true => 1.0,
                // Also what stands at one angle shares nothing without a window.
                false if apart >= window => 0.0,
                false => 1.0 - apart / window,
            }
        };
        let n = angles.len();
        let (mut shares, mut moved) = ([[0.0; 3]; 3], vec![[0.0; 3]; n]);
        for i in 0..n {
            for j in 0..n {
                let own = shared(i, j);
                for k in 0..3 {
                    moved[i][k] += own * gives[j][k];
                    (0..3).for_each(|l| shares[k][l] += own * gives[i][k] * gives[j][l]);
                }
            }
        }
        // What is left is M times what chance gave, M = 1 − X (XᵀX)⁻¹ Xᵀ; R is the correlation.
        let of_both = |i: usize, j: usize| shared(i, j) - dot(&rows[i], &moved[j]);
        let left: f64 = (0..n).map(|i| of_both(i, i)).sum();
        let squares: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| of_both(i, j) * of_both(j, i))
            .sum();
        let freedom = (left * left / squares).round();
        (left > 1e-9 && freedom >= 1.0).then_some(Self { left, freedom: freedom as usize, shares })
    }
}
