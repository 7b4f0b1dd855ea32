//! Perfect by default, and what each fault does, against its definition.

use crate::{Instrument, Instruments, Lag, Sensing, seed_of_turbine};
use basis::{Measurements, PerBlade, Truth};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn truth(time: f64) -> Truth {
    Truth {
        time,
        interval: 0.1,
        azimuth: (0.7 * time).rem_euclid(TAU),
        rotor_speed: 0.7,
        generator_speed: 0.7 + 0.1 * (0.5 * time).sin(),
        pitch: PerBlade::from_fn(3, |blade| 0.1 + 0.01 * blade as f64),
        yaw: 0.1,
        generator_torque: 1.2e7,
        power: 8e6,
        thrust: 2e6,
        aerodynamic_torque: 1.3e7,
        rotor_wind_speed: 6.0,
        flap_moments: PerBlade::splat(3, 5e7),
        edge_moments: PerBlade::splat(3, 1e7),
        tower_top_acceleration: 0.05,
    }
}

fn sensing(instruments: Instruments) -> Sensing {
    Sensing::new(instruments, 7).expect("such instruments can be")
}

fn faulty() -> Instruments {
    let fault = Instrument { noise: 0.01, dropout: 0.1, ..Instrument::default() };
    let lag = Lag::Second { frequency: 5.0, damping: 0.7 };
    Instruments {
        azimuth: Instrument { resolution: TAU / 4096.0, ..fault },
        generator_speed: Instrument { lag, ..fault },
        pitch: fault,
        ..Instruments::default()
    }
}

proptest! {
    #[test]
    fn perfect_instruments_show_every_bit(speed in prop::num::f64::ANY, azimuth in prop::num::f64::ANY) {
        let truth = Truth { generator_speed: speed, azimuth, ..truth(3.0) };
        let shown = sensing(Instruments::default()).gauge(&truth);
        prop_assert_eq!(shown.generator_speed.to_bits(), speed.to_bits());
        prop_assert_eq!(shown.azimuth.to_bits(), azimuth.to_bits());
        prop_assert_eq!(shown.pitch, truth.pitch);
    }
}

#[test]
fn noise_has_its_mean_and_deviation_and_differs_between_blades() {
    let noisy = Instrument { noise: 0.02, bias: 0.005, ..Instrument::default() };
    let mut sensing = sensing(Instruments { pitch: noisy, ..Instruments::default() });
    let n = 20_000;
    let (mut sum, mut squares, mut products) = (0.0, 0.0, 0.0);
    for step in 0..n {
        let truth = truth(0.1 * f64::from(step));
        let shown = sensing.gauge(&truth);
        let error = |blade: usize| shown.pitch[blade] - truth.pitch[blade];
        sum += error(0);
        squares += (error(0) - 0.005).powi(2);
        products += (error(0) - 0.005) * (error(1) - 0.005);
    }
    let n = f64::from(n);
    // Four standard errors.
    assert!((sum / n - 0.005).abs() < 4.0 * 0.02 / n.sqrt());
    assert!(((squares / n).sqrt() / 0.02 - 1.0).abs() < 4.0 / (2.0 * n).sqrt());
    assert!((products / n).abs() < 4.0 * 0.02 * 0.02 / n.sqrt());
}

#[test]
fn a_lag_of_first_order_turns_a_ramp_into_one_that_is_late_by_its_time_constant() {
    let lag = Lag::First { time_constant: 0.8 };
    let late = Instrument { lag, ..Instrument::default() };
    let mut sensing = sensing(Instruments { power: late, azimuth: late, ..Instruments::default() });
    let mut last = (truth(0.0), truth(0.0).measured());
    for step in 0..400 {
        let time = 0.1 * f64::from(step);
        let truth = Truth { power: 1e5 * time, ..truth(time) };
        last = (truth, sensing.gauge(&truth));
    }
    let (truth, shown) = last;
    let late = (truth.power - shown.power) / 1e5;
    assert!((late / 0.8 - 1.0).abs() < 2e-3, "{late}");
    // Through full turns too.
    let behind = (truth.azimuth - shown.azimuth).rem_euclid(TAU);
    assert!((behind / (0.7 * 0.8) - 1.0).abs() < 2e-3, "{behind}");
}

#[test]
fn an_encoder_shows_its_steps_and_a_dropout_repeats() {
    let encoder = Instrument { resolution: 0.01, dropout: 0.25, ..Instrument::default() };
    let mut sensing = sensing(Instruments { generator_speed: encoder, ..Instruments::default() });
    let (mut last, mut repeats) = (f64::NAN, 0);
    let n = 4000;
    for step in 0..n {
        let time = 0.1 * f64::from(step);
        // Each reading a step further on, so that only a drop-out repeats.
        let mut truth = truth(time);
        truth.generator_speed = 0.01 * f64::from(step) + 0.003;
        let shown = sensing.gauge(&truth).generator_speed;
        repeats += i32::from(shown == last);
        let steps = shown / 0.01;
        assert!((steps - steps.round()).abs() < 1e-9, "{shown}");
        last = shown;
    }
    let share = f64::from(repeats) / f64::from(n);
    assert!((share - 0.25).abs() < 4.0 * (0.25 * 0.75 / f64::from(n)).sqrt(), "{share}");
}

#[test]
fn stored_and_restored_it_goes_on_with_the_same_bits() {
    let read = |sensing: &mut Sensing, from: u32, to: u32| -> Vec<Measurements<'static>> {
        (from..to).map(|step| sensing.gauge(&truth(0.1 * f64::from(step)))).collect()
    };
    let mut one = sensing(faulty());
    read(&mut one, 0, 100);
    let stored = postcard::to_stdvec(&one.state()).expect("plain data serialises");
    let mut other = sensing(faulty());
    let stored = postcard::from_bytes(&stored).expect("what was written is read");
    other.restore(stored).expect("the same instruments");
    assert_eq!(read(&mut one, 100, 200), read(&mut other, 100, 200));
    let mut reseeded = Sensing::new(faulty(), 8).expect("such instruments can be");
    assert_ne!(read(&mut sensing(faulty()), 0, 9), read(&mut reseeded, 0, 9));
}

#[test]
fn winds_and_turbines_have_their_own_seeds() {
    let seeds: std::collections::BTreeSet<u64> = (0..40)
        .flat_map(|wind| (0..40).map(move |turbine| seed_of_turbine(wind, turbine)))
        .collect();
    assert_eq!(seeds.len(), 1600);
    assert!(Instruments::default().are_perfect() && !faulty().are_perfect());
    let perfect = Sensing::perfect();
    assert_eq!(perfect.instruments(), &Instruments::default());
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |pitch| {
        let instruments = Instruments { pitch, ..Instruments::default() };
        Sensing::new(instruments, 0).err().expect("refused").to_string()
    };
    let fine = Instrument::default();
    let message = refused(Instrument { noise: -1.0, ..fine });
    assert_eq!(message, "instrument pitch: noise must be zero or more, it is -1");
    assert!(refused(Instrument { dropout: 1.0, ..fine }).contains("dropout"));
    assert!(refused(Instrument { bias: f64::NAN, ..fine }).contains("bias"));
    let lag = Lag::First { time_constant: 0.0 };
    assert!(refused(Instrument { lag, ..fine }).contains("time_constant"));
}
