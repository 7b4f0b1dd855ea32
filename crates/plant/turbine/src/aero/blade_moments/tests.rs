//! The reduced model against the full one, and the properties that an estimator relies on.

use super::*;
use crate::aero::induction::{SnelSchepers, TwoConstant};
use crate::aero::rotor::{BemSettings, RotorAerodynamics, RotorKinematics};
use crate::aero::sample::Stiff;
use crate::sample::definition;
use basis::Vector3;

const ROTOR_SPEED: f64 = 1.1;

fn conditions(winds: [f64; 3], pitch: f64) -> Conditions {
    Conditions {
        winds: PerBlade::from_fn(3, |blade| winds[blade]),
        rotor_speed: ROTOR_SPEED,
        pitch: PerBlade::splat(3, pitch),
    }
}

fn model(induction: Induction) -> (Stiff, BladeMoments) {
    let stiff = Stiff::new(definition(), ROTOR_SPEED);
    let elements = stiff.line.elements();
    let moments =
        BladeMoments::new(&stiff.definition, elements, induction, Theory::default(), 1.225);
    (stiff, moments)
}

#[test]
fn the_reduced_model_is_the_rotors() {
    let inductions = [
        Induction::SnelSchepers(SnelSchepers::default()),
        Induction::TwoConstant(TwoConstant::varying()),
    ];
    for induction in inductions {
        let (stiff, model) = model(induction);
        let settings = BemSettings {
            induction,
            theory: Theory::default(),
            skewed_wake: false,
            dynamic_stall: false,
            tower: None,
        };
        let rotor =
            RotorAerodynamics::new(&stiff.definition, stiff.line.elements(), 1.225, settings);
        let (mut state, mut loads) = (rotor.start(), rotor.loads());
        let mut wake = model.settled(&conditions([9.0; 3], 0.0));
        for step in 0..300 {
            let pitch = if step == 0 { 0.0 } else { 0.03 };
            let elements = stiff.motions(0.3 * f64::from(step), pitch);
            let winds = vec![Vector3::X * 9.0; elements.len()];
            let pitches = stiff.pitch(pitch);
            let kinematics =
                RotorKinematics { frame: &stiff.frame, elements: &elements, pitch: &pitches };
            rotor.advance(0.05, &winds, kinematics, &mut state, &mut loads);
            let now = conditions([9.0; 3], pitch);
            if step > 0 {
                model.advance(0.05, &now, &mut wake);
            }
            let got = model.moments(&now, &wake);
            let n = stiff.line.elements().len();
            let expected: f64 = loads.elements[..n]
                .iter()
                .zip(stiff.line.elements())
                .map(|(load, element)| load.force.x * (element.span - 2.0))
                .sum();
            assert!((got[0] / expected - 1.0).abs() < 1e-9, "{induction:?} {step}");
            assert!(
                (got[1] / expected - 1.0).abs() < 1e-6 && (got[2] / expected - 1.0).abs() < 1e-6
            );
        }
    }
}

#[test]
fn each_blade_answers_to_its_own_wind_and_trying_changes_nothing() {
    let (_, model) = model(Induction::SnelSchepers(SnelSchepers::default()));
    let mean = conditions([9.0; 3], 0.0);
    let wake = model.settled(&mean);
    let kept = wake.clone();
    let base = model.moments(&mean, &wake);
    let step = 1e-3;
    for blade in 0..3 {
        let mut winds = [9.0; 3];
        winds[blade] += step;
        let tried = model.moments(&conditions(winds, 0.0), &wake);
        for other in 0..3 {
            let slope = (tried[other] - base[other]) / step;
            if other == blade {
                assert!(slope > 0.1 * base[blade] / 9.0, "{slope}");
            } else {
                assert_eq!(slope, 0.0);
            }
        }
    }
    assert_eq!(wake, kept);
}

#[test]
fn moments_overshoot_after_pitching_and_the_wake_restores_them() {
    let (_, model) = model(Induction::SnelSchepers(SnelSchepers::default()));
    let (before, after) = (conditions([9.0; 3], 0.0), conditions([9.0; 3], 0.04));
    let mut wake = model.settled(&before);
    let at_first = model.moments(&after, &wake)[0];
    for _ in 0..2000 {
        model.advance(0.1, &after, &mut wake);
    }
    let at_last = model.moments(&after, &wake)[0];
    let steady = model.moments(&after, &model.settled(&after))[0];
    assert!((at_last / steady - 1.0).abs() < 1e-6);
    assert!(at_first < at_last && at_last < model.moments(&before, &model.settled(&before))[0]);
}

#[test]
fn slopes_are_those_of_the_moments() {
    let (_, model) = model(Induction::SnelSchepers(SnelSchepers::default()));
    for wind in [4.0, 7.3, 9.0, 13.0] {
        let now = conditions([wind, wind + 0.7, wind - 0.4], 0.02);
        let wake = model.settled(&now);
        let (moments, slopes) = model.moments_with_slopes(&now, &wake);
        assert_eq!(moments, model.moments(&now, &wake));
        // Short enough that hardly any section passes a row of its polar.
        let step = 1e-7;
        for blade in 0..3 {
            let beside = |sign: f64| {
                let mut beside = now;
                beside.winds[blade] += 0.5 * sign * step;
                model.moments(&beside, &wake)[blade]
            };
            let expected = (beside(1.0) - beside(-1.0)) / step;
            assert!((slopes[blade] / expected - 1.0).abs() < 1e-5, "{wind} {blade}");
        }
    }
}

/// Sectors that all hold the same hand it to every blade; one whose tilt differs is met above, not below.
#[test]
fn blades_meet_the_sectors_that_they_stand_in() {
    let (_, model) = model(Induction::SnelSchepers(SnelSchepers::default()));
    let uniform = model.settled(&conditions([9.0; 3], 0.0));
    let mut met = uniform.clone();
    model.meet(&uniform, 1.234, 0.6, &mut met);
    for (met, still) in met.induced.iter().zip(&uniform.induced) {
        assert!((met.normal.velocity - still.normal.velocity).abs() < 1e-12);
    }
    let tilted = model.settled(&conditions([10.0, 8.5, 8.5], 0.0));
    let n_parts = model.parts.len();
    for blade in 0..3 {
        // That blade stands up, where sector 1 is.
        model.meet(&tilted, -blade_azimuth(0.0, blade, 3), 1.0, &mut met);
        for part in 0..n_parts {
            let got = met.induced[blade * n_parts + part].normal.velocity;
            assert!((got - tilted.induced[part].normal.velocity).abs() < 1e-12);
        }
    }
}
