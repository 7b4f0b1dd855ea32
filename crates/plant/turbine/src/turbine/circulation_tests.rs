//! Bound vortices that go with the forces on the air: Kutta-Joukowski, order, bodies.

use super::aerodynamics::Aerodynamics;
use super::tests::{DENSITY, built, by_flow, commands};
use super::*;
use crate::actuator_line::{Load, Onset, QuasiSteady};
use crate::aero::blade_element::Theory;
use crate::aero::induction::TwoConstant;
use crate::aero::rotor;
use crate::aero::tower_influence::{Effects, Potential, TowerInfluence};
use crate::motion::ElementMotion;
use crate::rotor::BladeFrame;

/// Short, so that blades stand where they stood when their wind was sampled.
const INSTANT: f64 = 1e-3;
/// The rotor turns by 1.3e-3 rad in an instant, and loads are those of its middle (–).
const TOLERANCE: f64 = 2e-3;

/// A rotor after an instant in an even wind, as it stood before, and the wind relative to each element as its
/// section felt it (m/s).
fn after_an_instant(induction: Induction) -> (Turbine, Turbine, Vec<Vector3>) {
    let mut turbine = built(false, induction);
    let before = turbine.clone();
    let wind = Vector3::new(9.0, 0.5, 0.0);
    turbine.advance(INSTANT, &vec![wind; before.stations().len()], &commands(0.02));
    let felt = motions_now(&before).into_iter().enumerate().map(|(index, motion)| {
        let BladeFrame { normal, tangent, .. } = motion.axes;
        match &turbine.aerodynamics {
            Aerodynamics::Line(_) => {
                let [axial, along_rotation] = turbine.state.smearing_corrections()[index];
                wind - motion.velocity + normal * axial + tangent * along_rotation
            }
            Aerodynamics::Momentum(pair) => {
                let flow = &pair.1.flows[index];
                normal * (flow.onset.normal - flow.induced_normal)
                    - tangent * (flow.onset.tangential + flow.induced_tangential)
            }
        }
    });
    let felt = felt.collect();
    (turbine, before, felt)
}

/// How the blade elements of `turbine` move now.
fn motions_now(turbine: &Turbine) -> Vec<ElementMotion> {
    let mut motions = turbine.workspace.motions.clone();
    turbine.structure.observe(0.0, &turbine.pitch_now(), &mut motions);
    motions
}

fn obeys_kutta_joukowski(induction: Induction) {
    let (turbine, before, felt) = after_an_instant(induction);
    let mut greatest = 0.0_f64;
    for (index, wind) in felt.iter().enumerate() {
        let force = turbine.forces()[index];
        let bound = force.bound.expect("an element has a bound vortex");
        assert_eq!((bound.blade, bound.station), (index / N_ELEMENTS, index % N_ELEMENTS));
        assert_eq!(force.position, before.stations()[index]);
        let span = before.workspace.axes[index].span;
        let width = turbine.line.elements()[bound.station].width;
        assert!((bound.along - span * width).length() < 1e-12 * width);
        // Across the wind and the span all of the force is lift; sign included.
        let wind = *wind - span * wind.dot(span);
        let across = wind.cross(span).normalize();
        let lift = -DENSITY * bound.circulation * wind.cross(bound.along);
        let found = force.force.dot(across);
        let scale = force.force.length();
        assert!((found - lift.dot(across)).abs() < TOLERANCE * scale, "{index} {found} {lift}");
        // What is left is drag: with the wind it pulls the blade along, and holds the air back.
        let drag = force.force - lift;
        assert!(
            drag.dot(wind) < 0.0 && drag.cross(wind).length() < TOLERANCE * scale * wind.length()
        );
        greatest = greatest.max(bound.circulation);
    }
    // Chords of some metres at tens of metres a second.
    assert!((10.0..100.0).contains(&greatest), "{greatest}");
}

#[test]
fn circulation_and_wind_make_the_lift_along_lines() {
    obeys_kutta_joukowski(by_flow(false));
}

#[test]
fn circulation_and_wind_make_the_lift_under_momentum_theory() {
    obeys_kutta_joukowski(Induction::ByMomentum(rotor::BemSettings {
        induction: crate::aero::Induction::TwoConstant(TwoConstant::varying()),
        theory: Theory::default(),
        skewed_wake: true,
        dynamic_stall: true,
        tower: None,
    }));
}

#[test]
fn bodies_have_no_circulation_and_come_last() {
    let (turbine, ..) = after_an_instant(by_flow(false));
    let (elements, bodies) = turbine.forces().split_at(3 * N_ELEMENTS);
    assert!(elements.iter().all(|force| force.bound.is_some()));
    assert!(bodies.len() > 1 && bodies.iter().all(|force| force.bound.is_none()));
}

#[test]
fn circulation_is_the_mean_over_the_steps_of_an_interval() {
    let mut long = built(false, by_flow(false));
    let mut short = long.clone();
    let winds = vec![Vector3::X * 9.0; long.stations().len()];
    // Four structural steps, the wind held.
    long.advance(4.0 * LONGEST_STRUCTURAL_STEP, &winds, &commands(0.0));
    let circulation = |turbine: &Turbine| {
        let bound = |force: &PointForce| force.bound.map(|bound| bound.circulation);
        turbine.forces().iter().filter_map(bound).collect::<Vec<f64>>()
    };
    short.advance(LONGEST_STRUCTURAL_STEP, &winds, &commands(0.0));
    for (mean, first) in circulation(&long).iter().zip(circulation(&short)) {
        // A rotor that turns by a tenth of a radian in the same wind.
        assert!((mean / first - 1.0).abs() < 0.1, "{mean} {first}");
    }
}

#[test]
fn without_bound_vortices_all_else_is_the_same() {
    let momentum = Induction::ByMomentum(rotor::BemSettings {
        induction: crate::aero::Induction::QuasiSteady,
        theory: Theory::default(),
        skewed_wake: false,
        dynamic_stall: true,
        tower: None,
    });
    for induction in [by_flow(true), momentum] {
        let mut with = built(true, induction);
        let mut without = with.clone().without_bound_vortices();
        let winds = vec![Vector3::X * 9.0; with.stations().len()];
        for _ in 0..20 {
            with.advance(0.2, &winds, &commands(0.02));
            without.advance(0.2, &winds, &commands(0.02));
        }
        assert_eq!(with.state(), without.state());
        assert!(with.forces().iter().any(|force| force.bound.is_some()));
        for (force, bare) in with.forces().iter().zip(without.forces()) {
            assert_eq!(PointForce { bound: None, ..*force }, *bare);
        }
        assert_eq!(with.forces().len(), without.forces().len());
    }
}

#[test]
fn blades_among_bound_vortices_feel_the_tower() {
    let induction =
        |tower: Option<TowerInfluence>| Induction::ByBoundVortices { dynamic_stall: false, tower };
    let bare = built(false, induction(None));
    let effects = Effects { potential: Potential::WithDrag, shadow: true };
    let foot = Vector3::new(100.0, -20.0, 0.0);
    let tower = TowerInfluence::new(bare.definition(), foot, effects);
    let wind = Vector3::new(9.0, 0.5, 0.0);
    let even = vec![wind; bare.stations().len()];
    let n = 3 * N_ELEMENTS;
    let parted: Vec<Vector3> = bare
        .stations()
        .iter()
        .enumerate()
        .map(|(index, at)| if index < n { tower.felt(*at, wind) } else { wind })
        .collect();
    let forces = |tower: Option<TowerInfluence>, winds: &[Vector3]| {
        let mut turbine = built(false, induction(tower));
        turbine.advance(INSTANT, winds, &commands(0.02));
        turbine.forces().to_vec()
    };
    let (told, felt) = (forces(None, &parted), forces(Some(tower), &even));
    let without = forces(None, &even);
    let mut greatest = 0.0_f64;
    for ((told, felt), without) in told.iter().zip(&felt).zip(&without) {
        let scale = without.force.length();
        assert!((told.force - felt.force).length() < TOLERANCE * scale);
        greatest = greatest.max((felt.force - without.force).length() / scale);
    }
    // One blade hangs before the tower or passes near it.
    assert!(greatest > 0.02, "{greatest}");
}

#[test]
fn the_drag_of_a_nacelle_is_that_of_the_wind_without_its_own_wake() {
    let built = || built(false, Induction::ByBoundVortices { dynamic_stall: false, tower: None });
    let (mut with, mut without) = (built(), built());
    let n = 3 * N_ELEMENTS;
    let (circulations, influence) = (vec![0.0; n], vec![Vector3::ZERO; n * n]);
    let at_nacelle = Vector3::X * -2.0;
    let answer = |at_nacelle: Vector3| {
        let (circulations, influence) = (&circulations[..], &influence[..]);
        Some(Answer { circulations, influence, at_nacelle })
    };
    let winds = vec![Vector3::X * 9.0; with.stations().len()];
    let slowed: Vec<Vector3> = winds
        .iter()
        .enumerate()
        .map(|(index, wind)| if index + 1 == winds.len() { *wind + at_nacelle } else { *wind })
        .collect();
    with.advance_answered(INSTANT, &slowed, answer(at_nacelle), &commands(0.02));
    without.advance_answered(INSTANT, &winds, answer(Vector3::ZERO), &commands(0.02));
    assert_eq!(with.forces(), without.forces());
    let nacelle = with.forces().last().expect("bodies come last");
    let radius = with.definition().rotor.hub_radius;
    assert_eq!(nacelle.disc_radius, Some(radius));
    let area = std::f64::consts::PI * radius * radius;
    let drag = 0.5 * DENSITY * 0.85 * area * 81.0;
    assert!((nacelle.force.x + drag).abs() < 1e-9 * drag, "{}", nacelle.force);
}

/// Blades in air that answers strongly, at angles of attack all round the circle: a circulation that no wind
/// bears out must not blow itself up.
#[test]
fn answers_of_the_air_to_stalled_blades_stay_as_strong_as_the_wind_that_they_answer_to() {
    let turbine = built(false, by_flow(false));
    let line = &turbine.line;
    let n = line.elements().len() * turbine.definition().n_blades;
    let motions = &motions_now(&turbine);
    // An element feels its own trailing vortices most, as half a metre behind it, its neighbours less.
    let influence: Vec<Vector3> = (0..n * n)
        .map(|place| {
            let (row, column) = (place / n, place % n);
            let apart = row.abs_diff(column) as f64;
            let axes = motions[row].axes;
            (axes.tangent - axes.normal) * (0.5 / (1.0 + 4.0 * apart * apart))
        })
        .collect();
    let circulations: Vec<f64> = (0..n).map(|index| 20.0 * (index as f64 * 0.7).sin()).collect();
    let mut answering = answering::Answering::new(n);
    for step in 0..36 {
        let angle = f64::from(step).to_radians() * 10.0;
        let onset = Onset { normal: 9.0 * angle.sin(), tangential: 9.0 * angle.cos() };
        let (onsets, pitch) = (vec![onset; n], vec![0.0; n]);
        let (mut corrections, mut loads) = (vec![[0.0; 2]; n], vec![Load::default(); n]);
        let answer = basis::Answer {
            circulations: &circulations,
            influence: &influence,
            at_nacelle: Vector3::ZERO,
        };
        answering.begin(Some(answer), motions);
        let sections = &mut QuasiSteady(line);
        answering.loads(line, &onsets, &pitch, sections, &mut corrections, &mut loads);
        for (load, [axial, tangential]) in loads.iter().zip(&corrections) {
            assert!(axial.hypot(*tangential) <= 9.0 * (1.0 + 1e-12), "{angle}");
            assert!(load.circulation.abs() < 200.0 && load.normal.is_finite(), "{angle} {load:?}");
        }
    }
}
