//! The helix against its closed forms: normal-mode form, spectral line, symmetry of its two senses.

use basis::mbc::{blade_azimuth, to_fixed_frame};
use control::{Excitation, Helix, Pulse, Sense, excitation_rate};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A helix long after its fade-in.
fn helix(sense: Sense, amplitude: f64, rate: f64, phase: f64, azimuth_offset: f64) -> Helix {
    let (strouhal, start, stop, chirp) = (0.25, -1e6, None, None);
    Helix { sense, amplitude, strouhal, rate, phase, azimuth_offset, start, stop, chirp }
}

fn senses() -> impl Strategy<Value = Sense> {
    prop_oneof![Just(Sense::Clockwise), Just(Sense::CounterClockwise)]
}

proptest! {
    /// van Vondelen et al. (2025), Eq. 7, with the minus sign of the cw form that the module derives.
    #[test]
    fn inverse_transformation_equals_the_normal_mode_form(
        sense in senses(), n_blades in 3_usize..=6, amplitude in 0.0..0.1_f64, rate in 0.01..0.2_f64,
        rotor_speed in 0.3..1.5_f64, initial in 0.0..TAU, phase in -PI..PI, offset in -PI..PI,
        time in 0.0..3000.0_f64,
    ) {
        let helix = helix(sense, amplitude, rate, phase, offset);
        let pitch = helix.pitch(time, initial + rotor_speed * time, n_blades);
        for (blade, pitch) in pitch.iter().enumerate() {
            let azimuth = blade_azimuth(initial, blade, n_blades) + offset;
            let expected = match sense {
                Sense::CounterClockwise => {
                    amplitude * ((rotor_speed + rate) * time + azimuth + phase).sin()
                }
                Sense::Clockwise => {
                    -amplitude * ((rotor_speed - rate) * time + azimuth - phase).sin()
                }
            };
            prop_assert!((pitch - expected).abs() < 1e-11);
        }
    }

    #[test]
    fn forward_transformation_gives_the_commands_back(
        sense in senses(), n_blades in 3_usize..=6, amplitude in 0.0..0.1_f64,
        azimuth in -10.0..10.0_f64, offset in -PI..PI, time in 0.0..3000.0_f64,
    ) {
        let helix = helix(sense, amplitude, 0.07, 0.4, offset);
        let commands = helix.commands(time);
        let back = to_fixed_frame(azimuth + offset, &helix.pitch(time, azimuth, n_blades));
        prop_assert!(back.average.abs() < 1e-14);
        prop_assert!((back.tilt - commands.tilt).abs() < 1e-14);
        prop_assert!((back.yaw - commands.yaw).abs() < 1e-14);
    }

    #[test]
    fn senses_swap_when_the_rotor_is_mirrored(
        n_blades in 3_usize..=6, azimuth in 0.0..TAU, offset in -PI..PI, time in 0.0..3000.0_f64,
    ) {
        let ccw = helix(Sense::CounterClockwise, 0.07, 0.07, 0.3, offset);
        let cw = helix(Sense::Clockwise, 0.07, 0.07, 0.3, -offset);
        let turning = ccw.pitch(time, azimuth, n_blades);
        let mirrored = cw.pitch(time, -azimuth, n_blades);
        for blade in 0..n_blades {
            let image = (n_blades - blade) % n_blades;
            prop_assert!((turning[blade] - mirrored[image]).abs() < 1e-14);
        }
    }

    /// In a frame that turns with the excitation, the helix stands still.
    #[test]
    fn image_in_the_helix_frame_is_constant(sense in senses(), time in 0.0..3000.0_f64) {
        let helix = helix(sense, 0.07, 0.07, 0.3, 0.0);
        let commands = helix.commands(time);
        let sign = helix.sense.yaw_lead() / FRAC_PI_2;
        let (sine, cosine) = (sign * (helix.rate * time + helix.phase)).sin_cos();
        let along = commands.tilt * cosine - commands.yaw * sine;
        let across = commands.tilt * sine + commands.yaw * cosine;
        prop_assert!(along.abs() < 1e-13);
        prop_assert!((across - sign * helix.amplitude).abs() < 1e-13);
    }
}

/// Amplitude of `samples` at `n_periods` whole periods over the record.
fn line(samples: &[f64], n_periods: usize) -> f64 {
    let (mut real, mut imaginary) = (0.0, 0.0);
    for (index, sample) in samples.iter().enumerate() {
        let (sine, cosine) = (TAU * (n_periods * index) as f64 / samples.len() as f64).sin_cos();
        real += sample * cosine;
        imaginary += sample * sine;
    }
    2.0 * f64::hypot(real, imaginary) / samples.len() as f64
}

#[test]
fn every_blade_pitches_at_one_frequency() {
    // 100 s hold ten turns of the rotor and one excitation period.
    let (rotor_speed, rate) = (TAU / 10.0, TAU / 100.0);
    for (sense, n_periods) in [(Sense::CounterClockwise, 11), (Sense::Clockwise, 9)] {
        let helix = helix(sense, 0.07, rate, 0.3, 0.1);
        for blade in 0..3 {
            let pitch: Vec<f64> = (0..400)
                .map(|step| {
                    let time = 0.25 * f64::from(step);
                    helix.pitch(time, rotor_speed * time, 3)[blade]
                })
                .collect();
            for other in 1..200 {
                let expected = if other == n_periods { 0.07 } else { 0.0 };
                assert!((line(&pitch, other) - expected).abs() < 1e-12, "{sense} {other}");
            }
        }
    }
}

/// Counter-clockwise seen from upwind: the direction of greatest pitch runs against the rotor.
#[test]
fn greatest_pitch_of_the_ccw_helix_runs_against_the_rotor() {
    let direction = |sense, time| {
        let commands = helix(sense, 0.07, 0.07, 0.0, 0.0).commands(time);
        f64::atan2(commands.yaw, commands.tilt)
    };
    assert!(direction(Sense::CounterClockwise, 11.0) < direction(Sense::CounterClockwise, 10.0));
    assert!(direction(Sense::Clockwise, 11.0) > direction(Sense::Clockwise, 10.0));
}

#[test]
fn words_name_kind_sense_amplitude_and_strouhal_number() {
    let four = 4.0_f64.to_radians();
    let ccw = Helix::new(Sense::CounterClockwise, four, 0.25, 8.0, 284.0);
    assert_eq!(ccw.describe(), "helix ccw 4.0° St 0.25");
    let cw = Helix { sense: Sense::Clockwise, ..ccw };
    assert_eq!(cw.describe(), "helix cw 4.0° St 0.25");
    let pulse = Pulse::new(2.5_f64.to_radians(), 0.3, 8.0, 284.0);
    assert_eq!(pulse.describe(), "pulse 2.5° St 0.30");
    assert_eq!(ccw.rate, excitation_rate(0.25, 8.0, 284.0));
}
