//! What a reader of the numbers must know of free wakes as a case has them.

use super::{in_faster_air, of_all, turning};
use crate::case::{Case, Shear};
use crate::plan::Plan;

/// Angle by which a rotor turns in a step beyond which a reader must know (rad).
const TURN_TO_WARN: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// Core at birth over the width of the blade elements next to it, below which a reader must know (–): of a
/// vortex with the circulation Γ of a sheet's strip of width w the fastest velocity is Γ/(2√2 π r), that of
/// the sheet Γ/2w, and they are equal at r/w = 1/(√2 π).
const NARROWEST: f64 = std::f64::consts::FRAC_1_SQRT_2 * std::f64::consts::FRAC_1_PI;
/// Length of a wake beyond which a reader must know what it is not (diameters).
const LENGTH_TO_WARN: f64 = 8.0;
/// Thrust coefficient of a turbine below its rated wind (–), and what a wake's end may add to its power
/// before a reader must know (–).
const USUAL_THRUST: f64 = 0.75;
const POWER_TO_WARN: f64 = 0.01;

/// What the end of the wake of turbine number `index` adds to its power (–), by the same state of the rotor
/// at [`USUAL_THRUST`] and one power coefficient in slower and faster air; nothing where the wake is not
/// ended early.
fn power_by_ending(case: &Case, plan: &Plan, index: usize) -> Option<f64> {
    case.flow.values.optional_number("wake_beyond_last_diameters")?;
    let resolution = of_all(case, plan).resolution;
    let length = resolution.length_behind(plan.positions[index].x);
    let is_ended = length < resolution.length;
    is_ended.then(|| in_faster_air(length / plan.diameter, USUAL_THRUST).powi(3) - 1.0)
}

pub(super) fn warnings(case: &Case, plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::new();
    let turn = plan.turn.to_degrees();
    if plan.turn > TURN_TO_WARN {
        warnings.push(format!(
            "a rotor turns by {turn:.0}° in a step: its wake is a polygon more than a helix; lower flow.step or raise flow.steps_per_turn"
        ));
    }
    let widths = case.flow.values.number("core_widths");
    if widths < NARROWEST {
        warnings.push(format!(
            "cores of {widths} element widths: beside its core each trailing vortex is felt more than the sheet that it stands for, which then rolls up by chance; raise flow.core_widths to {NARROWEST:.2} or more"
        ));
    }
    for (index, turbine) in case.turbines.iter().enumerate() {
        let excess = power_by_ending(case, plan, index).filter(|excess| *excess > POWER_TO_WARN);
        let Some(excess) = excess else { continue };
        warnings.push(format!(
            "the wake of {} ends early: it has some {:.1} % more power than with an endless one, at a thrust coefficient of {USUAL_THRUST}; raise flow.wake_beyond_last_diameters where its power itself is asked for",
            turbine.name,
            100.0 * excess
        ));
    }
    let shear = case.wind.shear;
    let is_sheared = !matches!(shear, Shear::PowerLaw { exponent } if exponent == 0.0);
    if case.flow.values.word("wake_shear") == "carried" && is_sheared {
        warnings.push(
            "sheared wind carries wakes faster above than below, so that they rise, by half a diameter in four at an exponent of 0.2: wakes in air rise by a fifth of that; take flow.wake_shear = \"left-out\"".to_owned(),
        );
    }
    let length = turning(case).longest(&plan.positions, plan.diameter);
    if length > LENGTH_TO_WARN {
        warnings.push(format!(
            "wakes of {length:.1} diameters: free vortices do not break down as a wake does beyond some 4 diameters, for they know no eddies smaller than themselves; take flow.solver = \"lattice\" for the far wake"
        ));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_end_adds_to_power_is_what_the_key_says() {
        let excess = |length| 100.0 * (in_faster_air(length, USUAL_THRUST).powi(3) - 1.0);
        for (length, told) in [(2.0, 2.6), (2.5, 1.7), (4.0, 0.7)] {
            assert!((excess(length) - told).abs() < 0.05, "{length} {}", excess(length));
        }
    }
}
