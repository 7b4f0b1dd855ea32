//! Closed forms of the kinematics, play, limits, and the amplitudes of the published plate.

use super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

/// Fast and without limits.
const FAST: PitchActuator = PitchActuator {
    natural_frequency: 2000.0,
    damping_ratio: 1.0,
    maximum_rate: 1e6,
    minimum_pitch: -1.0,
    maximum_pitch: 1.0,
};

fn straight() -> Swashplate {
    Swashplate {
        drive: Drive::Screw { lead: lead_of(1e-3) },
        rod_radius: 0.015,
        link_radius: 0.018,
        horn_length: 0.013,
        rod_azimuth: 0.4,
        bias: [0.0; 2],
        slack: 0.0,
        gains: [1.0; 2],
    }
}

/// The plate in `state` with its motors at `angles` (rad), at rest.
fn at(angles: [f64; 3]) -> SwashplateState {
    let motors = angles.map(|pitch| PitchState { pitch, rate: 0.0 });
    SwashplateState { motors, ..SwashplateState::default() }
}

/// The plate's average, tilt and yaw pitch (rad) after its rods went round once and a half with `amplitude`
/// (rad) of pitch as commanded, in the sense of `rate` (1: with the rotor; −1: against it).
fn gone_round(plate: &Swashplate, amplitude: f64, sense: f64) -> Vec<FixedFrame> {
    let (mut state, n) = (plate.at_rest(0.0), 720);
    let mut seen = Vec::new();
    for step in 1..=n * 3 / 2 {
        let angle = sense * TAU * f64::from(step) / f64::from(n);
        let command = FixedFrame {
            average: 0.0,
            tilt: amplitude * angle.cos(),
            yaw: amplitude * angle.sin(),
        };
        let motors = plate.motors_for(0.0, &to_blades(0.0, command, 3));
        plate.advance(&FAST, &mut state, 1.0, &motors);
        let blades = plate.blades(&state, 0.0, 0.0, 3);
        seen.push(to_fixed_frame(0.0, &blades.map(|blade| blade.pitch)));
    }
    seen.split_off(n as usize / 2)
}

#[test]
fn rods_that_move_alike_pitch_all_blades_alike() {
    // A turn of the motors is a millimetre, β = asin(s / h).
    let state = at([TAU; 3]);
    let exact = (1e-3 / 0.013_f64).asin();
    for blade in straight().blades(&state, 1.1, 80.0, 4).iter() {
        assert!((blade.pitch - exact).abs() < 1e-14 && blade.rate.abs() < 1e-9);
    }
}

#[test]
fn one_rod_alone_tilts_the_plate_about_the_other_two() {
    // A plane through (s, 0, 0) has a third of s in the middle and two thirds of it times the lever at the
    // rod's own azimuth; on the far side of the two others' line nothing is above it.
    let plate = straight();
    let (travel, lever) = (2e-3, 0.018 / 0.015);
    let state = at([TAU * 2.0, 0.0, 0.0]);
    let pitch_at = |azimuth: f64| plate.blades(&state, azimuth, 0.0, 3)[0].pitch;
    let exact = |share: f64| (travel * share / 0.013).asin();
    assert!((pitch_at(0.4) - exact((1.0 + 2.0 * lever) / 3.0)).abs() < 1e-14);
    assert!((pitch_at(0.4 + PI) - exact((1.0 - 2.0 * lever) / 3.0)).abs() < 1e-14);
    assert!((pitch_at(0.4 + 0.5 * PI) - exact(1.0 / 3.0)).abs() < 1e-14);
}

#[test]
fn a_crank_moves_its_rod_by_the_sine_of_its_angle() {
    let plate = Swashplate { drive: Drive::Crank { length: 4e-3 }, ..straight() };
    let state = at([PI / 6.0; 3]);
    assert!((plate.blades(&state, 0.0, 0.0, 3)[1].pitch - (2e-3 / 0.013_f64).asin()).abs() < 1e-14);
    assert!((plate.drive.angle(2e-3) - PI / 6.0).abs() < 1e-14);
    // It goes no farther than a quarter of a turn.
    assert_eq!(plate.drive.angle(1.0), 0.5 * PI);
}

proptest! {
    /// What three blades are asked for, a straight plate gives, wherever the rotor stands and however its
    /// rods are driven.
    #[test]
    fn three_blades_get_what_they_were_asked_for(
        azimuth in -9.0..9.0_f64, pitches in prop::array::uniform3(-0.12..0.12_f64), crank in any::<bool>(),
    ) {
        let drive = if crank { Drive::Crank { length: 6e-3 } } else { straight().drive };
        let plate = Swashplate { drive, ..straight() };
        let pitch = PerBlade::from_fn(3, |blade| pitches[blade]);
        let state = at(plate.motors_for(azimuth, &pitch));
        let given = plate.blades(&state, azimuth, 0.0, 3);
        for (given, asked) in given.iter().zip(pitches) {
            prop_assert!((given.pitch - asked).abs() < 1e-12);
        }
    }

    /// The rate is the slope of the pitch, with motors that move and a rotor that turns.
    #[test]
    fn the_rate_is_the_slope_of_the_pitch(
        azimuth in 0.0..6.0_f64, angles in prop::array::uniform3(-8.0..8.0_f64),
        rates in prop::array::uniform3(-60.0..60.0_f64), speed in -90.0..90.0_f64,
        bias in prop::array::uniform2(-0.02..0.02_f64),
    ) {
        let plate = Swashplate { bias, slack: 0.2, gains: [1.1, 0.9], ..straight() };
        let after = |time: f64| {
            let mut state = at(std::array::from_fn(|rod| angles[rod] + rates[rod] * time));
            state.flank = 0.7;
            for (motor, rate) in state.motors.iter_mut().zip(rates) {
                motor.rate = rate;
            }
            plate.blades(&state, azimuth + speed * time, speed, 3)
        };
        let (h, now) = (1e-6, after(0.0));
        let (early, late) = (after(-h), after(h));
        for blade in 0..3 {
            let slope = (late[blade].pitch - early[blade].pitch) / (2.0 * h);
            prop_assert!((now[blade].rate - slope).abs() < 1e-5 * (1.0 + slope.abs()));
        }
    }

    /// Play takes no more than its slack of the direction, and the gain lies between those of the flanks.
    #[test]
    fn play_stays_within_its_slack(steps in prop::collection::vec(-0.5..0.5_f64, 1..60)) {
        let plate = Swashplate { slack: 0.1, gains: [1.2, 0.8], ..straight() };
        let (mut state, mut direction) = (plate.at_rest(0.0), 0.3_f64);
        for step in steps {
            direction += step;
            let command =
                FixedFrame { average: 0.0, tilt: 0.05 * direction.cos(), yaw: 0.05 * direction.sin() };
            let motors = plate.motors_for(0.0, &to_blades(0.0, command, 3));
            plate.advance(&FAST, &mut state, 1.0, &motors);
            let blades = plate.blades(&state, 0.0, 0.0, 3).map(|blade| blade.pitch.sin());
            let given = to_fixed_frame(0.0, &blades);
            let lag = wrap_to_half_turn(direction - given.yaw.atan2(given.tilt));
            prop_assert!(lag.abs() < 0.1 + 2e-3, "{lag}");
            let amplitude = given.tilt.hypot(given.yaw);
            prop_assert!(amplitude > 0.8 * 0.0498 && amplitude < 1.2 * 0.0501, "{amplitude}");
        }
    }
}

#[test]
fn each_sense_has_its_amplitude_and_lags_by_the_slack() {
    let plate = Swashplate { slack: 0.15, gains: [1.25, 0.9], ..straight() };
    for (sense, gain) in [(1.0, 1.25), (-1.0, 0.9)] {
        for (step, given) in gone_round(&plate, 0.02, sense).into_iter().enumerate() {
            let direction = sense * TAU * (step + 361) as f64 / 720.0;
            let lag = wrap_to_half_turn(direction - given.yaw.atan2(given.tilt));
            assert!((given.tilt.hypot(given.yaw) / (gain * 0.02) - 1.0).abs() < 1e-4, "{given:?}");
            assert!((lag - sense * 0.15).abs() < 1e-4, "{lag}");
        }
    }
}

#[test]
fn a_bias_of_yaw_varies_the_amplitude_over_a_period() {
    let plate = Swashplate { bias: [0.0, 0.004], ..straight() };
    let seen = gone_round(&plate, 0.03, -1.0);
    let n = seen.len() as f64;
    let mean = |of: fn(&FixedFrame) -> f64| seen.iter().map(of).sum::<f64>() / n;
    assert!((mean(|seen| seen.yaw) - 0.004).abs() < 1e-6 && mean(|seen| seen.tilt).abs() < 1e-6);
    // Blades go to and fro by 0.03 ± 0.004.
    let amplitudes = seen.iter().map(|seen| seen.tilt.hypot(seen.yaw));
    let most = amplitudes.clone().fold(0.0, f64::max);
    let least = amplitudes.fold(1.0, f64::min);
    assert!((most - 0.034).abs() < 2e-5 && (least - 0.026).abs() < 2e-5, "{least} to {most}");
}

#[test]
fn limits_are_those_of_collective_pitch() {
    let plate = straight();
    let actuator =
        PitchActuator { maximum_rate: 0.5, minimum_pitch: -0.1, maximum_pitch: 0.12, ..FAST };
    let mut state = plate.at_rest(0.0);
    let far = [plate.motor_at(0.3); 3];
    assert!(plate.advance(&actuator, &mut state, 0.1, &far));
    // About zero, a tenth of a second at half a radian a second; the horn's sine makes it a little more.
    let pitch = plate.blades(&state, 0.0, 0.0, 3)[0].pitch;
    assert!((pitch - 0.05_f64.asin()).abs() < 1e-9, "{pitch}");
    for _ in 0..50 {
        plate.advance(&actuator, &mut state, 0.1, &far);
    }
    assert!((plate.blades(&state, 0.0, 0.0, 3)[2].pitch - 0.12).abs() < 1e-12);
}

/// van der Hoek et al. (2024), §2.2 and Table 1: motors to and fro by 180° make 2.5° where the plate moves
/// with the rotor (cw), 2.0° where it moves against it (ccw), and 216° make 2.4° (ccw).
#[test]
fn the_published_amplitudes_come_of_one_plate() {
    let measured = [(1.0, 180.0, 2.5), (-1.0, 180.0, 2.0), (-1.0, 216.0, 2.4)];
    let lever = 2.25_f64.to_radians().sin();
    let plate = Swashplate {
        horn_length: 0.5e-3 * 1.2 / lever,
        slack: 3.0_f64.to_radians(),
        gains: [2.5 / 2.25, 2.0 / 2.25],
        ..straight()
    };
    assert!((plate.amplitude_of(PI) - 2.25_f64.to_radians()).abs() < 1e-12);
    for (sense, motors_deg, pitch_deg) in measured {
        let commanded = plate.amplitude_of(f64::to_radians(motors_deg));
        let given = gone_round(&plate, commanded, sense);
        let amplitude = given.iter().map(|one| one.tilt.hypot(one.yaw)).sum::<f64>();
        let amplitude = (amplitude / given.len() as f64).to_degrees();
        assert!((amplitude - pitch_deg).abs() < 5e-3, "{motors_deg}°: {amplitude}");
    }
}
