//! Intervals against closed forms and against how often they hold the truth.

use super::*;
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// `n` independent normal numbers of mean zero and deviation one (Box and Muller).
fn normals(random: &mut ChaCha8Rng, n: usize) -> Vec<f64> {
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    (0..n)
        .map(|_| {
            let (a, b) = (1.0 - uniform(), uniform());
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
        })
        .collect()
}

#[test]
fn interval_is_that_of_the_block_means() {
    // Block means 1, 2, 6 and half a block that the interval does not see.
    let samples = [[1.0; 4], [2.0; 4], [6.0; 4]].concat();
    let whole = statistic(&samples, 0.5, 2.0).expect("three blocks");
    assert_eq!((whole.mean, whole.n_blocks), (3.0, 3));
    let expected = 4.302653 * 7.0_f64.sqrt() / 3.0_f64.sqrt();
    assert!((whole.half_width_95.expect("three blocks") - expected).abs() < 1e-6);
    let longer = [samples.as_slice(), &[9.0, 9.0]].concat();
    let longer = statistic(&longer, 0.5, 2.0).expect("three blocks");
    assert_eq!(longer.half_width_95, whole.half_width_95);
    assert!((longer.mean - 54.0 / 14.0).abs() < 1e-14);
}

#[test]
fn one_block_has_no_interval() {
    let one = statistic(&[1.0, 3.0], 300.0, 600.0).expect("one block");
    assert_eq!((one.mean, one.standard_deviation, one.n_blocks), (2.0, 1.0, 1));
    assert_eq!(one.half_width_95, None);
    let none = statistic(&[1.0], 300.0, 600.0).expect("one sample");
    assert_eq!((none.n_blocks, none.half_width_95), (0, None));
}

#[test]
fn bad_records_are_refused() {
    assert_eq!(
        statistic(&[], 1.0, 600.0),
        Err(AnalysisError::TooShort { n_samples: 0, needed: 1 })
    );
    assert!(statistic(&[1.0], 0.0, 600.0).is_err());
    assert!(statistic(&[1.0], 1.0, f64::NAN).is_err());
    assert!(gain(&[1.0], &[1.0, 2.0], 1.0, 1.0).is_err());
    assert_eq!(gain(&[1.0], &[0.0], 1.0, 1.0), Err(AnalysisError::ZeroMean));
}

#[test]
fn a_gain_that_every_block_shares_is_certain() {
    let compared = [[1.0; 3], [5.0; 3], [2.0; 3]].concat();
    let samples: Vec<f64> = compared.iter().map(|x| 1.075 * x).collect();
    let gain = gain(&samples, &compared, 1.0, 3.0).expect("three blocks");
    assert!((gain.mean - 0.075).abs() < 1e-14);
    assert!(gain.half_width_95.expect("three blocks") < 1e-14);
}

/// Deviation of a record, as what a change is of.
fn deviation(samples: &[f64]) -> Result<f64, AnalysisError> {
    Ok(standard_deviation(samples))
}

#[test]
fn a_change_that_every_block_shares_is_certain_and_a_shift_is_none() {
    let compared = [[1.0, 3.0], [5.0, 9.0], [2.0, 7.0]].concat();
    let samples: Vec<f64> = compared.iter().map(|x| 100.0 - 0.8 * x).collect();
    let less = change(&samples, &compared, 1.0, 2.0, deviation).expect("three blocks");
    assert!((less.mean + 0.2).abs() < 1e-12 && less.n_blocks == 3, "{less:?}");
    assert!(less.half_width_95.expect("three blocks") < 1e-12, "{less:?}");
    // Of means it is what a gain is, its interval that of the blocks' own changes: 10 % and 20 %.
    let mean_of = |samples: &[f64]| Ok(mean(samples));
    let more = change(&[1.1, 4.8], &[1.0, 4.0], 1.0, 1.0, mean_of).expect("two blocks");
    assert!((more.mean - 0.18).abs() < 1e-14, "{more:?}");
    assert!((more.half_width_95.expect("two blocks") - 12.706_205 * 0.05).abs() < 1e-6);
}

#[test]
fn a_change_of_one_block_has_no_interval_and_one_from_zero_is_refused() {
    let one = change(&[0.0, 3.0, 9.0], &[0.0, 2.0, 6.0], 1.0, 3.0, deviation).expect("a block");
    assert_eq!((one.n_blocks, one.half_width_95), (1, None));
    assert!((one.mean - 0.5).abs() < 1e-14);
    let from = |compared: &[f64]| change(&[1.0, 2.0, 3.0, 5.0], compared, 1.0, 2.0, deviation);
    assert_eq!(from(&[4.0; 4]), Err(AnalysisError::NoReference));
    assert_eq!(from(&[4.0, 4.0, 1.0, 2.0]), Err(AnalysisError::NoReference));
    assert_eq!(from(&[4.0]), Err(AnalysisError::UnequalLengths { first: 4, second: 1 }));
}

/// Of many intervals at 95 %, 95 % hold the truth: 2000 records of four blocks, binomial deviation 0.5 %.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let n_records = 2000;
    let (mut mean_held, mut gain_held) = (0, 0);
    for _ in 0..n_records {
        // The wind moves both runs alike; the true gain is 5 %.
        let wind = normals(&mut random, 16);
        let noise = normals(&mut random, 16);
        let compared: Vec<f64> = wind.iter().map(|w| 10.0 + w).collect();
        let samples: Vec<f64> =
            compared.iter().zip(&noise).map(|(x, e)| 1.05 * x + 0.1 * e).collect();
        let mean = statistic(&compared, 1.0, 4.0).expect("four blocks");
        let half_width = mean.half_width_95.expect("four blocks");
        mean_held += i32::from((mean.mean - 10.0).abs() <= half_width);
        let gain = gain(&samples, &compared, 1.0, 4.0).expect("four blocks");
        let half_width = gain.half_width_95.expect("four blocks");
        gain_held += i32::from((gain.mean - 0.05).abs() <= half_width);
        // Pairing takes the wind out: the gain is known far better than either mean.
        assert!(half_width < 0.1);
    }
    for held in [mean_held, gain_held] {
        let share = f64::from(held) / f64::from(n_records);
        assert!((share - 0.95).abs() < 0.015, "{share}");
    }
}

#[test]
fn turbulence_intensity_of_a_sine() {
    let samples: Vec<f64> = (0..1000)
        .map(|i| 8.0 + 0.8 * (std::f64::consts::TAU * f64::from(i) / 100.0).sin())
        .collect();
    let intensity = turbulence_intensity(&samples).expect("samples");
    assert!((intensity - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
}

proptest! {
    /// Scaling the signal scales everything; shifting it moves the mean alone.
    #[test]
    fn follows_the_unit_of_the_signal(
        values in prop::collection::vec(-1.0..1.0_f64, 6..60), scale in 0.1..1e7_f64, shift in -5.0..5.0_f64,
    ) {
        let plain = statistic(&values, 1.0, 3.0).unwrap();
        let moved: Vec<f64> = values.iter().map(|x| scale * (x + shift)).collect();
        let moved = statistic(&moved, 1.0, 3.0).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * scale;
        prop_assert!(near(moved.mean, scale * (plain.mean + shift)));
        prop_assert!(near(moved.standard_deviation, scale * plain.standard_deviation));
        prop_assert!(near(moved.half_width_95.unwrap(), scale * plain.half_width_95.unwrap()));
    }
}

#[test]
fn a_sample_short_of_the_last_block_does_not_cost_it() {
    let samples: Vec<f64> = (0..3767).map(|k| f64::from(k / 1256)).collect();
    let blocks = block_means(&samples, 0.4776, 600.0).unwrap();
    assert_eq!(blocks.len(), 3);
    assert!((blocks[2] - 2.0).abs() < 2e-3);
    // But a block that misses more is none.
    assert_eq!(block_means(&samples[..3700], 0.4776, 600.0).unwrap().len(), 2);
    assert_eq!(block_means(&samples[..1000], 0.4776, 600.0).unwrap().len(), 0);
}
