//! Noise of the filter from records: measurement noise, process noise intensity of the wave, and its best
//! scale.
//!
//! Algorithm 1 of van Vondelen et al. (2025): the variance of high-passed moments, the variance of the
//! derivative of the filtered true wave, and a factor on the latter found by trial against the truth. Pure
//! functions on slices.

use super::options::{HelixOptions, Measurement, positive};
use super::{HelixEstimate, HelixEstimator, HelixSettings};
use crate::{EstimationError, Estimator};
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use basis::{Measurements, Sense};
use lti::SecondOrder;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use std::sync::Arc;
use turbine::Definition;

/// Largest departure of a sampling interval from the record's (–).
const UNEVEN: f64 = 0.01;
/// Steps of the golden section.
const N_REFINEMENTS: usize = 8;

/// Process noise intensities of a wave: variances per time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProcessNoise {
    /// Of the amplitude ((m/s)²/s).
    pub amplitude: f64,
    /// Of the phase (rad²/s).
    pub phase: f64,
}

/// Result of tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// Options with the best noise.
    pub options: HelixOptions,
    /// Best factor on the process noise intensity of the wave (–).
    pub scale: f64,
    /// Root-mean-square phase error of tilt and yaw together with these options (rad).
    pub error: f64,
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

/// Amplitude (m/s) and phase (rad, unwrapped from the first) of the component of `signal` (m/s) at `rate`
/// (rad/s), sampled every `interval` (s) from `start` (s) on: A sin(ω t + φ), averaged around each sample
/// with weights that fall linearly to zero a period away.
///
/// The first and last period have no value: the columns begin a period after `start`.
///
/// # Errors
/// [`EstimationError`] for a record shorter than three periods, a rate above the Nyquist rate, or a sample
/// that is not a number.
pub fn wave(
    signal: &[f64],
    start: f64,
    interval: f64,
    rate: f64,
) -> Result<(Vec<f64>, Vec<f64>), EstimationError> {
    positive("sampling interval (s)", interval)?;
    positive("excitation rate (rad/s)", rate)?;
    if rate * interval >= PI {
        let (rotor_speed, nyquist) = (0.0, PI / interval);
        return Err(EstimationError::AboveNyquist { rate, rotor_speed, interval, nyquist });
    }
    finite("the signal", signal)?;
    let period = (TAU / rate / interval).round() as usize;
    if signal.len() < 3 * period {
        let (n_samples, needed) = (signal.len(), 3 * period);
        return Err(EstimationError::TooShort { n_samples, needed, purpose: "a wave's phase" });
    }
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let turn = |index: usize| (rate * (start + index as f64 * interval)).sin_cos();
    let part = |(index, value): (usize, &f64)| 2.0 * (value - mean) * turn(index).0;
    let sines: Vec<f64> = signal.iter().enumerate().map(part).collect();
    let part = |(index, value): (usize, &f64)| 2.0 * (value - mean) * turn(index).1;
    let cosines: Vec<f64> = signal.iter().enumerate().map(part).collect();
    let twice = |column: &[f64]| moving_mean(&moving_mean(column, period), period);
    let (mut amplitudes, mut phases) = (Vec::new(), Vec::new());
    for (sine, cosine) in twice(&sines).into_iter().zip(twice(&cosines)) {
        amplitudes.push(sine.hypot(cosine));
        let phase = cosine.atan2(sine);
        let last = phases.last().copied().unwrap_or(phase);
        phases.push(last + wrap_to_half_turn(phase - last));
    }
    Ok((amplitudes, phases))
}

/// Mean of each `n` successive values.
fn moving_mean(column: &[f64], n: usize) -> Vec<f64> {
    let mut sum: f64 = column[..n].iter().sum();
    let mut means = vec![sum / n as f64];
    for index in n..column.len() {
        sum += column[index] - column[index - n];
        means.push(sum / n as f64);
    }
    means
}

/// Process noise intensities of amplitude and phase of a helix, from the true fixed-frame winds `tilt` and
/// `yaw` (m/s) sampled every `interval` (s) from `start` (s) on: Algorithm 1, step 2. Variances of the
/// derivatives times the interval, which are the variances per time of a walk with such steps.
///
/// # Errors
/// Those of [`wave`], and columns of different length.
pub fn process_noise(
    [tilt, yaw]: [&[f64]; 2],
    start: f64,
    interval: f64,
    rate: f64,
) -> Result<ProcessNoise, EstimationError> {
    if tilt.len() != yaw.len() {
        let (found, expected) = (yaw.len(), tilt.len());
        return Err(EstimationError::Length { name: "the true yaw wind", found, expected });
    }
    let mut sums = [0.0; 2];
    for signal in [tilt, yaw] {
        let (amplitudes, phases) = wave(signal, start, interval, rate)?;
        for (sum, column) in sums.iter_mut().zip([amplitudes, phases]) {
            let squares = column.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
            *sum += 0.5 * squares.sum::<f64>() / (column.len() - 1) as f64 / interval;
        }
    }
    let [amplitude, phase] = sums;
    Ok(ProcessNoise { amplitude, phase })
}

/// True phases φ_tilt and φ_yaw (rad, [0, 2π)) at each sample of the true winds, as [`wave`] gives them; the
/// yaw's without the lead of its `sense`. The first and last period repeat their neighbours.
///
/// # Errors
/// Those of [`process_noise`].
pub fn true_phases(
    [tilt, yaw]: [&[f64]; 2],
    start: f64,
    interval: f64,
    rate: f64,
    sense: Sense,
) -> Result<Vec<[f64; 2]>, EstimationError> {
    if tilt.len() != yaw.len() {
        let (found, expected) = (yaw.len(), tilt.len());
        return Err(EstimationError::Length { name: "the true yaw wind", found, expected });
    }
    let (_, tilts) = wave(tilt, start, interval, rate)?;
    let (_, yaws) = wave(yaw, start, interval, rate)?;
    let half = (tilt.len() - tilts.len()) / 2;
    Ok((0..tilt.len())
        .map(|index| {
            let index = index.saturating_sub(half).min(tilts.len() - 1);
            [wrap_to_turn(tilts[index]), wrap_to_turn(yaws[index] - sense.yaw_lead())]
        })
        .collect())
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

/// Root-mean-square error (rad) of the phases of `estimates` against `truth`, both axes together, after
/// `settled` samples.
pub fn phase_error(estimates: &[HelixEstimate], truth: &[[f64; 2]], settled: usize) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for (estimate, truth) in estimates.iter().zip(truth).skip(settled) {
        for (axis, truth) in [estimate.tilt, estimate.yaw].iter().zip(truth) {
            sum += wrap_to_half_turn(axis.phase - truth).powi(2);
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

/// Algorithm 1 whole: measurement noise from the `record`'s moments above twice the excitation rate in the
/// fixed frame's tilt, process noise intensity from the `truth` (tilt and yaw wind, m/s, sample by sample),
/// its scale by trial.
///
/// # Errors
/// [`EstimationError`] for a record that is uneven, too short, or of another length than the truth.
pub fn tune(
    definition: &Arc<Definition>,
    settings: &HelixSettings,
    options: HelixOptions,
    record: &[Measurements],
    truth: [&[f64]; 2],
) -> Result<Tuned, EstimationError> {
    check_record(record, settings.interval)?;
    if truth[0].len() != record.len() {
        let (found, expected) = (truth[0].len(), record.len());
        return Err(EstimationError::Length { name: "the true tilt wind", found, expected });
    }
    let (start, interval, rate) = (record[0].time, settings.interval, settings.rate);
    let tilt: Vec<f64> = record
        .iter()
        .map(|read| basis::mbc::to_fixed_frame(read.azimuth, &read.flap_moments).tilt)
        .collect();
    // Noise of one blade from that of the tilt component, which is √(2/n) times it.
    let share = 0.5 * definition.n_blades as f64;
    let moment = (share * high_passed_variance(&tilt, interval, 2.0 * rate)?).sqrt();
    let found = process_noise(truth, start, interval, rate)?;
    let phases = true_phases(truth, start, interval, rate, settings.sense)?;
    let settled = (3.0 * TAU / rate / interval).round() as usize;
    if record.len() <= settled {
        let (n_samples, needed) = (record.len(), settled + 1);
        let purpose = "errors after three periods";
        return Err(EstimationError::TooShort { n_samples, needed, purpose });
    }
    let with = |scale: f64| {
        let mut tuned = options;
        tuned.noise.measurement = Measurement::Moment(moment);
        tuned.noise.amplitude = (scale * found.amplitude).max(f64::MIN_POSITIVE);
        tuned.noise.phase = (scale * found.phase).max(f64::MIN_POSITIVE);
        tuned
    };
    HelixEstimator::new(definition, settings, with(1.0))?;
    let (scale, error) = best_scale([1e-3, 1e3], |scale| {
        let Ok(mut estimator) = HelixEstimator::new(definition, settings, with(scale)) else {
            return f64::INFINITY;
        };
        let estimates: Vec<_> = record.iter().map(|read| estimator.update(read)).collect();
        phase_error(&estimates, &phases, settled)
    });
    Ok(Tuned { options: with(scale), scale, error })
}

fn finite(name: &'static str, signal: &[f64]) -> Result<(), EstimationError> {
    match signal.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            let (value, expected) = (signal[index], "a finite number");
            Err(EstimationError::Sample { name, index, value, expected })
        }
    }
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

    /// A walk of the phase comes back as its variance per time, less what one period's mean smooths away.
    #[test]
    fn a_wave_gives_amplitude_phase_and_their_process_noise() {
        let (rate, interval) = (TAU / 100.0, 0.5);
        let signal: Vec<f64> = (0..4000)
            .map(|k| 3.0 + 0.8 * (rate * (7.0 + interval * f64::from(k)) + 1.2).sin())
            .collect();
        let (amplitudes, phases) = wave(&signal, 7.0, interval, rate).unwrap();
        assert!(amplitudes.iter().all(|amplitude| (amplitude - 0.8).abs() < 1e-9));
        assert!(phases.iter().all(|phase| (phase - 1.2).abs() < 1e-9));
        let found = process_noise([&signal, &signal], 7.0, interval, rate).unwrap();
        assert!(found.amplitude < 1e-18 && found.phase < 1e-18);
        // A phase that runs ahead steadily has the variance of its steps.
        let ahead: Vec<f64> =
            (0..4000).map(|k| (1.01 * rate * interval * f64::from(k)).sin()).collect();
        let found = process_noise([&ahead, &ahead], 0.0, interval, rate).unwrap();
        let expected = (0.01 * rate).powi(2) * interval;
        assert!((found.phase / expected - 1.0).abs() < 0.1, "{} {expected}", found.phase);
    }

    #[test]
    fn the_best_scale_is_found() {
        let (scale, cost) = best_scale([1e-3, 1e3], |scale| 1.0 + (scale / 20.0).log10().powi(2));
        assert!((scale / 20.0 - 1.0).abs() < 0.03 && cost < 1.001, "{scale} {cost}");
        assert_eq!(best_scale([1e-3, 1e3], |scale| scale).0, 1e-3);
    }
}
