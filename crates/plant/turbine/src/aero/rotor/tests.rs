//! Steady limits, closed forms, balances and symmetries.

use super::*;
use crate::aero::blade_element;
use crate::aero::induction::{SnelSchepers, TwoConstant, two_constant};
use crate::aero::sample::Stiff;
use crate::aero::tower_influence::{Effects, Potential};
use crate::definition::TowerProfile;
use crate::sample::definition;
use crate::steady::SteadyRotor;

const WIND: f64 = 9.0;
const ROTOR_SPEED: f64 = 1.1;
const AIR_DENSITY: f64 = 1.225;

fn settings(induction: Induction) -> BemSettings {
    BemSettings {
        induction,
        theory: Theory::default(),
        skewed_wake: false,
        dynamic_stall: true,
        tower: None,
    }
}

fn all_models() -> [Induction; 4] {
    [
        Induction::QuasiSteady,
        Induction::SnelSchepers(SnelSchepers::default()),
        Induction::TwoConstant(TwoConstant::fixed(8.0)),
        Induction::TwoConstant(TwoConstant::varying()),
    ]
}

/// A rotor under way, with what it needs.
struct Flight {
    stiff: Stiff,
    rotor: RotorAerodynamics,
    state: BemState,
    loads: Loads,
    azimuth: f64,
}

impl Flight {
    fn new(stiff: Stiff, settings: BemSettings) -> Self {
        let rotor =
            RotorAerodynamics::new(&stiff.definition, stiff.line.elements(), AIR_DENSITY, settings);
        let (state, loads) = (rotor.start(), rotor.loads());
        Self { stiff, rotor, state, loads, azimuth: 0.0 }
    }

    fn step(&mut self, interval: f64, wind: Vector3, pitch: f64) {
        self.azimuth += interval * self.stiff.rotor_speed;
        let elements = self.stiff.motions(self.azimuth, pitch);
        let winds = vec![wind; elements.len()];
        let pitch = self.stiff.pitch(pitch);
        let kinematics =
            RotorKinematics { frame: &self.stiff.frame, elements: &elements, pitch: &pitch };
        self.rotor.advance(interval, &winds, kinematics, &mut self.state, &mut self.loads);
    }
}

#[test]
fn every_model_comes_to_rest_at_blade_element_momentum() {
    for induction in all_models() {
        let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
        flight.step(0.1, Vector3::X * WIND, 0.0);
        let pitch = 0.05;
        for _ in 0..4000 {
            flight.step(0.1, Vector3::X * WIND, pitch);
        }
        let elements = flight.stiff.line.elements();
        let (mut thrust, mut torque) = (0.0, 0.0);
        for (section, element) in flight.rotor.sections.iter().zip(elements) {
            let annulus = section.ring.annulus_now(pitch, element.radius);
            let rotation = ROTOR_SPEED * element.radius;
            let polar = |angle: f64| section.polar.at(angle);
            let inflow = blade_element::solve(&annulus, WIND, rotation, polar, Theory::default());
            let [normal, tangential] = inflow.forces(AIR_DENSITY, element.chord);
            thrust += 3.0 * normal * element.width;
            torque += 3.0 * tangential * element.width * element.radius;
        }
        let Loads { thrust: got_thrust, torque: got_torque, .. } = flight.loads;
        assert!((got_thrust / thrust - 1.0).abs() < 1e-6, "{induction:?}: {got_thrust} {thrust}");
        assert!((got_torque / torque - 1.0).abs() < 1e-6, "{induction:?}: {got_torque} {torque}");
        // And the steady rotor, cut into other elements.
        let steady = SteadyRotor::new(&flight.stiff.definition, Theory::default())
            .coefficients(ROTOR_SPEED * 60.0 / WIND, pitch);
        let pressure = 0.5 * AIR_DENSITY * WIND * WIND * flight.stiff.definition.rotor_area();
        assert!((got_thrust / (pressure * steady.thrust) - 1.0).abs() < 5e-3);
        assert!((got_torque / (pressure * 60.0 * steady.torque) - 1.0).abs() < 1e-2);
    }
}

#[test]
fn the_first_call_settles() {
    for induction in all_models() {
        let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
        flight.step(0.02, Vector3::X * WIND, 0.02);
        let first = flight.loads.thrust;
        for _ in 0..200 {
            flight.step(0.02, Vector3::X * WIND, 0.02);
        }
        assert!((flight.loads.thrust / first - 1.0).abs() < 1e-6, "{induction:?}");
    }
}

#[test]
fn a_step_in_pitch_decays_with_the_models_two_constants() {
    let (slow, k, interval) = (8.0, TwoConstant::COUPLING, 0.02);
    let induction = Induction::TwoConstant(TwoConstant::fixed(slow));
    let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
    let velocities = |flight: &Flight| -> Vec<f64> {
        flight.loads.flows.iter().map(|flow| flow.induced_normal).collect()
    };
    flight.step(interval, Vector3::X * WIND, 0.0);
    let before = velocities(&flight);
    let mut records = vec![];
    for _ in 0..500 {
        flight.step(interval, Vector3::X * WIND, 0.03);
        records.push(velocities(&flight));
    }
    for _ in 0..20_000 {
        flight.step(interval, Vector3::X * WIND, 0.03);
    }
    let after = velocities(&flight);
    for station in [6, 14, 20] {
        let share = flight.rotor.sections[station].ring.share;
        let fast = two_constant::fast_constant(slow, share);
        let slow_part = slow * (1.0 - k) / (slow - fast);
        for (step, record) in records.iter().enumerate() {
            // The change of pitch falls between two instants.
            let time = (step as f64 + 0.5) * interval;
            let rest = slow_part * (-time / slow).exp() + (1.0 - slow_part) * (-time / fast).exp();
            let expected = after[station] + (before[station] - after[station]) * rest;
            let scale = (before[station] - after[station]).abs();
            assert!((record[station] - expected).abs() < 1e-4 * scale, "{station} {step}");
        }
    }
}

#[test]
fn thrust_overshoots_when_blades_pitch_and_the_wake_lags() {
    let models = [
        Induction::SnelSchepers(SnelSchepers::default()),
        Induction::TwoConstant(TwoConstant::varying()),
    ];
    for induction in models {
        let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
        flight.step(0.05, Vector3::X * WIND, 0.0);
        let before = flight.loads.thrust;
        let mut lowest = before;
        for _ in 0..3000 {
            flight.step(0.05, Vector3::X * WIND, 0.03);
            lowest = lowest.min(flight.loads.thrust);
        }
        let after = flight.loads.thrust;
        let overshoot = (before - lowest) / (before - after);
        assert!(after < before && (1.1..2.5).contains(&overshoot), "{induction:?} {overshoot}");
    }
}

#[test]
fn power_is_what_the_blades_take_on_their_way() {
    let mut tilted = definition();
    tilted.rotor.shaft_tilt = 0.1;
    tilted.rotor.precone = 0.05;
    let mut settings = settings(Induction::SnelSchepers(SnelSchepers::default()));
    settings.skewed_wake = true;
    let mut flight = Flight::new(Stiff::new(tilted, ROTOR_SPEED), settings);
    for step in 0..50 {
        let pitch = 0.01 * f64::from(step % 7);
        flight.step(0.05, Vector3::new(WIND, 0.5, 0.2), pitch);
        let work: f64 = flight
            .stiff
            .motions(flight.azimuth, pitch)
            .iter()
            .zip(&flight.loads.elements)
            .map(|(motion, load)| load.force.dot(motion.velocity))
            .sum();
        assert!((flight.loads.torque * ROTOR_SPEED / work - 1.0).abs() < 1e-12);
    }
}

#[test]
fn blades_are_alike() {
    // Tilt makes loads depend on azimuth; with three blades a third of a turn on, they change places.
    let mut tilted = definition();
    tilted.rotor.shaft_tilt = 0.1;
    let n = 24;
    let mut settings = settings(Induction::QuasiSteady);
    settings.skewed_wake = true;
    settings.dynamic_stall = false;
    let mut flight = Flight::new(Stiff::new(tilted, ROTOR_SPEED), settings);
    let third = std::f64::consts::TAU / 3.0 / ROTOR_SPEED;
    // The skew follows the mean induction of the instant before: let it settle.
    for _ in 0..60 {
        flight.step(third, Vector3::X * WIND, 0.0);
    }
    let first = flight.loads.elements.clone();
    flight.step(third, Vector3::X * WIND, 0.0);
    for index in 0..3 * n {
        let (one, other) = (&first[(index + n) % (3 * n)], &flight.loads.elements[index]);
        assert!((one.force - other.force).length() < 1e-5 * one.force.length() + 1e-6, "{index}");
    }
    // Without tilt they are the same at every instant.
    let mut flat = Flight::new(
        Stiff::new(definition(), ROTOR_SPEED),
        self::settings(Induction::TwoConstant(TwoConstant::varying())),
    );
    for _ in 0..20 {
        flat.step(0.1, Vector3::X * WIND, 0.02);
    }
    for index in 0..n {
        let angles = [0, n, 2 * n].map(|k| flat.loads.flows[index + k].angle_of_attack);
        assert!(angles.iter().all(|angle| (angle - angles[0]).abs() < 1e-9));
    }
}

#[test]
fn a_flow_that_resolves_induction_is_met_as_it_is() {
    let mut plain = settings(Induction::Resolved);
    plain.dynamic_stall = false;
    let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), plain);
    flight.step(0.02, Vector3::X * 6.0, 0.0);
    flight.step(0.02, Vector3::X * 6.0, 0.0);
    for (load, element) in
        flight.loads.flows.iter().zip(flight.stiff.line.elements().iter().cycle())
    {
        let expected = 6.0f64.atan2(ROTOR_SPEED * element.radius) - element.twist;
        assert!((load.angle_of_attack - expected).abs() < 1e-12);
        assert_eq!((load.induced_normal, load.induced_tangential), (0.0, 0.0));
    }
    assert_eq!(flight.loads.mean_induction, 0.0);
}

#[test]
fn the_tower_is_felt_by_the_blade_that_passes_it() {
    let row = |height: f64| TowerProfile { height, diameter: 5.0, drag_coefficient: 0.5 };
    let mut towered = definition();
    towered.tower.profile = vec![row(0.0), row(85.0)];
    let mut with_tower = settings(Induction::QuasiSteady);
    with_tower.dynamic_stall = false;
    let effects = Effects { potential: Potential::WithDrag, shadow: true };
    let foot = Vector3::X * 5.0;
    with_tower.tower = Some(TowerInfluence::new(&towered, foot, effects));
    let mut flight = Flight::new(Stiff::new(towered, ROTOR_SPEED), with_tower);
    flight.azimuth = std::f64::consts::PI;
    flight.step(0.0, Vector3::X * WIND, 0.0);
    flight.step(0.0, Vector3::X * WIND, 0.0);
    let places = [16, 24 + 16];
    let [below, beside] = places.map(|k| flight.loads.flows[k].onset.normal);
    assert!(below < 0.9 * beside && beside == WIND);
    let [below, beside] = places.map(|k| flight.loads.elements[k]);
    assert!(below.force.x < beside.force.x);
}

#[test]
fn a_state_continues_with_the_same_bits() {
    let induction = Induction::TwoConstant(TwoConstant::varying());
    let mut flight = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
    for step in 0..40 {
        flight.step(0.05, Vector3::X * (WIND + (0.3 * f64::from(step)).sin()), 0.01);
    }
    let (saved, azimuth) = (flight.state.clone(), flight.azimuth);
    flight.step(0.05, Vector3::X * 7.0, 0.03);
    let expected = flight.loads.elements.clone();
    let mut other = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
    (other.state, other.azimuth) = (saved, azimuth);
    other.step(0.05, Vector3::X * 7.0, 0.03);
    assert_eq!(other.loads.elements, expected);
    assert_eq!(other.state, flight.state);
}

#[test]
fn nothing_goes_wrong_in_odd_winds() {
    for induction in all_models() {
        let mut flight = Flight::new(Stiff::new(definition(), 0.0), settings(induction));
        let winds = [9.0, 0.0, -9.0, 40.0, 1e-9, 25.0, -3.0, 12.0];
        for (step, wind) in winds.iter().cycle().take(160).enumerate() {
            flight.stiff.rotor_speed = [0.0, 1.2, -0.4, 2.0][step / 3 % 4];
            let across = f64::from((step % 5) as u32) - 2.0;
            flight.step(0.5, Vector3::new(*wind, across, 0.0), [0.0, 1.5, -0.5][step % 3]);
            assert!(flight.loads.elements.iter().all(|load| load.force.is_finite()), "{step}");
            assert!(flight.loads.thrust.abs() < 1e8, "{induction:?} {step} {wind}");
        }
        // And it finds back.
        flight.stiff.rotor_speed = ROTOR_SPEED;
        for _ in 0..4000 {
            flight.step(0.1, Vector3::X * WIND, 0.0);
        }
        let mut fresh = Flight::new(Stiff::new(definition(), ROTOR_SPEED), settings(induction));
        fresh.step(0.1, Vector3::X * WIND, 0.0);
        for (got, expected) in flight.loads.flows.iter().zip(&fresh.loads.flows) {
            let miss = (got.angle_of_attack - expected.angle_of_attack).abs();
            assert!(miss < 1e-6, "{induction:?}: {got:?} {expected:?}");
        }
    }
}
