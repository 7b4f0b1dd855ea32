//! Tower and individual-pitch damping on the simplest plants that have something to damp.

mod rotor;

use basis::mbc::{blade_azimuth, to_fixed_frame};
use basis::{FixedFrame, PerBlade, Truth};
use control::Controller;
use control::baseline::{Baseline, Constants, IndividualPitch, PitchFloor, TowerDamping};
use rotor::{Rotor, tracking_constants};
use std::f64::consts::TAU;

const INTERVAL: f64 = 0.05;

/// Share of critical damping of a tower top that swings freely while the rotor keeps its speed.
fn tower_damping_ratio(constants: Constants) -> f64 {
    let (mass, rate, interval) = (4e5, TAU * 0.32, 0.01);
    let mut rotor = Rotor::heier(interval, constants.rated_rotor_speed);
    let now = &mut rotor.truth;
    now.pitch = PerBlade::splat(3, 0.2);
    let mut baseline = Baseline::new(constants);
    let (mut position, mut velocity) = (0.0, 0.5);
    let mut turns = Vec::new();
    for _ in 0..6000 {
        // Thrust falls with pitch.
        let force = -3e6 * (now.pitch.mean() - 0.2);
        let acceleration = force / mass - rate * rate * position;
        let before: f64 = velocity;
        velocity += interval * acceleration;
        position += interval * velocity;
        if before * velocity <= 0.0 {
            turns.push(position);
        }
        now.tower_top_acceleration = acceleration;
        now.pitch = baseline.update(&now.measured()).pitch;
    }
    // From turn to turn, so that where it swings about does not matter; a half period each.
    let (first, n) = (4, 12);
    let swing = |k: usize| (turns[k + 1] - turns[k]).abs();
    (swing(first) / swing(first + n)).ln() / (0.5 * TAU * n as f64)
}

#[test]
fn the_tower_damper_damps_as_much_as_its_gain_says() {
    let without = tower_damping_ratio(tracking_constants());
    let damping = TowerDamping { gain: 0.02, high_pass_corner: 0.1, limit: 0.1 };
    let with =
        tower_damping_ratio(Constants { tower_damping: Some(damping), ..tracking_constants() });
    // 2 ζ ω m ẋ = (dF/dβ) gain ẋ, less what two high-pass filters turn out of phase.
    let (rate, corner) = (TAU * 0.32, damping.high_pass_corner);
    let in_phase =
        rate * rate * (rate * rate - corner * corner) / (rate * rate + corner * corner).powi(2);
    let expected = in_phase * 3e6 * damping.gain / (2.0 * 4e5 * rate);
    assert!(without.abs() < 2e-3, "{without}");
    assert!((with - without - expected).abs() < 0.03 * expected, "{with} for {expected}");
}

/// Root moments under a tilted load that pitch takes away with `per_pitch` (N m/rad), after the lag of the
/// blades (rad).
fn with_moments(measurements: &mut Truth, load: FixedFrame, per_pitch: f64, lag: f64) {
    let azimuth = measurements.azimuth;
    let pitch = to_fixed_frame(azimuth + lag, &measurements.pitch);
    let felt = FixedFrame {
        average: load.average,
        tilt: load.tilt - per_pitch * pitch.tilt,
        yaw: load.yaw - per_pitch * pitch.yaw,
    };
    measurements.flap_moments = basis::mbc::to_blades(azimuth, felt, 3);
}

#[test]
fn individual_pitch_takes_tilt_and_yaw_moments_away() {
    for offset in [0.0, 0.3] {
        let individual = IndividualPitch {
            proportional: 0.0,
            integral: 2e-9,
            azimuth_offset: Some(offset),
            limit: 0.1,
            ramp: [8.0, 10.0],
            floor: PitchFloor::Fine,
        };
        let constants = Constants { individual_pitch: Some(individual), ..tracking_constants() };
        let mut baseline = Baseline::new(constants);
        let mut rotor = Rotor::heier(INTERVAL, 1.267);
        rotor.truth.pitch = PerBlade::splat(3, 0.2);
        let load = FixedFrame { average: 8e6, tilt: 2e6, yaw: -1e6 };
        for _ in 0..8000 {
            with_moments(&mut rotor.truth, load, 1e8, offset);
            rotor.run(&mut baseline, 1, |_| 16.0);
        }
        with_moments(&mut rotor.truth, load, 1e8, offset);
        let moments = &rotor.truth.flap_moments;
        let left = to_fixed_frame(rotor.truth.azimuth, moments);
        // Pitch is held over an interval in which the rotor turns 3.6°.
        assert!(left.tilt.hypot(left.yaw) < 0.05 * 2.3e6, "{left:?}");
        assert!((left.average - 8e6).abs() < 1.0);
    }
}

#[test]
fn individual_pitch_keeps_its_amplitude_below_limit_ramp_and_floor() {
    let amplitude = |wind_speed: f64, floor, limit| {
        let individual = IndividualPitch {
            proportional: 1e-8,
            integral: 2e-9,
            azimuth_offset: Some(0.0),
            limit,
            ramp: [8.0, 10.0],
            floor,
        };
        let mut baseline =
            Baseline::new(Constants { individual_pitch: Some(individual), ..tracking_constants() });
        let mut rotor = Rotor::heier(INTERVAL, 1.1);
        rotor.truth.pitch = PerBlade::splat(3, if wind_speed > 12.0 { 0.2 } else { 0.0 });
        let mut last = (0.0, 0.0);
        for _ in 0..6000 {
            let azimuth = rotor.truth.azimuth;
            rotor.truth.flap_moments =
                PerBlade::from_fn(3, |blade| 5e7 * blade_azimuth(azimuth, blade, 3).cos());
            let commanded = baseline.update(&rotor.truth.measured()).pitch;
            let fixed = to_fixed_frame(azimuth, &commanded);
            last = (fixed.tilt.hypot(fixed.yaw), fixed.average);
            rotor.run(&mut baseline, 1, |_| wind_speed);
        }
        last
    };
    let (full, _) = amplitude(16.0, PitchFloor::Fine, 0.05);
    assert!((full - 0.05).abs() < 1e-9, "{full}");
    assert_eq!(amplitude(7.0, PitchFloor::None, 0.05).0, 0.0);
    assert!(amplitude(9.5, PitchFloor::Fine, 0.05).0 < 1e-12, "no room at fine pitch");
    assert!((amplitude(10.5, PitchFloor::None, 0.05).0 - 0.05).abs() < 1e-9);
    let (room, collective) = amplitude(13.0, PitchFloor::Fine, 0.5);
    assert!((room - collective).abs() < 1e-9, "{room} at {collective}");
}
