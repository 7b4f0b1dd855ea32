//! Waves of known energy and frequency, Parseval's theorem, and what changes nothing.

use super::*;
use basis::records::Grid;
use proptest::prelude::*;
use std::f64::consts::{PI, SQRT_2, TAU};

const INTERVAL: f64 = 0.1;
const ALL: [bool; 3] = [true; 3];
const PLENTY: u64 = 1 << 30;

fn grid(n_points: [usize; 3]) -> Grid {
    Grid { origin: [1.0, 2.0, 3.0], spacing: [0.5, 0.25, 2.0], n_points }
}

/// `velocity` at each place, counted in steps, and time (s).
fn held(
    n_points: [usize; 3],
    n_instants: usize,
    velocity: impl Fn([usize; 3], f64) -> [f64; 3],
) -> HeldSnapshots {
    let grid = grid(n_points);
    let times: Vec<f64> = (0..n_instants).map(|step| step as f64 * INTERVAL).collect();
    let of = |component: usize| {
        let at = |time: f64| {
            let velocity = &velocity;
            (0..grid.len()).map(move |index| velocity(grid.place(index), time)[component] as f32)
        };
        times.iter().flat_map(|time| at(*time)).collect()
    };
    let velocity = [0, 1, 2].map(of);
    HeldSnapshots { grid, times, velocity }
}

fn pod_settings() -> PodSettings {
    PodSettings { components: ALL, n_modes: 4, memory: PLENTY }
}

fn spod_settings(n_block: usize, overlap: f64, window: Window) -> SpodSettings {
    let (components, frequencies) = (ALL, Vec::new());
    SpodSettings {
        components,
        n_block,
        overlap,
        window,
        n_modes: 3,
        frequencies,
        n_strongest: 0,
        memory: PLENTY,
    }
}

/// Numbers in (−0.5, 0.5), the same ones every time.
fn noise(seed: u64, n: usize) -> Vec<f32> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) as f32
    };
    (0..n).map(|_| next()).collect()
}

fn noisy(n_points: [usize; 3], n_instants: usize, seed: u64) -> HeldSnapshots {
    let mut held = held(n_points, n_instants, |_, _| [0.0; 3]);
    for (component, values) in held.velocity.iter_mut().enumerate() {
        *values = noise(seed + component as u64, values.len());
    }
    held
}

/// A wave of 2 m/s in u, 8 periods of 1 s and two wavelengths; one of 1 m/s in w, 20 periods of 0.4 s and
/// three.
fn two_waves() -> HeldSnapshots {
    held([25, 1, 5], 80, |place, time| {
        let x = place[0] as f64 / 24.0;
        let first = 2.0 * (TAU * (2.0 * x - time)).cos();
        let second = (TAU * (3.0 * x - 2.5 * time)).cos();
        [9.0 + first, 0.0, second]
    })
}

/// Mean over the area of the product of two fields.
fn product(grid: &Grid, one: &[Vec<f32>; 3], other: &[Vec<f32>; 3]) -> f64 {
    let area: f64 = (0..grid.len()).map(|index| area_share(grid, index)).sum();
    let at = |index: usize| {
        let pairs = one.iter().zip(other);
        let sum: f64 = pairs.map(|(a, b)| f64::from(a[index]) * f64::from(b[index])).sum();
        area_share(grid, index) * sum
    };
    (0..grid.len()).map(at).sum::<f64>() / area
}

#[test]
fn a_travelling_wave_is_a_pair_of_modes_a_quarter_of_a_turn_apart() {
    let mut waves = two_waves();
    let found = pod(&mut waves, &pod_settings()).unwrap();
    // A wave of amplitude A has A²/2, half of it in each mode. Velocities are kept in single precision, whose
    // rounding is 1e-7 of 11 m/s.
    for (energy, expected) in found.energies.iter().zip([1.0, 1.0, 0.25, 0.25, 0.0]) {
        assert!((energy - expected).abs() < 1e-5, "{:?}", &found.energies[..5]);
    }
    assert!((found.total - 2.5).abs() < 1e-5);
    assert!((f64::from(found.mean[0][7]) - 9.0).abs() < 1e-6);
    for (one, a) in found.modes.iter().enumerate() {
        for (other, b) in found.modes.iter().enumerate() {
            let expected = f64::from(u8::from(one == other));
            assert!((product(&waves.grid, a, b) - expected).abs() < 1e-5, "{one} {other}");
        }
    }
    let [first, second] = [0, 1].map(|mode| &found.coefficients[mode]);
    for (a, b) in first.iter().zip(second) {
        assert!((a.hypot(*b) - SQRT_2).abs() < 1e-5);
    }
}

#[test]
fn a_travelling_wave_is_one_spectral_mode_that_travels() {
    let mut waves = two_waves();
    let frequencies = vec![1.0, 2.49];
    let settings = SpodSettings { frequencies, ..spod_settings(40, 0.5, Window::Even) };
    let found = spod(&mut waves, &settings).unwrap();
    assert_eq!((found.n_blocks, found.n_used, found.hop), (3, 80, 20));
    assert!((found.frequency_step - 0.25).abs() < 1e-12);
    for index in 0..=20 {
        let expected = match index {
            4 => 2.0,
            10 => 0.5,
            _ => 0.0,
        };
        let energy = found.frequency_step * found.densities[index][0];
        assert!((energy - expected).abs() < 1e-5, "{index}: {energy}");
        // One mode has all of it.
        assert!(found.frequency_step * found.densities[index][1] < 1e-6);
    }
    assert!((found.total() - 2.5).abs() < 1e-5);
    let frequencies: Vec<f64> = found.modes.iter().map(|one| one.frequency).collect();
    assert!((frequencies[0] - 1.0).abs() < 1e-12 && (frequencies[1] - 2.5).abs() < 1e-12);
    // exp (−i k x), as cos (k x − ω t) is the real part of exp (−i k x) exp (i ω t).
    for (one, [component, n_waves]) in found.modes.iter().zip([[0, 2], [2, 3]]) {
        let mode = &one.modes[0][component];
        let angle = |index: usize| f64::from(mode[index][1]).atan2(f64::from(mode[index][0]));
        for (index, [real, imaginary]) in mode.iter().enumerate() {
            let size = f64::from(*real).hypot(f64::from(*imaginary));
            assert!((size - 1.0).abs() < 1e-4, "{size}");
            let x = waves.grid.place(index)[0] as f64 / 24.0;
            let away = angle(index) - angle(0) + TAU * n_waves as f64 * x;
            assert!((away - TAU * (away / TAU).round()).abs() < 1e-4, "{index}: {away}");
        }
    }
}

#[test]
fn a_standing_wave_in_noise_stands_out_at_its_frequency_and_keeps_its_energy() {
    let mut field = noisy([9, 7, 1], 640, 3);
    let n_points = field.grid.len();
    for (index, value) in field.velocity[1].iter_mut().enumerate() {
        let (step, x) = (index / n_points, (index % n_points) % 9);
        let standing = (TAU * 1.25 * step as f64 * INTERVAL).cos() * (PI * x as f64 / 8.0).cos();
        *value += 3.0 * standing as f32;
    }
    let settings = SpodSettings { n_strongest: 1, ..spod_settings(64, 0.5, Window::Hamming) };
    let found = spod(&mut field, &settings).unwrap();
    assert_eq!((found.modes.len(), found.modes[0].index), (1, 8));
    let strongest = (0..=32).max_by(|a, b| found.density(*a).total_cmp(&found.density(*b)));
    assert_eq!(strongest, Some(8));
    // 9/4 in all; the window spreads it over three frequencies, and noise, 1/12 for each component, adds
    // 3/32 of its own energy.
    let around: f64 = (7..=9).map(|index| found.densities[index][0]).sum();
    let energy = around * found.frequency_step;
    let alone = 2.25;
    assert!((energy - alone).abs() < 0.03 * alone, "{energy}");
    assert!(found.densities[8][0] > 20.0 * found.densities[8][1]);
}

#[test]
fn energies_over_frequency_add_up_to_the_variance() {
    let mut field = noisy([4, 3, 2], 96, 11);
    let all = pod(&mut field, &pod_settings()).unwrap();
    let found = spod(&mut field, &spod_settings(32, 0.0, Window::Even)).unwrap();
    // Blocks without overlap and window hold each instant once: Parseval's theorem is exact.
    assert_eq!((found.n_blocks, found.n_used), (3, 96));
    assert!((found.total() / all.total - 1.0).abs() < 1e-12, "{} {}", found.total(), all.total);
    assert!((all.energies.iter().sum::<f64>() / all.total - 1.0).abs() < 1e-12);
    // A window of another shape is right on average.
    let windowed = spod(&mut field, &spod_settings(32, 0.5, Window::Hamming)).unwrap();
    assert!((windowed.total() / all.total - 1.0).abs() < 0.1);
    assert!(windowed.densities.iter().all(|of| of.windows(2).all(|pair| pair[0] >= pair[1])));
}

#[test]
fn all_modes_together_are_the_fluctuations() {
    let mut field = noisy([3, 4, 1], 6, 5);
    let settings = PodSettings { n_modes: 6, ..pod_settings() };
    let found = pod(&mut field, &settings).unwrap();
    // Fluctuations about the mean of six instants have five modes.
    assert_eq!(found.modes.len(), 5);
    let n_points = field.grid.len();
    for (component, values) in field.velocity.iter().enumerate() {
        for (index, value) in values.iter().enumerate() {
            let (instant, point) = (index / n_points, index % n_points);
            let part = |mode: usize| {
                found.coefficients[mode][instant] * f64::from(found.modes[mode][component][point])
            };
            let sum = f64::from(found.mean[component][point]) + (0..5).map(part).sum::<f64>();
            assert!((sum - f64::from(*value)).abs() < 1e-5, "{sum} {value}");
        }
    }
}

#[test]
fn points_with_a_hole_are_left_out_and_counted() {
    let mut field = two_waves();
    let n_points = field.grid.len();
    let whole = pod(&mut field, &pod_settings()).unwrap();
    // A row of points, of which all have the same history as those of other rows.
    for point in 25..50 {
        field.velocity[1][3 * n_points + point] = f32::NAN;
    }
    let found = pod(&mut field, &pod_settings()).unwrap();
    assert_eq!((whole.n_masked, found.n_masked), (0, 25));
    assert!((found.total - whole.total).abs() < 1e-5);
    assert!(found.modes[0][0][30].is_nan() && found.mean[2][30].is_nan());
    let settings = SpodSettings { frequencies: vec![1.0], ..spod_settings(40, 0.5, Window::Even) };
    let spectral = spod(&mut field, &settings).unwrap();
    assert_eq!(spectral.n_masked, 25);
    assert!((spectral.total() - 2.5).abs() < 1e-5 && spectral.modes[0].modes[0][0][30][0].is_nan());
    // A component that is not looked at has no say.
    let components = [true, false, true];
    let found = pod(&mut field, &PodSettings { components, ..pod_settings() }).unwrap();
    assert_eq!(found.n_masked, 0);
    field.velocity[0].fill(f32::NAN);
    assert_eq!(pod(&mut field, &pod_settings()), Err(ModesError::NoPoint { n_points }));
}

#[test]
fn what_has_no_modes_is_refused_with_its_place() {
    let mut field = noisy([3, 2, 1], 40, 1);
    let refused = |field: &mut HeldSnapshots, settings: &SpodSettings| spod(field, settings).err();
    let sound = spod_settings(16, 0.5, Window::Hamming);
    let blocks = |n_block, overlap| spod_settings(n_block, overlap, Window::Hamming);
    assert!(matches!(refused(&mut field, &blocks(3, 0.5)), Some(ModesError::Blocks { .. })));
    assert!(matches!(refused(&mut field, &blocks(16, 1.0)), Some(ModesError::Blocks { .. })));
    let short = Some(ModesError::TooFew { n_instants: 40, needed: 41 });
    assert_eq!(refused(&mut field, &blocks(41, 0.5)), short);
    let high = SpodSettings { frequencies: vec![5.1], ..sound.clone() };
    assert!(matches!(refused(&mut field, &high), Some(ModesError::Frequency { .. })));
    let nothing = SpodSettings { components: [false; 3], ..sound.clone() };
    assert_eq!(refused(&mut field, &nothing), Some(ModesError::NoComponent));
    field.times[7] += 0.05;
    let uneven = refused(&mut field, &sound);
    assert!(matches!(uneven, Some(ModesError::UnevenTimes { index: 7, .. })), "{uneven:?}");
    field.times[7] = f64::NAN;
    assert!(matches!(refused(&mut field, &sound), Some(ModesError::UnevenTimes { .. })));
}

#[test]
fn the_interval_is_that_of_chi_squared() {
    // Ten blocks that do not overlap have 20 degrees of freedom: χ² of 34.170 and 9.591 (tables). The
    // quantiles are within half a percent.
    let mut field = noisy([2, 2, 1], 160, 1);
    let [low, high] = spod(&mut field, &spod_settings(16, 0.0, Window::Even)).unwrap().interval_95;
    assert!((low / (20.0 / 34.170) - 1.0).abs() < 0.005, "{low}");
    assert!((high / (20.0 / 9.591) - 1.0).abs() < 0.005, "{high}");
    // With an even window that overlaps by half, 19 blocks share: 1 + 2 (18/19) / 4 of one each.
    let [low, _] = spod(&mut field, &spod_settings(16, 0.5, Window::Even)).unwrap().interval_95;
    assert!(low > 20.0 / 34.170 && low < 0.75);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn neither_strips_nor_a_steady_wind_change_anything(
        seed in 0_u64..1000, memory in 0_u64..40_000, wind in -20.0_f32..20.0,
    ) {
        let mut field = noisy([3, 4, 5], 24, seed);
        let settings = spod_settings(8, 0.5, Window::Hamming);
        let (whole, whole_pod) =
            (spod(&mut field, &settings).unwrap(), pod(&mut field, &pod_settings()).unwrap());
        for value in &mut field.velocity[0] {
            *value += wind;
        }
        let strips = spod(&mut field, &SpodSettings { memory, ..settings }).unwrap();
        let strips_pod = pod(&mut field, &PodSettings { memory, ..pod_settings() }).unwrap();
        // The wind costs digits of single precision.
        for (one, other) in whole.densities.iter().flatten().zip(strips.densities.iter().flatten()) {
            prop_assert!((one - other).abs() < 1e-4 * whole.densities[1][0], "{one} {other}");
        }
        for (one, other) in whole_pod.energies.iter().zip(&strips_pod.energies) {
            prop_assert!((one - other).abs() < 1e-4 * whole_pod.total, "{one} {other}");
        }
    }

    #[test]
    fn twice_the_fluctuation_has_four_times_the_energy(seed in 0_u64..1000) {
        let mut field = noisy([4, 3, 1], 32, seed);
        let settings = spod_settings(16, 0.5, Window::Hamming);
        let before = spod(&mut field, &settings).unwrap();
        for value in field.velocity.iter_mut().flatten() {
            *value *= 2.0;
        }
        let after = spod(&mut field, &settings).unwrap();
        for (one, other) in before.densities.iter().flatten().zip(after.densities.iter().flatten()) {
            prop_assert!((4.0 * one - other).abs() <= 1e-9 * before.densities[1][0]);
        }
    }
}
