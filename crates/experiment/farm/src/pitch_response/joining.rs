//! What a turbine that joins a helix is told of its own pitch: its azimuth offset, and what its phase estimator makes of it.

use super::{
    COUNTED, CalibrationError, Course, Pitching, ProbeCost, WAKE_SPEED, answers, pitching,
};
use crate::Progress;
use crate::assemble::{self, Model};
use crate::case::{Case, Decoupling, PhaseEstimator, PhaseSync, Solver};
use crate::plan::{Plan, without_air};
use control::excitation_rate;
use estimation::helix::{Calibration, calibrate};
use std::f64::consts::TAU;

/// Excitation periods for the filter to settle once the near wake has, and counted after them (–).
const PERIODS: [f64; 2] = [2.0, 2.0];
/// Cell updates that take about as long as a step of one turbine in prescribed wind (–).
const UPDATES_OF_A_STEP: f64 = 1e4;

/// What a turbine that joins a helix is told of its own pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPitch {
    /// Azimuth offset of the inverse multi-blade transformation with which it pitches (rad).
    pub azimuth_offset: f64,
    /// What its estimator makes of the pitch; none of one that is not calibrated.
    pub calibration: Option<Calibration>,
}

/// Cost of [`own_pitch`].
pub fn own_pitch_cost(case: &Case, plan: &Plan, model: &Model, sync: &PhaseSync) -> ProbeCost {
    let [offset, calibration] = costs(case, plan, model, sync);
    ProbeCost {
        n_steps: offset.n_steps + calibration.n_steps,
        work: offset.work + calibration.work,
    }
}

/// Costs of the azimuth offset and of the calibration, nothing for what is not sought.
fn costs(case: &Case, plan: &Plan, model: &Model, sync: &PhaseSync) -> [ProbeCost; 2] {
    let rate = excitation_rate(sync.strouhal, case.wind.speed, plan.diameter);
    let wind_speed = WAKE_SPEED * case.wind.speed;
    let mut costs = [ProbeCost::default(); 2];
    if sync.azimuth_offset.is_none() {
        let (prescribed, steps) = in_prescribed_wind(case, plan);
        let course = Course::new(wind_speed, &steps, model, rate, COUNTED);
        let cost = course.cost(&prescribed, &steps, model, 2);
        let of_a_step = if case.flow.solver.is_prescribed() { 1.0 } else { UPDATES_OF_A_STEP };
        costs[0] = ProbeCost { work: of_a_step * cost.work, ..cost };
    }
    if sync.estimator == PhaseEstimator::Robust {
        let course = Course::new(wind_speed, plan, model, rate, PERIODS[0] + PERIODS[1]);
        costs[1] = course.cost(case, plan, model, 1);
    }
    costs
}

/// What `sync` on turbine number `index` of `case` is told of its own pitch: the azimuth offset that is given, or else found,
/// and with it the calibration of a robust estimator; `progress` is told the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn own_pitch(
    case: &Case,
    plan: &Plan,
    model: &Model,
    index: usize,
    sync: &PhaseSync,
    progress: Progress,
) -> Result<OwnPitch, CalibrationError> {
    let [first, second] = costs(case, plan, model, sync).map(|cost| cost.work);
    let share_of_first = first / (first + second);
    let azimuth_offset = match sync.azimuth_offset {
        Some(given) => given,
        None => {
            let mut told = |share: f64| progress(share_of_first * share);
            found_offset(case, plan, model, index, sync, &mut told)?
        }
    };
    let calibration = match sync.estimator {
        PhaseEstimator::Published => None,
        PhaseEstimator::Robust => {
            let mut told = |share: f64| progress(share_of_first + (1.0 - share_of_first) * share);
            let found = calibration(case, plan, model, index, sync, azimuth_offset, &mut told);
            Some(found?)
        }
    };
    Ok(OwnPitch { azimuth_offset, calibration })
}

/// The azimuth offset (rad) with which tilt pitch of turbine number `index` of `case` answers in the tilt moment alone, at the
/// rate of the helix that `sync` joins.
///
/// The turbine stands as in [`calibration`], in prescribed wind whatever moves the air of the case: an offset belongs to
/// blade, rotor speed and pitch actuator, which momentum theory tells in a second.
fn found_offset(
    case: &Case,
    plan: &Plan,
    model: &Model,
    index: usize,
    sync: &PhaseSync,
    progress: Progress,
) -> Result<f64, CalibrationError> {
    let rate = excitation_rate(sync.strouhal, case.wind.speed, plan.diameter);
    let wind_speed = WAKE_SPEED * case.wind.speed;
    let (case, plan) = in_prescribed_wind(case, plan);
    let [counter_clockwise, clockwise] =
        answers(&case, &plan, model, index, wind_speed, rate, progress)?;
    Ok(Decoupling::from_senses(rate, counter_clockwise, clockwise).azimuth_offset)
}

/// `case` and its plan in prescribed wind, the turbines as they are.
fn in_prescribed_wind(case: &Case, plan: &Plan) -> (Case, Plan) {
    let mut case = case.clone();
    if case.flow.solver.is_prescribed() {
        return (case, plan.clone());
    }
    case.flow.solver = Solver::Uniform;
    // That of the case is the lattice's.
    case.flow.step = None;
    let plan = without_air(&case, plan.diameter, plan.hub_height, plan.positions.clone());
    (case, plan)
}

/// Calibrates the estimator of `sync` on turbine number `index` of `case`: gain and azimuth offset of its own pitch.
///
/// The turbine stands alone in a steady wind of three quarters of the case's, on the grid of `plan` or in prescribed wind
/// as the case has it, with perfect instruments, and pitches the helix that it shall pitch, with the `azimuth_offset` (rad)
/// with which it shall; `progress` is told the share done.
fn calibration(
    case: &Case,
    plan: &Plan,
    model: &Model,
    index: usize,
    sync: &PhaseSync,
    azimuth_offset: f64,
    progress: Progress,
) -> Result<Calibration, CalibrationError> {
    let pitch = Pitching {
        wind_speed: WAKE_SPEED * case.wind.speed,
        rate: excitation_rate(sync.strouhal, case.wind.speed, plan.diameter),
        sense: sync.sense,
        amplitude: sync.amplitude,
        azimuth_offset,
        periods: PERIODS[0] + PERIODS[1],
    };
    let record = pitching(case, plan, model, index, &pitch, progress)?;
    let setting = assemble::estimator_setting(sync, case, plan);
    let options = assemble::estimator_options(PhaseEstimator::Robust, case.flow.solver);
    let options = sync.noise.apply(options);
    let settling = PERIODS[0] * TAU / setting.rate;
    Ok(calibrate(&model.definition, &setting, options, &record, settling)?)
}
