//! What the walls of a domain do to the rotors in it, and to the wind that has to blow in.

use crate::case::{Blockage, Case};
use crate::plan::Plan;
use crate::solvers::WindSource;
use turbine::blockage::equivalent_speed_ratio;

/// Thrust coefficient of a rotor below its rated wind (–), for the effect of walls.
const USUAL_THRUST: f64 = 0.8;

/// Wind that blows in over the case's (–): one, or less where the case asks for a correction of blockage.
pub fn inflow_share(case: &Case, plan: &Plan) -> f64 {
    let is_corrected = case.wind_source() == WindSource::AtInlet
        && case.flow.domain().blockage == Blockage::Corrected;
    if is_corrected { 1.0 / equivalent_speed_ratio(USUAL_THRUST, plan.blockage) } else { 1.0 }
}

/// Rise of a rotor's power (–) that the walls of `plan` leave, over that in open air of the case's wind.
pub fn wall_gain(case: &Case, plan: &Plan) -> f64 {
    let ratio = equivalent_speed_ratio(USUAL_THRUST, plan.blockage) * inflow_share(case, plan);
    ratio.powi(3) - 1.0
}
