//! Theodorsen's function, steady limits, stall, and any flow at all.

use super::*;
use crate::sample::{ZERO_LIFT as SAMPLE_ZERO_LIFT, aerofoil, polar};
use proptest::prelude::*;

const SPEED: f64 = 50.0;
const CHORD: f64 = 2.0;

fn plate() -> Polar {
    polar(|angle| 2.0 * PI * angle.sin(), |_| 0.0)
}

fn stream(angle_of_attack: f64) -> Stream {
    Stream { angle_of_attack, speed: SPEED, chord: CHORD, rotation: 0.0 }
}

#[test]
fn parameters_are_the_polars() {
    let stall = DynamicStall::new(&plate(), Attached::Delayed).unwrap();
    assert!(stall.zero_lift_angle.abs() < 1e-12);
    assert!((stall.lift_slope / (2.0 * PI) - 1.0).abs() < 1e-3, "{stall:?}");
    let stall = DynamicStall::new(&aerofoil(), Attached::Delayed).unwrap();
    assert!((stall.zero_lift_angle - SAMPLE_ZERO_LIFT).abs() < 1e-4, "{stall:?}");
    assert!((stall.lift_slope / (2.0 * PI) - 1.0).abs() < 1e-2);
    assert_eq!(DynamicStall::new(&polar(|_| 0.0, |_| 0.5), Attached::Delayed), None);
    let cylinder = polar(|angle| 1e-4 * angle.sin(), |_| 0.35);
    assert_eq!(DynamicStall::new(&cylinder, Attached::Delayed), None);
}

#[test]
fn a_steady_flow_has_the_polars_coefficients() {
    let polar = aerofoil();
    let stall = DynamicStall::new(&polar, Attached::Delayed).unwrap();
    for k in -314..=314 {
        let stream = stream(0.01 * f64::from(k));
        let mut state = stall.settled(&stream, &polar);
        let expected = polar.at(stream.angle_of_attack);
        for interval in [0.0, 0.02, 100.0] {
            let got = stall.advance(interval, &stream, &polar, &mut state);
            assert!((got.lift - expected.lift).abs() < 1e-9, "{k}: {got:?} {expected:?}");
            assert!((got.drag - expected.drag).abs() < 1e-9, "{k}: {got:?} {expected:?}");
        }
    }
}

/// First harmonic, cosine and sine part over the amplitude of `motion`, of lift over 2π at reduced frequency
/// `k`.
fn harmonic(k: f64, motion: impl Fn(f64, f64) -> (f64, f64)) -> [f64; 2] {
    let polar = plate();
    let stall = DynamicStall::new(&polar, Attached::Delayed).unwrap();
    let frequency = k * 2.0 * SPEED / CHORD;
    let steps = 400;
    let interval = 2.0 * PI / frequency / f64::from(steps);
    let mut state = stall.settled(&stream(0.0), &polar);
    let mut parts = [0.0; 2];
    for step in 0..40 * steps {
        let phase = frequency * interval * f64::from(step);
        let (angle_of_attack, rotation) = motion(phase, frequency);
        let stream = Stream { rotation, ..stream(angle_of_attack) };
        let lift = stall.advance(interval, &stream, &polar, &mut state).lift / (2.0 * PI);
        if step >= 39 * steps {
            parts[0] += 2.0 / f64::from(steps) * lift * phase.cos();
            parts[1] += 2.0 / f64::from(steps) * lift * phase.sin();
        }
    }
    parts
}

/// Real part of Theodorsen's function and minus its imaginary part, by reduced frequency: NACA report 496,
/// 1935, table.
const THEODORSEN: [(f64, f64, f64); 5] = [
    (0.05, 0.9090, 0.1306),
    (0.1, 0.8319, 0.1723),
    (0.2, 0.7276, 0.1886),
    (0.3, 0.6650, 0.1793),
    (0.5, 0.5979, 0.1507),
];

#[test]
fn a_heaving_plate_follows_theodorsen() {
    let amplitude = 0.02;
    for (k, real, imaginary) in THEODORSEN {
        // Angle of attack as a cosine: lift over 2π is C(k) times it.
        let [cosine, sine] = harmonic(k, |phase, _| (amplitude * phase.cos(), 0.0));
        let (cosine, sine) = (cosine / amplitude, sine / amplitude);
        let (got, expected) = (cosine.hypot(sine), real.hypot(imaginary));
        assert!((got / expected - 1.0).abs() < 0.02, "{k}: {got} {expected}");
        let (got, expected) = (sine.atan2(cosine), imaginary.atan2(real));
        assert!((got - expected).abs() < 0.03, "{k}: {got} {expected}");
    }
}

#[test]
fn a_plate_pitching_about_its_quarter_chord_follows_theodorsen() {
    let amplitude = 0.02;
    for (k, real, imaginary) in THEODORSEN.into_iter().take(3) {
        let [cosine, sine] = harmonic(k, |phase, frequency| {
            (amplitude * phase.cos(), -amplitude * frequency * phase.sin())
        });
        // Theodorsen: C(k) (θ + θ̇ b/U) + θ̇ b/2U, with b/U θ̇ = −k θ₀ sin; the term with θ̈, k²/4, is not
        // the model's.
        let expected_cosine = real + k * imaginary;
        let expected_sine = imaginary - k * real - 0.5 * k;
        let scale = amplitude * real.hypot(imaginary);
        assert!((cosine - amplitude * expected_cosine).abs() < 0.03 * scale, "{k} {cosine}");
        assert!((sine - amplitude * expected_sine).abs() < 0.03 * scale, "{k} {sine}");
    }
}

#[test]
fn stall_comes_late_and_lift_returns_to_the_polar() {
    let polar = aerofoil();
    let stall = DynamicStall::new(&polar, Attached::Delayed).unwrap();
    let highest = (0..400).map(|k| polar.at(0.001 * f64::from(k)).lift).fold(0.0, f64::max);
    let mut state = stall.settled(&stream(0.1), &polar);
    let (mut peak, mut lift) = (0.0_f64, 0.0);
    let interval = 0.002;
    for step in 0..5000 {
        // Fifteen degrees in a tenth of a second, beyond stall.
        let angle = (0.1 + 2.6 * f64::from(step) * interval).min(0.36);
        let got = stall.advance(interval, &stream(angle), &polar, &mut state);
        lift = got.lift;
        peak = peak.max(lift);
        assert!((0.0..=1.0).contains(&state.attachment()));
    }
    assert!(peak > 1.1 * highest, "{peak} {highest}");
    assert!((lift - polar.at(0.36).lift).abs() < 1e-3, "{lift}");
    assert!(state.attachment() < 0.3);
}

#[test]
fn without_the_wakes_delay_attached_lift_is_the_polars_at_once() {
    let polar = aerofoil();
    let stall = DynamicStall::new(&polar, Attached::Steady).unwrap();
    let mut state = stall.settled(&stream(0.0), &polar);
    let got = stall.advance(1e-3, &stream(0.05), &polar, &mut state);
    let expected = polar.at(0.05);
    assert!((got.lift / expected.lift - 1.0).abs() < 2e-2, "{got:?} {expected:?}");
}

proptest! {
    #[test]
    fn any_flow_gives_bounded_coefficients(
        angles in prop::collection::vec(-7.0..7.0_f64, 30),
        speeds in prop::collection::vec(0.0..120.0_f64, 30),
        intervals in prop::collection::vec(0.0..2.0_f64, 30), rotation in -1.0..1.0_f64,
    ) {
        let polar = aerofoil();
        let stall = DynamicStall::new(&polar, Attached::Delayed).unwrap();
        let mut state = stall.settled(&stream(0.3), &polar);
        for ((angle_of_attack, speed), interval) in angles.into_iter().zip(speeds).zip(intervals) {
            let stream = Stream { angle_of_attack, speed, chord: CHORD, rotation: rotation * speed / CHORD };
            let got = stall.advance(interval, &stream, &polar, &mut state);
            prop_assert!(got.lift.is_finite() && got.drag.is_finite() && got.moment.is_finite());
            // Lift stays below what attached flow would reach at the model's largest angle, apparent mass
            // included.
            prop_assert!(got.lift.abs() < 2.0 * PI * (NONE - SAMPLE_ZERO_LIFT) + PI, "{got:?}");
            prop_assert!((0.0..=1.0).contains(&state.attachment()));
        }
    }
}
