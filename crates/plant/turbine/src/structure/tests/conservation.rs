//! Conservation of energy in a free motion, and the work of loads.

use super::samples::*;
use crate::motion::ElementMotion;
use crate::rotor::BladeFrame;
use crate::structure::{
    AppliedLoads, DegreeOfFreedom, ElementLoad, Pitch, Structure, StructureSettings,
};
use basis::Vector3;

const STEP: f64 = 0.02;
const PITCH: [Pitch; 3] = [Pitch { angle: 0.02, rate: 0.0, acceleration: 0.0 }; 3];

/// Sets every degree of freedom of `structure` moving: a metre per second at the tips, less at the tower.
fn shake(structure: &mut Structure, rotor_speed: f64) {
    let mut state = structure.state().clone();
    state.velocities.shared = [0.4, -0.1, 0.3, 0.05, rotor_speed, 0.0];
    state.velocities.blades[..3].copy_from_slice(&[
        [1.0, -0.2, 0.5],
        [-0.4, 0.3, 0.2],
        [0.6, 0.1, -0.7],
    ]);
    state.pitch.copy_from_slice(&PITCH);
    structure.restore(state);
}

/// Largest change of the energy of a free motion over `duration` (s), as a share of the energy of the motion
/// at its beginning.
fn energy_error(structure: &mut Structure, duration: f64) -> f64 {
    let before = structure.energy();
    let mut worst = 0.0_f64;
    for step in 0..(duration / STEP) as usize {
        structure.advance(STEP, &AppliedLoads::NONE, &PITCH);
        if step % 97 == 0 {
            worst = worst.max((structure.energy().total() - before.total()).abs());
        }
    }
    worst / before.kinetic
}

#[test]
fn a_free_vibration_keeps_its_energy_over_a_thousand_periods() {
    // 1000 periods of the tower, 4.3 s each, and far more of everything else.
    let mut structure = structure(&undamped(published(IEA_15)), &StructureSettings::AT_REST);
    structure.hold(&[DegreeOfFreedom::Generator]);
    shake(&mut structure, 0.0);
    let error = energy_error(&mut structure, 4300.0);
    assert!(error < 1e-4, "{error:e}");
}

#[test]
fn a_turning_free_rotor_keeps_its_energy() {
    // 600 s are 75 turns and 1100 periods of edgewise bending against the free shaft.
    let mut structure = structure(&undamped(published(IEA_15)), &StructureSettings::AT_REST);
    shake(&mut structure, 0.79);
    let error = energy_error(&mut structure, 600.0);
    assert!(error < 1e-4, "{error:e}");
}

#[test]
fn a_bare_blade_rings_down_at_its_damping_ratio() {
    // Flapwise alone, no gravity, still hub: q = cos(ω t) exp(−ζ ω t) and the midpoint rule's own period.
    let definition = plain();
    let settings = StructureSettings { gravity: 0.0, ..StructureSettings::AT_REST };
    let mut structure = structure(&definition, &settings);
    let held: Vec<DegreeOfFreedom> = DegreeOfFreedom::ALL
        .into_iter()
        .filter(|degree| *degree != DegreeOfFreedom::Flap1)
        .collect();
    structure.hold(&held);
    let frequency = structure.natural_modes()[0].frequency;
    let mut state = structure.state().clone();
    state.coordinates.blades[0][0] = 0.5;
    structure.restore(state);
    let start = structure.energy().total();
    let n_steps = 2000;
    (0..n_steps).for_each(|_| structure.advance(STEP, &AppliedLoads::NONE, &PITCH));
    let periods = frequency * STEP * f64::from(n_steps);
    let decay = (start / structure.energy().total()).ln() / (4.0 * std::f64::consts::PI * periods);
    assert!((decay / 0.01 - 1.0).abs() < 0.02, "{decay}");
}

#[test]
fn energy_grows_by_the_work_of_the_loads() {
    let definition = undamped(plain());
    let spans = [8.0, 20.0, 33.0, 41.0];
    let heights = [30.0, 70.0];
    let settings =
        StructureSettings { spans: &spans, heights: &heights, ..StructureSettings::AT_REST };
    let mut structure = structure(&definition, &settings);
    shake(&mut structure, 1.2);
    let loads: Vec<ElementLoad> = (0..12)
        .map(|k| ElementLoad {
            force: Vector3::new(2e4, 3e3 * f64::from(k), -1e3 * f64::from(k * k)),
            moment: Vector3::ZERO,
        })
        .collect();
    let tower = [Vector3::new(3e4, 1e4, 0.0), Vector3::new(1e4, -2e4, 500.0)];
    let nacelle = Vector3::new(5e4, 2e4, 1e4);
    let torque = 4e5;
    let applied =
        AppliedLoads { elements: &loads, tower: &tower, nacelle, generator_torque: torque };
    let blank = ElementMotion {
        position: Vector3::ZERO,
        velocity: Vector3::ZERO,
        axes: BladeFrame { span: Vector3::ZERO, normal: Vector3::ZERO, tangent: Vector3::ZERO },
        pitch: 0.0,
    };
    let (mut elements, mut points) = (vec![blank; 12], vec![(Vector3::ZERO, Vector3::ZERO); 2]);
    // Forces are constant in the farm frame: their work is force × way, the torque's is torque × turned
    // angle.
    let mut potential = |structure: &Structure| {
        structure.observe(0.0, &PITCH, &mut elements);
        structure.observe_tower(0.0, &mut points);
        let blades: f64 = elements
            .iter()
            .zip(&loads)
            .map(|(element, load)| element.position.dot(load.force))
            .sum();
        let tower: f64 = points.iter().zip(&tower).map(|(point, force)| point.0.dot(*force)).sum();
        blades + tower + structure.frame(0.0).hub.dot(nacelle)
    };
    let (start, energy) = (potential(&structure), structure.energy().total());
    let mut turned = 0.0;
    let step = 1e-3;
    for _ in 0..1000 {
        let before = structure.state().velocities.shared[4];
        structure.advance(step, &applied, &PITCH);
        turned += 0.5 * step * (before + structure.state().velocities.shared[4]);
    }
    let work = potential(&structure) - start - torque * turned;
    let gain = structure.energy().total() - energy;
    assert!(work.abs() > 1e5);
    assert!((gain - work).abs() < 2e-5 * work.abs().max(1e6), "{gain} {work}");
}

#[test]
fn moments_on_elements_work_through_the_turn_of_the_section() {
    // A couple of two forces on elements either side of a third is a moment on that one, if they all turn
    // alike.
    let mut definition = plain();
    definition.blade_structure.flap_modes[0].coefficients = [1.0, 0.0, 0.0, 0.0, 0.0];
    (definition.rotor.shaft_tilt, definition.rotor.precone) = (0.0, 0.0);
    definition.blade[1].prebend = 0.0;
    let run = |loads: [ElementLoad; 3]| {
        let spans = [29.9, 30.0, 30.1];
        let settings =
            StructureSettings { spans: &spans, gravity: 0.0, ..StructureSettings::AT_REST };
        let mut structure = structure(&definition, &settings);
        let mut all = vec![ElementLoad::default(); 9];
        all[..3].copy_from_slice(&loads);
        let applied = AppliedLoads { elements: &all, ..AppliedLoads::NONE };
        structure.advance(1e-4, &applied, &[Pitch::default(); 3]);
        structure.state().clone()
    };
    let none = ElementLoad::default();
    let push = |x: f64| ElementLoad { force: Vector3::X * x, moment: Vector3::ZERO };
    let couple = run([push(-1e4), none, push(1e4)]);
    let turn = ElementLoad { force: Vector3::ZERO, moment: Vector3::Y * 2e3 };
    let moment = run([none, turn, none]);
    for mode in 0..3 {
        let (a, b) = (couple.accelerations.blades[0][mode], moment.accelerations.blades[0][mode]);
        assert!((a - b).abs() < 2e-3 * couple.accelerations.blades[0][0].abs(), "{mode}: {a} {b}");
    }
    let (a, b) = (couple.loads.blades[0].root.moment, moment.loads.blades[0].root.moment);
    assert!((a - b).length() < 2e-3 * a.length(), "{a} {b}");
}
