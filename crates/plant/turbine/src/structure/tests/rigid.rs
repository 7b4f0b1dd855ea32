//! The rigid limit: loads of a spinning rotor in closed form.

use super::samples::*;
use crate::definition::Definition;
use crate::structure::coordinates::GENERATOR;
use crate::structure::stations::LoadResultants;
use crate::structure::{
    AppliedLoads, DegreeOfFreedom, Pitch, Structure, StructureSettings, midpoint::PhasePoint,
};
use basis::Vector3;

const SPEED: f64 = 1.7;
const STEP: f64 = 0.02;

/// `definition` with everything held, its rotor turning at [`SPEED`], after `n_steps` steps; and the azimuth
/// of the loads.
fn spun(definition: &Definition, gravity: f64, n_steps: usize) -> (Structure, f64) {
    let settings = StructureSettings {
        gravity,
        rotor_speed: SPEED,
        azimuth: 0.3,
        ..StructureSettings::AT_REST
    };
    let mut structure = structure(definition, &settings);
    structure.hold(&DegreeOfFreedom::ALL);
    let pitch = vec![Pitch::default(); definition.n_blades];
    (0..n_steps).for_each(|_| structure.advance(STEP, &AppliedLoads::NONE, &pitch));
    let azimuth = 0.3 + SPEED * STEP * (n_steps as f64 - 0.5);
    (structure, azimuth)
}

/// ∫ mass over the blade, times the distance from the apex and the root to the powers given (kg m^(a+b));
/// even blade.
fn moment_of_mass(definition: &Definition, apex_power: i32, root_power: i32) -> f64 {
    let n = 4000;
    let length = definition.blade_length();
    (0..n)
        .map(|k| {
            let span = length * (f64::from(k) + 0.5) / f64::from(n);
            let density = definition.blade_structure.sections[0].mass;
            density * length / f64::from(n)
                * (definition.rotor.hub_radius + span).powi(apex_power)
                * span.powi(root_power)
        })
        .sum()
}

fn near(found: f64, expected: f64, scale: f64, what: &str) {
    assert!((found - expected).abs() < 1e-6 * scale, "{what}: {found}, expected {expected}");
}

#[test]
fn centrifugal_force_pulls_at_the_root() {
    let definition = plain();
    let (structure, _) = spun(&definition, 0.0, 40);
    let (sine, cosine) = definition.rotor.precone.sin_cos();
    let pull = SPEED * SPEED * moment_of_mass(&definition, 1, 0);
    let bend = SPEED * SPEED * moment_of_mass(&definition, 1, 1);
    for blade in structure.loads().blades.iter() {
        near(blade.root.force.z, pull * cosine * cosine, pull, "along the blade");
        near(blade.root.force.x, pull * cosine * sine, pull, "out of plane");
        near(blade.root.force.y, 0.0, pull, "in plane");
        near(blade.root.moment.y, bend * cosine * sine, bend, "flapwise");
        near(blade.root.moment.x, 0.0, bend, "edgewise");
    }
    // The three pulls cancel, nothing else moves.
    assert!(structure.loads().shaft.force.length() < 1e-6 * pull);
    assert!(structure.loads().tower_base.moment.length() < 1e-6 * bend);
}

#[test]
fn weight_swings_through_the_blade_root() {
    let definition = plain();
    let g = crate::structure::GRAVITY;
    let (cone_sine, cone_cosine) = definition.rotor.precone.sin_cos();
    let (tilt_sine, tilt_cosine) = definition.rotor.shaft_tilt.sin_cos();
    let first = moment_of_mass(&definition, 0, 1);
    let bend = SPEED * SPEED * moment_of_mass(&definition, 1, 1) * cone_cosine * cone_sine;
    for n_steps in [1, 50, 111, 160] {
        let (structure, azimuth) = spun(&definition, g, n_steps);
        for (k, blade) in structure.loads().blades.iter().enumerate() {
            let psi = azimuth + std::f64::consts::TAU * k as f64 / 3.0;
            let edgewise = first * g * tilt_cosine * psi.sin();
            let flapwise =
                first * g * (tilt_sine * cone_cosine - tilt_cosine * cone_sine * psi.cos());
            near(blade.root.moment.x, edgewise, first * g, "edgewise");
            near(blade.root.moment.y, flapwise + bend, first * g, "flapwise");
        }
        near(structure.loads().shaft.moment.x, 0.0, first * g, "the rotor is balanced");
        let rotor_mass = 3.0 * definition.blade_mass() + definition.hub.mass;
        near(
            structure.loads().shaft.force.x,
            rotor_mass * g * tilt_sine,
            rotor_mass * g,
            "RotThrust",
        );
    }
}

#[test]
fn everything_weighs_on_the_foot() {
    let definition = plain();
    let g = crate::structure::GRAVITY;
    let mut still = structure(&definition, &StructureSettings::AT_REST);
    still.hold(&DegreeOfFreedom::ALL);
    still.advance(STEP, &AppliedLoads::NONE, &[Pitch::default(); 3]);
    let (tower, nacelle) = (&definition.tower, &definition.nacelle);
    let tower_mass = 4000.0 * (tower.top_height - tower.base_height);
    let rotor_mass = 3.0 * definition.blade_mass() + definition.hub.mass;
    let top = rotor_mass + nacelle.mass;
    let all = top + nacelle.yaw_bearing_mass + tower_mass;
    let loads = still.loads();
    near(loads.yaw_bearing.force.z, -top * g, top * g, "YawBrFzp");
    near(loads.tower_base.force.z, -all * g, all * g, "TwrBsFzt");
    // The rotor's centre of mass lies ahead of the apex by what the cone takes, and all of it upwind of the
    // tower.
    let cone = 3.0 * moment_of_mass(&definition, 1, 0) * definition.rotor.precone.sin();
    let ahead = rotor_mass * definition.rotor.overhang + cone;
    let lever =
        -ahead * definition.rotor.shaft_tilt.cos() + nacelle.mass * nacelle.center_of_mass.x;
    near(loads.yaw_bearing.moment.y, lever * g, ahead * g, "YawBrMyp");
    near(loads.tower_base.moment.y, lever * g, ahead * g, "TwrBsMyt");
}

#[test]
fn a_nodding_tower_feels_the_gyroscope() {
    let mut definition = plain();
    definition.rotor.precone = 0.0;
    definition.rotor.shaft_tilt = 0.0;
    let structure =
        structure(&definition, &StructureSettings { gravity: 0.0, ..StructureSettings::AT_REST });
    let mut phase = PhasePoint::default();
    phase.v.shared[GENERATOR] = SPEED;
    phase.q.shared[GENERATOR] = 0.4;
    phase.v.shared[0] = 0.5;
    let none = LoadResultants::default();
    let pitch = [Pitch::default(); 3];
    let equations = structure.machine.equations_of_motion(&phase.q, &phase.v, &pitch, &none);
    let loads = structure.machine.loads(&phase, &equations, &none);
    // Nodding at θ̇ about y turns the angular momentum J Ω of the rotor; the rotor answers with J Ω θ̇ about
    // z.
    let nodding = equations.motion.top.spin.y;
    assert!(nodding > 0.005);
    let expected = definition.rotor_inertia() * SPEED * nodding;
    near(loads.shaft.moment.z, expected, 10.0 * expected, "LSSTipMzs");
    near(loads.shaft.moment.y, 0.0, expected, "LSSTipMys");
    near(loads.shaft.moment.x, 0.0, expected, "RotTorq");
}

#[test]
fn a_rigid_rotor_speeds_up_by_torque_over_inertia() {
    let definition = plain();
    let mut structure = structure(
        &definition,
        &StructureSettings { rotor_speed: 1.0, ..StructureSettings::AT_REST },
    );
    let held: Vec<DegreeOfFreedom> = DegreeOfFreedom::ALL
        .into_iter()
        .filter(|degree| *degree != DegreeOfFreedom::Generator)
        .collect();
    structure.hold(&held);
    let applied = AppliedLoads { generator_torque: -1e6, ..AppliedLoads::NONE };
    (0..500).for_each(|_| structure.advance(STEP, &applied, &[Pitch::default(); 3]));
    let (sine, cosine) = definition.rotor.precone.sin_cos();
    assert!(sine > 0.0);
    let blade = moment_of_mass(&definition, 2, 0) * cosine * cosine;
    let inertia = 3.0 * blade + definition.hub.inertia + definition.drive_train.generator_inertia;
    near(structure.rotor_speed(), 1.0 + 1e6 * 10.0 / inertia, 1.0, "rotor speed");
    // Half the way of the torque is spent on what stands between it and the cut.
    let share = 1.0 - definition.drive_train.generator_inertia / inertia;
    near(structure.loads().shaft.moment.x, -1e6 * share, 1e6, "RotTorq");
}

#[test]
fn a_pitching_rigid_blade_turns_its_loads_with_it() {
    let definition = plain();
    let mut structure = structure(
        &definition,
        &StructureSettings { rotor_speed: SPEED, ..StructureSettings::AT_REST },
    );
    structure.hold(&DegreeOfFreedom::ALL);
    let pitch = [0.0, 0.4, 1.2].map(|angle| Pitch { angle, ..Pitch::default() });
    structure.advance(STEP, &AppliedLoads::NONE, &pitch);
    for (blade, pitch) in structure.loads().blades.iter().zip(pitch) {
        let (sine, cosine) = pitch.angle.sin_cos();
        let root = blade.root.moment;
        let turned =
            Vector3::new(cosine * root.x - sine * root.y, sine * root.x + cosine * root.y, root.z);
        assert!((blade.pitched_root.moment - turned).length() < 1e-9 * root.length());
    }
}

#[test]
fn moments_along_the_span_are_those_of_what_lies_beyond() {
    let definition = plain();
    let length = definition.blade_length();
    let spans = [27.0, 37.0];
    let settings = StructureSettings { spans: &spans, ..StructureSettings::AT_REST };
    let mut structure = structure(&definition, &settings);
    structure.hold(&DegreeOfFreedom::ALL);
    let push = |x: f64, y: f64| crate::structure::ElementLoad {
        force: Vector3::new(x, y, 0.0),
        moment: Vector3::ZERO,
    };
    let pitch = [Pitch::default(); 3];
    let moments = |structure: &mut Structure, loads: [[f64; 2]; 2]| {
        let mut all = vec![push(0.0, 0.0); 6];
        (all[0], all[1]) = (push(loads[0][0], loads[0][1]), push(loads[1][0], loads[1][1]));
        structure.advance(STEP, &AppliedLoads { elements: &all, ..AppliedLoads::NONE }, &pitch);
        structure.loads().blades
    };
    let weight = moments(&mut structure, [[0.0; 2]; 2]);
    // Blade 2 stands at 120°: weight bends it edgewise by what lies beyond the gauge.
    let across = crate::structure::GRAVITY
        * definition.rotor.shaft_tilt.cos()
        * (std::f64::consts::TAU / 3.0).sin();
    for (gauge, moments) in weight[1].span_moments.iter().enumerate() {
        let beyond = length * (1.0 - (gauge as f64 + 1.0) / 8.0);
        near(moments[0], 300.0 * across * 0.5 * beyond * beyond, 1e5, "edgewise");
    }
    // Pushes to the left on blade 1, which stands up: edgewise moment −force × arm inboard, nothing outboard.
    let pushed = moments(&mut structure, [[0.0, 1e4], [0.0, 2e4]]);
    for gauge in 0..crate::structure::N_GAUGES {
        let span = length * (gauge as f64 + 1.0) / 8.0;
        let arm = |radius: f64| (radius - definition.rotor.hub_radius - span).max(0.0);
        let change = pushed[0].span_moments[gauge][0] - weight[0].span_moments[gauge][0];
        near(change, -1e4 * arm(27.0) - 2e4 * arm(37.0), 1e5, "push");
    }
}
