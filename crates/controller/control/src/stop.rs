//! When an excitation may end.

use crate::error::ControlError;

/// The `stop` (s) of an excitation of `rate` (rad/s) that begins at `start` (s), which is to be whole before
/// it ends.
pub(crate) fn stop_of(
    start: f64,
    stop: Option<f64>,
    rate: f64,
) -> Result<Option<f64>, ControlError> {
    let period = std::f64::consts::TAU / rate;
    match stop {
        Some(stop) if stop < start + period => {
            let earliest = (start + period).ceil();
            Err(ControlError::StopsTooEarly { stop, start, period, earliest })
        }
        stop => Ok(stop),
    }
}
