//! The step of a free wake: so many to a turn of the fastest rotor.

use super::{Layout, Plan, PlanError, without_cells};
use crate::case::Case;
use std::f64::consts::TAU;

/// Farthest that a rotor may turn in a step (rad).
const FARTHEST: f64 = TAU / 8.0;

/// The plan of turbines in air without cells whose step follows the fastest rotor: `steps_per_turn` (–) of
/// them, unless the case gives the step; a minute is a whole number of them.
///
/// # Errors
/// [`PlanError::TurnsTooFar`] for a step in which a rotor turns too far.
pub fn by_turns(case: &Case, layout: &Layout, steps_per_turn: f64) -> Result<Plan, PlanError> {
    let rate = |footprint: &super::Footprint| footprint.tip_speed / (0.5 * footprint.diameter);
    let rates = layout.machines.iter().map(|(placement, footprint)| (placement, rate(footprint)));
    let (name, fastest) = rates
        .reduce(|a, b| if b.1 > a.1 { b } else { a })
        .map_or(("", 0.0), |(placement, rate)| (placement.name.as_str(), rate));
    let step = match case.flow.step {
        Some(step) => step,
        None => 60.0 / (60.0 * fastest * steps_per_turn / TAU).ceil().max(1.0),
    };
    let turn = fastest * step;
    if turn > FARTHEST {
        return Err(PlanError::TurnsTooFar {
            name: name.to_owned(),
            step,
            turn_deg: turn.to_degrees(),
            most_deg: FARTHEST.to_degrees(),
            longest: FARTHEST / fastest,
        });
    }
    let mut stepped = case.clone();
    stepped.flow.step = Some(step);
    Ok(Plan { turn, ..without_cells(&stepped, layout)? })
}
