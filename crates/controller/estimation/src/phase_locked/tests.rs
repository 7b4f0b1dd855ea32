//! Loops against tones, ramps, jumps and bad samples.

mod generators;

use super::*;
use basis::angle::wrap_to_half_turn;
use basis::{FixedFrame, Sense};
use proptest::prelude::*;
use std::f64::consts::{PI, SQRT_2, TAU};

const INTERVAL: f64 = 0.1;
/// Rates of St 0.15 to 0.3 in 9 to 10.5 m/s past 240 m (rad/s), and what a loop is given to look in.
const BAND: [f64; 2] = [TAU * 0.15 * 9.0 / 240.0, TAU * 0.3 * 10.5 / 240.0];
const RATES: [f64; 2] = [0.6 * BAND[0], 1.3 * BAND[1]];

fn kinds() -> [GeneratorKind; 3] {
    [GeneratorKind::Second, GeneratorKind::extended(SQRT_2, 1.0).unwrap(), GeneratorKind::Mixed]
}

fn settings(generator: GeneratorKind) -> PhaseLockedSettings {
    PhaseLockedSettings { generator, ..PhaseLockedSettings::between(RATES) }
}

/// Error of a loop's estimate of 3 + 2 sin(0.4 + ∫ω dt): of the phase (rad), the rate and the amplitude (–).
fn distance(estimate: &Estimate, phase: f64, rate: f64) -> [f64; 3] {
    let phase = wrap_to_half_turn(estimate.phase - phase);
    [phase.abs(), (estimate.rate / rate - 1.0).abs(), (estimate.amplitude / 2.0 - 1.0).abs()]
}

#[test]
fn a_tone_is_followed_exactly_and_its_offset_taken_off() {
    for kind in &kinds()[1..] {
        for part in 0..=8 {
            let rate = BAND[0] + (BAND[1] - BAND[0]) * f64::from(part) / 8.0;
            let mut follower = PhaseLockedLoop::new(&settings(*kind), INTERVAL).unwrap();
            let mut phase = 0.4;
            for step in 0..50_000 {
                phase = 0.4 + rate * INTERVAL * f64::from(step);
                follower.update(INTERVAL, 3.0 + 2.0 * phase.sin());
            }
            let estimate = follower.estimate();
            let [phase, rate, amplitude] = distance(&estimate, phase, rate);
            assert!(phase < 0.1_f64.to_radians() && rate < 1e-3 && amplitude < 1e-6);
            assert!((estimate.offset - 3.0).abs() < 1e-6, "{kind:?}: {}", estimate.offset);
            assert!(estimate.locked && !estimate.held);
        }
    }
}

#[test]
fn the_second_order_generator_is_disturbed_by_an_offset() {
    let mut worst = 0.0_f64;
    let mut follower = PhaseLockedLoop::new(&settings(GeneratorKind::Second), INTERVAL).unwrap();
    for step in 0..20_000 {
        let estimate =
            follower.update(INTERVAL, 1.0 + 2.0 * (0.05 * INTERVAL * f64::from(step)).sin());
        if step > 15_000 {
            worst = worst.max((estimate.rate / 0.05 - 1.0).abs());
        }
    }
    assert!(worst > 0.02, "{worst}");
}

/// Phase error (rad) after a ramp from one end of the band to the other over `duration` (s).
fn error_on_a_ramp(order: Order, duration: f64) -> f64 {
    let mut settings = settings(GeneratorKind::Mixed);
    settings.follower.order = order;
    let mut follower = PhaseLockedLoop::new(&settings, INTERVAL).unwrap();
    let growth = (BAND[1] - BAND[0]) / duration;
    let mut error = 0.0;
    for step in 0..(duration / INTERVAL) as usize {
        let time = INTERVAL * step as f64;
        let phase = BAND[0] * time + 0.5 * growth * time * time;
        let estimate = follower.update(INTERVAL, 1.0 + 2.0 * phase.sin());
        error = wrap_to_half_turn(phase - estimate.phase);
    }
    error
}

#[test]
fn only_type_two_lags_behind_a_ramp() {
    let duration = 8000.0;
    let growth = (BAND[1] - BAND[0]) / duration;
    // Eq. 2-27 without the amplitude, which the half tangent takes off.
    let lag = growth
        / Gains::new(Order::Two, settings(GeneratorKind::Mixed).follower.natural_rate, 1.0)
            .integral;
    let two = error_on_a_ramp(Order::Two, duration);
    assert!((two / lag - 1.0).abs() < 0.01, "{two} and {lag}");
    assert!(error_on_a_ramp(Order::QuasiTwo, duration).abs() < 1e-3 * lag);
    assert!(error_on_a_ramp(Order::Three, duration).abs() < 1e-2 * lag);
}

#[test]
fn the_two_axes_keep_their_own_amplitudes_offsets_and_phases() {
    for sense in [Sense::Clockwise, Sense::CounterClockwise] {
        for leader in [Leader::Tilt, Leader::Yaw, Leader::Both] {
            let signal = settings(GeneratorKind::Mixed);
            let mut follower =
                TwoAxisLoop::new(&TwoAxisSettings { signal, sense, leader }, INTERVAL).unwrap();
            let mut phase = 0.0;
            for step in 0..30_000 {
                phase = 0.05 * INTERVAL * f64::from(step);
                let tilt = 1e6 + 7e6 * phase.sin();
                let yaw = -2e6 + 1.5e7 * (phase + sense.yaw_lead()).sin();
                follower.follow(INTERVAL, FixedFrame { average: 0.0, tilt, yaw });
            }
            let TwoAxisEstimate { tilt, yaw, locked, .. } = follower.estimate();
            assert!(locked && follower.phase_error() < 1e-3);
            assert!((tilt.amplitude - 7e6).abs() < 10.0 && (yaw.amplitude - 1.5e7).abs() < 10.0);
            assert!((tilt.offset - 1e6).abs() < 10.0 && (yaw.offset + 2e6).abs() < 10.0);
            assert!(wrap_to_half_turn(tilt.phase - phase).abs() < 1e-6);
            assert!(wrap_to_half_turn(yaw.phase - phase - sense.yaw_lead()).abs() < 1e-6);
        }
    }
}

#[test]
fn samples_that_are_no_numbers_are_bridged_and_flagged() {
    for kind in kinds() {
        let offset = if kind == GeneratorKind::Second { 0.0 } else { 3.0 };
        let mut follower = PhaseLockedLoop::new(&settings(kind), INTERVAL).unwrap();
        for step in 0..24_000 {
            let phase = 0.05 * INTERVAL * f64::from(step);
            let missing = (20_000..20_400).contains(&step);
            let sample = if missing { f64::NAN } else { offset + 2.0 * phase.sin() };
            let estimate = follower.update(INTERVAL, sample);
            assert_eq!(estimate.held, missing);
            if step > 19_000 {
                let [phase, rate, amplitude] = distance(&estimate, phase, 0.05);
                assert!(
                    phase < 1e-3 && rate < 1e-3 && amplitude < 1e-3,
                    "{kind:?} at {step}: {phase} {rate} {amplitude}"
                );
                assert!(estimate.locked);
            }
        }
        // A whole period without a sample loses the lock; numbers bring it back.
        for _ in 0..1300 {
            follower.update(INTERVAL, f64::INFINITY);
        }
        assert!(!follower.estimate().locked);
        for step in 0..15_000 {
            follower.update(INTERVAL, offset + 2.0 * (0.05 * INTERVAL * f64::from(step)).sin());
        }
        assert!(follower.estimate().locked);
    }
}

/// Every third sample missing does not cost the lock; the phase stays right.
#[test]
fn scattered_gaps_do_not_cost_the_lock() {
    for kind in kinds() {
        let mut follower = PhaseLockedLoop::new(&settings(kind), INTERVAL).unwrap();
        for step in 0..30_000 {
            let phase = 0.05 * INTERVAL * f64::from(step);
            let sample = if step % 3 == 1 { f64::NAN } else { 2.0 * phase.sin() };
            let estimate = follower.update(INTERVAL, sample);
            if step > 25_000 {
                let [phase, ..] = distance(&estimate, phase, 0.05);
                assert!(estimate.locked && phase < 1e-2, "{kind:?} at {step}: {phase}");
            }
        }
    }
}

#[test]
fn noise_alone_does_not_lock() {
    let mut follower = PhaseLockedLoop::new(&settings(GeneratorKind::Mixed), INTERVAL).unwrap();
    let mut state = 1_u64;
    for _ in 0..30_000 {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let sample = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        assert!(!follower.update(INTERVAL, sample).locked);
    }
}

#[test]
fn what_cannot_be_built_says_why() {
    let build = |change: fn(&mut PhaseLockedSettings)| {
        let mut settings = settings(GeneratorKind::Mixed);
        change(&mut settings);
        PhaseLockedLoop::new(&settings, INTERVAL).unwrap_err()
    };
    let crossing = build(|settings| settings.follower.rates = [-0.01, 0.1]);
    assert!(matches!(crossing, PhaseLockedError::Rates { .. }), "{crossing}");
    let unstable = build(|settings| settings.follower.natural_rate = 0.08);
    let PhaseLockedError::Unstable { pole, .. } = unstable else { panic!("{unstable}") };
    assert!(pole.real > 0.0 && pole.imaginary != 0.0);
    assert!(unstable.to_string().contains("a pole at +"), "{unstable}");
    assert!(matches!(build(|s| s.damping = 2.5), PhaseLockedError::Damping { .. }));
    assert!(matches!(
        build(|s| s.follower.damping_ratio = 0.0),
        PhaseLockedError::LoopSetting { .. }
    ));
    let seldom = PhaseLockedLoop::new(&settings(GeneratorKind::Mixed), 30.0).unwrap_err();
    assert!(matches!(seldom, PhaseLockedError::Interval { .. }));
    let few = follow(&[1.0; 50], INTERVAL, &settings(GeneratorKind::Mixed)).unwrap_err();
    assert!(matches!(few, PhaseLockedError::TooShort { .. }), "{few}");
    for value in [5.0, f64::NAN] {
        let still =
            follow(&[value; 20_000], INTERVAL, &settings(GeneratorKind::Mixed)).unwrap_err();
        assert!(matches!(still, PhaseLockedError::Constant { .. }), "{still}");
    }
}

/// Routh's condition k_p > τ k_i of the closed loop is where the pole crosses.
#[test]
fn the_slowest_pole_crosses_where_routh_says() {
    let lag = 30.0;
    let limit = SQRT_2 / lag;
    for (share, stable) in [(0.99, true), (1.01, false)] {
        let pole = Gains::new(Order::QuasiTwo, share * limit, 1.0 / SQRT_2).slowest_pole(lag);
        assert_eq!(pole.real < 0.0, stable, "{pole}");
    }
    let gains = Gains::new(Order::Three, 0.01, 1.0 / SQRT_2);
    assert!(gains.slowest_pole(lag).real < 0.0 && gains.slowest_pole(20.0 * lag).real > 0.0);
}

/// Whether a loop of `natural_rate` (rad/s) that starts one sample off a tone comes closer to it.
fn comes_closer(kind: GeneratorKind, natural_rate: f64, rate: f64) -> bool {
    let mut settings = settings(kind);
    settings.follower.rates = [0.5 * rate, 1.5 * rate];
    settings.follower.natural_rate = natural_rate;
    let mut generator = Generator::new(kind, SQRT_2).unwrap();
    let mut oscillator = oscillator::Oscillator::new(&settings.follower);
    let interval = TAU / rate / 400.0;
    let mut errors = [0.0_f64; 2];
    for step in 0..400 * 60 {
        let turned = oscillator.turn(interval);
        let sample = (rate * interval * f64::from(step)).sin();
        generator.update(turned, sample);
        if step == 0 {
            // In lock but for the phase.
            generator = settled_on_a_tone(kind, rate * interval);
        }
        oscillator.follow(generator.in_phase(), generator.quadrature());
        let error = (oscillator.rate() / rate - 1.0).abs();
        let early = (400 * 5..400 * 10).contains(&step);
        let late = step >= 400 * 55;
        errors[0] = errors[0].max(if early { error } else { 0.0 });
        errors[1] = errors[1].max(if late { error } else { 0.0 });
    }
    errors[1] < errors[0]
}

/// A generator that has followed sin θ up to θ = 0, its centre turning by `turned` (rad) a sample.
fn settled_on_a_tone(kind: GeneratorKind, turned: f64) -> Generator {
    let mut generator = Generator::new(kind, SQRT_2).unwrap();
    for step in -400 * 30..=0 {
        generator.update(turned, (turned * f64::from(step)).sin());
    }
    generator
}

/// What the constructor accepts comes closer to a tone, what it refuses does not; the lag of the phase alone
/// would accept more.
#[test]
fn the_whole_loop_is_stable_where_it_can_be_built() {
    let rate = 0.05;
    for kind in kinds() {
        let limit = SQRT_2 * rate / kind.lag(SQRT_2);
        for share in [0.3, 0.55, 0.8, 0.95, 1.25] {
            let mut settings = settings(kind);
            settings.follower.rates = [rate, 2.0 * rate];
            settings.follower.natural_rate = share * limit;
            let built = PhaseLockedLoop::new(&settings, INTERVAL).is_ok();
            let closer = comes_closer(kind, share * limit, rate);
            assert_eq!(built, closer, "{kind:?} at {share}");
            let expected =
                share < if matches!(kind, GeneratorKind::Extended { .. }) { 0.4 } else { 0.6 };
            assert_eq!(built, expected, "{kind:?} at {share}");
        }
    }
}

#[test]
fn a_state_survives_being_written_and_read() {
    let mut follower = PhaseLockedLoop::new(&settings(GeneratorKind::Mixed), INTERVAL).unwrap();
    let sample = |step: i32| 3.0 + 2.0 * (0.05 * INTERVAL * f64::from(step)).sin();
    for step in 0..5000 {
        follower.update(INTERVAL, sample(step));
    }
    let bytes = postcard::to_stdvec(&follower).unwrap();
    let mut resumed: PhaseLockedLoop = postcard::from_bytes(&bytes).unwrap();
    for step in 5000..6000 {
        assert_eq!(follower.update(INTERVAL, sample(step)), resumed.update(INTERVAL, sample(step)));
    }
}

/// From every phase and rate the half tangent comes home within the same turn; nothing waits at half a turn.
#[test]
fn the_loop_locks_from_any_phase() {
    for part in 0..16 {
        let first = TAU * f64::from(part) / 16.0 + PI;
        for rate in [BAND[0], BAND[1]] {
            let mut follower =
                PhaseLockedLoop::new(&settings(GeneratorKind::Mixed), INTERVAL).unwrap();
            let mut phase = 0.0;
            for step in 0..40_000 {
                phase = first + rate * INTERVAL * f64::from(step);
                follower.update(INTERVAL, 2.0 * phase.sin());
            }
            let [phase, rate, _] = distance(&follower.estimate(), phase, rate);
            assert!(phase < 1e-4 && rate < 1e-4 && follower.estimate().locked);
        }
    }
}
