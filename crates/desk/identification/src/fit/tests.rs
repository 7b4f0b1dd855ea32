//! What models account for, against closed forms.

use super::*;
use crate::simulate::{Noise, experiment, noise, oscillators, record, response};

/// A record that starts in the middle of a response: the state there is the one that the system had.
#[test]
fn the_state_at_the_start_is_found() {
    let system = oscillators(4);
    let inputs = vec![noise(1, 300), noise(2, 300)];
    let outputs = response(&system, &inputs);
    let cut = |channels: &[Vec<f64>]| channels.iter().map(|c| c[100..].to_vec()).collect();
    let later = record(cut(&inputs), cut(&outputs));
    for (modelled, output) in simulated(&system, &later).expect("fits").iter().zip(later.outputs())
    {
        for (found, expected) in modelled.iter().zip(&output.samples) {
            assert!((found - expected).abs() < 1e-10);
        }
    }
    let start = initial_state(&system, &later).expect("fits");
    assert!(start.iter().any(|x| x.abs() > 0.1));
}

/// What of an unstable system can be seen at its start is found as well.
#[test]
fn an_unstable_system_is_no_obstacle() {
    let of = |value: f64| Mat::from_fn(1, 1, |_, _| value);
    let system = StateSpace::new(of(2.0), of(1.0), of(1.0), of(0.0), Some(1.0));
    let mut state = 0.7;
    let input = noise(4, 80);
    let output = input.iter().map(|u| {
        let seen = state;
        state = 2.0 * state + u;
        seen
    });
    let output = output.collect();
    let found = initial_state(&system, &record(vec![input], vec![output])).expect("fits");
    assert!((found[0] - 0.7).abs() < 1e-9, "{}", found[0]);
}

#[test]
fn half_the_amplitude_accounts_for_three_quarters() {
    let both = record(vec![noise(1, 100)], vec![noise(2, 100)]);
    let halved: Vec<f64> = both.outputs()[0].samples.iter().map(|y| 3.0 + 0.5 * y).collect();
    let figure = variance_accounted_for(&both, &[halved]).expect("fits")[0];
    assert!((figure - 75.0).abs() < 1e-9);
    let wrong: Vec<f64> = both.outputs()[0].samples.iter().map(|y| -y).collect();
    assert_eq!(variance_accounted_for(&both, &[wrong]), Ok(vec![0.0]));
    assert!(variance_accounted_for(&both, &[]).is_err());
    assert!(variance_accounted_for(&both, &[vec![0.0; 99]]).is_err());
}

/// With the Kalman gain of the innovation form that made the record, what is left are the innovations.
#[test]
fn the_predictor_leaves_the_innovations() {
    let system = oscillators(2);
    let gain = Mat::from_fn(2, 2, |i, j| 0.2 - 0.1 * (i + 2 * j) as f64);
    let driven = StateSpace::new(
        system.a.clone(),
        blocks(&[&[&system.b, &gain]]),
        system.c.clone(),
        blocks(&[&[&system.d, &Mat::identity(2, 2)]]),
        Some(1.0),
    );
    let series: Vec<Vec<f64>> = (0..4).map(|seed| noise(seed, 500)).collect();
    let both = record(series[..2].to_vec(), response(&driven, &series));
    let predictions = predicted(&system, &gain, &both).expect("fits");
    for output in 0..2 {
        let figures = both.outputs()[output].samples.iter().zip(&predictions[output]);
        let errors: Vec<f64> = figures.map(|(y, p)| y - p).collect();
        // The state at the start is estimated, so the first errors are not quite the innovations.
        for (error, innovation) in errors.iter().zip(&series[2 + output]).skip(200) {
            assert!((error - innovation).abs() < 1e-6);
        }
    }
}

#[test]
fn other_channels_are_refused() {
    let both = experiment(&oscillators(2), 1, 50, Noise::None);
    let single = record(vec![noise(1, 50)], vec![noise(2, 50)]);
    assert!(simulated(&oscillators(2), &both).is_ok());
    let refused = simulated(&oscillators(2), &single);
    assert!(refused.is_err_and(|e| e.to_string().contains("inputs of the record: 1 where 2")));
}
