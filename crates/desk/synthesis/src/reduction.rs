//! Controllers of lower order.

use crate::SynthesisError;
use crate::generalised_plant::GeneralisedPlant;
use faer::Mat;
use lti::matrices::dense::{
    blocks, identity, inverse, part, square_root_factor, symmetric, transposed,
};
use lti::matrices::{
    MatrixError, StateSpace, balanced_truncation, discrete_riccati, parallel, riccati,
};

/// A controller of lower order, and what it costs.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// Of the lower order.
    pub controller: StateSpace,
    /// H-infinity norm of the closed loop with the whole controller (–).
    pub norm_before: f64,
    /// H-infinity norm of the closed loop with the controller of lower order (–).
    pub norm_after: f64,
    /// H-infinity norm of the difference of both controllers; none where one is not stable (–).
    pub difference: Option<f64>,
    /// Hankel singular values of the whole controller, or of its coprime factors where it is not stable;
    /// largest first (–).
    pub hankel_singular_values: Vec<f64>,
}

/// Balanced truncation of a `controller` to `order`; of its normalised left coprime factors where it is not
/// stable. An error where the loop with it is not stable.
///
/// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, §7.1 and §19.3 (coprime factors:
/// Meyer, "Fractional balanced reduction", IEEE Trans. Automatic Control 35, 1990).
pub fn reduced_to_order(
    plant: &GeneralisedPlant,
    controller: &StateSpace,
    order: usize,
) -> Result<Reduced, SynthesisError> {
    let norm_before = plant.closed(controller)?.h_infinity_norm()?.gain;
    with_order(plant, controller, order, norm_before)
}

/// The controller of the lowest order whose closed loop is stable and has a norm at most `tolerance` (–,
/// share) above that of the whole controller.
pub fn reduced_to_tolerance(
    plant: &GeneralisedPlant,
    controller: &StateSpace,
    tolerance: f64,
) -> Result<Reduced, SynthesisError> {
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        let what = "the share of the norm that a reduction may cost";
        let needed = "it is not below zero and finite";
        return Err(SynthesisError::OutOfRange { what, value: tolerance, needed });
    }
    let norm_before = plant.closed(controller)?.h_infinity_norm()?.gain;
    for order in 0..controller.order() {
        // An order that leaves the loop unstable is passed over; other errors come back with the whole
        // order.
        match with_order(plant, controller, order, norm_before) {
            Ok(reduced) if reduced.norm_after <= norm_before * (1.0 + tolerance) => {
                return Ok(reduced);
            }
            _ => {}
        }
    }
    with_order(plant, controller, controller.order(), norm_before)
}

fn with_order(
    plant: &GeneralisedPlant,
    controller: &StateSpace,
    order: usize,
    norm_before: f64,
) -> Result<Reduced, SynthesisError> {
    let (reduced, hankel_singular_values) = if controller.is_stable()? {
        let balanced = balanced_truncation(controller, order)?;
        (balanced.system, balanced.hankel_singular_values)
    } else {
        by_coprime_factors(controller, order)?
    };
    let norm_after = plant.closed(&reduced)?.h_infinity_norm()?.gain;
    let difference = parallel(controller, &reduced.scaled(-1.0))?;
    let difference = match difference.h_infinity_norm() {
        Ok(peak) => Some(peak.gain),
        Err(MatrixError::Unstable { .. }) => None,
        Err(error) => return Err(error.into()),
    };
    Ok(Reduced { controller: reduced, norm_before, norm_after, difference, hankel_singular_values })
}

/// M⁻¹ N of the truncated factors (N, M), which are stable whatever the controller; their Hankel singular
/// values.
fn by_coprime_factors(
    controller: &StateSpace,
    order: usize,
) -> Result<(StateSpace, Vec<f64>), MatrixError> {
    let StateSpace { a, b, c, d, interval } = controller;
    let (inputs, outputs) = (controller.inputs(), controller.outputs());
    let (injection, weight) = coprime_injection(controller)?;
    let scale = transposed(&square_root_factor(&weight)?);
    let back = inverse(&scale).ok_or(MatrixError::Singular("the scale of coprime factors"))?;
    let factors = StateSpace::new(
        a + &injection * c,
        blocks(&[&[&(b + &injection * d), &injection]]),
        &scale * c,
        blocks(&[&[&(&scale * d), &scale]]),
        *interval,
    );
    let balanced = balanced_truncation(&factors, order)?;
    let kept = balanced.system;
    let n = kept.order();
    let driven = part(&kept.b, 0, 0, n, inputs);
    let injection = part(&kept.b, 0, inputs, n, outputs);
    let c = back * &kept.c;
    let reduced = StateSpace::new(
        &kept.a - &injection * &c,
        driven - &injection * d,
        c,
        d.clone(),
        *interval,
    );
    Ok((reduced, balanced.hankel_singular_values))
}

/// L and the squared scale of the normalised left coprime factors, scale (A + L C, (B + L D, L), C, (D, I)).
fn coprime_injection(controller: &StateSpace) -> Result<(Mat<f64>, Mat<f64>), MatrixError> {
    let StateSpace { a, b, c, d, interval } = controller;
    let singular = || MatrixError::Singular("I + D Dᵀ");
    let weight = identity(controller.outputs()) + d * d.transpose();
    let solved = inverse(&weight).ok_or_else(singular)?;
    let turned = transposed(&(a - b * d.transpose() * &solved * c));
    let seen = symmetric(&(c.transpose() * &solved * c));
    let left = identity(controller.inputs()) - d.transpose() * &solved * d;
    let driven = symmetric(&(b * left * b.transpose()));
    if interval.is_none() {
        let y = riccati(&turned, &seen, &driven)?;
        return Ok((-((y * c.transpose() + b * d.transpose()) * &solved), solved));
    }
    let y = discrete_riccati(&turned, &seen, &driven)?;
    let whole = inverse(&(weight + c * &y * c.transpose())).ok_or_else(singular)?;
    Ok((-((a * &y * c.transpose() + b * d.transpose()) * &whole), whole))
}
