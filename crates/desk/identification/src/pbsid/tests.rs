//! Models of simulated systems: poles, orders, responses.

use super::*;
use crate::excitation::pseudo_random_binary;
use crate::fit::{predicted, simulated, variance_accounted_for};
use crate::simulate::{Noise, delayed, experiment, level, noise, oscillators, record, response};
use crate::{IdentificationError, Record};
use faer::Mat;
use lti::matrices::StateSpace;

fn settings(window: usize) -> Settings {
    Settings {
        past: window,
        future: window,
        feedthrough: true,
        regularisation: Regularisation::Exact,
    }
}

/// Largest distance of a system's poles from the nearest of those found, as a share of their modulus.
fn pole_error(system: &StateSpace, found: &StateSpace) -> f64 {
    let found = found.poles().expect("converges");
    let known = system.poles().expect("converges");
    let nearest = |pole: &lti::Complex64| {
        found.iter().map(|other| (other - pole).norm() / pole.norm()).fold(f64::MAX, f64::min)
    };
    known.iter().map(nearest).fold(0.0, f64::max)
}

/// Largest difference of the two systems' responses, as a share of the largest response.
fn response_error(system: &StateSpace, found: &StateSpace) -> f64 {
    let (mut error, mut size) = (0.0_f64, 0.0_f64);
    for step in 0..=60 {
        let frequency = 0.05 * f64::from(step);
        let known = system.response(frequency).expect("no pole there");
        let difference = &known - found.response(frequency).expect("no pole there");
        error = error.max(difference.norm_max());
        size = size.max(known.norm_max());
    }
    error / size
}

#[test]
fn poles_are_found_in_white_and_coloured_noise() {
    for order in [2, 4, 6, 8] {
        let system = oscillators(order);
        for noisy in [Noise::White(20.0), Noise::Coloured(20.0)] {
            for regularisation in [Regularisation::Exact, Regularisation::CrossValidated] {
                let record = experiment(&system, order as u64, 6000, noisy);
                let settings = Settings { regularisation, ..settings(30) };
                let subspace = Subspace::new(&record, settings).expect("a good record");
                assert_eq!(subspace.largest_gap(12), order);
                let model = subspace.model(order).expect("an order");
                let error = pole_error(&system, &model.system);
                println!("order {order}, {noisy:?}, {regularisation:?}: {error}");
                assert!(error < 0.01, "order {order}, {noisy:?}, {regularisation:?}: {error}");
                assert!(response_error(&system, &model.system) < 0.05);
            }
        }
    }
}

#[test]
fn without_noise_all_is_exact() {
    for order in [2, 4, 6, 8] {
        let system = oscillators(order);
        let record = experiment(&system, 1, 1500, Noise::None);
        for regularisation in [Regularisation::Exact, Regularisation::CrossValidated] {
            let settings = Settings { regularisation, ..settings(15) };
            let subspace = Subspace::new(&record, settings).expect("a good record");
            assert_eq!(subspace.largest_gap(15), order);
            let model = subspace.model(order).expect("an order");
            let error = response_error(&system, &model.system);
            println!("order {order}, {regularisation:?}: {error}");
            assert!(error < 1e-6, "order {order}, {regularisation:?}: {error}");
            assert!(pole_error(&system, &model.system) < 1e-6);
            assert_eq!(model.gain.norm_max(), 0.0);
        }
    }
}

#[test]
fn fresh_data_are_reproduced() {
    let system = oscillators(4);
    let (first, fresh) = (
        experiment(&system, 1, 4000, Noise::White(40.0)),
        experiment(&system, 2, 2000, Noise::White(40.0)),
    );
    let model = Subspace::new(&first, settings(20)).expect("good").model(4).expect("an order");
    let modelled = simulated(&model.system, &fresh).expect("fits");
    for figure in variance_accounted_for(&fresh, &modelled).expect("fits") {
        assert!(figure > 99.0, "{figure}");
    }
}

/// x(k+1) = A x + B u + K e, y = C x + e, with u = r − F y: r and e are given, u depends on past e.
fn closed_loop(system: &StateSpace, gain: &Mat<f64>, n_samples: usize, strength: f64) -> Record {
    let column = |values: [f64; 2]| Mat::from_fn(2, 1, |i, _| values[i]);
    let series: Vec<Vec<f64>> = (0..4).map(|seed| noise(70 + seed, n_samples)).collect();
    let (references, innovations) = series.split_at(2);
    let feedback = Mat::from_fn(2, 2, |i, j| if i == j { 0.12 } else { -0.05 });
    let mut state = Mat::<f64>::zeros(system.order(), 1);
    let (mut inputs, mut outputs) = (vec![Vec::new(); 2], vec![Vec::new(); 2]);
    for k in 0..n_samples {
        let reference = column([references[0][k], references[1][k]]);
        let innovation = column([strength * innovations[0][k], strength * innovations[1][k]]);
        let output = &system.c * &state + &innovation;
        let input = reference - &feedback * &output;
        state = &system.a * &state + &system.b * &input + gain * &innovation;
        for channel in 0..2 {
            inputs[channel].push(input[(channel, 0)]);
            outputs[channel].push(output[(channel, 0)]);
        }
    }
    record(inputs, outputs)
}

/// A short window leaves few singular values: the end of them is no fall.
#[test]
fn the_order_is_found_in_short_windows_too() {
    let record = experiment(&oscillators(2), 2, 6000, Noise::White(20.0));
    for window in [6, 8, 10] {
        let subspace = Subspace::new(&record, settings(window)).expect("a good record");
        assert_eq!(subspace.largest_gap(20), 2, "window {window}");
    }
}

/// In a closed loop the input depends on past noise, which would bias methods that take it not to; and the
/// noise's own model comes out as well.
#[test]
fn a_closed_loop_is_no_obstacle() {
    let mut system = oscillators(4);
    system.d = Mat::zeros(2, 2);
    let gain = Mat::from_fn(4, 2, |i, j| 0.15 * (1.0 + i as f64 - 2.0 * j as f64).cos());
    let record = closed_loop(&system, &gain, 9000, 0.3);
    let settings = Settings { feedthrough: false, ..settings(30) };
    let subspace = Subspace::new(&record, settings).expect("a good record");
    assert_eq!(subspace.largest_gap(10), 4);
    let model = subspace.model(4).expect("an order");
    let error = pole_error(&system, &model.system);
    println!("closed loop: {error}, {}", response_error(&system, &model.system));
    assert!(error < 0.01, "{error}");
    assert!(response_error(&system, &model.system) < 0.05);
    let noise_path = |system: &StateSpace, gain: &Mat<f64>| {
        let one = Mat::identity(2, 2);
        StateSpace::new(system.a.clone(), gain.clone(), system.c.clone(), one, Some(1.0))
    };
    let difference =
        response_error(&noise_path(&system, &gain), &noise_path(&model.system, &model.gain));
    assert!(difference < 0.1, "{difference}");
    let known = faer::Scale(0.09) * Mat::<f64>::identity(2, 2);
    assert!((&model.innovation_covariance - known).norm_max() < 0.005);
    let predictions = predicted(&model.system, &model.gain, &record).expect("fits");
    for (output, prediction) in record.outputs().iter().zip(&predictions) {
        let errors: Vec<f64> = output.samples.iter().zip(prediction).map(|(y, p)| y - p).collect();
        assert!((level(&errors) / 0.3 - 1.0).abs() < 0.03, "{}", level(&errors));
    }
}

/// Units of the channels change the model by them alone.
#[test]
fn units_do_not_matter() {
    let system = oscillators(4);
    let plain = experiment(&system, 5, 2000, Noise::White(20.0));
    let scaled = |channels: &[crate::Channel], factors: [f64; 2]| {
        let channels = channels.iter().zip(factors);
        channels.map(|(c, by)| c.samples.iter().map(|x| by * x).collect()).collect()
    };
    let other = record(scaled(plain.inputs(), [1e3, 0.01]), scaled(plain.outputs(), [1e-6, 500.0]));
    let model = |record: &Record| {
        Subspace::new(record, settings(15)).expect("good").model(4).expect("an order")
    };
    let (plain, other) = (model(&plain), model(&other));
    for frequency in [0.0, 0.3, 1.0] {
        let first = plain.system.response(frequency).expect("no pole there");
        let second = other.system.response(frequency).expect("no pole there");
        for (i, output) in [1e-6, 500.0].into_iter().enumerate() {
            for (j, input) in [1e3, 0.01].into_iter().enumerate() {
                let expected = first[(i, j)] * output / input;
                assert!((second[(i, j)] / expected - 1.0).norm() < 1e-6);
            }
        }
    }
    let share = other.innovation_covariance[(1, 1)] / plain.innovation_covariance[(1, 1)];
    assert!((share / 250_000.0 - 1.0).abs() < 1e-6);
}

#[test]
fn a_delay_is_found_by_the_autoregression() {
    let inputs = vec![noise(1, 4000), noise(2, 4000)];
    let late = vec![delayed(&inputs[0], 5), delayed(&inputs[1], 9)];
    let outputs = response(&oscillators(2), &late);
    let strength = 0.1 * level(&outputs[0]);
    let outputs = outputs.iter().zip([3, 4]).map(|(output, seed)| {
        output.iter().zip(noise(seed, 4000)).map(|(y, n)| y + strength * n).collect()
    });
    let record = record(inputs, outputs.collect());
    let subspace = Subspace::new(&record, settings(30)).expect("a good record");
    // The direct gain is on the diagonal alone; elsewhere the state is one sample late.
    assert_eq!(subspace.delay(0, 1), Some(6));
    assert_eq!(subspace.delay(1, 0), Some(10));
}

#[test]
fn bad_settings_say_what_is_needed() {
    let record = experiment(&oscillators(2), 1, 100, Noise::White(20.0));
    let refused = |settings| Subspace::new(&record, settings).expect_err("refused").to_string();
    assert!(refused(settings(40)).contains("206 are needed"));
    let long = Settings { past: 10, future: 11, ..settings(10) };
    assert!(refused(long).contains("future window (samples) is 11"));
    assert!(refused(Settings { past: 1, ..settings(1) }).contains("past window"));
    let subspace = Subspace::new(&record, settings(10)).expect("long enough");
    assert!(matches!(subspace.model(0), Err(IdentificationError::OutOfRange { .. })));
    assert!(subspace.model(21).is_err());
}

/// Two slow channels, each with a resonance, and some coupling.
fn slow_wake() -> StateSpace {
    let poles = [lti::Complex64::from_polar(0.97, 0.08), lti::Complex64::from_polar(0.96, 0.12)];
    let a = Mat::from_fn(4, 4, |i, j| {
        let pole = poles[i / 2];
        match (i / 2 == j / 2, i % 2, j % 2) {
            (false, ..) => 0.0,
            (true, 0, 0) | (true, 1, 1) => pole.re,
            (true, 0, _) => pole.im,
            _ => -pole.im,
        }
    });
    let b = faer::mat![[0.0, 0.02], [0.1, -0.01], [0.02, 0.0], [0.0, 0.12]];
    let c = faer::mat![[1.0, 0.1, -0.2, 0.0], [0.2, 0.0, 1.0, 0.1]];
    StateSpace::new(a, b, c, Mat::zeros(2, 2), Some(1.0))
}

/// Inputs that move in an eighth of all frequencies leave most of the autoregression undetermined; a penalty
/// settles the rest, which least squares alone would give to rounding.
#[test]
fn a_narrow_band_is_enough_for_cross_validation() {
    let system = slow_wake();
    let made = |seed| pseudo_random_binary(seed, 6000, 1.0, (0.0, 0.06), 1.0).expect("a band");
    let inputs = vec![made(1), made(2)];
    let mut outputs = response(&system, &inputs);
    for (output, seed) in outputs.iter_mut().zip([3, 4]) {
        let strength = 0.1 * level(output);
        output.iter_mut().zip(noise(seed, 6000)).for_each(|(y, n)| *y += strength * n);
    }
    let record = record(inputs, outputs);
    let regularisation = Regularisation::CrossValidated;
    let settings = Settings { regularisation, ..settings(60) };
    let subspace = Subspace::new(&record, settings).expect("a good record");
    assert_eq!(subspace.largest_gap(10), 4);
    let model = subspace.model(4).expect("an order");
    let error = pole_error(&system, &model.system);
    assert!(error < 0.001, "{error}");
    assert!(response_error(&system, &model.system) < 0.02);
}
