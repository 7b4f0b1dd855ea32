//! Delays between inputs and outputs: by correlation, and by a model's zeros. [`Subspace::delay`] finds one
//! in a closed loop as well.
//!
//! [`Subspace::delay`]: crate::pbsid::Subspace::delay

use crate::error::within;
use crate::{IdentificationError, Record};
use lti::Complex64;
use lti::matrices::StateSpace;
use std::f64::consts::TAU;

/// Highest order of the filter that whitens an input (–).
const HIGHEST_ORDER: usize = 60;

/// Chance that a record without any correlation shows one (–).
const CHANCE: f64 = 0.05;

/// Correlation of an output with an input at lags from zero on, both filtered so that the input is white.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelationDelay {
    /// First lag whose correlation is beyond the bound (samples); `None` where none is.
    pub samples: Option<usize>,
    /// Correlation at each lag (–), which is proportional to the impulse response.
    pub correlations: Vec<f64>,
    /// Within ± this (–) 95 % of records without correlation stay at all lags together.
    pub bound: f64,
}

/// Delay from input number `input` to output number `output`, up to lag `most` (samples), in open loop.
///
/// Source: Box, Jenkins and Reinsel, "Time series analysis", 4th ed., 2008, section 12.1.1. The filter is
/// autoregressive by Levinson and Durbin, of the order that Akaike's criterion chooses.
///
/// # Errors
/// [`IdentificationError::TooFewSamples`] for fewer than ten times as many samples as lags.
///
/// # Panics
/// Without such an input or output.
pub fn by_correlation(
    record: &Record,
    input: usize,
    output: usize,
    most: usize,
) -> Result<CorrelationDelay, IdentificationError> {
    record.long_enough(10 * (most + 1).max(HIGHEST_ORDER), "the correlation's lags")?;
    let record = record.detrended(crate::Trend::Constant)?;
    let (input, output) = (&record.inputs()[input].samples, &record.outputs()[output].samples);
    let whitening = whitening(input);
    let (input, output) = (filtered(input, &whitening), filtered(output, &whitening));
    let power = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let scale = (power(&input) * power(&output)).sqrt();
    let correlations: Vec<f64> = (0..=most)
        .map(|lag| input.iter().zip(&output[lag..]).map(|(u, y)| u * y).sum::<f64>() / scale)
        .collect();
    let bound = beyond(0.5 * CHANCE / (most + 1) as f64) / (input.len() as f64).sqrt();
    let samples = correlations.iter().position(|value| value.abs() > bound);
    Ok(CorrelationDelay { samples, correlations, bound })
}

/// Coefficients of the filter, the first of which is one, that leaves of `signal` what its past cannot
/// predict.
fn whitening(signal: &[f64]) -> Vec<f64> {
    let n_samples = signal.len() as f64;
    let covariance: Vec<f64> = (0..=HIGHEST_ORDER)
        .map(|lag| signal.iter().zip(&signal[lag..]).map(|(x, y)| x * y).sum::<f64>() / n_samples)
        .collect();
    let (mut filter, mut error) = (vec![1.0], covariance[0]);
    let (mut best, mut least) = (filter.clone(), n_samples * error.ln());
    for order in 1..=HIGHEST_ORDER {
        let missed: f64 =
            filter.iter().zip((1..=order).rev()).map(|(f, l)| f * covariance[l]).sum();
        let reflection = -missed / error;
        filter.push(0.0);
        let mirrored: Vec<f64> = filter.iter().rev().copied().collect();
        filter.iter_mut().zip(mirrored).for_each(|(value, back)| *value += reflection * back);
        error *= 1.0 - reflection * reflection;
        if error.is_nan() || error <= 0.0 {
            break;
        }
        let criterion = n_samples * error.ln() + 2.0 * order as f64;
        if criterion < least {
            (best, least) = (filter.clone(), criterion);
        }
    }
    best
}

/// Through a filter of finite response, from where all of it lies on the signal.
fn filtered(signal: &[f64], filter: &[f64]) -> Vec<f64> {
    let windows = signal.windows(filter.len());
    windows.map(|window| window.iter().rev().zip(filter).map(|(x, f)| x * f).sum()).collect()
}

/// What a standard normal number exceeds with this `chance` (below one half).
/// Source: Börjesson and Sundberg, IEEE Trans. Commun. 27, 1979, within 0.3 %.
fn beyond(chance: f64) -> f64 {
    let tail =
        |x: f64| (-0.5 * x * x).exp() / (TAU.sqrt() * (0.661 * x + 0.339 * (x * x + 5.51).sqrt()));
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tail(middle) > chance {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// What a system's zeros in the right half-plane amount to.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroDelay {
    /// Zeros with positive real part, in continuous time (rad/s).
    pub zeros: Vec<Complex64>,
    /// Sum of Re(2/z) over them (s): the delay at low frequencies of the all-pass system with these zeros. A
    /// Padé approximant of any order has the delay that it stands for. Channels with delays of their own add.
    pub delay: f64,
}

/// Delay that a system's finite zeros stand for. Those of a system in discrete time are carried over by the
/// bilinear transformation s = 2/T (z − 1)/(z + 1); whole samples of delay show as zeros at infinity there
/// and are not counted.
///
/// # Errors
/// [`IdentificationError::Matrix`] where the zeros do not converge.
pub fn by_zeros(system: &StateSpace) -> Result<ZeroDelay, IdentificationError> {
    if let Some(interval) = system.interval {
        within("the interval (s)", interval, f64::MIN_POSITIVE, f64::MAX)?;
    }
    let carried = |zero: Complex64| match system.interval {
        None => zero,
        Some(interval) => 2.0 / interval * (zero - 1.0) / (zero + 1.0),
    };
    let zeros: Vec<Complex64> = system
        .invariant_zeros()?
        .into_iter()
        .map(carried)
        .filter(|zero| zero.is_finite() && zero.re > 0.0)
        .collect();
    let delay = zeros.iter().map(|zero| (2.0 / zero).re).sum();
    Ok(ZeroDelay { zeros, delay })
}

#[cfg(test)]
mod tests;
