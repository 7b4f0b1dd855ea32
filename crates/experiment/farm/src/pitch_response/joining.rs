//! Pitch response given to a turbine that joins a helix: its azimuth offset, and the calibration of its phase
//! estimator.

use super::prescribed::{found_offset, offset_cost};
use super::{CalibrationError, Course, IdentificationCost, Pitching, WAKE_SPEED, pitching};
use crate::Progress;
use crate::assemble::{self, TurbineModel};
use crate::case::Case;
use crate::plan::Plan;
use basis::Truth;
use control::excitation_rate;
use control::phase_sync::{PhaseEstimator, PhaseSyncSettings};
use estimation::helix::{Calibration, calibrate};
use std::f64::consts::TAU;

/// Excitation periods for the filter to settle once the near wake has, and counted after them (–).
const PERIODS: [f64; 2] = [2.0, 2.0];

/// Pitch response given to a turbine that joins a helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPitch {
    /// Azimuth offset of the inverse multi-blade transformation with which it pitches (rad).
    pub azimuth_offset: f64,
    /// What its estimator makes of the pitch; none of one that is not calibrated.
    pub calibration: Option<Calibration>,
}

/// Cost of [`own_pitch`].
pub fn own_pitch_cost(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    sync: &PhaseSyncSettings,
) -> IdentificationCost {
    let [offset, calibration] = costs(case, plan, model, sync);
    IdentificationCost {
        n_steps: offset.n_steps + calibration.n_steps,
        work: offset.work + calibration.work,
    }
}

/// Wind (m/s) in which the turbine is identified, and rate of the helix that it joins (rad/s).
fn conditions(case: &Case, plan: &Plan, sync: &PhaseSyncSettings) -> (f64, f64) {
    let rate = excitation_rate(sync.strouhal, case.wind.speed, plan.diameter);
    (WAKE_SPEED * case.wind.speed, rate)
}

/// Costs of the azimuth offset and of the calibration, zero for what is not needed.
fn costs(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    sync: &PhaseSyncSettings,
) -> [IdentificationCost; 2] {
    let (wind_speed, rate) = conditions(case, plan, sync);
    let mut costs = [IdentificationCost::default(); 2];
    if sync.azimuth_offset.is_none() {
        costs[0] = offset_cost(case, plan, model, wind_speed, rate);
    }
    if sync.estimator == PhaseEstimator::Robust {
        let course = Course::new(wind_speed, plan, model, rate, PERIODS[0] + PERIODS[1]);
        costs[1] = course.cost(case, plan, model, 1);
    }
    costs
}

/// Pitch response for `sync` on turbine number `index` of `case`: the azimuth offset, given or else
/// identified, and with it the calibration of a robust estimator; `progress` receives the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn own_pitch(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    sync: &PhaseSyncSettings,
    progress: Progress,
) -> Result<OwnPitch, CalibrationError> {
    let [first, second] = costs(case, plan, model, sync).map(|cost| cost.work);
    let share_of_first = first / (first + second);
    let azimuth_offset = match sync.azimuth_offset {
        Some(given) => given,
        None => {
            let (wind_speed, rate) = conditions(case, plan, sync);
            let mut report = |share: f64| progress(share_of_first * share);
            found_offset(case, plan, model, index, wind_speed, rate, &mut report)?
        }
    };
    let calibration = match sync.estimator {
        PhaseEstimator::Published | PhaseEstimator::PublishedWithOffset => None,
        PhaseEstimator::Robust => {
            let mut report = |share: f64| progress(share_of_first + (1.0 - share_of_first) * share);
            let found = calibration(case, plan, model, index, sync, azimuth_offset, &mut report);
            Some(found?)
        }
    };
    Ok(OwnPitch { azimuth_offset, calibration })
}

/// Calibrates the estimator of `sync` on turbine number `index` of `case`: gain and azimuth offset of its own
/// pitch.
///
/// The turbine stands alone in a steady wind of three quarters of the case's, on the grid of `plan` or in
/// prescribed wind as the case has it, with perfect instruments, and pitches the helix that it shall pitch,
/// with the `azimuth_offset` (rad) with which it shall; `progress` receives the share done.
fn calibration(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    sync: &PhaseSyncSettings,
    azimuth_offset: f64,
    progress: Progress,
) -> Result<Calibration, CalibrationError> {
    let (wind_speed, rate) = conditions(case, plan, sync);
    let pitch = Pitching {
        wind_speed,
        rate,
        sense: sync.sense,
        amplitude: sync.amplitude,
        azimuth_offset,
        periods: PERIODS[0] + PERIODS[1],
    };
    let record = pitching(case, plan, model, index, &pitch, progress)?;
    let record: Vec<_> = record.iter().map(Truth::measured).collect();
    let site = assemble::site(model, case, plan);
    let setting = sync.estimator_setting(&site);
    let options = sync.estimator_options(site.flow_resolves_induction);
    let settling = PERIODS[0] * TAU / setting.rate;
    Ok(calibrate(&model.definition, &setting, options, &record, settling)?)
}
