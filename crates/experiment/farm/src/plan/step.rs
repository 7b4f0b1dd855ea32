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

/// The step (s) of `case` on cells of `spacing` (m).
///
/// # Errors
/// [`PlanError`] for a step that is too long for tips or wind, or too short for either.
pub(super) fn step(
    case: &Case,
    machines: &[(&Placement, Footprint)],
    spacing: f64,
) -> Result<f64, PlanError> {
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
            Ok(60.0 / (60.0 / longest).ceil())
        }
    }
}
