//! Delays of simulated systems.

use super::*;
use crate::simulate::{coloured_noise, delayed, noise, record};
use lti::matrices::{append, bilinear, pade_delay};

/// A lag behind a delay of seven samples, with a coloured input and as much coloured noise as signal.
#[test]
fn a_delay_shows_in_the_correlation() {
    let input = coloured_noise(1, 5000, 0.9);
    let mut state = 0.0;
    let lagged: Vec<f64> = delayed(&input, 7)
        .into_iter()
        .map(|u| {
            state += 0.5 * (u - state);
            state
        })
        .collect();
    let output = lagged.iter().zip(coloured_noise(2, 5000, 0.8)).map(|(y, n)| y + n).collect();
    let found = by_correlation(&record(vec![input], vec![output]), 0, 0, 30).expect("long enough");
    assert_eq!(found.samples, Some(7));
    // The impulse response of the lag halves every sample.
    let ratio = found.correlations[8] / found.correlations[7];
    assert!((ratio - 0.5).abs() < 0.15, "{ratio}");
}

/// Of records without correlation 5 % show one.
#[test]
fn the_bound_holds_in_95_records_of_100() {
    let shown = (0..400)
        .filter(|trial| {
            let both = record(
                vec![coloured_noise(2 * trial, 1000, 0.7)],
                vec![coloured_noise(2 * trial + 1, 1000, 0.7)],
            );
            by_correlation(&both, 0, 0, 20).expect("long enough").samples.is_some()
        })
        .count();
    // Three standard deviations of a count of 400 at 5 %.
    assert!((7..=33).contains(&shown), "{shown}");
    let short = record(vec![noise(1, 300)], vec![noise(2, 300)]);
    assert!(by_correlation(&short, 0, 0, 40).is_err());
}

#[test]
fn quantiles_of_the_normal_distribution() {
    for (chance, quantile) in [(0.025, 1.959_964), (0.005, 2.575_829), (1e-4, 3.719_016)] {
        assert!((beyond(chance) - quantile).abs() < 2e-3, "{}", beyond(chance));
    }
}

/// Padé's approximants of orders one to four have the delay they stand for, in continuous and discrete time,
/// and two channels have both of theirs.
#[test]
fn zeros_give_back_the_delay_of_an_approximant() {
    for order in 1..=4 {
        let system = pade_delay(3.0, order).expect("an order");
        let found = by_zeros(&system).expect("converges");
        assert_eq!(found.zeros.len(), order);
        assert!((found.delay - 3.0).abs() < 1e-8, "{}", found.delay);
        let both = append(&[&system, &pade_delay(2.0, order).expect("an order")]).expect("two");
        let sampled = bilinear(&both, 0.5).expect("no pole there");
        let found = by_zeros(&sampled).expect("converges");
        assert!((found.delay - 5.0).abs() < 1e-7, "{}", found.delay);
    }
}
