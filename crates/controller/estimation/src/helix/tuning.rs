//! Noise of the filter from records: measurement noise, process noise intensity of the wave, and its best
//! scale.
//!
//! Algorithm 1 of van Vondelen et al. (2025): the variance of high-passed moments, the variance of the
//! derivative of the filtered truth, and a factor on the latter found by trial on validation data. The first
//! half of a record is fitted to, the second validates. What is found are intensities, which hold at every
//! interval. Pure functions on slices.

use super::options::{HelixOptions, Measurement, positive};
use super::true_wave::finite;
pub use super::true_wave::{ProcessNoise, TrueWave, process_noise, wave};
use super::wave::Form;
use super::{HelixEstimate, HelixEstimator, HelixSettings};
use crate::{EstimationError, Estimator};
use basis::Measurements;
use basis::angle::wrap_to_half_turn;
use lti::SecondOrder;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use std::ops::Range;
use std::sync::Arc;
use turbine::Definition;

/// Largest departure of a sampling interval from the record's (–).
const UNEVEN: f64 = 0.01;
/// Steps of the golden section.
const N_REFINEMENTS: usize = 8;

/// Excitation periods before errors count (–).
const SETTLING_PERIODS: f64 = 3.0;

/// Result of tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// HelixOptions with the best noise.
    pub options: HelixOptions,
    /// Best factor on the process noise intensities (–).
    pub scale: f64,
    /// Root-mean-square phase error of tilt and yaw together with these options (rad) over the second half of
    /// the record, on which the factor was chosen: one number of many tried, so that it is less than another
    /// record will show.
    pub error: f64,
    /// The same over the first half (rad), to which the noise was fitted.
    pub fitted_error: f64,
    /// The same over the second half with the options that were given (rad).
    pub untuned_error: f64,
}

/// # Errors
/// [`EstimationError`] when `record` is not sampled every `interval` (s) without a gap, or an azimuth is not
/// a number.
pub fn check_record(record: &[Measurements], interval: f64) -> Result<(), EstimationError> {
    positive("sampling interval (s)", interval)?;
    if record.len() < 2 {
        let purpose = "an estimate";
        return Err(EstimationError::TooShort { n_samples: record.len(), needed: 2, purpose });
    }
    for (index, measurements) in record.iter().enumerate() {
        let bad =
            |name, value, expected| Err(EstimationError::Sample { name, index, value, expected });
        if !measurements.azimuth.is_finite() {
            return bad("the azimuth (rad)", measurements.azimuth, "a finite number");
        }
        if index > 0 {
            let step = measurements.time - record[index - 1].time;
            let uneven = (step / interval - 1.0).abs();
            if uneven.is_nan() || uneven >= UNEVEN {
                let expected = "samples an equal interval apart, that of the estimator";
                return bad("the step of time (s)", step, expected);
            }
        }
    }
    Ok(())
}

/// Variance (in the square of the unit of `signal`) of what `signal`, sampled every `interval` (s), holds
/// above `corner` (rad/s): Algorithm 1, step 1. Second-order Butterworth.
///
/// # Errors
/// [`EstimationError`] for a record shorter than two periods of the corner, a corner above the Nyquist rate,
/// or a sample that is not a number.
pub fn high_passed_variance(
    signal: &[f64],
    interval: f64,
    corner: f64,
) -> Result<f64, EstimationError> {
    positive("sampling interval (s)", interval)?;
    positive("corner of the high pass (rad/s)", corner)?;
    if corner * interval >= PI {
        let expected = "below the Nyquist rate of the record";
        let name = "corner of the high pass (rad/s)";
        return Err(EstimationError::Setting { name, value: corner, expected });
    }
    let settle = (TAU / corner / interval).ceil() as usize;
    finite("the signal", signal)?;
    if signal.len() < 2 * settle {
        let (n_samples, needed) = (signal.len(), 2 * settle);
        return Err(EstimationError::TooShort { n_samples, needed, purpose: "a high pass" });
    }
    let mut filter = SecondOrder::high_pass(corner, FRAC_1_SQRT_2, signal[0]);
    let (mut sum, mut n) = (0.0, 0.0);
    for (index, value) in signal.iter().enumerate() {
        let through = filter.update(interval, *value);
        if index >= settle {
            sum += through * through;
            n += 1.0;
        }
    }
    Ok(sum / n)
}

/// Estimates of `estimator` on `record`, one for each sample.
///
/// # Errors
/// Those of [`check_record`].
pub fn replay<E: Estimator<Estimate = HelixEstimate>>(
    estimator: &mut E,
    record: &[Measurements],
    interval: f64,
) -> Result<Vec<HelixEstimate>, EstimationError> {
    check_record(record, interval)?;
    Ok(record.iter().map(|measurements| estimator.update(measurements)).collect())
}

/// Root-mean-square error (rad) of the phases of `estimates` against `truth`, both axes together, over the
/// samples in `range`.
pub fn phase_error(estimates: &[HelixEstimate], truth: &TrueWave, range: Range<usize>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for index in range {
        let estimate = &estimates[index];
        for (axis, truth) in [estimate.tilt, estimate.yaw].iter().zip(&truth.phases) {
            sum += wrap_to_half_turn(axis.phase - truth[index]).powi(2);
            n += 1.0;
        }
    }
    (sum / f64::max(n, 1.0)).sqrt()
}

/// The factor (–) between those of `range` for which `cost` is least, and that cost: a grid of factors a
/// decade over three apart, then the golden section around the best of them. Algorithm 1, step 3.
pub fn best_scale(range: [f64; 2], mut cost: impl FnMut(f64) -> f64) -> (f64, f64) {
    let [low, high] = range.map(f64::log10);
    let n = ((high - low) * 3.0).ceil().max(1.0) as usize;
    let at = |k: usize| low + (high - low) * k as f64 / n as f64;
    let mut best = (low, f64::INFINITY);
    for k in 0..=n {
        let value = cost(10.0_f64.powf(at(k)));
        if value < best.1 {
            best = (at(k), value);
        }
    }
    let reach = (high - low) / n as f64;
    let (mut left, mut right) = ((best.0 - reach).max(low), (best.0 + reach).min(high));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..N_REFINEMENTS {
        let (a, b) = (right - golden * (right - left), left + golden * (right - left));
        let (at_a, at_b) = (cost(10.0_f64.powf(a)), cost(10.0_f64.powf(b)));
        for (place, value) in [(a, at_a), (b, at_b)] {
            if value < best.1 {
                best = (place, value);
            }
        }
        if at_a < at_b { right = b } else { left = a }
    }
    (10.0_f64.powf(best.0), best.1)
}

/// Algorithm 1 whole. From the first half of the `record`: measurement noise from its moments above twice the
/// excitation rate in the fixed frame's tilt, process noise of mean wind and helix from the `truth`, sample
/// by sample. On the second half: the scale of the process noise, by trial.
///
/// The variance of a reading times the interval is the intensity of white noise, whatever the interval. Of
/// noise that lasts longer than the interval it is what readings so far apart make of it; the scale is found
/// with it.
///
/// # Errors
/// [`EstimationError`] for a record that is uneven, shorter than six excitation periods, or of another length
/// than the truth.
pub fn tune(
    definition: &Arc<Definition>,
    settings: &HelixSettings,
    options: HelixOptions,
    record: &[Measurements],
    truth: &TrueWave,
) -> Result<Tuned, EstimationError> {
    let (interval, rate) = (settings.interval, settings.rate);
    check_record(record, interval)?;
    truth.check(record.len())?;
    let settled = (SETTLING_PERIODS * TAU / rate / interval).ceil() as usize;
    let half = record.len() / 2;
    if half <= settled {
        let (n_samples, needed) = (record.len(), 2 * (settled + 1));
        let purpose = "three periods to settle, and as long a part to validate";
        return Err(EstimationError::TooShort { n_samples, needed, purpose });
    }
    let tilt: Vec<f64> = record[..half]
        .iter()
        .map(|read| basis::mbc::to_fixed_frame(read.azimuth, &read.flap_moments).tilt)
        .collect();
    // Noise of one blade from that of the tilt component, which is √(2/n) times it; a reading stands for the
    // interval.
    let share = 0.5 * definition.n_blades as f64;
    let moment = (share * high_passed_variance(&tilt, interval, 2.0 * rate)? * interval).sqrt();
    let found = process_noise(&truth.part(0..half), interval, rate)?;
    let with = |scale: f64| {
        let mut tuned = options;
        let scaled = |intensity: f64| (scale * intensity).max(f64::MIN_POSITIVE);
        let quadrature = options.form == Form::Quadrature;
        let of_the_wave = if quadrature { found.component } else { found.amplitude };
        tuned.noise.measurement = Measurement::Moment(moment);
        tuned.noise.mean_wind = scaled(found.mean_wind);
        tuned.noise.amplitude = scaled(of_the_wave);
        tuned.noise.phase = scaled(found.phase);
        tuned
    };
    let errors = |options: HelixOptions| -> Result<[f64; 2], EstimationError> {
        let mut estimator = HelixEstimator::new(definition, settings, options)?;
        let estimates: Vec<_> = record.iter().map(|read| estimator.update(read)).collect();
        Ok([settled..half, half..record.len()].map(|part| phase_error(&estimates, truth, part)))
    };
    let [_, untuned_error] = errors(options)?;
    errors(with(1.0))?;
    let (scale, error) =
        best_scale([1e-3, 1e3], |scale| errors(with(scale)).map_or(f64::INFINITY, |[_, e]| e));
    let [fitted_error, _] = errors(with(scale))?;
    Ok(Tuned { options: with(scale), scale, error, fitted_error, untuned_error })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_high_pass_keeps_what_is_fast_and_drops_what_is_slow() {
        let sine = |rate: f64| -> Vec<f64> {
            (0..20_000).map(|k| (rate * 0.05 * f64::from(k)).sin()).collect()
        };
        let fast = high_passed_variance(&sine(3.0), 0.05, 0.3).unwrap();
        assert!((fast - 0.5).abs() < 0.01, "{fast}");
        let slow = high_passed_variance(&sine(0.03), 0.05, 0.3).unwrap();
        assert!(slow < 1e-4, "{slow}");
        let corner = high_passed_variance(&sine(0.3), 0.05, 0.3).unwrap();
        assert!((corner - 0.25).abs() < 0.01, "{corner}");
        assert!(high_passed_variance(&[1.0; 10], 0.05, 0.3).is_err());
        assert!(high_passed_variance(&[f64::NAN; 9000], 0.05, 0.3).is_err());
        assert!(high_passed_variance(&sine(1.0), 0.05, 80.0).is_err());
    }

    #[test]
    fn the_best_scale_is_found() {
        let (scale, cost) = best_scale([1e-3, 1e3], |scale| 1.0 + (scale / 20.0).log10().powi(2));
        assert!((scale / 20.0 - 1.0).abs() < 0.03 && cost < 1.001, "{scale} {cost}");
        assert_eq!(best_scale([1e-3, 1e3], |scale| scale).0, 1e-3);
    }
}
