//! The central H-infinity controller at a given bound.

use crate::generalised_plant::Parts;
use crate::normalised::Normalised;
use faer::Mat;
use lti::matrices::dense::{
    blocks, eigenvalues, identity, inverse, part, singular_decomposition, symmetric,
    symmetric_eigen, transposed,
};
use lti::matrices::{MatrixError, StateSpace, riccati, riccati_residual};

/// Share (–) of a solution's largest eigenvalue below zero that is rounding.
const ROUNDING: f64 = 1e-8;

/// Share (–) of the size that a solution would have by its equation's terms, below which it is zero.
const NOTHING: f64 = 1e-11;

/// Solutions of both Riccati equations at a bound that they allow.
pub(crate) struct Solutions {
    pub(crate) bound: f64,
    x: Mat<f64>,
    y: Mat<f64>,
    /// −R⁻¹ (D1•ᵀ C1 + Bᵀ X): (disturbances, controls) × order.
    feedback: Mat<f64>,
    /// −(B1 D•1ᵀ + Y Cᵀ) R̃⁻¹: order × (errors, measurements).
    injection: Mat<f64>,
    /// Relative residuals of both equations (–).
    pub(crate) residuals: [f64; 2],
}

/// One equation's solution, the gain that it gives, its relative residual (–).
struct Half {
    x: Mat<f64>,
    gain: Mat<f64>,
    residual: f64,
}

impl Solutions {
    /// At `bound` γ; none where the bound is too low.
    ///
    /// Source: Glover and Doyle, Systems & Control Letters 11, 1988; Zhou, Doyle and Glover 1996, Theorem
    /// 17.1.
    pub(crate) fn at(plant: &Normalised, bound: f64) -> Option<Self> {
        if least_bound(&plant.parts).ok()? >= bound {
            return None;
        }
        let Parts { b1, b2, c1, c2, d11, d12, d21, .. } = &plant.parts;
        let state = half(&plant.a, [b1, b2], c1, [d11, d12], bound)?;
        let dual = half(
            &transposed(&plant.a),
            [&transposed(c1), &transposed(c2)],
            &transposed(b1),
            [&transposed(d11), &transposed(d21)],
            bound,
        )?;
        let coupled = eigenvalues(&(&state.x * &dual.x)).ok()?;
        let radius = coupled.iter().map(|value| value.norm()).fold(0.0, f64::max);
        (radius < bound * bound).then(|| Self {
            bound,
            x: state.x,
            y: dual.x,
            feedback: state.gain,
            injection: transposed(&dual.gain),
            residuals: [state.residual, dual.residual],
        })
    }

    /// The central controller of the normalised plant.
    ///
    /// Source: Zhou, Doyle and Glover 1996, Theorem 17.1 (Q = 0).
    pub(crate) fn controller(&self, plant: &Normalised) -> Result<StateSpace, MatrixError> {
        let n = plant.a.nrows();
        let Parts { b1, b2, c2, d11, d12, d21, .. } = &plant.parts;
        let (n_w, n_z) = (d11.ncols(), d11.nrows());
        let (n_u, n_y) = (d12.ncols(), d21.nrows());
        let squared = self.bound * self.bound;
        let direct = direct(d11, n_u, n_y, squared)?;
        // Rows of the feedback: disturbances that no measurement shows, those that one shows, controls.
        let f12 = part(&self.feedback, n_w - n_y, 0, n_y, n);
        let f2 = part(&self.feedback, n_w, 0, n_u, n);
        let l12 = part(&self.injection, 0, n_z - n_u, n, n_u);
        let l2 = part(&self.injection, 0, n_z, n, n_y);
        let coupling = identity(n) - (1.0 / squared) * (&self.y * &self.x);
        let coupling =
            inverse(&coupling).ok_or(MatrixError::Singular("I less Y X over the squared bound"))?;
        // D̂12 and D̂21 enter as B̂2 D̂12⁻¹ = Z (B2 + L12) and D̂21⁻¹ Ĉ2 = −(C2 + F12) alone.
        let b_hat = -(&coupling * &l2) + &coupling * (b2 + &l12) * &direct;
        let c_shown = c2 + &f12;
        let c_hat = &f2 - &direct * &c_shown;
        let b = blocks(&[&[b1, b2]]);
        let a_hat = &plant.a + &b * &self.feedback - &b_hat * &c_shown;
        Ok(StateSpace::new(a_hat, b_hat, c_hat, direct, None))
    }
}

/// The controller's gain without delay: −D1121 D1111ᵀ (γ² I − D1111 D1111ᵀ)⁻¹ D1112 − D1122.
fn direct(d11: &Mat<f64>, n_u: usize, n_y: usize, squared: f64) -> Result<Mat<f64>, MatrixError> {
    let (rows, columns) = (d11.nrows() - n_u, d11.ncols() - n_y);
    let first = part(d11, 0, 0, rows, columns);
    let right = part(d11, 0, columns, rows, n_y);
    let below = part(d11, rows, 0, n_u, columns);
    let corner = part(d11, rows, columns, n_u, n_y);
    let inner = squared * identity(rows) - &first * first.transpose();
    let inner = inverse(&inner).ok_or(MatrixError::Singular("the squared bound less D1111"))?;
    Ok(-(below * first.transpose() * inner * right) - corner)
}

/// The bound below which no controller's gain at infinite frequency lets the closed loop's be.
pub(crate) fn least_bound(parts: &Parts) -> Result<f64, MatrixError> {
    let Parts { d11, d12, d21, .. } = parts;
    let (rows, columns) = (d11.nrows() - d12.ncols(), d11.ncols() - d21.nrows());
    let largest = |matrix: &Mat<f64>| {
        let (_, values, _) = singular_decomposition(matrix)?;
        Ok(values.first().copied().unwrap_or(0.0))
    };
    let above = largest(&part(d11, 0, 0, rows, d11.ncols()))?;
    Ok(above.max(largest(&part(d11, 0, 0, d11.nrows(), columns))?))
}

/// The Riccati equation of the state feedback; that of the injection is the same of transposed matrices.
fn half(
    a: &Mat<f64>,
    [b1, b2]: [&Mat<f64>; 2],
    c1: &Mat<f64>,
    [d11, d12]: [&Mat<f64>; 2],
    bound: f64,
) -> Option<Half> {
    let (b, d) = (blocks(&[&[b1, b2]]), blocks(&[&[d11, d12]]));
    let mut weight = d.transpose() * &d;
    for index in 0..b1.ncols() {
        weight[(index, index)] -= bound * bound;
    }
    let weight = inverse(&symmetric(&weight))?;
    let cross = d.transpose() * c1;
    let shifted = a - &b * &weight * &cross;
    let squared = symmetric(&(&b * &weight * b.transpose()));
    let cost = c1.transpose() * c1;
    let mut constant = symmetric(&(&cost - cross.transpose() * &weight * &cross));
    // As where the disturbances reach measurements alone: two equal terms leave rounding.
    if constant.norm_l2() <= NOTHING * cost.norm_l2() {
        constant = Mat::zeros(a.nrows(), a.nrows());
    }
    let x = riccati(&shifted, &squared, &constant).ok()?;
    let (values, _) = symmetric_eigen(&x).ok()?;
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    // A solution that is zero but for rounding has no sign.
    let noise = c1.norm_l2().powi(2) / shifted.norm_l2() + shifted.norm_l2() / squared.norm_l2();
    let noise = if noise.is_finite() { NOTHING * noise } else { 0.0 };
    if values.first().is_some_and(|least| *least < -(ROUNDING * largest + noise)) {
        return None;
    }
    let gain = -(&weight * (cross + b.transpose() * &x));
    let residual = riccati_residual(&shifted, &squared, &constant, &x);
    Some(Half { x, gain, residual })
}
