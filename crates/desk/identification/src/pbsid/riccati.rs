//! The Kalman gain of a discrete-time system whose disturbances and noise have known covariances.

use crate::IdentificationError;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use lti::matrices::MatrixError;

/// Steps of the recursion before it is given up.
const STEPS: usize = 100_000;

/// Change of the gain at which the recursion ends, as a share of its size (–).
const SETTLED: f64 = 1e-12;

/// Gain K of x̂(k+1) = A x̂ + K (y − C x̂) for x(k+1) = A x + w, y = C x + v with cov w = Q, cov v = R and
/// cov(w, v) = S, by the Riccati recursion from the state's covariance P = Q on:
///
/// K = (A P Cᵀ + S)(C P Cᵀ + R)⁻¹, P ← A P Aᵀ + Q − K (A P Cᵀ + S)ᵀ.
///
/// Source: Anderson and Moore, "Optimal filtering", 1979, chapter 5.
pub(super) fn stabilising_gain(
    a: &Mat<f64>,
    c: &Mat<f64>,
    q: &Mat<f64>,
    s: &Mat<f64>,
    r: &Mat<f64>,
) -> Result<Mat<f64>, IdentificationError> {
    let mut state = q.to_owned();
    let mut gain = Mat::<f64>::zeros(a.nrows(), c.nrows());
    for _ in 0..STEPS {
        let cross = a * &state * c.transpose() + s;
        let seen = c * &state * c.transpose() + r;
        let singular = MatrixError::Singular("the innovations' covariance");
        let factor = seen.llt(Side::Lower).map_err(|_| singular)?;
        let next = factor.solve(cross.transpose()).transpose().to_owned();
        let step = (&next - &gain).norm_max();
        state = a * &state * a.transpose() + q - &next * cross.transpose();
        // Rounding would turn it askew.
        state = faer::Scale(0.5) * (&state + state.transpose());
        gain = next;
        if step <= SETTLED * gain.norm_max() {
            return Ok(gain);
        }
    }
    Err(IdentificationError::NotConverged { what: "Riccati recursion" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First order with a = c = 1: P² = P q + q r at rest, K = P/(P + r).
    #[test]
    fn a_random_walk_has_its_closed_form() {
        let of = |value: f64| Mat::from_fn(1, 1, |_, _| value);
        let (q, r): (f64, f64) = (0.3, 2.0);
        let p = 0.5 * (q + (q * q + 4.0 * q * r).sqrt());
        let one = of(1.0);
        let found = stabilising_gain(&one, &one, &of(q), &of(0.0), &of(r));
        assert!((found.expect("converges")[(0, 0)] - p / (p + r)).abs() < 1e-10);
    }

    /// Of a zero of the noise outside the unit circle the gain takes the mirror image: y = (1 + b/z) e with
    /// b = 2 has the spectrum of b = 1/2 with four times the variance.
    #[test]
    fn noise_is_inverted_stably() {
        let of = |value: f64| Mat::from_fn(1, 1, |_, _| value);
        let found = stabilising_gain(&of(0.0), &of(1.0), &of(4.0), &of(2.0), &of(1.0));
        assert!((found.expect("converges")[(0, 0)] - 0.5).abs() < 1e-9);
    }
}
