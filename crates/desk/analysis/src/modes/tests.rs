//! Modes of fields that are made of few.

use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn field(n_instants: usize, n_values: usize, value: impl Fn(usize, usize) -> f64) -> InMemory {
    let values = (0..n_instants).flat_map(|t| (0..n_values).map(move |x| (t, x)));
    InMemory { n_values, values: values.map(|(t, x)| value(t, x)).collect() }
}

/// Two standing waves that are orthogonal in space and time: energies ½ 4 and ½ 1 times half the length.
#[test]
fn two_waves_are_two_modes() {
    let wave = |t: usize, x: usize| {
        let (t, x) = (TAU * t as f64 / 40.0, TAU * x as f64 / 30.0);
        3.0 + 2.0 * (2.0 * t).cos() * x.sin() + (5.0 * t).sin() * (2.0 * x).cos()
    };
    let found = pod(&field(40, 30, wave), 0.1, 5).unwrap();
    assert_eq!((found.modes.len(), found.n_masked), (2, 0));
    let expected = [0.5 * 4.0 * 15.0 * 0.1, 0.5 * 15.0 * 0.1];
    for (energy, expected) in found.energies.iter().zip(expected) {
        assert!((energy / expected - 1.0).abs() < 1e-12);
    }
    assert!(found.mean.iter().all(|mean| (mean - 3.0).abs() < 1e-12));
    let size: f64 = found.modes[0].iter().map(|value| 0.1 * value * value).sum();
    assert!((size - 1.0).abs() < 1e-12);
}

proptest! {
    /// All modes and coefficients give the field back; energies are its variance; modes are orthogonal.
    #[test]
    fn modes_give_the_field_back(values in prop::collection::vec(-5.0..5.0_f64, 48), weight in 0.1..3.0_f64) {
        let field = InMemory { n_values: 6, values };
        let found = pod(&field, weight, 8).unwrap();
        for t in 0..8 {
            for x in 0..6 {
                let sum: f64 = (0..found.modes.len())
                    .map(|mode| found.coefficients[mode][t] * found.modes[mode][x]).sum();
                prop_assert!((found.mean[x] + sum - field.values[6 * t + x]).abs() < 1e-8);
            }
        }
        let variance: f64 = (0..48).map(|i| (field.values[i] - found.mean[i % 6]).powi(2)).sum();
        let energy: f64 = found.energies.iter().sum();
        prop_assert!((energy / (weight * variance / 8.0) - 1.0).abs() < 1e-10);
        for a in 0..found.modes.len() {
            for b in 0..found.modes.len() {
                let product: f64 =
                    found.modes[a].iter().zip(&found.modes[b]).map(|(a, b)| weight * a * b).sum();
                let expected = if a == b { 1.0 } else { 0.0 };
                prop_assert!((product - expected).abs() < 1e-7);
            }
        }
    }
}

fn settings(n_block: usize, n_overlap: usize, at: Vec<f64>) -> SpodSettings {
    SpodSettings { interval: 0.1, n_block, n_overlap, n_modes: 2, at }
}

/// A wave cos(2πft − kx) at a frequency of the spectrum: one mode there, e^{−ikx} but for a phase.
#[test]
fn a_travelling_wave_is_one_spectral_mode() {
    let wave =
        |t: usize, x: usize| 1.5 * (TAU * (8.0 * t as f64 / 64.0 - x as f64 / 16.0)).cos() + 0.2;
    let found = spod(&field(400, 16, wave), 1.0, &settings(64, 32, vec![1.25])).unwrap();
    assert_eq!(found.n_blocks, 11);
    let peak = (0..found.frequencies.len())
        .max_by(|a, b| found.energies[*a][0].total_cmp(&found.energies[*b][0]))
        .unwrap();
    assert!((found.frequencies[peak] - 1.25).abs() < 1e-12);
    assert!(found.energies[peak][1] < 1e-12 * found.energies[peak][0]);
    let mode = &found.modes[0];
    assert_eq!((mode.frequency, mode.rank), (peak, 0));
    let [re, im] = mode.values[0];
    for (x, value) in mode.values.iter().enumerate() {
        let (sine, cosine) = (-TAU * x as f64 / 16.0).sin_cos();
        let expected = [re * cosine - im * sine, re * sine + im * cosine];
        // Of the other sign of the frequency the window's side lobes let through 0.75 % at most.
        let size = 2.0 * 0.0075 * re.hypot(im);
        assert!((value[0] - expected[0]).abs() < size && (value[1] - expected[1]).abs() < size);
    }
    let size: f64 = mode.values.iter().map(|value| value[0].powi(2) + value[1].powi(2)).sum();
    assert!((size - 1.0).abs() < 1e-10);
    // Energy over all frequencies is the variance, ½ 1.5² at each of 16 places, to the window's leakage.
    let step = found.frequencies[1];
    let energy: f64 = found.energies.iter().flatten().sum::<f64>() * step;
    assert!((energy / (0.5 * 2.25 * 16.0) - 1.0).abs() < 1e-2, "{energy}");
}

#[test]
fn places_with_holes_play_no_part_and_are_counted() {
    let wave = |t: usize, x: usize| if (t, x) == (3, 1) { f64::NAN } else { (t * (x + 1)) as f64 };
    let found = pod(&field(8, 3, wave), 1.0, 1).unwrap();
    assert_eq!((found.n_masked, found.modes[0][1]), (1, 0.0));
    assert!(found.mean[1].is_nan() && found.modes[0][2] != 0.0);
    let still = field(8, 2, |_, _| 4.0);
    assert!(matches!(pod(&still, 1.0, 1), Err(ModesError::Nothing { n_masked: 0, .. })));
    assert!(matches!(
        spod(&still, 1.0, &settings(8, 0, Vec::new())),
        Err(ModesError::TooFew { needed: 16, .. })
    ));
    assert!(spod(&still, 1.0, &settings(4, 4, Vec::new())).is_err());
}

#[test]
fn frequencies_are_named_by_rotor_and_helix() {
    let name = |frequency| frequency_name(frequency, Some(0.2), Some(1.0), 0.02);
    let expected =
        [(0.2, "f_e"), (0.41, "2 f_e"), (0.8, "f_r − f_e"), (3.0, "3 f_r"), (1.2, "f_r + f_e")];
    for (frequency, expected) in expected {
        assert_eq!(name(frequency).as_deref(), Some(expected), "{frequency}");
    }
    assert_eq!(name(0.5), None);
    assert_eq!(frequency_name(1.0, None, Some(1.0), 0.1).as_deref(), Some("f_r"));
}
