//! The step of a lattice: long enough to come to an end, short enough for tips and wind.

use super::{Footprint, LATTICE_SOUND_SPEED, MAXIMUM_LATTICE_SPEED, PlanError};
use crate::case::{Case, Placement};

/// Fastest tip that a chosen step allows, in cells a step, in the mean wind; what a gust adds beyond the
/// speed of sound is warned of after the run.
pub(super) const FASTEST_TIP: f64 = 0.5;
/// Longest step between two control instants (s): pitch actuators and rotor speed are integrated on it.
const LONGEST_STEP: f64 = 0.5;
/// Shortest step over the longest one (–): the wind of a shorter one is lost in the rounding of the lattice,
/// and a run would take more than a hundred times as long as it needs.
const LEAST_SHARE: f64 = 0.01;

/// The step (s) of the finest cells of `case`, in cells of `spacing` (m) with `depth` boxes in one another.
///
/// Cells of half the size make steps of half the length: tips and wind move as many cells a step on all.
///
/// # Errors
/// [`PlanError`] for a step that is too long for tips or wind, or too short for either.
pub(super) fn step(
    case: &Case,
    machines: &[(&Placement, Footprint)],
    spacing: f64,
    depth: u32,
) -> Result<f64, PlanError> {
    let in_one = f64::from(1_u32 << depth);
    let spacing = spacing / in_one;
    let (fastest, tip_speed) = machines
        .iter()
        .map(|(placement, footprint)| (placement, footprint.tip_speed))
        .reduce(|a, b| if b.1 > a.1 { b } else { a })
        .map_or(("", 0.0), |(placement, speed)| (placement.name.as_str(), speed));
    let tip_limit = LATTICE_SOUND_SPEED * spacing / tip_speed;
    let speed_limit = MAXIMUM_LATTICE_SPEED * spacing / case.wind.speed;
    let shortest = LEAST_SHARE * tip_limit.min(speed_limit);
    match case.flow.step {
        Some(step) if step > tip_limit => Err(PlanError::TipOutruns {
            name: fastest.to_owned(),
            step,
            cells: step * tip_speed / spacing,
            tip_speed,
            longest: tip_limit,
        }),
        Some(step) if step > speed_limit => Err(PlanError::TooFast {
            step,
            cells: case.wind.speed * step / spacing,
            longest: speed_limit,
        }),
        Some(step) if step < shortest => {
            let cells = case.wind.speed * step / spacing;
            Err(PlanError::TooSlow { step, cells, shortest })
        }
        Some(step) => Ok(step),
        None => {
            let safe = FASTEST_TIP * spacing / tip_speed;
            let longest = safe.min(speed_limit).min(LONGEST_STEP);
            // A minute is a whole number of the longest steps, too.
            Ok(60.0 / (60.0 / (longest * in_one)).ceil() / in_one)
        }
    }
}
