//! A turbine that stands yawed, and one that is being yawed.

use super::tests::{built_yawed, by_flow, commands};
use super::*;
use crate::aero::blade_element::Theory;
use crate::aero::induction::TwoConstant;
use crate::aero::rotor::BemSettings;
use basis::Matrix3;
use std::f64::consts::TAU;

const INTERVAL: f64 = 0.1;
/// Rotor speed of the turbines in these tests (rad/s).
const ROTOR_SPEED: f64 = 1.3;

fn by_momentum() -> Induction {
    Induction::ByMomentum(BemSettings {
        induction: crate::aero::Induction::TwoConstant(TwoConstant::varying()),
        theory: Theory::default(),
        skewed_wake: true,
        dynamic_stall: true,
        tower: None,
    })
}

/// A wind that turns with the nacelle changes nothing but the directions of forces: all that is done in the
/// farm's frame is done in the yawed rotor's.
#[test]
fn a_yawed_turbine_in_a_wind_turned_alike_is_the_same_machine() {
    for induction in [by_flow(true), by_momentum()] {
        for flexible in [false, true] {
            let yaw = 0.4;
            let turn = Matrix3::from_rotation_z(yaw);
            let mut facing = built_yawed(flexible, induction.clone(), 0.0, ROTOR_SPEED);
            let mut yawed = built_yawed(flexible, induction.clone(), yaw, ROTOR_SPEED);
            for _ in 0..40 {
                let wind = Vector3::new(8.0, 0.7, -0.2);
                let n = facing.stations().len();
                facing.advance(INTERVAL, &vec![wind; n], &commands(0.02));
                yawed.advance(INTERVAL, &vec![turn * wind; n], &commands(0.02));
            }
            let (one, other) = (facing.truth(4.0, INTERVAL), yawed.truth(4.0, INTERVAL));
            let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * a.abs().max(b.abs()).max(1e-3);
            // The tower's two directions are alike in stiffness, but their modes bend in one order.
            let tolerance = if flexible { 2e-3 } else { 1e-6 };
            let close = |a: f64, b: f64| (a - b).abs() < tolerance * a.abs().max(b.abs());
            assert!(close(one.thrust, other.thrust), "{} {}", one.thrust, other.thrust);
            assert!(close(one.aerodynamic_torque, other.aerodynamic_torque));
            assert!(close(one.rotor_speed, other.rotor_speed));
            assert!(flexible || near(one.flap_moments[0], other.flap_moments[0]));
            assert_eq!((one.yaw, other.yaw), (0.0, yaw));
            let foot = Vector3::new(100.0, -20.0, 0.0);
            let places = facing.stations().iter().zip(yawed.stations());
            for (a, b) in places {
                let turned = foot + turn * (*a - foot);
                assert!((turned - *b).length() < if flexible { 0.05 } else { 1e-9 }, "{a} {b}");
            }
            for (a, b) in facing.forces().iter().zip(yawed.forces()) {
                let apart = (turn * a.force - b.force).length();
                assert!(apart < tolerance * a.force.length().max(1e3), "{} {}", a.force, b.force);
            }
        }
    }
}

/// Thrust acts along the shaft: with positive yaw the air is pushed upwind and to the right looking downwind,
/// where the wake goes.
#[test]
fn the_air_is_pushed_to_the_right_by_the_sine_of_the_yaw() {
    let yaw = 25_f64.to_radians();
    let mut turbine = built_yawed(false, by_flow(false), yaw, ROTOR_SPEED).without_bodies();
    let mut sum = Vector3::ZERO;
    let mut thrust = 0.0;
    // A turn, so that what circles with the blades is gone.
    let n = 60;
    let interval = TAU / ROTOR_SPEED / f64::from(n);
    turbine = turbine.at_held_speed();
    for _ in 0..n {
        let winds = vec![Vector3::X * 8.0; turbine.stations().len()];
        turbine.advance(interval, &winds, &commands(0.0));
        sum += turbine.forces().iter().map(|point| point.force).sum::<Vector3>();
        thrust += turbine.truth(0.0, interval).thrust;
    }
    assert!(sum.x < 0.0 && sum.y < 0.0, "{sum}");
    let shaft = turbine.frame().shaft;
    assert!((sum.dot(shaft) / -thrust - 1.0).abs() < 1e-9);
    // In the rotor plane there is a little too, from drag in the wind along it.
    let lateral = sum.y / sum.x;
    assert!((lateral / yaw.tan() - 1.0).abs() < 0.1, "{lateral}");
}

/// Mean power (W) and thrust (N) over a turn of the rotor at `rotor_speed` (rad/s), yawed by `yaw` (rad) in
/// 9 m/s, by momentum theory once its wake has settled.
fn settled(yaw: f64, rotor_speed: f64) -> [f64; 2] {
    let turbine = built_yawed(false, by_momentum(), yaw, rotor_speed);
    let mut turbine = turbine.without_bodies().at_held_speed();
    let n_turn = 240;
    let interval = TAU / rotor_speed / f64::from(n_turn);
    let (mut power, mut thrust) = (0.0, 0.0);
    for step in 0..12 * n_turn {
        let winds = vec![Vector3::X * 9.0; turbine.stations().len()];
        turbine.advance(interval, &winds, &commands(0.0));
        if step >= 11 * n_turn {
            let read = turbine.truth(0.0, interval);
            power += read.aerodynamic_torque * read.rotor_speed / f64::from(n_turn);
            thrust += read.thrust / f64::from(n_turn);
        }
    }
    [power, thrust]
}

/// Momentum theory that knows the wind across the rotor plane alone gives cos³ for the power and cos² for
/// the thrust of a rotor that keeps its tip-speed ratio in that wind; the wind along the plane and the
/// wake's skew change that in second order. The shaft's tilt makes the wind meet the rotor at an angle of
/// its own.
#[test]
fn power_falls_with_the_cube_of_the_cosine_and_thrust_with_its_square() {
    let [power, thrust] = settled(0.0, ROTOR_SPEED);
    for degrees in [-30.0_f64, -20.0, 20.0, 30.0] {
        let cosine = degrees.to_radians().cos();
        let yawed = settled(degrees.to_radians(), ROTOR_SPEED * cosine);
        let exponents = [(yawed[0] / power).ln(), (yawed[1] / thrust).ln()];
        let [of_power, of_thrust] = exponents.map(|log| log / cosine.ln());
        assert!((of_power - 3.0).abs() < 0.2, "{degrees}°: power {of_power}");
        assert!((of_thrust - 2.0).abs() < 0.2, "{degrees}°: thrust {of_thrust}");
    }
}

/// A turn under way: the stations turn with the nacelle, and what was stored goes on with the same bits.
#[test]
fn a_turbine_that_is_being_yawed_turns_and_goes_on_with_the_same_bits() {
    for induction in [by_flow(true), by_momentum()] {
        let rate = 0.01;
        let turning = Commands { yaw_rate: rate, ..commands(0.0) };
        let step = |turbine: &mut Turbine| {
            let winds = vec![Vector3::X * 8.0; turbine.stations().len()];
            turbine.advance(INTERVAL, &winds, &turning);
        };
        let start = || built_yawed(true, induction.clone(), -0.1, ROTOR_SPEED);
        let mut turbine = start();
        (0..100).for_each(|_| step(&mut turbine));
        let stored = postcard::to_stdvec(turbine.state()).expect("plain data serialises");
        let mut restored = start();
        restored.restore(postcard::from_bytes(&stored).expect("what was written is read"));
        assert_eq!(restored.stations(), turbine.stations());
        assert_eq!(restored.frame(), turbine.frame());
        for _ in 0..50 {
            step(&mut turbine);
            step(&mut restored);
        }
        assert_eq!(restored.state(), turbine.state());
        assert_eq!(restored.forces(), turbine.forces());
        // 15 s at the rate, less the second in which the drive takes it up.
        let yaw = turbine.truth(15.0, INTERVAL).yaw;
        assert!((yaw - (-0.1 + rate * 14.0)).abs() < 1e-6, "{yaw}");
        let shaft = turbine.frame().shaft;
        assert!((shaft.y.atan2(shaft.x) - yaw).abs() < 1e-12);
        let mut values = vec![0.0; turbine.channels().len()];
        turbine.write_channels(&mut values);
        let channel = turbine.structure().channel("NacYaw").expect("it is there");
        // In the middle of the last step.
        assert!((values[channel] - yaw).abs() < rate * INTERVAL, "{}", values[channel]);
    }
}

/// A nacelle that turns about the tower carries its rotor sideways: blades feel their own motion.
#[test]
fn the_yaw_rate_moves_the_hub_by_rate_times_overhang() {
    let rate = 0.02;
    let turning = Commands { yaw_rate: rate, ..commands(0.0) };
    let mut turbine = built_yawed(false, by_flow(false), 0.0, ROTOR_SPEED).without_bodies();
    let still = vec![Vector3::ZERO; turbine.stations().len()];
    (0..100).for_each(|_| turbine.advance(INTERVAL, &still, &turning));
    let before = turbine.frame().hub;
    turbine.advance(INTERVAL, &still, &turning);
    let velocity = (turbine.frame().hub - before) / INTERVAL;
    // Overhang 5 m along a shaft tilted by 0.09.
    let expected = rate * 5.0 * 0.09_f64.cos();
    assert!((velocity.length() / expected - 1.0).abs() < 1e-3, "{velocity}");
}
