//! A recorded signal, followed from end to end.

use super::PhaseLockedError;
use super::single::{Estimate, PhaseLockedLoop, PhaseLockedSettings};
use std::f64::consts::TAU;

/// Least length of a record in periods of the lowest rate (–): two for generator and loop to settle, one for
/// the estimate.
pub const FEWEST_PERIODS: f64 = 3.0;

/// Estimate after each of `samples` (any unit, every `interval` s) of a signal followed with `settings`.
///
/// # Errors
/// [`PhaseLockedError::TooShort`] when the record has fewer than [`FEWEST_PERIODS`] periods of the lowest
/// rate, [`PhaseLockedError::Constant`] when it is constant or has no numbers, and those of
/// [`PhaseLockedLoop::new`].
pub fn follow(
    samples: &[f64],
    interval: f64,
    settings: &PhaseLockedSettings,
) -> Result<Vec<Estimate>, PhaseLockedError> {
    let mut follower = PhaseLockedLoop::new(settings, interval)?;
    let needed = (FEWEST_PERIODS * TAU / (settings.follower.rates[0] * interval)).ceil() as usize;
    if samples.len() < needed {
        return Err(PhaseLockedError::TooShort { n_samples: samples.len(), needed });
    }
    let finite = || samples.iter().copied().filter(|sample| sample.is_finite());
    let (least, most) =
        (finite().fold(f64::INFINITY, f64::min), finite().fold(-f64::INFINITY, f64::max));
    // Rounding alone moves a constant by parts in 10¹⁶.
    let large = most.abs().max(least.abs());
    let moves = most - least > 1e-13 * large;
    if !moves {
        return Err(PhaseLockedError::Constant { n_samples: samples.len() });
    }
    Ok(samples.iter().map(|sample| follower.update(interval, *sample)).collect())
}
