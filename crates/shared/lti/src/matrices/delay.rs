//! Delays as systems.

use super::{MatrixError, StateSpace, TransferFunction};
use faer::Mat;

/// Order (–) up to which an approximant's coefficients are well apart from rounding.
const HIGHEST_ORDER: usize = 12;

/// A delay of `samples` whole samples of each of `channels` signals, every `interval` (s): one state a
/// sample and channel.
pub fn sample_delay(
    channels: usize,
    samples: usize,
    interval: f64,
) -> Result<StateSpace, MatrixError> {
    if !(interval > 0.0 && interval.is_finite()) {
        let needed = "it is above zero and finite";
        return Err(MatrixError::OutOfRange { what: "the sample time", value: interval, needed });
    }
    if samples == 0 {
        return Ok(StateSpace::gain(Mat::identity(channels, channels), Some(interval)));
    }
    // State k·channels + i holds what signal i was k + 1 samples ago.
    let order = samples * channels;
    let one_if = |condition: bool| f64::from(u8::from(condition));
    Ok(StateSpace::new(
        Mat::from_fn(order, order, |i, j| one_if(i == j + channels)),
        Mat::from_fn(order, channels, |i, j| one_if(i == j)),
        Mat::from_fn(channels, order, |i, j| one_if(j == order - channels + i)),
        Mat::zeros(channels, channels),
        Some(interval),
    ))
}

/// Padé's approximant of `order` of a `delay` (s) of one signal in continuous time: all-pass.
///
/// Source: Golub and Van Loan, "Matrix Computations", 4th ed., 2013, Eq. 9.3.4 with −s τ.
pub fn pade_delay(delay: f64, order: usize) -> Result<StateSpace, MatrixError> {
    if !(delay >= 0.0 && delay.is_finite()) {
        let needed = "it is not below zero and finite";
        return Err(MatrixError::OutOfRange { what: "the delay", value: delay, needed });
    }
    if order > HIGHEST_ORDER {
        let what = "order of a delay's approximant, at most";
        return Err(MatrixError::Size { what, found: order, expected: HIGHEST_ORDER });
    }
    if order == 0 || delay == 0.0 {
        return Ok(StateSpace::gain(Mat::identity(1, 1), None));
    }
    // Coefficient of (s τ)^k; the numerator's alternate in sign.
    let mut coefficient = 1.0;
    let mut denominator = vec![coefficient];
    for k in 1..=order {
        coefficient *= (order - k + 1) as f64 / (k * (2 * order - k + 1)) as f64;
        denominator.push(coefficient);
    }
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let numerator = denominator.iter().enumerate().map(|(k, value)| sign(k) * value);
    let unit = TransferFunction {
        numerator: numerator.rev().collect(),
        denominator: denominator.iter().rev().copied().collect(),
        interval: None,
    }
    .state_space()?;
    // In units of the delay; one second is 1/τ of them.
    Ok(StateSpace { a: (1.0 / delay) * &unit.a, b: (1.0 / delay) * &unit.b, ..unit })
}
