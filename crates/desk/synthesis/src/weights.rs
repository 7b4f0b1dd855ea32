//! Weights of a mixed-sensitivity problem.

use crate::SynthesisError;
use lti::matrices::{StateSpace, TransferFunction};
use std::f64::consts::SQRT_2;

/// Performance weight (s/M + ω)/(s + A ω): the sensitivity is to stay below its inverse, A at rest and M at
/// high frequency. Continuous time.
///
/// `bandwidth` ω is in rad/s, `peak` M and `attenuation` A are gains (–). Source: Eq. 11 of the source on
/// closed-loop control of the helical wake; Skogestad and Postlethwaite 2005, Eq. 2.105.
pub fn performance_weight(
    bandwidth: f64,
    peak: f64,
    attenuation: f64,
) -> Result<StateSpace, SynthesisError> {
    positive("the bandwidth of a performance weight (rad/s)", bandwidth)?;
    positive("the peak of a performance weight", peak)?;
    positive("the attenuation of a performance weight", attenuation)?;
    let weight = TransferFunction {
        numerator: vec![peak.recip(), bandwidth],
        denominator: vec![1.0, attenuation * bandwidth],
        interval: None,
    };
    Ok(weight.state_space()?)
}

/// Control weight `scale` B² (s² + √2 ω s + ω²)/(s² + √2 B ω s + (B ω)²): `scale` at rest, from ω on
/// rising, `scale` B² from B ω on. Continuous time.
///
/// `corner` ω is in rad/s, `ratio` B and `scale` are gains (–). Source: Eq. 12 of the source on closed-loop
/// control of the helical wake, where the scale is 0.4 and the numerator's √2 ω lacks its s: rad/s would
/// stand beside rad²/s².
pub fn control_weight(corner: f64, ratio: f64, scale: f64) -> Result<StateSpace, SynthesisError> {
    positive("the corner of a control weight (rad/s)", corner)?;
    positive("the ratio of a control weight", ratio)?;
    positive("the scale of a control weight", scale)?;
    let (gain, far) = (scale * ratio * ratio, ratio * corner);
    let weight = TransferFunction {
        numerator: vec![gain, gain * SQRT_2 * corner, gain * corner * corner],
        denominator: vec![1.0, SQRT_2 * far, far * far],
        interval: None,
    };
    Ok(weight.state_space()?)
}

/// Whether `value` is above zero and finite.
fn positive(what: &'static str, value: f64) -> Result<(), SynthesisError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(SynthesisError::OutOfRange { what, value, needed: "it is above zero and finite" })
}
