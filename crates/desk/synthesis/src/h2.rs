//! H2 synthesis in continuous and discrete time.

use crate::SynthesisError;
use crate::assumptions::check;
use crate::generalised_plant::{GeneralisedPlant, Parts};
use crate::normalised::Normalised;
use faer::Mat;
use lti::matrices::dense::{identity, inverse, symmetric, transposed};
use lti::matrices::{
    MatrixError, StateSpace, discrete_riccati, discrete_riccati_residual, riccati, riccati_residual,
};

/// The controller of the least H2 norm.
#[derive(Clone, Debug)]
pub struct H2 {
    /// From measurements to controls, as many states as the generalised plant.
    pub controller: StateSpace,
    /// H2 norm of the closed loop (–).
    pub norm: f64,
    /// Relative residuals (–) of both Riccati equations.
    pub riccati_residuals: [f64; 2],
}

/// The controller that makes the H2 norm of the closed loop least; in discrete time it uses the newest
/// measurement.
///
/// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, Theorem 14.7 and §21.7; Chen and
/// Francis, "Optimal Sampled-Data Control Systems", 1995, §6.6.
pub fn h2(plant: &GeneralisedPlant) -> Result<H2, SynthesisError> {
    check(plant)?;
    let normalised = Normalised::new(plant)?;
    let (controller, riccati_residuals) = match plant.system.interval {
        None if normalised.parts.d11.norm_max() > 0.0 => {
            return Err(SynthesisError::DirectDisturbance);
        }
        None => continuous(&normalised)?,
        Some(interval) => discrete(&normalised, interval)?,
    };
    let controller = normalised.restored(&controller)?;
    let norm = plant.closed(&controller)?.h2_norm()?;
    Ok(H2 { controller, norm, riccati_residuals })
}

/// The controller of the normalised plant in continuous time, and the residuals.
fn continuous(plant: &Normalised) -> Result<(StateSpace, [f64; 2]), MatrixError> {
    let Parts { b1, b2, c1, c2, d12, d21, .. } = &plant.parts;
    let regulator = Equation::new(&plant.a, b2, c1, d12);
    let filter =
        Equation::new(&transposed(&plant.a), &transposed(c2), &transposed(b1), &transposed(d21));
    let x = riccati(&regulator.a, &regulator.squared, &regulator.constant)?;
    let y = riccati(&filter.a, &filter.squared, &filter.constant)?;
    let residuals = [(&regulator, &x), (&filter, &y)]
        .map(|(of, x)| riccati_residual(&of.a, &of.squared, &of.constant, x));
    let feedback = -(b2.transpose() * &x + d12.transpose() * c1);
    let injection = -(&y * c2.transpose() + b1 * d21.transpose());
    let a = &plant.a + b2 * &feedback + &injection * c2;
    let direct = Mat::zeros(b2.ncols(), c2.nrows());
    Ok((StateSpace::new(a, -injection, feedback, direct, None), residuals))
}

/// The controller of the normalised plant in discrete time, and the residuals.
fn discrete(plant: &Normalised, interval: f64) -> Result<(StateSpace, [f64; 2]), MatrixError> {
    let Parts { b1, b2, c1, c2, d11, d12, d21, .. } = &plant.parts;
    let regulator = Equation::new(&plant.a, b2, c1, d12);
    let filter =
        Equation::new(&transposed(&plant.a), &transposed(c2), &transposed(b1), &transposed(d21));
    let x = discrete_riccati(&regulator.a, &regulator.squared, &regulator.constant)?;
    let y = discrete_riccati(&filter.a, &filter.squared, &filter.constant)?;
    let residuals = [(&regulator, &x), (&filter, &y)]
        .map(|(of, x)| discrete_riccati_residual(&of.a, &of.squared, &of.constant, x));
    let cost = inverse(&(identity(b2.ncols()) + b2.transpose() * &x * b2))
        .ok_or(MatrixError::Singular("the cost of a control"))?;
    let noise = inverse(&(identity(c2.nrows()) + c2 * &y * c2.transpose()))
        .ok_or(MatrixError::Singular("the variance of a measurement"))?;
    let moved = b2.transpose() * &x;
    let of_state = -(&cost * (&moved * &plant.a + d12.transpose() * c1));
    let of_disturbance = -(&cost * (&moved * b1 + d12.transpose() * d11));
    let injection = -((&plant.a * &y * c2.transpose() + b1 * d21.transpose()) * &noise);
    let direct = (&of_state * &y * c2.transpose() + &of_disturbance * d21.transpose()) * &noise;
    let c = &of_state - &direct * c2;
    let a = &plant.a + b2 * &c + &injection * c2;
    let b = b2 * &direct - &injection;
    Ok((StateSpace::new(a, b, c, direct, Some(interval)), residuals))
}

/// The regulator's equation with D12ᵀ D12 = I, without its cross term.
struct Equation {
    a: Mat<f64>,
    squared: Mat<f64>,
    constant: Mat<f64>,
}

impl Equation {
    fn new(a: &Mat<f64>, b2: &Mat<f64>, c1: &Mat<f64>, d12: &Mat<f64>) -> Self {
        let cross = d12.transpose() * c1;
        Self {
            a: a - b2 * &cross,
            squared: b2 * b2.transpose(),
            constant: symmetric(&(c1.transpose() * c1 - cross.transpose() * &cross)),
        }
    }
}
