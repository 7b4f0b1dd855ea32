//! An estimator run again over the records of a turbine, and tuned on them.

use super::estimates::Estimates;
use super::query::{Query, Records};
use super::{PhaseQuestion, column};
use crate::PostprocessingError;
use crate::error::InRecords;
use analysis::phase::uniform_interval;
use basis::channels::{AZIMUTH, BLD_PITCH, BladeChannel, ROOT_MYC, ROT_SPEED, TIME};
use basis::{Measurements, PerBlade};
use control::ControlError;
use control::phase_sync::PhaseEstimator;
use estimation::helix::tuning::{self, TrueWave, Tuned};
use estimation::helix::{self, HelixOptions, HelixSettings, OperatingPoint};
use estimation::{EstimationError, HelixEstimate, HelixEstimator, LinearEstimator};
use farm::assemble::AssemblyError;

/// An estimator that can be run over records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replayed {
    /// One that a turbine runs.
    InRun(PhaseEstimator),
    /// The robust one forward over the record and back: it knows the future.
    Smoothed,
    /// The linear filter of the earlier method, around the means of the record: true wind, rotor speed,
    /// pitch.
    Linear,
}

/// Estimate of `estimator` on the records of the turbine, row by row, calibrated as in the run.
pub(super) fn replay(
    query: &Query<'_>,
    estimator: Replayed,
) -> Result<Estimates, PostprocessingError> {
    let interval = uniform_interval(column(query.series, &TIME.name)?)?;
    let setting = setting(query, interval);
    let record = record(query, interval)?;
    let replayed = match estimator {
        Replayed::InRun(estimator) => {
            let options = options(query, estimator)?;
            let estimator = HelixEstimator::new(&query.definition, &setting, options);
            tuning::replay(&mut estimator.map_err(not_estimated)?, &record, interval)
        }
        Replayed::Smoothed => {
            let options = options(query, PhaseEstimator::Robust)?;
            let estimator = HelixEstimator::new(&query.definition, &setting, options);
            helix::smooth(&mut estimator.map_err(not_estimated)?, &record, interval)
        }
        Replayed::Linear => {
            let point = operating_point(query, &record);
            let options = HelixOptions::default();
            let estimator = LinearEstimator::new(&query.definition, &setting, point, options);
            tuning::replay(&mut estimator.map_err(not_estimated)?, &record, interval)
        }
    };
    Ok(over_time(&replayed.map_err(not_estimated)?))
}

/// `found` at each instant, quantity by quantity.
fn over_time(found: &[HelixEstimate]) -> Estimates {
    let mut estimates = Estimates::default();
    for estimate in found {
        estimates.wind.push(estimate.mean_wind);
        estimates.wind_deviation.push(estimate.mean_wind_variance.sqrt());
        let [of_tilt, of_yaw] = estimate.helix_deviation;
        for (wave, axis, deviation) in [
            (&mut estimates.tilt, estimate.tilt, of_tilt),
            (&mut estimates.yaw, estimate.yaw, of_yaw),
        ] {
            wave.amplitude.push(axis.amplitude);
            wave.phase.push(axis.phase);
            wave.deviation.push(axis.phase_variance.sqrt());
            wave.wind_deviation.push(deviation);
        }
        estimates.trust.push(estimate.trust.overall());
    }
    estimates
}

/// Means over the `record` of rotor speed and pitch, and the true mean wind.
fn operating_point(query: &Query<'_>, record: &[Measurements]) -> OperatingPoint {
    let n = record.len().max(1) as f64;
    let mean = |of: fn(&Measurements) -> f64| record.iter().map(of).sum::<f64>() / n;
    OperatingPoint {
        wind: analysis::statistics::mean(&query.truth.wind.average),
        rotor_speed: mean(|read| read.rotor_speed),
        pitch: mean(|read| read.pitch.mean()),
    }
}

/// Noise for the estimator that `question` names, tuned on its record against the true wind: fitted to the
/// first half, its scale chosen on the second. The truth is the one that [`phase`](super::phase) compares
/// with, filtered once.
///
/// Source: van Vondelen et al. (2025), Algorithm 1.
///
/// # Errors
/// As [`phase`](super::phase); [`PostprocessingError::Setting`] for an estimator that has no noise to tune.
pub fn tune(question: &PhaseQuestion) -> Result<Tuned, PostprocessingError> {
    let mut records = Records::read(question)?;
    let first = records.turbines[0];
    let query = records.query(first)?;
    tuned(question, &query).in_records(&query.path)
}

/// What tuning finds for the turbine of `query`.
fn tuned(question: &PhaseQuestion, query: &Query<'_>) -> Result<Tuned, PostprocessingError> {
    let truth = &query.truth.wind;
    let interval = uniform_interval(column(query.series, &TIME.name)?)?;
    let from = question.from.unwrap_or(query.case.time.spin_up);
    let whole = record(query, interval)?;
    let (mut measured, mut wave) = (Vec::new(), TrueWave::default());
    for measurements in whole {
        let at = truth.index_at(measurements.time).filter(|at| truth.trusted.contains(at));
        if let (Some(at), true) = (at, measurements.time >= from) {
            measured.push(measurements);
            wave.average.push(truth.average[at]);
            for (axis, truth) in [&truth.tilt, &truth.yaw].into_iter().enumerate() {
                wave.amplitudes[axis].push(truth.amplitude[at]);
                wave.phases[axis].push(truth.phase[at]);
            }
        }
    }
    let estimator = match question.estimator {
        None => PhaseEstimator::Robust,
        Some(Replayed::InRun(estimator)) => estimator,
        Some(other @ (Replayed::Linear | Replayed::Smoothed)) => {
            let given = if other == Replayed::Linear { "linear" } else { "smoothed" };
            return Err(PostprocessingError::Setting {
                setting: "estimator",
                given: given.to_owned(),
                expected: "one that a turbine runs, whose noise a case file can give",
                fix: "name robust, published or published-with-offset",
            });
        }
    };
    let options = options(query, estimator)?;
    let setting = setting(query, interval);
    let tuned = tuning::tune(&query.definition, &setting, options, &measured, &wave);
    Ok(tuned.map_err(not_estimated)?)
}

/// Choices of `estimator`, calibrated as in the run, with what it was given there.
///
/// # Errors
/// [`PostprocessingError::Setting`] where the published form shall have an azimuth offset that was not
/// recorded.
fn options(
    query: &Query<'_>,
    estimator: PhaseEstimator,
) -> Result<HelixOptions, PostprocessingError> {
    let options = estimator.options(query.case.flow.solver.resolves_induction);
    let options = match estimator {
        PhaseEstimator::Robust => query.calibration.map_or(options, |found| found.apply(options)),
        PhaseEstimator::Published => options,
        PhaseEstimator::PublishedWithOffset => {
            // What pitches nothing has nothing to turn.
            let unneeded = (!query.pitches).then_some(0.0);
            let offset = query.transformation_offset.or(unneeded);
            options.with_azimuth_offset(offset.ok_or_else(no_offset)?)
        }
    };
    // Noise and choices are given to one estimator; another's states may have other process noise.
    let sync = query.sync.filter(|sync| sync.estimator == estimator);
    Ok(sync.map_or(options, |sync| sync.noise.apply(sync.choices.apply(options))))
}

fn no_offset() -> PostprocessingError {
    PostprocessingError::Setting {
        setting: "estimator",
        given: "published-with-offset".to_owned(),
        expected: "a run before which the azimuth offset of the turbine was found",
        fix: "name published, or run the case with the turbine under kind = \"phase-sync\" and without azimuth_offset_deg",
    }
}

fn not_estimated(error: EstimationError) -> AssemblyError {
    ControlError::from(error).into()
}

/// Settings of the turbine's estimator.
fn setting(query: &Query<'_>, interval: f64) -> HelixSettings {
    HelixSettings {
        sense: query.reference.sense,
        rate: query.reference.rate,
        interval,
        air_density: query.case.wind.air_density,
        n_elements: HelixSettings::N_ELEMENTS,
    }
}

/// What the turbine measured, row by row.
fn record(
    query: &Query<'_>,
    interval: f64,
) -> Result<Vec<Measurements<'static>>, PostprocessingError> {
    let (name, series, n_blades) = (query.name, query.series, query.definition.n_blades);
    let per_blade = |what: BladeChannel| {
        let names = what.at(name, n_blades);
        names.iter().map(|name| column(series, name)).collect::<Result<Vec<_>, _>>()
    };
    let times = column(series, &TIME.name)?;
    let azimuth = column(series, &AZIMUTH.at(name))?;
    let rotor_speed = column(series, &ROT_SPEED.at(name))?;
    let (pitch, flap) = (per_blade(BLD_PITCH)?, per_blade(ROOT_MYC)?);
    let measurements = |row: usize| Measurements {
        time: times[row],
        interval,
        azimuth: azimuth[row],
        rotor_speed: rotor_speed[row],
        generator_speed: rotor_speed[row],
        pitch: PerBlade::from_fn(n_blades, |blade| pitch[blade][row]),
        flap_moments: PerBlade::from_fn(n_blades, |blade| flap[blade][row]),
        ..Measurements::at_rest(n_blades)
    };
    Ok((0..times.len()).map(measurements).collect())
}
