//! Continuous time to discrete time and back.

use super::dense::{blocks, identity, inverse, part};
use super::{MatrixError, StateSpace, exponential, logarithm};
use faer::Mat;
use num_complex::Complex64;

/// The system in discrete time that the bilinear (Tustin) transformation s = 2/T (z − 1)/(z + 1) makes,
/// with T `interval` (s). H-infinity norms, stability and Gramians stay as they are.
///
/// Source: Al-Saggaf and Franklin, "Model reduction via balanced realizations", IEEE Trans. Automatic
/// Control 33, 1988, Eq. 5.
pub fn bilinear(system: &StateSpace, interval: f64) -> Result<StateSpace, MatrixError> {
    if system.interval.is_some() {
        return Err(MatrixError::Time { needed: "continuous" });
    }
    let rate = rate(interval)?;
    let shifted = rate * identity(system.order()) - &system.a;
    let solved = inverse(&shifted).ok_or(MatrixError::PoleAt { pole: rate.into() })?;
    let root = (2.0 * rate).sqrt();
    let to_states = &solved * &system.b;
    Ok(StateSpace::new(
        &solved * (rate * identity(system.order()) + &system.a),
        root * &to_states,
        root * (&system.c * &solved),
        &system.d + &system.c * &to_states,
        Some(interval),
    ))
}

/// The system in continuous time of which the bilinear transformation makes this one.
pub fn inverse_bilinear(system: &StateSpace) -> Result<StateSpace, MatrixError> {
    let interval = system.interval.ok_or(MatrixError::Time { needed: "discrete" })?;
    let rate = rate(interval)?;
    let one = identity(system.order());
    let pole = Complex64::new(-1.0, 0.0);
    let solved = inverse(&(&system.a + &one)).ok_or(MatrixError::PoleAt { pole })?;
    let root = (2.0 * rate).sqrt();
    let to_states = &solved * &system.b;
    Ok(StateSpace::new(
        rate * (&solved * (&system.a - &one)),
        root * &to_states,
        root * (&system.c * &solved),
        &system.d - &system.c * &to_states,
        None,
    ))
}

/// The system in discrete time that is exact for an input held over each `interval` (s).
pub fn zero_order_hold(system: &StateSpace, interval: f64) -> Result<StateSpace, MatrixError> {
    if system.interval.is_some() {
        return Err(MatrixError::Time { needed: "continuous" });
    }
    rate(interval)?;
    let (n, m) = (system.order(), system.inputs());
    let whole = blocks(&[&[&system.a, &system.b], &[&Mat::zeros(m, n), &Mat::zeros(m, m)]]);
    let after = exponential(&(interval * &whole))?;
    Ok(StateSpace::new(
        part(&after, 0, 0, n, n),
        part(&after, 0, n, n, m),
        system.c.clone(),
        system.d.clone(),
        Some(interval),
    ))
}

/// The system in continuous time that a held input turns into this one; refused where a pole is on the
/// negative real axis, which no real system in continuous time of this order has.
pub fn inverse_hold(system: &StateSpace) -> Result<StateSpace, MatrixError> {
    let interval = system.interval.ok_or(MatrixError::Time { needed: "discrete" })?;
    rate(interval)?;
    let (n, m) = (system.order(), system.inputs());
    let on_cut =
        |pole: &Complex64| pole.re <= 0.0 && pole.im.abs() <= 1e-12 * pole.norm().max(1e-12);
    if let Some(pole) = system.poles()?.into_iter().find(on_cut) {
        return Err(MatrixError::PoleAt { pole });
    }
    let after = blocks(&[&[&system.a, &system.b], &[&Mat::zeros(m, n), &identity(m)]]);
    let whole = (1.0 / interval) * logarithm(&after)?;
    Ok(StateSpace::new(
        part(&whole, 0, 0, n, n),
        part(&whole, 0, n, n, m),
        system.c.clone(),
        system.d.clone(),
        None,
    ))
}

/// 2/T (1/s) of an interval T (s).
fn rate(interval: f64) -> Result<f64, MatrixError> {
    if interval > 0.0 && interval.is_finite() {
        return Ok(2.0 / interval);
    }
    let needed = "it is above zero and finite";
    Err(MatrixError::OutOfRange { what: "the sample time", value: interval, needed })
}
