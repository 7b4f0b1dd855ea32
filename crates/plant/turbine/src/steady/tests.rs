//! Closed forms, balances and limits.

use super::*;
use crate::definition::{BladeStation, BladeStructure, RotorGeometry};
use crate::sample;
use std::f64::consts::PI;

const RADIUS: f64 = 50.0;
const HUB: f64 = 2.5;

/// A rotor whose blades carry thin aerofoils with constant `drag`; chord (m) and twist (rad) by distance from
/// the shaft (m).
fn rotor(drag: f64, shape: impl Fn(f64) -> (f64, f64)) -> Definition {
    let angles: Vec<f64> = (-1800..=1800).map(|k| f64::from(k) * PI / 1800.0).collect();
    let lift: Vec<f64> = angles.iter().map(|angle| 2.0 * PI * angle.sin()).collect();
    let constant = vec![drag; angles.len()];
    let zero = vec![0.0; angles.len()];
    let polar = Polar::new("thin", &angles, &lift, &constant, &zero).unwrap();
    let station = |k: usize| {
        let span = (RADIUS - HUB) * k as f64 / 200.0;
        let (chord, twist) = shape(HUB + span);
        BladeStation { span, chord, twist, prebend: 0.0, sweep: 0.0, polar: 0 }
    };
    let base = sample::definition();
    Definition {
        name: "ideal".into(),
        rotor: RotorGeometry {
            hub_radius: HUB,
            tip_radius: RADIUS,
            precone: 0.0,
            shaft_tilt: 0.0,
            overhang: 5.0,
            hub_height: 90.0,
        },
        blade: (0..=200).map(station).collect(),
        polars: vec![polar],
        blade_structure: BladeStructure {
            sections: sample::even_sections(RADIUS - HUB, 100.0),
            ..base.blade_structure.clone()
        },
        ..base
    }
}

const NO_LOSS: Theory = Theory { tip_loss: false, hub_loss: false, drag_in_induction: true };
/// Angle of attack that the optimum rotor is laid out for (rad).
const ATTACK: f64 = 0.1;

/// Glauert's optimum rotor for `tip_speed_ratio`: Manwell, McGowan, Rogers, "Wind energy explained", 2nd ed.,
/// eq. 3.105-3.107.
fn optimum(tip_speed_ratio: f64) -> impl Fn(f64) -> (f64, f64) {
    move |radius: f64| {
        let angle = 2.0 / 3.0 * (RADIUS / (tip_speed_ratio * radius)).atan();
        let chord = 8.0 * PI * radius / (3.0 * 2.0 * PI * ATTACK.sin()) * (1.0 - angle.cos());
        (chord, angle - ATTACK)
    }
}

/// Power and thrust coefficient of Glauert's optimum rotor with the hub cut out, ring by ring from the cubic
/// of its induction.
fn glauert(tip_speed_ratio: f64) -> (f64, f64) {
    let n = 20_000;
    let (mut power, mut thrust) = (0.0, 0.0);
    for k in 0..n {
        let radius = HUB + (RADIUS - HUB) * (f64::from(k) + 0.5) / f64::from(n);
        let ratio = tip_speed_ratio * radius / RADIUS;
        let angle = 2.0 / 3.0 * (1.0 / ratio).atan();
        // tan φ = (1 − a) / ((1 + a') λ_r) with a' = (1 − 3a)/(4a − 1) at the optimum; a by bisection.
        let (mut low, mut high) = (0.25 + 1e-12, 1.0 / 3.0);
        for _ in 0..80 {
            let a = 0.5 * (low + high);
            let swirl = (1.0 - 3.0 * a) / (4.0 * a - 1.0);
            if (1.0 - a) / ((1.0 + swirl) * ratio) < angle.tan() { low = a } else { high = a }
        }
        let a = 0.5 * (low + high);
        let swirl = (1.0 - 3.0 * a) / (4.0 * a - 1.0);
        let ring = 2.0 * radius * (RADIUS - HUB) / f64::from(n) / (RADIUS * RADIUS);
        power += 4.0 * swirl * (1.0 - a) * ratio * ratio * ring;
        thrust += 4.0 * a * (1.0 - a) * ring;
    }
    (power, thrust)
}

#[test]
fn the_optimum_rotor_reaches_glauerts_limit() {
    for ratio in [2.0, 6.0, 10.0] {
        let definition = rotor(1e-9, optimum(ratio));
        let got = SteadyRotor::new(&definition, NO_LOSS).coefficients(ratio, 0.0);
        let (power, thrust) = glauert(ratio);
        assert!((got.power / power - 1.0).abs() < 2e-3, "{ratio}: {} {power}", got.power);
        assert!((got.thrust / thrust - 1.0).abs() < 2e-3, "{ratio}: {} {thrust}", got.thrust);
        assert!(got.power < 16.0 / 27.0);
        assert!((got.torque * ratio - got.power).abs() < 1e-12);
    }
}

#[test]
fn no_pitch_betters_the_optimum_and_losses_cost_power() {
    let definition = rotor(1e-9, optimum(8.0));
    let ideal = SteadyRotor::new(&definition, NO_LOSS);
    let best = ideal.coefficients(8.0, 0.0).power;
    for pitch_deg in [-2.0f64, -1.0, 1.0, 2.0] {
        assert!(ideal.coefficients(8.0, pitch_deg.to_radians()).power < best, "{pitch_deg}");
    }
    let lossy = SteadyRotor::new(&definition, Theory::default()).coefficients(8.0, 0.0).power;
    assert!(lossy < 0.97 * best && lossy > 0.85 * best, "{lossy} {best}");
    let draggy = rotor(0.01, optimum(8.0));
    let with_drag = SteadyRotor::new(&draggy, NO_LOSS).coefficients(8.0, 0.0).power;
    assert!(with_drag < best - 0.02);
}

#[test]
fn thrust_of_the_blades_is_the_momentum_that_the_air_loses() {
    let definition = rotor(0.008, optimum(7.0));
    let rotor = SteadyRotor::new(&definition, Theory::default());
    let mut points = vec![SpanwisePoint::default(); rotor.n_elements()];
    rotor.distribution(7.0, 0.02, &mut points);
    let width = (RADIUS - HUB) / rotor.n_elements() as f64;
    let ring_thrust = |inflow: &Inflow| {
        let (a, loss) = (inflow.axial_induction, inflow.loss_factor);
        if a <= 0.4 {
            4.0 * loss * a * (1.0 - a)
        } else {
            // Buhl's parabola, where momentum theory ends.
            8.0 / 9.0 + (4.0 * loss - 40.0 / 9.0) * a + (50.0 / 9.0 - 4.0 * loss) * a * a
        }
    };
    let air: f64 = points
        .iter()
        .map(|point| 2.0 * PI * point.radius * width * ring_thrust(&point.inflow))
        .sum();
    let thrust = rotor.coefficients(7.0, 0.02).thrust * definition.rotor_area();
    assert!((air / thrust - 1.0).abs() < 1e-9, "{air} {thrust}");
}

#[test]
fn stations_and_equal_lengths_agree_where_stations_are_many() {
    let definition = rotor(0.008, optimum(7.0));
    let even = SteadyRotor::new(&definition, Theory::default()).coefficients(7.0, 0.0);
    let nodes = SteadyRotor::at_stations(&definition, Theory::default()).coefficients(7.0, 0.0);
    // The trapezoidal rule leaves out half a station's load at the blunt tip: one of 200 stations is the
    // bound.
    assert!((even.power / nodes.power - 1.0).abs() < 1.0 / 200.0, "{even:?} {nodes:?}");
    assert!((even.thrust / nodes.thrust - 1.0).abs() < 1.0 / 200.0);
    assert_eq!(steady(&definition, 7.0, 0.0), even);
}

#[test]
fn tilt_and_cone_cost_what_their_cosines_say() {
    let flat = rotor(0.008, optimum(7.0));
    let power = |definition: &Definition| steady(definition, 7.0, 0.0).power;
    let mut tilted = flat.clone();
    tilted.rotor.shaft_tilt = 0.1;
    // Wind along the shaft × cos: at the best tip-speed ratio power goes with its cube, to second order in
    // the tilt.
    let expected = 0.1f64.cos().powi(3);
    assert!((power(&tilted) / power(&flat) - expected).abs() < 4e-3);
    let mut coned = flat.clone();
    coned.rotor.precone = 0.1;
    assert!((coned.rotor_radius() / RADIUS - 0.1f64.cos()).abs() < 1e-12);
    let ratio = power(&coned) / power(&flat);
    assert!(ratio < 1.0 && ratio > 0.1f64.cos().powi(3) - 4e-3, "{ratio}");
}

#[test]
fn inertia_of_a_uniform_blade_in_closed_form() {
    let definition = rotor(0.008, optimum(7.0));
    let blade = 100.0 * (RADIUS.powi(3) - HUB.powi(3)) / 3.0;
    assert!((definition.blade_mass() - 100.0 * (RADIUS - HUB)).abs() < 1e-6);
    assert!((definition.rotor_inertia() / (3.0 * blade + 1e5) - 1.0).abs() < 1e-12);
    let whole = definition.rotor_inertia() + 1e4;
    assert!((definition.drive_train_inertia() - whole).abs() < 1e-6);
    assert!((definition.efficiency() - 0.9).abs() < 1e-15);
}
