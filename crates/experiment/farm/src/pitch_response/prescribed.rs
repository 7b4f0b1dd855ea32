//! The azimuth offset alone, found in prescribed wind: it belongs to blade, rotor speed and pitch actuator,
//! which momentum theory tells in seconds.

use super::{COUNTED, CalibrationError, Course, IdentificationCost, answers};
use crate::Progress;
use crate::assemble::TurbineModel;
use crate::case::{Case, Solver};
use crate::plan::{Plan, prescribed_step, without_air};
use control::excitation_rate;
use control::meandering::Decoupling;

/// Strouhal number of the helices that tell the azimuth offset of individual pitch control, with the case's
/// wind and the turbine's own diameter (–).
///
/// What that control works against hardly moves in the fixed frame, so they are slow: while one turns once,
/// air passes ten diameters, and the wake follows within about one. Slower ones would tell the same and take
/// longer.
pub const INDIVIDUAL_PITCH_STROUHAL: f64 = 0.1;
/// Cell updates that take about as long as a step of one turbine in prescribed wind (–).
const UPDATES_OF_A_STEP: f64 = 1e4;

/// Cost of [`individual_pitch_offset`].
pub fn individual_pitch_offset_cost(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
) -> IdentificationCost {
    offset_cost(case, plan, model, case.wind.speed, individual_pitch_rate(case, model))
}

/// The azimuth offset (rad) of the individual pitch control of turbine number `index` of `case`, with which
/// tilt pitch answers in the tilt moment alone: in a steady wind of the case's speed, with that control
/// switched off, at [`INDIVIDUAL_PITCH_STROUHAL`]; `progress` receives the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn individual_pitch_offset(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    progress: Progress,
) -> Result<f64, CalibrationError> {
    // It would work against the helices.
    let model = model.clone().without_individual_pitch();
    let rate = individual_pitch_rate(case, &model);
    found_offset(case, plan, &model, index, case.wind.speed, rate, progress)
}

/// Rate of the helices that identify a turbine of `model` for its individual pitch control (rad/s).
fn individual_pitch_rate(case: &Case, model: &TurbineModel) -> f64 {
    let diameter = model.definition.rotor_diameter();
    excitation_rate(INDIVIDUAL_PITCH_STROUHAL, case.wind.speed, diameter)
}

/// The azimuth offset (rad) with which tilt pitch of turbine number `index` of `case` answers in the tilt
/// moment alone, alone in a steady wind of `wind_speed` (m/s) at `rate` (rad/s); in prescribed wind whatever
/// moves the air of the case.
pub(super) fn found_offset(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    wind_speed: f64,
    rate: f64,
    progress: Progress,
) -> Result<f64, CalibrationError> {
    let (case, plan) = in_prescribed_wind(case, plan, model);
    let [counter_clockwise, clockwise] =
        answers(&case, &plan, model, index, wind_speed, rate, progress)?;
    Ok(Decoupling::from_senses(rate, counter_clockwise, clockwise).azimuth_offset)
}

/// Cost of [`found_offset`].
pub(super) fn offset_cost(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    wind_speed: f64,
    rate: f64,
) -> IdentificationCost {
    let (prescribed, steps) = in_prescribed_wind(case, plan, model);
    let course = Course::new(wind_speed, &steps, model, rate, COUNTED);
    let cost = course.cost(&prescribed, &steps, model, 2);
    let of_a_step = if case.flow.solver.resolves_induction { UPDATES_OF_A_STEP } else { 1.0 };
    IdentificationCost { work: of_a_step * cost.work, ..cost }
}

/// `case` and its plan in prescribed wind, the turbines as they are.
fn in_prescribed_wind(case: &Case, plan: &Plan, model: &TurbineModel) -> (Case, Plan) {
    let mut case = case.clone();
    if !case.flow.solver.resolves_induction {
        return (case, plan.clone());
    }
    case.flow.solver = Solver::UNIFORM;
    // That of the case is the lattice's.
    case.flow.step = None;
    let step = prescribed_step(model.rotor_speed(case.wind.speed));
    let plan = without_air(&case, plan.diameter, plan.hub_height, plan.positions.clone(), step);
    (case, plan)
}
