//! Lyapunov's equations, and the Gramians that solve them.

use super::dense::{identity, inverse, is_finite, symmetric, transposed};
use super::{MatrixError, StateSpace};
use faer::Mat;

/// Steps of an iteration that converges quadratically.
const MOST_STEPS: usize = 80;
/// Relative change (–) after which one more step is exact.
const LAST_CHANGE: f64 = 1e-9;
/// Relative residual (–) at which a solution is improved no more.
const SMALL_RESIDUAL: f64 = 1e-14;

/// X of A X + X Aᵀ + Q = 0 with a stable A and a symmetric Q, by Newton's iteration for the matrix sign
/// function, then refined.
///
/// Source: Roberts, "Linear model reduction and solution of the algebraic Riccati equation by use of the
/// sign function", Int. J. Control 32, 1980.
pub fn lyapunov(a: &Mat<f64>, q: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let mut x = by_sign(a, q)?;
    let mut before = f64::INFINITY;
    for _ in 0..3 {
        let ax = a * &x;
        let residual = symmetric(&(&ax + ax.transpose() + q));
        let size = residual.norm_l2() / (2.0 * ax.norm_l2() + q.norm_l2()).max(f64::MIN_POSITIVE);
        if size < SMALL_RESIDUAL || size > 0.5 * before {
            break;
        }
        before = size;
        x += by_sign(a, &residual)?;
    }
    Ok(x)
}

/// One pass of the sign iteration on (A, Q; 0, −Aᵀ).
fn by_sign(a: &Mat<f64>, q: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let n = a.nrows();
    let (mut e, mut q) = (a.clone(), symmetric(q));
    let mut scale_on = true;
    for _ in 0..MOST_STEPS {
        let turned = inverse(&e).ok_or_else(|| unstable(a))?;
        let scale = if scale_on { (turned.norm_l2() / e.norm_l2()).sqrt() } else { 1.0 };
        let next = 0.5 * (scale * &e + (1.0 / scale) * &turned);
        let carried = &turned * &q * turned.transpose();
        q = symmetric(&(0.5 * (scale * &q + (1.0 / scale) * &carried)));
        let change = (&next - &e).norm_l2() / next.norm_l2().max(f64::MIN_POSITIVE);
        e = next;
        scale_on = scale_on && change > 1e-2;
        if change < LAST_CHANGE {
            let away = (&e + identity(n)).norm_l2();
            return if away < 1e-3 { Ok(0.5 * q) } else { Err(unstable(a)) };
        }
    }
    if n == 0 { Ok(q) } else { Err(unstable(a)) }
}

/// The error that names the pole.
fn unstable(a: &Mat<f64>) -> MatrixError {
    match super::dense::eigenvalues(a) {
        Ok(values) => values
            .into_iter()
            .max_by(|a, b| a.re.total_cmp(&b.re))
            .filter(|pole| pole.re >= 0.0)
            .map_or(MatrixError::NotConverged("the Lyapunov equation"), |pole| {
                MatrixError::Unstable { pole }
            }),
        Err(error) => error,
    }
}

/// X of A X Aᵀ − X + Q = 0 with a stable A and a symmetric Q, by doubling.
///
/// Source: Smith, "Matrix equation XA + BX = C", SIAM J. Appl. Math. 16, 1968.
pub fn discrete_lyapunov(a: &Mat<f64>, q: &Mat<f64>) -> Result<Mat<f64>, MatrixError> {
    let (mut power, mut x) = (a.clone(), symmetric(q));
    for _ in 0..MOST_STEPS {
        let more = &power * &x * power.transpose();
        let (size, change) = (x.norm_l2(), more.norm_l2());
        x = symmetric(&(&x + &more));
        if change <= f64::EPSILON * 0.01 * size && power.norm_l2() < 1.0 || size == 0.0 {
            return Ok(x);
        }
        power = &power * &power;
        if !is_finite(&power) || !is_finite(&x) {
            break;
        }
    }
    let system = StateSpace { interval: Some(1.0), ..StateSpace::gain(Mat::zeros(0, 0), None) };
    let poles = super::dense::eigenvalues(a)?;
    let pole = poles.into_iter().max_by(|a, b| system.growth(*a).total_cmp(&system.growth(*b)));
    pole.map_or(Ok(x), |pole| Err(MatrixError::Unstable { pole }))
}

impl StateSpace {
    /// Controllability Gramian of a stable system: order × order.
    pub fn controllability_gramian(&self) -> Result<Mat<f64>, MatrixError> {
        self.stable_or_error()?;
        let excitation = &self.b * self.b.transpose();
        match self.interval {
            None => lyapunov(&self.a, &excitation),
            Some(_) => discrete_lyapunov(&self.a, &excitation),
        }
    }

    /// Observability Gramian of a stable system: order × order.
    pub fn observability_gramian(&self) -> Result<Mat<f64>, MatrixError> {
        self.stable_or_error()?;
        let (turned, seen) = (transposed(&self.a), self.c.transpose() * &self.c);
        match self.interval {
            None => lyapunov(&turned, &seen),
            Some(_) => discrete_lyapunov(&turned, &seen),
        }
    }
}
