//! The step of a free wake: so many to a turn of the fastest rotor.

use super::{Layout, Plan, PlanError, check_planes, without_cells};
use crate::case::Case;
use basis::Vector3;
use std::f64::consts::TAU;

/// Air of planes and volumes upstream of the foremost turbine, to either side of the outermost ones, and
/// above the highest hub (diameters).
const UPSTREAM: f64 = 2.0;
const BESIDE: f64 = 1.5;
const ABOVE: f64 = 1.5;

/// Farthest that a rotor may turn in a step (rad).
const FARTHEST: f64 = TAU / 8.0;

/// Numbers from which the plan of a free wake follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Steps to a turn of the fastest rotor (–), unless the case gives the step.
    pub steps_per_turn: f64,
    /// Points of planes and volumes to a diameter of the first turbine (–).
    pub points_per_diameter: f64,
    /// Length of wakes (diameters of the first turbine).
    pub length: f64,
    /// How far they reach behind the last turbine, no further than that (diameters of the first turbine):
    /// planes and volumes show it.
    pub beyond_last: f64,
    /// Usual speed of a wake (m/s).
    pub wake_speed: f64,
}

impl Turning {
    /// Length of the longest wake (diameters), that of the first of turbines at `positions` (m), where
    /// lengths are given in a `diameter` (m).
    pub fn longest(&self, positions: &[Vector3], diameter: f64) -> f64 {
        let places = || positions.iter().map(|position| position.x);
        let first = places().reduce(f64::min).unwrap_or_default();
        let last = places().reduce(f64::max).unwrap_or_default();
        self.length.min((last - first) / diameter + self.beyond_last)
    }
}

/// The plan of turbines in air without cells whose step follows the fastest rotor; a minute is a whole number
/// of steps.
///
/// # Errors
/// [`PlanError::TurnsTooFar`] for a step in which a rotor turns too far, and those of planes.
pub fn by_turns(case: &Case, layout: &Layout, turning: &Turning) -> Result<Plan, PlanError> {
    let rate = |footprint: &super::Footprint| footprint.tip_speed / (0.5 * footprint.diameter);
    let rates = layout.machines.iter().map(|(placement, footprint)| (placement, rate(footprint)));
    let (name, fastest) = rates
        .reduce(|a, b| if b.1 > a.1 { b } else { a })
        .map_or(("", 0.0), |(placement, rate)| (placement.name.as_str(), rate));
    let step = match case.flow.step {
        Some(step) => step,
        None => 60.0 / (60.0 * fastest * turning.steps_per_turn / TAU).ceil().max(1.0),
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
    let plan = shown(without_cells(&stepped, layout)?, layout, turning);
    check_planes(&case.output.crosswind_diameters, &plan)?;
    let longest = turning.longest(&plan.positions, plan.diameter) * plan.diameter;
    let n_growing_steps = (longest / (turning.wake_speed * step)).ceil() as u64;
    Ok(Plan { turn, n_growing_steps, ..plan })
}

/// `plan` with the points of planes and volumes about the turbines of `layout` and their wakes.
fn shown(plan: Plan, layout: &Layout, turning: &Turning) -> Plan {
    let (diameter, spacing) = (plan.diameter, plan.diameter / turning.points_per_diameter);
    let low = plan.positions.iter().copied().reduce(Vector3::min).unwrap_or_default();
    let high = plan.positions.iter().copied().reduce(Vector3::max).unwrap_or_default();
    let hub = layout.machines.iter().map(|(_, footprint)| footprint.hub_height).fold(0.0, f64::max);
    let extent = [
        high.x - low.x + (UPSTREAM + turning.beyond_last) * diameter,
        high.y - low.y + 2.0 * BESIDE * diameter,
        hub + ABOVE * diameter,
    ];
    let n_points = extent.map(|length| (length / spacing).round().max(1.0) as usize);
    let width = n_points[1] as f64 * spacing;
    let y = 0.5 * (low.y + high.y) - 0.5 * width;
    let origin = Vector3::new(low.x - UPSTREAM * diameter, y, 0.0);
    Plan { origin, spacing, n_points, ..plan }
}
