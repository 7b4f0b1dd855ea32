//! The step of a free wake: so many to a turn of the fastest rotor.

use super::{Footprint, Layout, Plan, PlanError, check_planes, without_cells};
use crate::case::Case;
use basis::Vector3;
use flow::vortex::FARTHEST_TURN;
use std::f64::consts::TAU;

/// Air of planes and volumes upstream of the foremost turbine, to either side of the outermost ones, and
/// above the highest hub (diameters).
const UPSTREAM: f64 = 2.0;
const BESIDE: f64 = 1.5;
const ABOVE: f64 = 1.5;

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
    let (_, fastest) = fastest(layout, |footprint| footprint.tip_speed);
    let step = match case.flow.step {
        Some(step) => step,
        None => 60.0 / (60.0 * fastest * turning.steps_per_turn / TAU).ceil().max(1.0),
    };
    let turn = farthest_turn(case, layout, turning, step)?;
    let mut stepped = case.clone();
    stepped.flow.step = Some(step);
    let plan = shown(without_cells(&stepped, layout)?, layout, turning);
    check_planes(&case.output.crosswind_diameters, &plan)?;
    let longest = turning.longest(&plan.positions, plan.diameter) * plan.diameter;
    let n_growing_steps = (longest / (turning.wake_speed * step)).ceil() as u64;
    Ok(Plan { turn, n_growing_steps, ..plan })
}

/// The fastest rotor of `layout` whose tips have the speed that `tip_speed` gives, by its turbine's name, and
/// how fast it turns (rad/s).
fn fastest<'a>(layout: &Layout<'a>, tip_speed: impl Fn(&Footprint) -> f64) -> (&'a str, f64) {
    let rate = |one: &Footprint| tip_speed(one) / (0.5 * one.diameter);
    let rates = layout.machines.iter().map(|(placement, one)| (*placement, rate(one)));
    let fastest = rates.reduce(|a, b| if b.1 > a.1 { b } else { a });
    fastest.map_or(("", 0.0), |(placement, rate)| (placement.name.as_str(), rate))
}

/// Angle (rad) by which a rotor of `layout` turns in a `step` (s): in the mean wind, or at its rated speed
/// where the wind varies and may bring it there.
///
/// # Errors
/// [`PlanError::TurnsTooFar`].
fn farthest_turn(
    case: &Case,
    layout: &Layout,
    turning: &Turning,
    step: f64,
) -> Result<f64, PlanError> {
    let varies = case.wind.varies();
    let in_mean_wind = fastest(layout, |footprint| footprint.tip_speed);
    let at_most = |one: &Footprint| one.tip_speed.max(one.rated_tip_speed);
    let (name, rate) = if varies { fastest(layout, at_most) } else { in_mean_wind };
    let turn = rate * step;
    if turn <= FARTHEST_TURN {
        return Ok(turn);
    }
    let [turn_deg, most_deg] = [turn, FARTHEST_TURN].map(f64::to_degrees);
    let (is_given, per_turn) = (case.flow.step.is_some(), turning.steps_per_turn);
    let what = if is_given {
        format!("flow.step = {step} s is too long")
    } else {
        format!("flow.steps_per_turn = {per_turn} is too few")
    };
    let fix = if is_given {
        // Rounded down, so that what is printed can be taken.
        format!(
            "use at most {:.4} s, or leave the key out",
            (1e4 * FARTHEST_TURN / rate).floor() / 1e4
        )
    } else {
        let least = TAU / FARTHEST_TURN * rate / in_mean_wind.1;
        format!("use {:.0} or more", least.ceil())
    };
    let when = if varies {
        "at its rated speed, which this wind may bring it to"
    } else {
        "in the mean wind"
    };
    let key = if is_given { "step" } else { "steps_per_turn" };
    Err(PlanError::TurnsTooFar { name: name.to_owned(), key, what, turn_deg, when, most_deg, fix })
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
