//! Tests of the count, the loads and the bearing.

use super::*;
use crate::AnalysisError;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;

/// Ranges with their counts, smallest first, equal ranges together.
fn counts(load: &[f64]) -> Vec<(f64, f64)> {
    let mut all = cycles(load).unwrap();
    all.sort_by(|a, b| a.range.total_cmp(&b.range));
    let mut counts: Vec<(f64, f64)> = Vec::new();
    for cycle in all {
        match counts.last_mut() {
            Some((range, count)) if *range == cycle.range => *count += cycle.count,
            _ => counts.push((cycle.range, cycle.count)),
        }
    }
    counts
}

/// Numbers from 0 to 999 that look random.
fn scattered(n_samples: usize) -> Vec<f64> {
    let mut state = 20_261_121_u64;
    (0..n_samples)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 40) % 1000) as f64
        })
        .collect()
}

fn waves(n_periods: usize, per_period: usize) -> Vec<f64> {
    (0..=n_periods * per_period)
        .map(|index| 5.0 + 1.5 * (TAU * index as f64 / per_period as f64).cos())
        .collect()
}

#[test]
fn the_standard_s_own_example() {
    // ASTM E1049-85, Fig. 6: ranges AB 3, BC 4, CD 8, DG 9, GH 8, HI 6 as halves, EF 4 as a whole.
    let load = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];
    assert_eq!(counts(&load), [(3.0, 0.5), (4.0, 1.5), (6.0, 0.5), (8.0, 1.0), (9.0, 0.5)]);
    let in_order: Vec<(f64, f64, f64)> =
        cycles(&load).unwrap().iter().map(|cycle| (cycle.range, cycle.mean, cycle.count)).collect();
    let expected = [
        (3.0, -0.5, 0.5),
        (4.0, -1.0, 0.5),
        (4.0, 1.0, 1.0),
        (8.0, 1.0, 0.5),
        (9.0, 0.5, 0.5),
        (8.0, 0.0, 0.5),
        (6.0, 1.0, 0.5),
    ];
    assert_eq!(in_order, expected);
}

#[test]
fn samples_between_reversals_and_equal_ones_do_not_count() {
    let bare = [0.0, 4.0, 1.0, 3.0, -2.0];
    let dressed = [0.0, 0.0, 1.0, 3.9, 4.0, 4.0, 2.0, 1.0, 1.0, 1.5, 3.0, 0.0, -2.0, -2.0];
    assert_eq!(cycles(&bare), cycles(&dressed));
}

#[test]
fn another_program_counts_the_same() {
    // Package rainflow 3.2.0 of PyPI (extract_cycles) on the same 400 numbers.
    let load = scattered(400);
    assert_eq!(load[..4], [281.0, 171.0, 493.0, 756.0]);
    let all = cycles(&load).unwrap();
    assert_eq!(all.len(), 141);
    assert_eq!(all.iter().map(|cycle| cycle.count).sum::<f64>(), 134.5);
    assert_eq!(all.iter().map(|cycle| cycle.count * cycle.mean).sum::<f64>(), 68390.75);
    let expected = [
        (1.0, 1758.6842105263158),
        (3.0, 951.3685066276461),
        (4.0, 906.3833950419875),
        (7.5, 878.1059063378132),
        (10.0, 882.670556085308),
    ];
    for (slope, expected) in expected {
        let found = damage_equivalent_load(&load, 0.1, slope, 1.0).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12, "{slope}: {found}");
    }
}

#[test]
fn a_wave_is_its_own_equivalent_load() {
    for slope in [1.0, 3.0, 4.0, 10.0, 12.5] {
        let load = damage_equivalent_load(&waves(60, 40), 0.25, slope, 0.1).unwrap();
        assert!((load - 3.0).abs() < 1e-12, "{slope}: {load}");
        // Ten seconds a period: 1 Hz repeats ten times as often.
        let at_one_hertz = damage_equivalent_load(&waves(60, 40), 0.25, slope, 1.0).unwrap();
        assert!((at_one_hertz - 3.0 * 0.1_f64.powf(1.0 / slope)).abs() < 1e-12);
    }
}

#[test]
fn a_constant_does_no_damage() {
    assert_eq!(cycles(&[7.0; 100]), Ok(Vec::new()));
    assert_eq!(damage_equivalent_load(&[7.0; 100], 0.1, 10.0, 1.0), Ok(0.0));
}

#[test]
fn no_unit_overflows_the_sum() {
    let load = scattered(300);
    let expected = damage_equivalent_load(&load, 0.1, 12.0, 1.0).unwrap();
    for unit in [1e-200, 1e-30, 1e30, 1e200] {
        let scaled: Vec<f64> = load.iter().map(|sample| unit * sample).collect();
        let found = damage_equivalent_load(&scaled, 0.1, 12.0, 1.0).unwrap();
        assert!((found / unit / expected - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_cannot_be_counted_is_reported() {
    let mut counter = LoadCounter::new(&[4.0]).unwrap();
    counter.extend(&[1.0, 2.0, 0.0]).unwrap();
    let error = counter.extend(&[3.0, f64::NAN, 1.0]).unwrap_err();
    assert_eq!(error, AnalysisError::NotFinite { index: 4 });
    assert_eq!(counter.push(f64::INFINITY), Err(AnalysisError::NotFinite { index: 4 }));
    counter.push(1.0).unwrap();
    assert_eq!(counter.n_samples(), 5);
    assert_eq!(cycles(&[1.0, f64::NAN]), Err(AnalysisError::NotFinite { index: 1 }));
    assert_eq!(cycles(&[f64::NAN]), Err(AnalysisError::NotFinite { index: 0 }));
    for slope in [0.5, -3.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(LoadCounter::new(&[slope]), Err(AnalysisError::Slope { .. })));
    }
    let too_short = LoadCounter::new(&[4.0]).unwrap().finish(1.0);
    assert_eq!(too_short, Err(AnalysisError::TooShort { n_samples: 0, needed: 2 }));
    assert!(damage_equivalent_load(&[0.0, 1.0], 0.0, 4.0, 1.0).is_err());
    assert!(damage_equivalent_load(&[0.0, 1.0], 1.0, 4.0, 0.0).is_err());
}

#[test]
fn two_samples_make_half_a_cycle() {
    assert_eq!(cycles(&[1.0, 4.0]), Ok(vec![Cycle { range: 3.0, mean: 2.5, count: 0.5 }]));
}

#[test]
fn a_load_that_narrows_for_long_is_counted_all_the_same() {
    let load: Vec<f64> =
        (0..5000).map(|i| f64::from(5000 - i) * if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
    let all = cycles(&load).unwrap();
    assert_eq!(all.len(), 4999);
    assert!(all.iter().all(|cycle| cycle.count == 0.5));
}

#[test]
fn one_bin_counts_all_at_its_middle() {
    let load = scattered(400);
    let all = cycles(&load).unwrap();
    let one = RangeBins::new(&all, NonZeroUsize::MIN);
    assert_eq!(one.counts(), [134.5]);
    assert_eq!(one.middle(0), 0.5 * one.width());
    let expected = one.middle(0) * (134.5_f64 / 39.9).powf(0.1);
    assert!((one.equivalent_load(10.0, 39.9).unwrap() / expected - 1.0).abs() < 1e-12);
}

#[test]
fn a_bearing_under_a_steady_load_carries_its_positive_projection() {
    // Pitch swings at the reference rate, so the equivalent load is the moment where it presses.
    let mut bearing = PitchBearing::new(3.0, 36).unwrap();
    for step in 0..=6000_i32 {
        let triangle = f64::from((step % 200 - 100).abs());
        bearing.push(triangle * REFERENCE_TRAVEL_RATE * 0.1, 3.0e7, 4.0e7).unwrap();
    }
    for BearingLoad { position, load } in bearing.loads(600.0).unwrap() {
        let expected = (3.0e7 * position.cos() + 4.0e7 * position.sin()).max(0.0);
        assert!((load - expected).abs() < 1.0, "{position}: {load} {expected}");
    }
    assert_eq!(bearing.push(0.0, f64::NAN, 0.0), Err(AnalysisError::NotFinite { index: 6001 }));
}

#[test]
fn a_bearing_that_does_not_turn_wears_not() {
    let mut bearing = PitchBearing::new(3.0, 12).unwrap();
    (0..100).for_each(|step| bearing.push(0.1, f64::from(step), 1.0).unwrap());
    assert!(bearing.loads(10.0).unwrap().iter().all(|position| position.load == 0.0));
}

#[test]
fn a_helix_of_two_degrees_travels_the_reference() {
    // A sine of amplitude A travels 4 A a period: 600° in 10 minutes at A = 2° is 0.125 Hz.
    let mut pitch = PitchTravel::new();
    for step in 0..=60_000 {
        pitch.push(2.0_f64.to_radians() * (TAU * 0.125 * 0.01 * f64::from(step)).sin()).unwrap();
    }
    let travel = pitch.travel(0.01).unwrap();
    assert!((travel.travel.to_degrees() - 600.0).abs() < 1e-9);
    assert!((travel.mean_rate / REFERENCE_TRAVEL_RATE - 1.0).abs() < 1e-9);
    assert!((travel.maximum_rate / (2.0_f64.to_radians() * TAU * 0.125) - 1.0).abs() < 1e-4);
    assert_eq!(travel.n_reversals, 150);
    assert_eq!(travel.moving_share, 1.0);
    assert!((travel.duty_cycle(0.1) - 10.0 * travel.mean_rate).abs() < 1e-15);
}

fn load() -> impl Strategy<Value = Vec<f64>> {
    // Whole numbers, so that equal ranges occur.
    prop::collection::vec((-20..20_i32).prop_map(f64::from), 2..200)
}

proptest! {
    #[test]
    fn sample_by_sample_is_all_at_once(load in load(), parts in prop::collection::vec(0..50_usize, 0..8)) {
        let mut streamed = Vec::new();
        let mut rainflow = Rainflow::new();
        let mut rest = load.as_slice();
        for part in parts {
            let (now, later) = rest.split_at(part.min(rest.len()));
            rainflow.extend(now, |cycle| streamed.push(cycle)).unwrap();
            rest = later;
        }
        for sample in rest {
            rainflow.push(*sample, |cycle| streamed.push(cycle)).unwrap();
        }
        rainflow.finish(|cycle| streamed.push(cycle));
        prop_assert_eq!(streamed, cycles(&load).unwrap());
    }

    #[test]
    fn the_largest_range_is_peak_to_valley(load in load()) {
        let peak = load.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let valley = load.iter().copied().fold(f64::INFINITY, f64::min);
        let all = cycles(&load).unwrap();
        let largest = all.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
        prop_assert_eq!(largest, peak - valley);
    }

    #[test]
    fn all_the_way_is_counted(load in load()) {
        // A whole cycle goes its range twice, a half once: together they are the way of the load.
        let way: f64 = load.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
        let counted: f64 =
            cycles(&load).unwrap().iter().map(|cycle| 2.0 * cycle.count * cycle.range).sum();
        prop_assert_eq!(way, counted);
    }

    #[test]
    fn scaling_and_shifting_the_load_scales_its_equivalent(
        load in load(), scale in 1e-6..1e9_f64, shift in -100..100_i32, slope in 1.0..15.0_f64,
    ) {
        let changed: Vec<f64> = load.iter().map(|x| scale * (f64::from(shift) - x)).collect();
        let before = damage_equivalent_load(&load, 0.1, slope, 1.0).unwrap();
        let after = damage_equivalent_load(&changed, 0.1, slope, 1.0).unwrap();
        prop_assert!((after - scale * before).abs() <= 1e-9 * scale * before);
    }

    #[test]
    fn bins_err_by_half_a_bin_at_most(load in load(), n_bins in 1..5000_usize, slope in 1.0..15.0_f64) {
        let all = cycles(&load).unwrap();
        let duration = 0.1 * (load.len() - 1) as f64;
        let exact = damage_equivalent_load(&load, 0.1, slope, 1.0).unwrap();
        let bins = RangeBins::new(&all, NonZeroUsize::new(n_bins).unwrap());
        let binned = bins.equivalent_load(slope, duration).unwrap();
        // Minkowski's inequality of the norm that the equivalent load is.
        let n_cycles: f64 = all.iter().map(|cycle| cycle.count).sum();
        let bound = 0.5 * bins.width() * (n_cycles / duration).powf(1.0 / slope);
        prop_assert!((binned - exact).abs() <= bound + 1e-9 * exact, "{} {} {}", binned, exact, bound);
    }

    #[test]
    fn several_slopes_at_once_are_each_alone(load in load()) {
        let mut counter = LoadCounter::new(&[3.0, 4.0, 10.5]).unwrap();
        counter.extend(&load).unwrap();
        let duration = 0.1 * (load.len() - 1) as f64;
        let fatigue = counter.finish(duration).unwrap();
        for EquivalentLoad { slope, load: found } in fatigue.loads {
            prop_assert_eq!(found, damage_equivalent_load(&load, 0.1, slope, 1.0).unwrap());
        }
    }
}
