//! Bins, averages and their parts against waves that are given.

use super::*;
use basis::Sense;
use basis::records::{Grid, Moments, PhaseAverages, STRESSES};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::{PI, TAU};

/// A number drawn evenly from (0, 1).
fn even(random: &mut ChaCha8Rng) -> f64 {
    (f64::from(random.next_u32()) + 0.5) / 2_f64.powi(32)
}

/// Two numbers drawn from the normal distribution.
fn normals(random: &mut ChaCha8Rng) -> [f64; 2] {
    let radius = (-2.0 * even(random).ln()).sqrt();
    let (sine, cosine) = (TAU * even(random)).sin_cos();
    [radius * cosine, radius * sine]
}

fn line(n_points: usize) -> Grid {
    Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [n_points, 1, 1] }
}

/// CW: f_e = 0.2143 f_r; CCW: f_r/f_e = 5.68.
#[test]
fn the_published_bins_are_168_and_204() {
    let cw = Bins::of_helix(12, 14.0 / 3.0, 3, Sense::Clockwise, Bins::WIDTH).unwrap();
    let ccw = Bins::of_helix(12, 5.68, 3, Sense::CounterClockwise, Bins::WIDTH).unwrap();
    assert_eq!((cw.len(), ccw.len()), (168, 204));
    assert_eq!(cycles_that_close(5.68, 3), 3);
    assert_eq!(cycles_that_close(5.0, 7), 1);
    // Windows of 40° on 17 values of helix azimuth, 360°/17 apart.
    assert!((ccw.overlap() - 17.0 / 9.0).abs() < 1e-12);
}

#[test]
fn helix_azimuth_goes_from_yaw_to_tilt_and_grows_in_a_ccw_helix() {
    for (sense, way) in [(Sense::CounterClockwise, 1.0), (Sense::Clockwise, -1.0)] {
        let at = |angle: f64| helix_azimuth(angle.sin(), (angle + sense.yaw_lead()).sin());
        let step = basis::angle::wrap_to_half_turn(at(0.3) - at(0.2));
        assert!((step - way * 0.1).abs() < 1e-12, "{sense}");
    }
    assert!((helix_azimuth(1.0, 0.0) - 0.5 * PI).abs() < 1e-15);
}

proptest! {
    #[test]
    fn every_bin_holds_its_middle_and_windows_share_the_circle(
        n_azimuths in 1_usize..24, revolutions in 1_usize..20, n_cycles in 1_usize..5,
        is_ccw: bool, width_deg in 1.0..360.0_f64, rotor in 0.0..TAU,
    ) {
        let sense = if is_ccw { Sense::CounterClockwise } else { Sense::Clockwise };
        let ratio = revolutions as f64 / n_cycles as f64;
        let width = width_deg.to_radians();
        let bins = Bins::of_helix(n_azimuths, ratio, n_cycles, sense, width).unwrap();
        prop_assert_eq!(bins.len(), n_azimuths * revolutions);
        for index in 0..bins.len() {
            let (rotor, helix) = bins.middle(index);
            prop_assert!(bins.of_instant(rotor, helix.unwrap()).any(|bin| bin == index));
        }
        // On the average over the helix azimuth an instant is in as many bins as windows overlap.
        let n = 720;
        let helix = |i: usize| TAU * (i as f64 + 0.37) / n as f64;
        let members: usize = (0..n).map(|i| bins.of_instant(rotor, helix(i)).count()).sum();
        let tolerance = 2.0 * revolutions as f64 / n as f64;
        prop_assert!((members as f64 / n as f64 - bins.overlap()).abs() <= tolerance);
    }

    /// Against means and products summed again from all samples, holes left out.
    #[test]
    fn sums_that_stream_give_the_moments_of_their_samples(
        seed: u64, offset in -1e4..1e4_f64, n_instants in 30_usize..80,
    ) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let bins = Bins::of_rotor(3).unwrap();
        let mut averager = PhaseAverager::new(line(2), bins);
        let mut samples: Vec<(usize, [[f32; 2]; 3])> = Vec::new();
        let mut holes = 0;
        for step in 0..n_instants {
            let rotor = TAU * even(&mut random);
            let mut value = || (offset + normals(&mut random)[0]) as f32;
            let mut velocity: [[f32; 2]; 3] = std::array::from_fn(|_| [value(), value()]);
            if step % 7 == 0 {
                velocity[step % 3][1] = f32::NAN;
                holes += 1;
            }
            let rows = velocity.each_ref().map(|row| &row[..]);
            prop_assert_eq!(averager.add(step as f64, rotor, None, rows).unwrap(), 1);
            samples.push(((3.0 * rotor / TAU) as usize, velocity));
        }
        prop_assert_eq!(averager.n_holes(), holes);
        let averages = averager.averages();
        for (index, moments) in averages.each.iter().enumerate() {
            let mine: Vec<_> = samples.iter().filter(|(bin, _)| *bin == index).collect();
            prop_assert_eq!(averages.bins[index].n_instants, mine.len() as u64);
            for point in 0..2 {
                let sound: Vec<[f64; 3]> = mine.iter().map(|(_, v)| v.map(|row| f64::from(row[point])))
                    .filter(|v| v.iter().all(|x| x.is_finite())).collect();
                let n = sound.len() as f64;
                prop_assert_eq!(f64::from(moments.n_samples[point]), n);
                let mean = |f: &dyn Fn(&[f64; 3]) -> f64| sound.iter().map(f).sum::<f64>() / n;
                let means: [f64; 3] = std::array::from_fn(|c| mean(&|v| v[c]));
                for (component, expected) in means.into_iter().enumerate() {
                    let found = f64::from(moments.mean[component][point]);
                    prop_assert!((found - expected).abs() <= 1e-7 * offset.abs() + 1e-6 || n == 0.0);
                }
                for (place, [a, b]) in STRESSES.into_iter().enumerate() {
                    let expected = mean(&|v| (v[a] - means[a]) * (v[b] - means[b]));
                    let found = f64::from(moments.stress[place][point]);
                    prop_assert!((found - expected).abs() < 1e-5 || n == 0.0);
                }
            }
        }
    }
}

proptest! {
    /// However instants are taken in: one by one, in batches, on all points at once or on some at a time.
    #[test]
    fn batches_and_parts_of_the_points_give_the_same_bits(
        seed: u64, n_points in 1_usize..9, n_instants in 2_usize..60, cut in 0.0..1.0_f64,
        part in 1_usize..5,
    ) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let bins = Bins::of_helix(3, 2.5, 2, Sense::Clockwise, Bins::WIDTH * 4.0).unwrap();
        let mut instants = Vec::new();
        let mut velocity = [const { Vec::new() }; 3];
        for step in 0..n_instants {
            let [rotor, helix] = [0.7 * step as f64, -0.28 * step as f64];
            instants.push(PhaseInstant { time: step as f64, rotor, helix: Some(helix) });
            for values in &mut velocity {
                values.extend((0..n_points).map(|_| 8.0 + normals(&mut random)[0] as f32));
                if even(&mut random) < 0.2 {
                    let hole = values.len() - 1 - random.next_u32() as usize % n_points;
                    values[hole] = f32::NAN;
                }
            }
        }
        let rows = |points: std::ops::Range<usize>, instants: std::ops::Range<usize>| {
            velocity.each_ref().map(|values| -> Vec<f32> {
                let row = |step: usize| &values[step * n_points..][points.clone()];
                instants.clone().flat_map(row).copied().collect()
            })
        };
        let mut one_by_one = PhaseAverager::new(line(n_points), bins);
        for (step, instant) in instants.iter().enumerate() {
            let row = rows(0..n_points, step..step + 1);
            let row = row.each_ref().map(Vec::as_slice);
            one_by_one.add(instant.time, instant.rotor, instant.helix, row).unwrap();
        }
        let cut = 1 + ((n_instants - 2) as f64 * cut) as usize;
        let spans = [0..cut, cut..n_instants];
        let batches = spans.clone().map(|span| PhaseBatch::new(bins, &instants[span]).unwrap());
        let mut some = PhaseAverager::new(line(1), bins);
        let expected = one_by_one.averages();
        let mut n_holes = 0;
        for first in (0..n_points).step_by(part) {
            let points = first..(first + part).min(n_points);
            some.begin_anew(line(points.len()));
            for (span, batch) in spans.iter().zip(&batches) {
                let rows = rows(points.clone(), span.clone());
                some.add_batch(batch, rows.each_ref().map(Vec::as_slice)).unwrap();
            }
            n_holes += some.n_holes();
            prop_assert_eq!(some.phase_bins(), one_by_one.phase_bins());
            prop_assert_eq!(some.span(), one_by_one.span());
            let bits = |values: &[f32]| -> Vec<u32> { values.iter().map(|v| v.to_bits()).collect() };
            let pairs = expected.each.iter().enumerate().map(|(bin, own)| (some.bin(bin), own));
            for (found, expected) in pairs.chain([(some.all(), &expected.all)]) {
                prop_assert_eq!(&found.n_samples, &expected.n_samples[points.clone()]);
                let found = found.mean.iter().chain(&found.stress);
                for (found, expected) in found.zip(expected.mean.iter().chain(&expected.stress)) {
                    prop_assert_eq!(bits(found), bits(&expected[points.clone()]));
                }
            }
        }
        prop_assert_eq!(n_holes, one_by_one.n_holes());
        prop_assert!(PhaseBatch::new(bins, &[instants[1], instants[0]]).is_err());
    }
}

/// Of bins that hold equally many samples, total stress = periodic + random, whatever the samples.
#[test]
fn periodic_and_random_stresses_add_up_where_bins_are_equal() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut averager = PhaseAverager::new(line(3), Bins::of_rotor(4).unwrap());
    for step in 0..40 {
        let rotor = TAU * (f64::from(step % 4) + 0.5) / 4.0;
        let velocity: [[f32; 3]; 3] = std::array::from_fn(|_| {
            std::array::from_fn(|_| (8.0 + rotor.sin() + normals(&mut random)[0]) as f32)
        });
        averager
            .add(f64::from(step), rotor, None, velocity.each_ref().map(|row| &row[..]))
            .unwrap();
    }
    let found = decompose(&averager.averages());
    for point in 0..3 {
        for place in 0..6 {
            let parts = found.periodic[place][point] + found.random[place][point];
            assert!((parts - found.total[place][point]).abs() < 1e-5);
        }
        assert_eq!((found.n_bins[point], found.fewest[point]), (4, 10));
    }
}

/// u = 8 + 0.6 cos(θ + p) + 0.2 n₁, w = 0.3 sin(θ + p) + 0.2 (0.8 n₁ + 0.6 n₂) with θ = 2 helix azimuths:
/// stresses are known, and a window keeps sin(Δ)/Δ of the wave's amplitude.
fn travelling_wave(n_each: usize, seed: u64) -> (Bins, PhaseAverages) {
    let ratio = 4.9;
    let bins = Bins::of_helix(4, ratio, 2, Sense::CounterClockwise, TAU / 10.0).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut averager = PhaseAverager::new(line(5), bins);
    for step in 0..n_each * bins.len() {
        let (helix, rotor) = (TAU * even(&mut random), TAU * even(&mut random));
        let mut velocity = [[0.0_f32; 5]; 3];
        let [along, _, up] = &mut velocity;
        for (point, (along, up)) in along.iter_mut().zip(up).enumerate() {
            let angle = 2.0 * helix + point as f64;
            let [first, second] = normals(&mut random);
            *along = (8.0 + 0.6 * angle.cos() + 0.2 * first) as f32;
            *up = (0.3 * angle.sin() + 0.2 * (0.8 * first + 0.6 * second)) as f32;
        }
        let rows = velocity.each_ref().map(|row| &row[..]);
        averager.add(step as f64, rotor, Some(helix), rows).unwrap();
    }
    (bins, averager.averages())
}

/// Mean, periodic and random parts of a wave. Of 20 bins that differ, each of 1500 samples that scatter by
/// 0.25 m/s, the periodic stress of amplitude 0.56 m/s has a scatter of 0.7 %, that of 0.28 m/s of 1.4 %, and
/// the random stress one of 0.8 %; tolerances are four times that.
#[test]
fn a_travelling_wave_is_taken_apart() {
    let (bins, averages) = travelling_wave(1500, 11);
    let found = decompose(&averages);
    let half = 0.5 * bins.helix_width().unwrap();
    // The wave turns twice as fast as the helix: over the window its angle goes through four halves.
    let kept = (2.0 * half).sin() / (2.0 * half);
    let (u_u, w_w) = (0.5 * 0.36 * kept * kept, 0.5 * 0.09 * kept * kept);
    let within = 0.5 * 0.36 * (1.0 - kept * kept);
    for point in 0..5 {
        assert!((found.mean[0][point] / 8.0 - 1.0).abs() < 0.001);
        assert!(
            (found.periodic[0][point] / u_u - 1.0).abs() < 0.028,
            "{}",
            found.periodic[0][point]
        );
        assert!(
            (found.periodic[2][point] / w_w - 1.0).abs() < 0.056,
            "{}",
            found.periodic[2][point]
        );
        let random = found.random[0][point] / (0.04 + within);
        assert!((random - 1.0).abs() < 0.032, "{random}");
        // No correlation of the periodic parts, 0.8 of the random ones.
        assert!(found.periodic[4][point].abs() < 0.03 * u_u);
        assert!((found.random[4][point] / (0.04 * 0.8) - 1.0).abs() < 0.04);
    }
}

/// The scatter of bin means falls with the root of the samples, and is the standard error that is told.
#[test]
fn the_error_of_a_bin_falls_as_theory_says() {
    let scatter = |n_each: usize| {
        let mut squares = Vec::new();
        let mut told = Vec::new();
        for seed in 0..3 {
            let (bins, averages) = travelling_wave(n_each, 100 + seed);
            let kept = (bins.helix_width().unwrap()).sin() / bins.helix_width().unwrap();
            for (bin, moments) in averages.bins.iter().zip(&averages.each) {
                for point in 0..5 {
                    let angle = 2.0 * bin.helix.unwrap() + point as f64;
                    // The wave across its window is no error of the mean: taken at its own average.
                    let expected = 8.0 + 0.6 * kept * angle.cos();
                    squares.push((f64::from(moments.mean[0][point]) - expected).powi(2));
                    let n = bin.n_instants as f64;
                    told.push(standard_error(moments, 0, point, n).powi(2));
                }
            }
        }
        let mean = |values: &[f64]| (values.iter().sum::<f64>() / values.len() as f64).sqrt();
        (mean(&squares), mean(&told))
    };
    let ((few, few_told), (many, many_told)) = (scatter(40), scatter(160));
    assert!((few / many / 2.0 - 1.0).abs() < 0.15, "{few} {many}");
    assert!((few / few_told - 1.0).abs() < 0.15 && (many / many_told - 1.0).abs() < 0.15);
}

#[test]
fn an_empty_bin_is_not_a_number_and_visits_are_counted() {
    let mut averager = PhaseAverager::new(line(1), Bins::of_rotor(4).unwrap());
    let add = |averager: &mut PhaseAverager, time: f64, rotor: f64| {
        averager.add(time, rotor, None, [&[1.0], &[2.0], &[3.0]]).unwrap()
    };
    for (step, rotor) in [0.1, 0.2, 1.7, 0.3, 0.4].into_iter().enumerate() {
        add(&mut averager, step as f64, rotor);
    }
    let averages = averager.averages();
    let counts: Vec<_> = averages.bins.iter().map(|bin| (bin.n_instants, bin.n_visits)).collect();
    assert_eq!(counts, [(4, 2), (1, 1), (0, 0), (0, 0)]);
    assert!(averages.each[2].mean[0][0].is_nan() && averages.each[2].stress[3][0].is_nan());
    assert_eq!(averages.each[0].stress, Moments { ..averages.each[0].clone() }.stress);
    assert_eq!(averages.span, [0.0, 4.0]);
    averager.begin_record();
    add(&mut averager, 0.0, 0.1);
    assert_eq!(averager.phase_bins()[0].n_visits, 3);
}

#[test]
fn what_cannot_be_averaged_is_refused_and_changes_nothing() {
    let bins = Bins::of_helix(12, 5.0, 1, Sense::Clockwise, 1.0).unwrap();
    let mut averager = PhaseAverager::new(line(1), bins);
    let one: [&[f32]; 3] = [&[1.0], &[1.0], &[1.0]];
    averager.add(1.0, 0.0, Some(0.0), one).unwrap();
    let before = averager.clone();
    let two: [&[f32]; 3] = [&[1.0, 1.0], &[1.0], &[1.0]];
    let refusals = [
        averager.add(1.0, 0.0, Some(0.0), one).unwrap_err(),
        averager.add(2.0, 0.0, None, one).unwrap_err(),
        averager.add(2.0, f64::NAN, Some(0.0), one).unwrap_err(),
        averager.add(2.0, 0.0, Some(0.0), two).unwrap_err(),
    ];
    assert!(matches!(refusals[0], PhaseError::TimeRunsBack { .. }));
    assert_eq!(refusals[1], PhaseError::NoHelix { time: 2.0 });
    assert!(matches!(refusals[2], PhaseError::NotFinite { what: "rotor azimuth", .. }));
    assert_eq!(refusals[3], PhaseError::Points { found: 2, expected: 1 });
    assert_eq!(averager.phase_bins(), before.phase_bins());
    assert!(Bins::of_rotor(0).is_err());
    assert!(Bins::of_helix(12, 0.1, 1, Sense::Clockwise, 1.0).is_err());
    assert!(Bins::of_helix(12, 5.0, 1, Sense::Clockwise, 0.0).is_err());
}

#[test]
fn memory_is_told_beforehand() {
    let bins = Bins::of_helix(12, 14.0 / 3.0, 3, Sense::Clockwise, Bins::WIDTH).unwrap();
    assert_eq!(PhaseAverager::memory(1000, &bins), 1000 * (169 * 76 + 12));
}
