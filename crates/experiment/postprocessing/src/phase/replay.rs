//! An estimator run again over the records of a turbine, and tuned on them.

use super::query::{Query, Records};
use super::{Estimates, PhaseQuestion, Wave, column};
use crate::PostprocessingError;
use crate::error::InRecords;
use analysis::phase::uniform_interval;
use basis::{Measurements, PerBlade};
use control::ControlError;
use control::phase_sync::PhaseEstimator;
use estimation::helix::tuning::{self, Tuned};
use estimation::helix::{HelixOptions, HelixSettings};
use estimation::{EstimationError, HelixEstimator};
use farm::assemble::AssemblyError;

/// Estimate of `estimator` on the records of the turbine, row by row, calibrated as in the run.
pub(super) fn replay(
    query: &Query<'_>,
    estimator: PhaseEstimator,
) -> Result<Estimates, PostprocessingError> {
    let interval = uniform_interval(column(query.series, "time_s")?)?;
    let setting = setting(query, interval);
    let options = options(query, estimator);
    let mut estimator =
        HelixEstimator::new(&query.definition, &setting, options).map_err(not_estimated)?;
    let record = record(query, interval)?;
    let replayed = tuning::replay(&mut estimator, &record, interval).map_err(not_estimated)?;
    let mut estimates = Estimates {
        wind: Vec::new(),
        tilt: Wave::default(),
        yaw: Wave::default(),
        trust: Vec::new(),
    };
    for estimate in replayed {
        estimates.wind.push(estimate.mean_wind);
        for (wave, axis) in
            [(&mut estimates.tilt, estimate.tilt), (&mut estimates.yaw, estimate.yaw)]
        {
            wave.amplitude.push(axis.amplitude);
            wave.phase.push(axis.phase);
        }
        estimates.trust.push(estimate.trust.overall());
    }
    Ok(estimates)
}

/// Noise for the estimator that `question` names, tuned on its record against the true wind.
///
/// Source: van Vondelen et al. (2025), Algorithm 1.
///
/// # Errors
/// As [`phase`](super::phase).
pub fn tune(question: &PhaseQuestion) -> Result<Tuned, PostprocessingError> {
    let mut records = Records::read(question)?;
    let first = records.turbines[0];
    let query = records.query(first)?;
    tuned(question, &query).in_records(&query.path)
}

/// What tuning finds for the turbine of `query`.
fn tuned(question: &PhaseQuestion, query: &Query<'_>) -> Result<Tuned, PostprocessingError> {
    let truth = &query.truth.wind;
    let interval = uniform_interval(column(query.series, "time_s")?)?;
    let from = question.from.unwrap_or(query.case.time.spin_up);
    let whole = record(query, interval)?;
    let (mut measured, mut tilt, mut yaw) = (Vec::new(), Vec::new(), Vec::new());
    for measurements in whole {
        let at = truth.index_at(measurements.time).filter(|at| truth.trusted.contains(at));
        if let (Some(at), true) = (at, measurements.time >= from) {
            measured.push(measurements);
            tilt.push(truth.tilt.wind[at]);
            yaw.push(truth.yaw.wind[at]);
        }
    }
    let estimator = question.estimator.unwrap_or(PhaseEstimator::Robust);
    let options = options(query, estimator);
    let setting = setting(query, interval);
    let tuned = tuning::tune(&query.definition, &setting, options, &measured, [&tilt, &yaw]);
    Ok(tuned.map_err(not_estimated)?)
}

/// Choices of `estimator`, calibrated as in the run, with the noise that it was given there.
fn options(query: &Query<'_>, estimator: PhaseEstimator) -> HelixOptions {
    let options = estimator.options(query.case.flow.solver.resolves_induction);
    let calibration = query.calibration.filter(|_| estimator == PhaseEstimator::Robust);
    let options = calibration.map_or(options, |found| found.apply(options));
    // Noise is given to one estimator; another's states may have other process noise.
    let sync = query.sync.filter(|sync| sync.estimator == estimator);
    sync.map_or(options, |sync| sync.noise.apply(options))
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
    let channel = |what: &str| column(series, &format!("{name}.{what}"));
    let per_blade = |what: &str| {
        (1..=n_blades)
            .map(|blade| channel(&what.replace('#', &blade.to_string())))
            .collect::<Result<Vec<_>, _>>()
    };
    let times = column(series, "time_s")?;
    let azimuth = channel("azimuth_rad")?;
    let rotor_speed = channel("rotor_speed_rad_s")?;
    let (pitch, flap) = (per_blade("pitch_#_rad")?, per_blade("flap_moment_#_nm")?);
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
