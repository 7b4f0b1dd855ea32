//! A turbine on a swashplate beside one with an actuator on each blade.

use super::super::tests::{by_flow, machine};
use super::super::{Turbine, TurbineSettings};
use crate::Definition;
use crate::actuators::{Drive, PitchActuator, Swashplate, lead_of};
use basis::mbc::{to_blades, to_fixed_frame};
use basis::{Commands, FixedFrame, PerBlade, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

const INTERVAL: f64 = 0.1;
const FAST: PitchActuator = PitchActuator {
    natural_frequency: 60.0,
    damping_ratio: 1.0,
    maximum_rate: 1.0,
    minimum_pitch: -0.2,
    maximum_pitch: 1.0,
};

fn turbine(swashplate: Option<Swashplate>) -> Turbine {
    let definition =
        Definition { swashplate, pitch_actuator: FAST, ..Definition::clone(&machine()) };
    let settings = TurbineSettings {
        induction: by_flow(false),
        flexible: false,
        air_density: 1.2,
        yaw: 0.0,
        rotor_speed: 1.3,
        azimuth: 0.3,
        pitch: 0.02,
    };
    let turbine = Turbine::new(Arc::new(definition), Vector3::ZERO, settings);
    turbine.expect("a sound machine").at_held_speed()
}

fn plate() -> Swashplate {
    Swashplate {
        drive: Drive::Screw { lead: lead_of(0.1) },
        rod_radius: 1.0,
        link_radius: 1.0,
        horn_length: 1.0,
        rod_azimuth: 0.0,
        bias: [0.0; 2],
        slack: 0.0,
        gains: [1.0; 2],
    }
}

/// Average, tilt and yaw pitch (rad) that the blades of `turbine` show under a helix of 0.03 rad in the sense
/// of `rate` (rad/s), step by step.
fn seen(turbine: &mut Turbine, rate: f64, n_steps: usize) -> Vec<FixedFrame> {
    let winds = vec![Vector3::new(8.0, 0.0, 0.0); turbine.stations().len()];
    let one = |step: usize| {
        let truth = turbine.truth(step as f64 * INTERVAL, INTERVAL);
        let (sine, cosine) = (rate * truth.time).sin_cos();
        let asked = FixedFrame { average: 0.02, tilt: 0.03 * cosine, yaw: 0.03 * sine };
        let pitch = to_blades(truth.azimuth, asked, 3);
        turbine.advance(
            INTERVAL,
            &winds,
            &Commands { pitch, generator_torque: 1e6, yaw_rate: 0.0 },
        );
        let truth = turbine.truth(0.0, INTERVAL);
        to_fixed_frame(truth.azimuth, &truth.pitch)
    };
    (0..n_steps).map(one).collect()
}

#[test]
fn blades_stand_as_they_are_asked_to_without_a_step_at_the_start() {
    let mut turbine = turbine(Some(plate()));
    let winds = vec![Vector3::new(8.0, 0.0, 0.0); turbine.stations().len()];
    let at_rest =
        Commands { pitch: PerBlade::splat(3, 0.02), generator_torque: 1e6, yaw_rate: 0.0 };
    for _ in 0..20 {
        turbine.advance(INTERVAL, &winds, &at_rest);
        assert!(
            turbine.truth(0.0, INTERVAL).pitch.iter().all(|pitch| (pitch - 0.02).abs() < 1e-12)
        );
    }
    assert_eq!(turbine.limited_instants(), (20, 0));
}

/// A helix goes round slowly in the fixed frame: the plate follows it, and blades that are told each for
/// itself what to do lag by what their actuators and the control interval take at rotor frequency.
#[test]
fn a_plate_lags_by_the_excitation_alone() {
    let period = 40.0;
    let amplitude_and_lag = |turbine: &mut Turbine| {
        let seen = seen(turbine, TAU / period, 800);
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (step, seen) in seen.iter().enumerate().skip(400) {
            let (sine, cosine) = (TAU / period * (step + 1) as f64 * INTERVAL).sin_cos();
            real += (seen.tilt * cosine + seen.yaw * sine) / 400.0;
            imaginary += (seen.yaw * cosine - seen.tilt * sine) / 400.0;
        }
        (f64::hypot(real, imaginary), -imaginary.atan2(real))
    };
    let (amplitude, lag) = amplitude_and_lag(&mut turbine(Some(plate())));
    // Commands of the step before, through a lag of 2 ζ / ω.
    let expected = TAU / period * (INTERVAL + 2.0 / 60.0);
    assert!((amplitude / 0.03 - 1.0).abs() < 2e-3, "{amplitude}");
    assert!((lag - expected).abs() < 0.3 * expected, "{lag}");
    let (_, other) = amplitude_and_lag(&mut turbine(None));
    assert!(other.abs() > 3.0 * lag, "{other}");
}

#[test]
fn a_state_that_was_kept_goes_on_with_the_same_bits() {
    let plate = Swashplate { slack: 0.2, gains: [1.2, 0.9], bias: [0.0, 0.004], ..plate() };
    let mut first = turbine(Some(plate));
    seen(&mut first, -0.6, 30);
    let bytes = postcard::to_allocvec(first.state()).expect("plain data");
    let mut second = turbine(Some(plate));
    second.restore(postcard::from_bytes(&bytes).expect("the same"));
    assert_eq!(seen(&mut first, -0.6, 25), seen(&mut second, -0.6, 25));
}

/// A blade that is mounted wrong pulls as one does that is pitched so, and its bearing tells nothing of it.
#[test]
fn a_misaligned_blade_stands_as_if_it_were_pitched() {
    let misalignment = PerBlade::from_fn(3, |blade| [0.0, 0.01, -0.03][blade]);
    let mut wrong = turbine(None).misaligned(misalignment);
    let mut right = turbine(None);
    let winds = vec![Vector3::new(8.0, 0.0, 0.0); right.stations().len()];
    for _ in 0..200 {
        let commands = |pitch| Commands { pitch, generator_torque: 1e6, yaw_rate: 0.0 };
        wrong.advance(INTERVAL, &winds, &commands(PerBlade::splat(3, 0.02)));
        let pitched = PerBlade::from_fn(3, |blade| 0.02 + misalignment[blade]);
        right.advance(INTERVAL, &winds, &commands(pitched));
    }
    let (told, beside) = (wrong.truth(20.0, INTERVAL), right.truth(20.0, INTERVAL));
    assert!(told.pitch.iter().all(|pitch| (pitch - 0.02).abs() < 1e-9), "{:?}", told.pitch);
    let mut channels = vec![0.0; wrong.channels().len()];
    wrong.write_channels(&mut channels);
    let shown = wrong.channels().iter().zip(&channels);
    let mut bearings = shown.filter(|(channel, _)| channel.name.starts_with("BldPitch"));
    assert!(bearings.all(|(_, pitch)| (pitch - 0.02).abs() < 1e-9));
    assert!((told.thrust / beside.thrust - 1.0).abs() < 1e-6, "{told:?} {beside:?}");
    for (one, other) in told.flap_moments.iter().zip(beside.flap_moments.iter()) {
        assert!((one / other - 1.0).abs() < 1e-6, "{one} {other}");
    }
    let [first, last] = [told.flap_moments[0], told.flap_moments[2]];
    assert!((last / first - 1.0).abs() > 0.02, "an imbalance is felt: {first} {last}");
}
