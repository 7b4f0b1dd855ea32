//! The baseline along k ω² on a rotor with a known power coefficient: settles where theory says, within its
//! limits.

mod rotor;

use basis::PerBlade;
use control::baseline::{Baseline, Constants, MinimumPitch};
use control::{Controller, Excitation, Helix, Pulse, Sense};
use proptest::prelude::*;
use rotor::{RADIUS, RATED_POWER, RATED_SPEED, Rotor, bits, constants, gusts, spread};

#[test]
fn settles_at_the_optimal_tip_speed_ratio_below_rated() {
    let constants = constants();
    for interval in [0.05, 0.1, 0.2, 0.3] {
        for wind_speed in [5.0, 7.0, 9.0] {
            let mut baseline = Baseline::new(constants.clone());
            let n_steps = (600.0 / interval) as usize;
            let run = Rotor::new(interval, 0.8).run(&mut baseline, n_steps, |_| wind_speed);
            let tail = &run[n_steps - (100.0 / interval) as usize..];
            let (speed, wobble) = spread(tail.iter().map(|m| m.rotor_speed));
            let ratio = speed * RADIUS / wind_speed / constants.optimal_tip_speed_ratio;
            assert!((ratio - 1.0).abs() < 2e-3, "{interval} s, {wind_speed} m/s: {ratio}");
            assert!(wobble < 1e-3 * speed, "{interval} s, {wind_speed} m/s: {wobble}");
            assert!(tail.iter().all(|m| m.pitch.mean() == constants.fine_pitch));
        }
    }
}

#[test]
fn holds_rated_speed_and_power_above_rated() {
    let constants = constants();
    for constant_power in [true, false] {
        let constants = Constants { constant_power, ..constants.clone() };
        for interval in [0.05, 0.1, 0.2, 0.3] {
            for wind_speed in [13.0, 17.0, 23.0] {
                let mut baseline = Baseline::new(constants.clone());
                let n_steps = (600.0 / interval) as usize;
                // Feathered, as after a start: at fine pitch this rotor would stall in a storm.
                let mut rotor = Rotor::new(interval, 1.2);
                rotor.truth.pitch = PerBlade::splat(3, 0.3);
                let run = rotor.run(&mut baseline, n_steps, |_| wind_speed);
                let tail = &run[n_steps - (100.0 / interval) as usize..];
                let (speed, wobble) = spread(tail.iter().map(|m| m.rotor_speed));
                let (power, _) = spread(tail.iter().map(|m| m.power));
                assert!((speed / RATED_SPEED - 1.0).abs() < 1e-3, "{wind_speed} m/s: {speed}");
                assert!((power / RATED_POWER - 1.0).abs() < 1e-3, "{wind_speed} m/s: {power}");
                assert!(wobble < 1e-4, "{interval} s, {wind_speed} m/s: {wobble}");
            }
        }
    }
}

#[test]
fn keeps_minimum_rotor_speed_in_a_light_wind() {
    let constants = constants();
    let mut baseline = Baseline::new(constants.clone());
    let run = Rotor::new(0.1, 0.6).run(&mut baseline, 6000, |_| 3.0);
    let speed = run[5999].rotor_speed;
    assert!((speed / constants.minimum_rotor_speed - 1.0).abs() < 1e-3, "{speed}");
}

/// Around rated, where torque and pitch control meet, the rotor settles too.
#[test]
fn settles_at_every_wind_speed_around_rated() {
    let constants = constants();
    for tenth in 95..=130 {
        let wind_speed = f64::from(tenth) * 0.1;
        let mut baseline = Baseline::new(constants.clone());
        let run = Rotor::new(0.2, 1.1).run(&mut baseline, 5000, |_| wind_speed);
        let (speed, wobble) = spread(run[4500..].iter().map(|m| m.rotor_speed));
        assert!(wobble < 2e-4, "{wind_speed} m/s: {wobble}");
        assert!(speed < 1.01 * RATED_SPEED, "{wind_speed} m/s: {speed}");
    }
}

#[test]
fn power_rises_with_the_wind_up_to_rated_and_stays() {
    let constants = constants();
    let mut last = 0.0;
    for tenth in (40..200).step_by(4) {
        let wind_speed = f64::from(tenth) * 0.1;
        let mut baseline = Baseline::new(constants.clone());
        let run = Rotor::new(0.2, 1.0).run(&mut baseline, 5000, |_| wind_speed);
        let (power, _) = spread(run[4500..].iter().map(|m| m.power));
        assert!(power > last - 1e-3 * RATED_POWER, "{wind_speed} m/s: {power} after {last}");
        assert!(power < 1.002 * RATED_POWER, "{wind_speed} m/s: {power}");
        last = power;
    }
}

#[test]
fn least_pitch_follows_its_table_at_the_wind_speed_of_the_power() {
    let row = |wind_speed, pitch| MinimumPitch { wind_speed, pitch };
    let constants = Constants { minimum_pitch: vec![row(4.0, 0.0), row(9.0, 0.01)], ..constants() };
    let mut baseline = Baseline::new(constants);
    let run = Rotor::new(0.2, 0.8).run(&mut baseline, 5000, |_| 8.0);
    // Half a degree costs little power, so that the estimate is close to the wind.
    assert!((run[4999].pitch.mean() - 0.008).abs() < 3e-4, "{}", run[4999].pitch.mean());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Steps of the wind, up and down, at any interval.
    #[test]
    fn stays_within_its_limits_in_gusts(
        winds in prop::collection::vec(3.5..25.0_f64, 8), interval in 0.05..0.3_f64,
    ) {
        let constants = constants();
        let mut baseline = Baseline::new(constants.clone());
        let n_steps = (240.0 / interval) as usize;
        let gusts = |time: f64| winds[((time / 30.0) as usize).min(winds.len() - 1)];
        let run = Rotor::new(interval, 1.0).run(&mut baseline, n_steps, gusts);
        for pair in run.windows(2) {
            let torque = pair[1].generator_torque;
            prop_assert!((0.0..=constants.maximum_torque).contains(&torque));
            let torque_rate = (torque - pair[0].generator_torque).abs() / interval;
            prop_assert!(torque_rate <= constants.maximum_torque_rate * (1.0 + 1e-9));
            let pitch = pair[1].pitch.mean();
            prop_assert!((constants.fine_pitch..=constants.maximum_pitch).contains(&pitch));
            let pitch_rate = (pitch - pair[0].pitch.mean()).abs() / interval;
            prop_assert!(pitch_rate <= constants.maximum_pitch_rate * (1.0 + 1e-9));
            prop_assert!(pair[1].rotor_speed > 0.1 && pair[1].rotor_speed < 1.6 * RATED_SPEED);
        }
    }
}

#[test]
fn amplitude_zero_is_the_baseline_bit_for_bit() {
    let baseline = || -> Box<dyn Controller> { Box::new(Baseline::new(constants())) };
    let fly = |mut controller: Box<dyn Controller>| {
        bits(&Rotor::new(0.2, 1.0).run(&mut *controller, 2000, gusts))
    };
    let alone = fly(baseline());
    let helix = Helix::new(Sense::CounterClockwise, 0.0, 0.25, 10.5, 2.0 * RADIUS);
    assert_eq!(alone, fly(helix.on_top_of(baseline())));
    let pulse = Pulse::new(0.0, 0.25, 10.5, 2.0 * RADIUS);
    assert_eq!(alone, fly(pulse.on_top_of(baseline())));
    assert_ne!(alone, fly(Helix { amplitude: 0.01, ..helix }.on_top_of(baseline())));
}

/// Before its start, an excitation of any amplitude is not there.
#[test]
fn nothing_is_added_before_the_start() {
    let baseline = || -> Box<dyn Controller> { Box::new(Baseline::new(constants())) };
    let fly = |mut controller: Box<dyn Controller>| {
        bits(&Rotor::new(0.2, 1.0).run(&mut *controller, 500, gusts))
    };
    let helix = Helix {
        start: 100.0,
        ..Helix::new(Sense::CounterClockwise, 0.07, 0.25, 10.5, 2.0 * RADIUS)
    };
    assert_eq!(fly(baseline()), fly(helix.on_top_of(baseline())));
}

#[test]
fn a_stored_controller_goes_on_with_the_same_bits() {
    let helix = Helix::new(Sense::CounterClockwise, 0.07, 0.25, 10.5, 2.0 * RADIUS);
    let new = || helix.on_top_of(Box::new(Baseline::new(constants())));
    let mut rotor = Rotor::new(0.2, 1.0);
    let mut controller = new();
    rotor.run(&mut *controller, 777, gusts);
    let stored = controller.save();
    let mut twin = rotor.clone();
    let mut restored = new();
    restored.restore(&stored).expect("its own state");
    assert_eq!(restored.save(), controller.save());
    let uninterrupted = bits(&rotor.run(&mut *controller, 500, gusts));
    assert_eq!(uninterrupted, bits(&twin.run(&mut *restored, 500, gusts)));
    assert_eq!(restored.save(), controller.save());
    // What another controller saved is refused, and so is what was cut short.
    assert!(restored.restore(&Baseline::new(constants()).save()).is_err());
    assert!(restored.restore(&stored[..stored.len() - 1]).is_err());
}

#[test]
fn a_reading_that_is_no_number_gives_commands_that_are() {
    let mut baseline = Baseline::new(constants());
    let mut rotor = Rotor::new(0.2, 1.0);
    rotor.run(&mut baseline, 100, gusts);
    rotor.truth.rotor_speed = f64::NAN;
    rotor.truth.generator_speed = f64::NAN;
    let commands = baseline.update(&rotor.truth.measured());
    assert!(commands.generator_torque.is_finite() && commands.pitch[0].is_finite());
    rotor.truth.rotor_speed = 1.0;
    rotor.truth.generator_speed = 1.0;
    let commands = baseline.update(&rotor.truth.measured());
    assert!(commands.generator_torque > 0.0);
}
