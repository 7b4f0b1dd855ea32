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

/// Induction in the middle of a rotor that its wake has at least of what an endless one has (–), before a
/// reader must know.
const SHARE_TO_WARN: f64 = 0.99;

/// Shortest wake (diameters) with that [share](SHARE_TO_WARN): of a cylinder of vortices from the rotor on,
/// the piece of length L induces L/√(L² + R²) in its middle of what the endless one does.
fn shortest() -> f64 {
    0.5 * SHARE_TO_WARN / (1.0 - SHARE_TO_WARN * SHARE_TO_WARN).sqrt()
}

/// That wakes are too short for the induction at their own rotors, with what they lack of it.
fn of_length(case: &Case) -> Option<String> {
    let length = case.flow.values.number("wake_length_diameters");
    let least = shortest();
    (length < least).then(|| {
        format!(
            "wakes of {length} D are too short for their rotors: of an endless wake's induction they lack {:.0} %, and have some {:.0} % more power for it, at a \
             thrust coefficient of {USUAL_THRUST}; raise flow.wake_length_diameters to {:.1} or more",
            100.0 * (1.0 - length / length.hypot(0.5)),
            100.0 * (in_faster_air(length, USUAL_THRUST).powi(3) - 1.0),
            (10.0 * least).ceil() / 10.0
        )
    })
}

/// That what is analysed begins before wakes have their length.
fn of_spin_up(case: &Case, plan: &Plan) -> Option<String> {
    let grown = plan.n_growing_steps as f64 * plan.interval;
    (plan.n_spin_up_steps < plan.n_growing_steps).then(|| {
        format!(
            "wakes take some {grown:.0} s to grow to their length, and time.spin_up = {} s is shorter: the first of what is analysed has less induction, and more \
             power, than with wakes that stand; raise time.spin_up to {:.0} or more",
            case.time.spin_up,
            // As much again for what left the blades at the start to be gone.
            (1.5 * grown).ceil()
        )
    })
}

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
    warnings.extend(of_length(case));
    warnings.extend(of_spin_up(case, plan));
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
    let is_of_file = case.wind.planes.is_some() || case.wind.table.is_some();
    // What shear a file has is not known here.
    let is_sheared =
        is_of_file || !matches!(shear, Shear::PowerLaw { exponent } if exponent == 0.0);
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
    use crate::case::{Flow, Method, Solver};
    use crate::self_check::Tunnel;
    use crate::solvers::vortex::{KEYS, VORTEX, with_an_end};
    use basis::keys::Values;

    #[test]
    fn the_shortest_wake_lacks_a_hundredth_of_the_induction() {
        let length = shortest();
        assert!((length - 3.509).abs() < 1e-3, "{length}");
        assert!((length / length.hypot(0.5) - SHARE_TO_WARN).abs() < 1e-12);
        // That is about a hundredth of power, too.
        assert!((in_faster_air(length, USUAL_THRUST).powi(3) - 1.01).abs() < 2e-3);
    }

    #[test]
    fn the_check_takes_off_its_own_end_and_not_that_of_the_case() {
        let tunnel = |downstream: f64| Tunnel {
            upstream: 1.0,
            downstream,
            width: 1.0,
            settling: 1.0,
            averaging: 1.0,
            spacing: 0.0,
            interval: 0.1,
            method: Method::default(),
        };
        let expected = |length: f64| {
            let mut values = Values::defaults(&KEYS);
            values.set("wake_length_diameters", length);
            let flow = Flow { solver: Solver(&VORTEX), values, step: None, threads: None };
            with_an_end(&tunnel(length.min(1.0)), &flow, 100.0, USUAL_THRUST)
        };
        // A wake as short as the check's is compared with an endless one as it is.
        assert_eq!((expected(0.3), expected(1.0)), (1.0, 1.0));
        // Of a long one's check what the check cuts off is taken off.
        let endless = in_faster_air(1.0, USUAL_THRUST);
        assert!((expected(40.0) / endless - 1.0).abs() < 2e-4 && endless > 1.02);
    }

    #[test]
    fn what_an_end_adds_to_power_is_what_the_key_says() {
        let excess = |length| 100.0 * (in_faster_air(length, USUAL_THRUST).powi(3) - 1.0);
        for (length, told) in [(2.0, 2.6), (2.5, 1.7), (4.0, 0.7)] {
            assert!((excess(length) - told).abs() < 0.05, "{length} {}", excess(length));
        }
    }
}
