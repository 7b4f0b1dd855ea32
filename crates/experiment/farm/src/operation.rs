//! Whether the mean wind of a case is one in which its turbines work.

use crate::assemble::TurbineModel;
use crate::case::{Case, Change, Control, WindEvent};
use crate::plan::{Plan, PlanError};
use crate::wind::profile;

const FIX: &str =
    "take another speed, or another turbine: a turbine file states both speeds under [operation]";

/// Nothing when the mean wind at the hub of every turbine of `case` lies between its cut-in and cut-out wind
/// speeds, where its `models` state them, before and after a lasting change. What comes and goes, gusts and
/// turbulence, may lead beyond. `recorded` is the key of the file that the wind comes from, if
/// it does, and its mean speed at hub height (m/s).
///
/// # Errors
/// [`PlanError::NotInOperation`].
pub fn check_operation(
    case: &Case,
    plan: &Plan,
    models: &[TurbineModel],
    recorded: Option<(&'static str, f64)>,
) -> Result<(), PlanError> {
    let (speed, profile) = (case.wind.speed, profile(case, plan));
    let mut winds = vec![(format!("wind.speed = {speed} m/s"), "speed", speed)];
    if let Some((key, speed)) = recorded {
        winds.push((format!("the file of wind.{key}, with {speed} m/s,"), key, speed));
    }
    if let Some(last) = last_speed(case) {
        winds.push((format!("wind.event, which leads to {last} m/s,"), "event", last));
    }
    for (index, (placement, model)) in case.turbines.iter().zip(models).enumerate() {
        let Some(operation) = model.definition.operation else { continue };
        let is_there =
            case.runs.iter().any(|run| run.control.get(index).is_some_and(Control::is_there));
        if !is_there {
            continue;
        }
        // The profile keeps its form when its speed changes.
        let share = profile.speed(model.definition.rotor.hub_height) / speed;
        for (what, key, wind) in &winds {
            let at_hub = share * wind;
            if !(operation.cut_in..=operation.cut_out).contains(&at_hub) {
                return Err(PlanError::NotInOperation {
                    what: what.clone(),
                    key,
                    name: placement.name.clone(),
                    speed: at_hub,
                    cut_in: operation.cut_in,
                    cut_out: operation.cut_out,
                    fix: FIX,
                });
            }
        }
    }
    Ok(())
}

/// Speed at hub height that the event of `case` leads to (m/s); none where none stays.
fn last_speed(case: &Case) -> Option<f64> {
    match case.wind.event? {
        WindEvent::Everywhere(Change::Step { speed, .. } | Change::Ramp { speed, .. }) => {
            Some(speed)
        }
        WindEvent::Everywhere(Change::Staircase { rise, n_steps, .. }) => {
            Some(case.wind.speed + rise * f64::from(n_steps))
        }
        _ => None,
    }
}
