//! Calibration of the model's response to the rotor's own pitch, on a record without a helix in the wind.
//!
//! A rotor that pitches at the rate of the helix that it estimates takes every error of its pitch response
//! for wind: a few percent of four degrees are as much wind as a helix five diameters downstream. In a steady
//! wind there is no helix, so whatever the filter finds is that error. It is linear in a complex factor on
//! the pitch, gain and azimuth offset. Two trials give the factor with which no error is left.
//!
//! The paper identifies an azimuth offset for the same end (van Vondelen et al., 2025, §2.4) and names
//! calibration against experiments as a remedy for its biases (§4.2).

use super::estimator::HelixEstimator;
use super::options::HelixOptions;
use super::settings::HelixSettings;
use crate::{EstimationError, Estimator};
use basis::{Measurements, Sense};
use lti::Complex64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;
use turbine::Definition;

/// Step of the factor between the two trials (–).
const TRIAL: f64 = 0.1;
/// Rounds (–); the error is nearly linear in the factor.
const N_ROUNDS: usize = 2;

/// Complex factor on the pitch, and the error with and without it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Factor on tilt and yaw of the pitch (–).
    pub gain: f64,
    /// Azimuth offset: angle by which a blade leads its pitch (rad).
    pub azimuth_offset: f64,
    /// Amplitude of the spurious helix before calibration (m/s).
    pub before: f64,
    /// Amplitude of the spurious helix after calibration (m/s).
    pub after: f64,
}

impl Calibration {
    /// `options` with this calibration.
    pub fn apply(&self, options: HelixOptions) -> HelixOptions {
        let mut options = options;
        options.rotor.pitch_gain = self.gain;
        options.rotor.pitch_azimuth_offset = self.azimuth_offset;
        options
    }
}

/// Calibrates `options` on `record`: measurements at every [`HelixSettings::interval`] of a rotor that
/// pitches a helix with the rate and sense of `settings` in a steady wind. The filter settles for `settling`
/// (s); whole periods after that count.
///
/// # Errors
/// Those of [`HelixEstimator::new`]; [`EstimationError::RecordTooShort`] without a whole period after the
/// settling time; [`EstimationError::NothingToCalibrate`] when the rotor did not pitch.
pub fn calibrate(
    definition: &Arc<Definition>,
    settings: &HelixSettings,
    options: HelixOptions,
    record: &[Measurements],
    settling: f64,
) -> Result<Calibration, EstimationError> {
    let period = TAU / settings.rate;
    let n_settling = (settling / settings.interval).ceil() as usize;
    let n_left = record.len().saturating_sub(n_settling);
    let n_period = period / settings.interval;
    let n_counted = ((n_left as f64 / n_period).floor() * n_period).round() as usize;
    if n_counted == 0 {
        let (found, needed) = (record.len(), n_settling + n_period.ceil() as usize);
        return Err(EstimationError::RecordTooShort { found, needed });
    }
    let found = |factor: Complex64| -> Result<Complex64, EstimationError> {
        let options = with_factor(options, settings.sense, factor);
        let mut estimator = HelixEstimator::new(definition, settings, options)?;
        let mut sum = Complex64::default();
        for (index, measurements) in record.iter().take(n_settling + n_counted).enumerate() {
            let estimate = estimator.update(measurements);
            if index < n_settling {
                continue;
            }
            for axis in [estimate.tilt, estimate.yaw] {
                let (sine, cosine) = axis.phase.sin_cos();
                let half = 0.5 * axis.amplitude;
                sum += Complex64::new(half * cosine, half * sine);
            }
        }
        Ok(sum / n_counted as f64)
    };
    let mut factor = Complex64::new(1.0, 0.0);
    let mut left = found(factor)?;
    let before = left.norm();
    for _ in 0..N_ROUNDS {
        let beside = found(factor + TRIAL)?;
        let slope = (beside - left) / TRIAL;
        let size = slope.norm();
        if size.is_nan() || size < f64::EPSILON {
            return Err(EstimationError::NothingToCalibrate);
        }
        factor -= left / slope;
        left = found(factor)?;
    }
    let rotor = with_factor(options, settings.sense, factor).rotor;
    Ok(Calibration {
        gain: rotor.pitch_gain,
        azimuth_offset: rotor.pitch_azimuth_offset,
        before,
        after: left.norm(),
    })
}

/// `options` with a complex `factor` on the pitch's phasor: turning tilt and yaw by an azimuth takes it from
/// a ccw helix's phase and adds it to a cw one's.
fn with_factor(options: HelixOptions, sense: Sense, factor: Complex64) -> HelixOptions {
    let turned = factor.arg();
    let mut options = options;
    options.rotor.pitch_gain = factor.norm();
    options.rotor.pitch_azimuth_offset = match sense {
        Sense::CounterClockwise => -turned,
        Sense::Clockwise => turned,
    };
    options
}
