//! Linear quadratic Gaussian control, with and without integral action.

use crate::SynthesisError;
use crate::generalised_plant::GeneralisedPlant;
use crate::h2::{H2, h2};
use faer::Mat;
use lti::matrices::dense::{
    blocks, identity, inverse, square_root_factor, symmetric_eigen, transposed,
};
use lti::matrices::{MatrixError, StateSpace, discrete_riccati, riccati};

/// Share (–) of the largest entry by which a symmetric matrix may differ from its transpose, and of the
/// largest eigenvalue by which the least may be below zero.
const ROUNDING: f64 = 1e-10;

/// Quadratic weights and covariances (spectral densities in continuous time).
#[derive(Clone, Debug)]
pub struct LqgWeights {
    /// Positive semidefinite, of the states; with integral action of the states and of the outputs'
    /// integrated errors after them.
    pub states: Mat<f64>,
    /// Positive definite, of the controls.
    pub controls: Mat<f64>,
    /// Positive semidefinite, of noise on each state.
    pub process_noise: Mat<f64>,
    /// Positive definite, of noise on each measurement.
    pub measurement_noise: Mat<f64>,
}

/// The controller from r − y to u that makes E(xᵀ Q x + uᵀ R u) least.
///
/// Source: Skogestad and Postlethwaite 2005, §9.2 and §9.3.3 (as an H2 problem).
pub fn lqg(plant: &StateSpace, weights: &LqgWeights) -> Result<H2, SynthesisError> {
    let (n, n_u, n_y) = (plant.order(), plant.inputs(), plant.outputs());
    let states = factor("weight of the states", &weights.states, n, false)?;
    let controls = factor("weight of the controls", &weights.controls, n_u, true)?;
    let process = factor("process noise", &weights.process_noise, n, false)?;
    let sensed = factor("measurement noise", &weights.measurement_noise, n_y, true)?;
    let zeros = |rows, columns| Mat::<f64>::zeros(rows, columns);
    let b = blocks(&[&[&process, &zeros(n, n_y), &plant.b]]);
    let c = blocks(&[&[&transposed(&states)], &[&zeros(n_u, n)], &[&(-&plant.c)]]);
    let d = blocks(&[
        &[&zeros(n, n), &zeros(n, n_y), &zeros(n, n_u)],
        &[&zeros(n_u, n), &zeros(n_u, n_y), &transposed(&controls)],
        &[&zeros(n_y, n), &sensed, &(-&plant.d)],
    ]);
    let system = StateSpace::new(plant.a.clone(), b, c, d, plant.interval);
    h2(&GeneralisedPlant::new(system, n_y, n_u)?)
}

/// The controller from r − y to u of a linear quadratic regulator of the states and of the integrated
/// errors, with a Kalman filter for the states: no steady error for a steady reference or disturbance.
///
/// In discrete time the filter predicts: the newest measurement moves the next control. Source: Skogestad
/// and Postlethwaite 2005, §9.2.2; Franklin, Powell and Workman, "Digital Control of Dynamic Systems",
/// 1998, §8.5.
pub fn lqg_with_integral_action(
    plant: &StateSpace,
    weights: &LqgWeights,
) -> Result<StateSpace, SynthesisError> {
    let (n, n_u, n_y) = (plant.order(), plant.inputs(), plant.outputs());
    let (a, b, c, d) = (&plant.a, &plant.b, &plant.c, &plant.d);
    factor("weight of the states", &weights.states, n + n_y, false)?;
    factor("weight of the controls", &weights.controls, n_u, true)?;
    factor("process noise", &weights.process_noise, n, false)?;
    factor("measurement noise", &weights.measurement_noise, n_y, true)?;
    let (step, kept) = plant.interval.map_or((1.0, 0.0), |interval| (interval, 1.0));
    let integrators = kept * identity(n_y);
    let zeros = Mat::<f64>::zeros(n, n_y);
    let wide = StateSpace::new(
        blocks(&[&[a, &zeros], &[&(-step * c), &integrators]]),
        blocks(&[&[b], &[&(-step * d)]]),
        Mat::zeros(0, n + n_y),
        Mat::zeros(0, n_u),
        plant.interval,
    );
    if let Some(mode) = wide.unstabilisable_mode()? {
        return Err(SynthesisError::NotStabilisable { mode });
    }
    if let Some(mode) = plant.undetectable_mode()? {
        return Err(SynthesisError::NotDetectable { mode });
    }
    let gain = regulator(&wide.a, &wide.b, &weights.states, &weights.controls, plant.interval)?;
    let (turned, seen) = (transposed(a), transposed(c));
    let (noise, sensed) = (&weights.process_noise, &weights.measurement_noise);
    let filter = transposed(&regulator(&turned, &seen, noise, sensed, plant.interval)?);
    // x̂ moves by A x̂ + B u + L (−e − C x̂ − D u), the integrals by e, and u = −K (x̂, integrals).
    let driven = b - &filter * d;
    let through = -&blocks(&[&[&driven], &[&Mat::zeros(n_y, n_u)]]) * &gain;
    let free = blocks(&[&[&(a - &filter * c), &zeros], &[&Mat::zeros(n_y, n), &integrators]]);
    let input = blocks(&[&[&(-&filter)], &[&(step * identity(n_y))]]);
    Ok(StateSpace::new(free + through, input, -gain, Mat::zeros(n_u, n_y), plant.interval))
}

/// K of u = −K x.
fn regulator(
    a: &Mat<f64>,
    b: &Mat<f64>,
    q: &Mat<f64>,
    r: &Mat<f64>,
    interval: Option<f64>,
) -> Result<Mat<f64>, MatrixError> {
    let singular = || MatrixError::Singular("the weight of the controls");
    let cheap = inverse(r).ok_or_else(singular)?;
    let squared = b * &cheap * b.transpose();
    if interval.is_none() {
        let x = riccati(a, &squared, q)?;
        return Ok(cheap * b.transpose() * x);
    }
    let x = discrete_riccati(a, &squared, q)?;
    let cost = inverse(&(r + b.transpose() * &x * b)).ok_or_else(singular)?;
    Ok(cost * b.transpose() * x * a)
}

/// A factor L Lᵀ of a weight of `size` rows that is symmetric and positive semidefinite, or `definite`.
fn factor(
    what: &'static str,
    matrix: &Mat<f64>,
    size: usize,
    definite: bool,
) -> Result<Mat<f64>, SynthesisError> {
    let wrong = SynthesisError::NotPositive(what);
    if (matrix.nrows(), matrix.ncols()) != (size, size) {
        return Err(wrong);
    }
    let (values, _) = symmetric_eigen(matrix)?;
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let least = values.first().copied().unwrap_or(1.0);
    let uneven = (matrix - matrix.transpose()).norm_max() > ROUNDING * largest;
    let below = if definite { least <= ROUNDING * largest } else { least < -ROUNDING * largest };
    if uneven || below { Err(wrong) } else { Ok(square_root_factor(matrix)?) }
}
