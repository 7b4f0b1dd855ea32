//! Closed forms, balances and limits.

use super::*;
use crate::Polar;
use crate::actuators::PitchActuator;
use crate::definition::{
    BladeStation, BladeStructure, DriveTrain, Mode, RotorGeometry, Tower, TowerProfile,
    TowerSection,
};
use crate::sample;
use basis::PerBlade;
use std::f64::consts::PI;

pub(super) const DENSITY: f64 = 1.2;
const INTERVAL: f64 = 0.1;

/// A tilted, coned and prebent rotor of thin aerofoils, 100 m across.
pub(super) fn machine() -> Arc<Definition> {
    let angles: Vec<f64> = (-360..=360).map(|k| f64::from(k) * PI / 360.0).collect();
    let lift: Vec<f64> = angles.iter().map(|angle| 2.0 * PI * angle.sin()).collect();
    let drag: Vec<f64> = angles.iter().map(|angle| 0.01 + angle.sin().powi(2)).collect();
    let polar = Polar::new("thin", &angles, &lift, &drag, &vec![0.0; angles.len()]).unwrap();
    let station = |k: usize| {
        let share = k as f64 / 20.0;
        BladeStation {
            span: 48.0 * share,
            chord: 4.0 - 3.0 * share,
            twist: (12.0 - 12.0 * share).to_radians(),
            prebend: 2.0 * share * share,
            sweep: 0.0,
            polar: 0,
        }
    };
    let mode = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.01 };
    let second = Mode { coefficients: [-3.0, 4.0, 0.0, 0.0, 0.0], damping_ratio: 0.01 };
    let tower = |height: f64| TowerSection {
        height,
        mass: 4e3,
        fore_aft_stiffness: 5e11,
        side_to_side_stiffness: 5e11,
    };
    let profile = |height: f64| TowerProfile { height, diameter: 5.0, drag_coefficient: 0.6 };
    let base = sample::definition();
    Arc::new(Definition {
        name: "small".into(),
        rotor: RotorGeometry {
            hub_radius: 2.0,
            tip_radius: 50.0,
            precone: 0.05,
            shaft_tilt: 0.09,
            overhang: 5.0,
            hub_height: 90.0,
        },
        blade: (0..=20).map(station).collect(),
        polars: vec![polar],
        blade_structure: BladeStructure {
            sections: sample::even_sections(48.0, 200.0),
            flap_modes: [mode, second],
            edge_mode: mode,
        },
        tower: Tower {
            base_height: 0.0,
            top_height: 88.0,
            top_to_shaft: 2.0 - 5.0 * 0.09_f64.sin(),
            profile: vec![profile(0.0), profile(88.0)],
            sections: vec![tower(0.0), tower(88.0)],
            fore_aft_modes: [mode, second],
            side_to_side_modes: [mode, second],
        },
        drive_train: DriveTrain {
            gear_ratio: 1.0,
            generator_inertia: 1e6,
            gearbox_efficiency: 1.0,
            generator_efficiency: 0.95,
            stiffness: 1e9,
            damping: 1e6,
        },
        pitch_actuator: PitchActuator { minimum_pitch: -0.05, ..base.pitch_actuator },
        operation: None,
        rated_power: 3e6,
        rated_rotor_speed: 1.4,
        ..base
    })
}

pub(super) fn by_flow(dynamic_stall: bool) -> Induction {
    Induction::ByFlow { smearing_length: 12.0, sample_spacing: 6.0, dynamic_stall }
}

fn turbine() -> Turbine {
    built(false, by_flow(false))
}

pub(super) fn built(flexible: bool, induction: Induction) -> Turbine {
    built_yawed(flexible, induction, 0.0, 1.3)
}

/// The same with its nacelle turned by `yaw` (rad), at `rotor_speed` (rad/s).
pub(super) fn built_yawed(
    flexible: bool,
    induction: Induction,
    yaw: f64,
    rotor_speed: f64,
) -> Turbine {
    let settings = TurbineSettings {
        induction,
        flexible,
        air_density: DENSITY,
        yaw,
        rotor_speed,
        azimuth: 0.3,
        pitch: 0.0,
    };
    Turbine::new(machine(), Vector3::new(100.0, -20.0, 0.0), settings).expect("a sound machine")
}

pub(super) fn commands(pitch: f64) -> Commands {
    Commands { pitch: PerBlade::splat(3, pitch), generator_torque: 1e6, yaw_rate: 0.0 }
}

/// Wind that varies from place to place, a sheared wake of some sort.
fn winds(turbine: &Turbine) -> Vec<Vector3> {
    turbine
        .stations()
        .iter()
        .map(|at| Vector3::new(6.0 + 0.01 * at.z, 0.2 + 0.002 * at.y, -0.1))
        .collect()
}

#[test]
fn structural_steps_are_as_long_as_asked_and_never_turn_too_far() {
    let usual = built(true, by_flow(false));
    let farthest = FARTHEST_STRUCTURAL_STEP / usual.definition.rated_rotor_speed;
    let after = |mut turbine: Turbine| {
        turbine.advance(0.3, &winds(&turbine), &commands(0.0));
        turbine.state
    };
    let of = |step: f64| after(usual.clone().with_structural_steps(step));
    assert_eq!(of(LONGEST_STRUCTURAL_STEP), after(usual.clone()));
    assert_ne!(of(0.5 * LONGEST_STRUCTURAL_STEP), after(usual.clone()));
    assert!(farthest > LONGEST_STRUCTURAL_STEP && farthest < 0.1);
    assert_ne!(of(farthest), after(usual.clone()));
    assert_eq!(of(0.3), of(farthest));
}

#[test]
fn the_air_feels_what_the_blades_feel() {
    let mut turbine = turbine().without_bodies();
    let winds = winds(&turbine);
    let speed = turbine.truth(0.0, INTERVAL).rotor_speed;
    turbine.advance(INTERVAL, &winds, &commands(0.0));
    let read = turbine.truth(INTERVAL, INTERVAL);
    let Frame { hub, shaft, .. } = *turbine.frame();
    let total: Vector3 = turbine.forces().iter().map(|point| point.force).sum();
    let moment: Vector3 =
        turbine.forces().iter().map(|point| (point.position - hub).cross(point.force)).sum();
    assert!((total.dot(shaft) / -read.thrust - 1.0).abs() < 1e-12);
    assert!((moment.dot(shaft) / -read.aerodynamic_torque - 1.0).abs() < 1e-12);
    // Power from the shaft is what the blades' motion takes from the air: Σ force on blade · velocity of
    // blade.
    let work: f64 = turbine
        .forces()
        .iter()
        .map(|point| -point.force.dot((shaft * speed).cross(point.position - hub)))
        .sum();
    assert!((work / (read.aerodynamic_torque * speed) - 1.0).abs() < 1e-12);
    assert!(read.thrust > 0.0 && read.aerodynamic_torque > 0.0);
}

#[test]
fn a_blade_reaches_up_at_azimuth_zero_and_apex_stands_at_hub_height() {
    let turbine = turbine();
    let apex = turbine.frame().hub;
    assert!((apex.z - 90.0).abs() < 1e-12 && (apex.y + 20.0).abs() < 1e-12 && apex.x < 100.0);
    let tip = turbine.stations()[N_ELEMENTS - 1] - apex;
    // Azimuth 0.3: up, and to the right looking downwind.
    assert!(tip.z > 0.0 && tip.y < 0.0 && (tip.y / tip.z + 0.3_f64.tan()).abs() < 0.01);
}

#[test]
fn bodies_hold_the_air_back() {
    let mut turbine = turbine();
    let winds = winds(&turbine);
    turbine.advance(INTERVAL, &winds, &commands(0.0));
    let bodies = &turbine.forces()[3 * N_ELEMENTS..];
    assert!(bodies.len() > 5 && bodies.iter().all(|point| point.force.x < 0.0));
    let foot = bodies[0].position;
    assert!((foot.x - 100.0).abs() < 1e-12 && (foot.y + 20.0).abs() < 1e-12 && foot.z > 0.0);
}

#[test]
fn the_rotor_spins_up_by_its_torques() {
    let mut turbine = turbine();
    let winds = winds(&turbine);
    let before = turbine.truth(0.0, INTERVAL);
    turbine.advance(INTERVAL, &winds, &commands(0.0));
    let after = turbine.truth(INTERVAL, INTERVAL);
    let gained =
        (after.aerodynamic_torque - 1e6) * INTERVAL / turbine.definition().drive_train_inertia();
    // The middle of a step is found by iteration, to a millionth.
    let relative = (after.rotor_speed - before.rotor_speed) / gained - 1.0;
    assert!(relative.abs() < 1e-5, "{relative}");
    let turned = 0.5 * INTERVAL * (before.rotor_speed + after.rotor_speed);
    assert!((after.azimuth - before.azimuth - turned).abs() < 1e-6);
    assert!((after.power - 0.95 * 1e6 * after.rotor_speed).abs() < 1e-6);
    let mut held = self::turbine().at_held_speed();
    held.advance(INTERVAL, &winds, &commands(0.0));
    assert_eq!(held.truth(INTERVAL, INTERVAL).rotor_speed, 1.3);
}

#[test]
fn a_restored_turbine_goes_on_with_the_same_bits() {
    for dynamic_stall in [false, true] {
        let turbine = || built(true, by_flow(dynamic_stall));
        let (mut first, mut second) = (turbine(), turbine());
        for step in 0..20 {
            let pitch = 0.05 * (0.3 * f64::from(step)).sin();
            let winds = winds(&first);
            first.advance(INTERVAL, &winds, &commands(pitch));
        }
        let stored = postcard::to_stdvec(first.state()).expect("plain data serialises");
        second.restore(postcard::from_bytes(&stored).expect("what was written is read"));
        for step in 20..30 {
            let pitch = 0.05 * (0.3 * f64::from(step)).sin();
            let winds = winds(&first);
            first.advance(INTERVAL, &winds, &commands(pitch));
            second.advance(INTERVAL, &winds, &commands(pitch));
        }
        assert_eq!(first.state(), second.state());
        assert_eq!(first.forces(), second.forces());
    }
}

/// In a wind that does not change the delay of separation has nothing to do; where blades pitch, it has.
#[test]
fn dynamic_stall_along_the_line_rests_at_the_polars() {
    let run = |dynamic_stall: bool, amplitude: f64| {
        let mut turbine = built(false, by_flow(dynamic_stall)).without_bodies().at_held_speed();
        // Along the shaft: the same on every blade, wherever it stands. Strong enough to separate half of the
        // blade.
        let wind = turbine.frame().shaft * 22.0;
        let mut thrusts = Vec::new();
        for step in 0..200 {
            let winds = vec![wind; turbine.stations().len()];
            let pitch = 0.1 + amplitude * (0.25 * f64::from(step)).sin();
            turbine.advance(0.05, &winds, &commands(pitch));
            thrusts.push(turbine.truth(0.0, 0.05).thrust);
        }
        thrusts
    };
    let (steady, dynamic) = (run(false, 0.0), run(true, 0.0));
    assert!((dynamic[199] / steady[199] - 1.0).abs() < 1e-6, "{} {}", dynamic[199], steady[199]);
    let (steady, dynamic) = (run(false, 0.05), run(true, 0.05));
    let swing = |thrusts: &[f64]| {
        let last = &thrusts[100..];
        last.iter().fold(f64::MIN, |most, now| most.max(*now))
            - last.iter().fold(f64::MAX, |least, now| least.min(*now))
    };
    let differ = steady.iter().zip(&dynamic).skip(100).map(|(a, b)| (a - b).abs());
    let most = differ.fold(0.0, f64::max);
    assert!(most > 1e-4 * swing(&steady) && most < 0.5 * swing(&steady), "{most}");
}

#[test]
fn limits_of_the_pitch_are_counted() {
    let mut turbine = turbine();
    let winds = winds(&turbine);
    turbine.advance(INTERVAL, &winds, &commands(0.0));
    turbine.advance(INTERVAL, &winds, &commands(-0.2));
    turbine.advance(INTERVAL, &winds, &commands(0.5));
    assert_eq!(turbine.limited_instants(), (3, 2));
}

#[test]
fn pitching_all_blades_by_nothing_is_not_pitching() {
    let (mut still, mut excited) = (turbine(), turbine());
    for step in 0..10 {
        let winds = winds(&still);
        still.advance(INTERVAL, &winds, &commands(0.02));
        let helix = 0.0 * (0.1 * f64::from(step)).sin();
        excited.advance(INTERVAL, &winds, &commands(0.02 + helix));
    }
    assert_eq!(still.state(), excited.state());
}

#[test]
fn the_correction_settles_and_forgets_where_it_began() {
    let mut turbine = turbine().without_bodies().at_held_speed();
    let mut thrusts = Vec::new();
    for _ in 0..60 {
        // The same wind for every blade, so that turning changes nothing.
        let winds = vec![Vector3::new(7.0, 0.0, 0.0); turbine.stations().len()];
        turbine.advance(0.01, &winds, &commands(0.0));
        thrusts.push(turbine.truth(0.0, 0.01).thrust);
    }
    let last = thrusts[59];
    assert!((thrusts[40] / last - 1.0).abs() < 1e-3, "{thrusts:?}");
    assert!(turbine.state().smearing_corrections().iter().all(|velocity| velocity[0].abs() < 4.0));
}

#[test]
fn under_prescribed_wind_the_turbine_finds_what_momentum_theory_says() {
    use crate::aero::blade_element::Theory;
    use crate::aero::induction::TwoConstant;
    let theory = crate::aero::rotor::BemSettings {
        induction: crate::aero::Induction::TwoConstant(TwoConstant::varying()),
        theory: Theory::default(),
        skewed_wake: false,
        dynamic_stall: true,
        tower: None,
    };
    let mut turbine = built(false, Induction::ByMomentum(theory)).without_bodies().at_held_speed();
    let (wind, interval) = (9.0, 0.02);
    let n_turn = (2.0 * PI / 1.3 / interval) as usize;
    let (mut power, mut thrust) = (0.0, 0.0);
    for step in 0..12 * n_turn {
        let winds = vec![Vector3::X * wind; turbine.stations().len()];
        turbine.advance(interval, &winds, &commands(0.0));
        if step >= 11 * n_turn {
            let read = turbine.truth(0.0, interval);
            power += read.aerodynamic_torque * read.rotor_speed / n_turn as f64;
            thrust += read.thrust / n_turn as f64;
        }
    }
    let definition = machine();
    let tip_speed_ratio = 1.3 * definition.rotor_radius() / wind;
    let expected = crate::steady::steady(&definition, tip_speed_ratio, 0.0);
    let scale = 0.5 * DENSITY * definition.rotor_area() * wind * wind;
    assert!((power / (scale * wind * expected.power) - 1.0).abs() < 0.01, "power {power}");
    assert!((thrust / (scale * expected.thrust) - 1.0).abs() < 0.01, "thrust {thrust}");
}

#[test]
fn flexible_blades_bend_downwind_and_the_tower_with_them() {
    let mut turbine = built(true, by_flow(false));
    for _ in 0..600 {
        let winds = vec![Vector3::X * 7.0; turbine.stations().len()];
        turbine.advance(INTERVAL, &winds, &commands(0.0));
    }
    let loads = turbine.structure().loads();
    let read = turbine.truth(60.0, INTERVAL);
    assert!(loads.blades.iter().all(|blade| blade.tip_deflection.x > 0.0), "{loads:?} {read:?}");
    assert!(loads.tower_top.x > 0.0 && loads.tower_base.moment.y > 0.0);
    assert!(read.flap_moments.iter().all(|moment| moment.is_finite() && *moment > 0.0));
}
