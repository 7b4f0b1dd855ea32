//! Tracks, leapfrogging and its sine against motions that are given.

use super::*;
use std::f64::consts::TAU;

fn vortex(x: f64, y: f64) -> Vortex {
    let drift = [1.0, 0.0];
    let (circulation, core_radius) = (-1.0, 0.1);
    Vortex { position: [x, y], circulation, core_radius, drift, misfit: 0.0, turning: None }
}

/// Vortices born every `period` steps at x = 0, going at unit speed, each pair turning about its middle: the
/// second passes the first at `place`.
fn pairs(n_frames: usize, period: usize, place: impl Fn(usize) -> f64) -> Vec<Vec<Vortex>> {
    let speed = 0.05;
    let gap = speed * period as f64;
    let mut frames = vec![Vec::new(); n_frames];
    for pair in 0..n_frames.div_ceil(2 * period) {
        let (births, radius) = ([2 * pair * period, (2 * pair + 1) * period], 0.5 * gap);
        // Both go on at one speed, turning about their middle by a quarter until `place`.
        for (age, frame) in frames.iter_mut().skip(births[1]).take(80).enumerate() {
            let middle = speed * age as f64 + radius;
            let share = (middle - radius) / (place(pair) - radius);
            let (sine, cosine) = (share * TAU / 4.0).sin_cos();
            frame.push(vortex(middle + radius * cosine, 1.0 - radius * sine));
            frame.push(vortex(middle - radius * cosine, 1.0 + radius * sine));
        }
        for (age, frame) in frames.iter_mut().skip(births[0]).take(period).enumerate() {
            frame.push(vortex(speed * age as f64, 1.0));
        }
    }
    frames
}

#[test]
fn each_pair_leapfrogs_where_it_does() {
    let place = |pair: usize| 1.5 + 0.1 * pair as f64;
    let frames = pairs(200, 10, place);
    let tracking =
        Tracking { interval: 0.05, gate: 0.06, n_rounds: 1, birth: 0.06, most_missed: 1 };
    let tracks = follow(&frames, &tracking);
    let born: Vec<&Track> = tracks.iter().filter(|track| track.is_born).collect();
    assert_eq!(born.len(), 20);
    // Vortices pass this line 3 steps after the first one, so that none stands at the edge of the count.
    let blades = Blades { n: 2, per_revolution: 20, line: 0.15 };
    let pairs = |first| Pairs::Of { blades, first, later: 1 };
    let found = leapfrogs(&tracks, pairs(0));
    assert!(found.len() >= 7, "{}", found.len());
    for (pair, leapfrog) in found.iter().enumerate() {
        assert!((leapfrog.place - place(pair)).abs() < 2e-3, "{leapfrog:?}");
        assert_eq!(leapfrog.ids[1], leapfrog.ids[0] + 1);
    }
    // The second of a pair never passes the first of the next one.
    assert!(leapfrogs(&tracks, pairs(1)).is_empty());
    // Nor does the first of a pair pass that of the pair before.
    assert!(leapfrogs(&tracks, Pairs::Of { blades, first: 0, later: 2 }).is_empty());
    let of_blades = blades_of(&tracks, &blades);
    assert!(of_blades.iter().all(|(id, blade)| id % 2 == *blade), "{of_blades:?}");
    // Without one vortex its pair is gone, and all others are found as before.
    let mut fewer = tracks.clone();
    fewer.retain(|track| track.id != found[2].ids[1]);
    let left = leapfrogs(&fewer, pairs(0));
    let others = found.iter().enumerate().filter(|(pair, _)| *pair != 2).map(|(_, one)| *one);
    assert_eq!(left, others.collect::<Vec<_>>());
}

/// A vortex that is missing from a frame keeps its number; one beyond the gate does not.
#[test]
fn a_missing_frame_is_bridged_and_a_jump_is_not() {
    let mut frames: Vec<Vec<Vortex>> =
        (0..20).map(|step| vec![vortex(0.05 * f64::from(step), 0.0)]).collect();
    frames[7].clear();
    let tracking = Tracking { interval: 0.05, gate: 0.02, n_rounds: 1, birth: 0.0, most_missed: 1 };
    let tracks = follow(&frames, &tracking);
    assert_eq!((tracks.len(), tracks[0].sightings.len()), (1, 19));
    assert!(tracks[0].first_axis_at(7).is_some_and(|x| (x - 0.35).abs() < 1e-12));
    for vortices in &mut frames[12..] {
        vortices[0].position[0] += 0.5;
    }
    assert_eq!(follow(&frames, &tracking).len(), 2);
}

/// In a cycle a vortex is followed beyond the last frame into the first.
#[test]
fn a_cycle_has_no_end() {
    // One is born each turn of 10 frames, and lives for 18.
    let frame = |step: usize| {
        let ages = [step, step + 10];
        ages.iter().filter(|age| **age < 18).map(|age| vortex(0.05 * *age as f64, 0.0)).collect()
    };
    let frames: Vec<Vec<Vortex>> = (0..10).map(frame).collect();
    let tracking =
        Tracking { interval: 0.05, gate: 0.02, n_rounds: 2, birth: 0.01, most_missed: 0 };
    let tracks = follow(&frames, &tracking);
    let longest = tracks.iter().filter(|track| track.is_born).map(|track| track.sightings.len());
    assert_eq!(longest.max(), Some(18));
}

#[test]
fn a_sine_comes_back_with_an_interval_that_holds_it() {
    let angles: Vec<f64> = (0..24).map(|i| TAU * f64::from(i) / 24.0).collect();
    let exact: Vec<f64> = angles.iter().map(|a| 1.6 + 0.3 * (a + 0.7).sin()).collect();
    let found = sine_fit(&angles, &exact, 0.0).unwrap();
    assert!((found.mean - 1.6).abs() < 1e-12 && (found.amplitude - 0.3).abs() < 1e-12);
    assert!((found.phase - 0.7).abs() < 1e-12 && found.half_widths[0] < 1e-12);
    // What is left has a standard deviation of 0.05 √(24/21): the interval is t s √(1/24).
    let noisy: Vec<f64> =
        exact.iter().enumerate().map(|(i, v)| v + if i % 2 == 0 { 0.05 } else { -0.05 }).collect();
    let found = sine_fit(&angles, &noisy, 0.0).unwrap();
    let expected = 2.0796 * 0.05 * (24.0_f64 / 21.0).sqrt() / 24.0_f64.sqrt();
    assert!((found.half_widths[0] / expected - 1.0).abs() < 1e-3);
    assert!((found.half_widths[1] / (expected * 2.0_f64.sqrt()) - 1.0).abs() < 1e-3);
    // Evenly spread, mean, sine and cosine have variances of 1, 2 and 2 parts, and the sum 3 at any angle.
    for angle in [0.3_f64, 2.0, -1.1] {
        let [value, half_width] = found.at(angle);
        let exact = found.mean + found.amplitude * (angle + found.phase).sin();
        assert!((value - exact).abs() < 1e-12);
        assert!((half_width / (expected * 3.0_f64.sqrt()) - 1.0).abs() < 1e-3, "{half_width}");
    }
    assert!((found.largest_gap - TAU / 24.0).abs() < 1e-12);
    // Where a third of the turn has no values, the interval is wider: by numpy's inverse of the normal
    // equations, 1.76585 times as wide in the middle of the gap as in the middle of the values.
    let part = sine_fit(&angles[..17], &noisy[..17], 0.0).unwrap();
    assert!((part.largest_gap - TAU * 8.0 / 24.0).abs() < 1e-12);
    let [beside, within] = [8.0, 20.0].map(|place| part.at(TAU * place / 24.0)[1]);
    assert!((within / beside - 1.76585).abs() < 1e-4, "{within} {beside}");
    // Of values that are there twice with all they share, the interval is that of one of each.
    let twice = |values: &[f64]| [values, values].concat();
    let doubled = sine_fit(&twice(&angles), &twice(&noisy), 1e-6).unwrap();
    assert_eq!(doubled.n, 48);
    for (own, other) in doubled.half_widths.iter().zip(found.half_widths) {
        assert!((own / other - 1.0).abs() < 1e-9, "{own} {other}");
    }
    assert!(sine_fit(&angles[..3], &exact[..3], 0.0).is_err());
    assert!(sine_fit(&[0.0; 6], &[1.0; 6], 0.0).is_err());
}

#[test]
fn a_cubic_comes_back_with_an_interval_that_holds_it() {
    let places: Vec<f64> = (0..40).map(|i| 0.5 + 0.07 * f64::from(i)).collect();
    let cubic = |x: f64| 9.0 - 4.0 * x + 0.8 * x * x - 0.05 * x.powi(3);
    let exact: Vec<f64> = places.iter().map(|x| cubic(*x)).collect();
    let found = cubic_fit(&places, &exact).unwrap();
    for x in [0.5, 1.3, 3.2] {
        let (value, half_width) = found.at(x);
        assert!((value - cubic(x)).abs() < 1e-10 && half_width < 1e-9, "{value} {half_width}");
    }
    let noisy: Vec<f64> =
        exact.iter().enumerate().map(|(i, v)| v + if i % 2 == 0 { 0.1 } else { -0.1 }).collect();
    let found = cubic_fit(&places, &noisy).unwrap();
    // The mean of what four of 40 numbers take: t s √(4/40).
    let mean = places.iter().map(|x| found.at(*x).1.powi(2)).sum::<f64>() / 40.0;
    let expected = 2.0281 * 0.1 * (40.0_f64 / 36.0).sqrt() * (4.0_f64 / 40.0).sqrt();
    assert!((mean.sqrt() / expected - 1.0).abs() < 0.01, "{} {expected}", mean.sqrt());
    assert!(cubic_fit(&places[..4], &exact[..4]).is_err());
    assert!(cubic_fit(&[1.0; 8], &[2.0; 8]).is_err());
}

/// Three blades pass one side, and the other half a turn later, where their vortices turn the other way.
#[test]
fn a_blade_has_one_number_on_both_sides() {
    let (per_revolution, speed) = (12, 0.05);
    let born = |blade: usize, turn: usize, side: usize| {
        per_revolution * turn + 4 * blade + if side == 1 { 6 } else { 0 }
    };
    let mut frames = vec![Vec::new(); 60];
    for (blade, turn, side) in
        (0..3).flat_map(|blade| (0..4).flat_map(move |turn| [(blade, turn, 0), (blade, turn, 1)]))
    {
        let first = born(blade, turn, side);
        for (age, frame) in frames.iter_mut().skip(first).take(8).enumerate() {
            let vortex = vortex(speed * age as f64, 1.0 - 2.0 * side as f64);
            let circulation = if side == 1 { 1.0 } else { -1.0 };
            frame.push(Vortex { circulation, ..vortex });
        }
    }
    let tracking =
        Tracking { interval: 0.05, gate: 0.02, n_rounds: 1, birth: 0.01, most_missed: 0 };
    let tracks = follow(&frames, &tracking);
    let blades = Blades { n: 3, per_revolution, line: 0.1 };
    let found = blades_of(&tracks, &blades);
    assert_eq!(found.len(), 24);
    for (id, blade) in found {
        let track = tracks.iter().find(|track| track.id == id).unwrap();
        let (step, side) = (track.sightings[0].step, track.sightings[0].vortex.circulation > 0.0);
        let came = if side { step + per_revolution - 6 } else { step };
        assert_eq!(blade, came / 4 % 3, "track {id}, first seen in frame {step}");
    }
}

/// A vortex whose core grows so that its vorticity falls by e in a length of `length`, seen each 0.1 m.
fn fading(length: f64, n: usize) -> Track {
    let sighting = |step: usize| {
        let x = 0.1 * step as f64;
        let core_radius = 0.1 * (0.5 * x / length).exp();
        Sighting { step, vortex: Vortex { core_radius, ..vortex(x, 1.0) } }
    };
    Track { id: 0, sightings: (0..n).map(sighting).collect(), is_born: true }
}

#[test]
fn a_vortex_has_half_of_its_strength_left_where_it_does() {
    let length = 1.7_f64;
    let track = fading(length, 40);
    // The mean of the first three is what it was at first.
    let mean = [0.0, 0.1, 0.2].map(|x: f64| (-x / length).exp()).iter().sum::<f64>() / 3.0;
    let expected = -length * (0.5 * mean).ln();
    let found = track.half_strength_at().expect("a place");
    assert!((found - expected).abs() < 1e-3, "{found} for {expected}");
    let before = (expected / 0.1).ceil() as usize;
    assert_eq!(fading(length, before).half_strength_at(), None);
    assert!(fading(length, before + 1).half_strength_at().is_some());
    // No strength is known of what is hardly seen.
    assert_eq!(fading(length, 2).half_strength_at(), None);
    // It is the first time that counts: what is strong again later does not undo it.
    let mut twice = fading(length, 40);
    twice.sightings.extend(fading(length, 3).sightings.iter().map(|one| {
        let step = one.step + 40;
        Sighting { step, vortex: Vortex { position: [0.1 * step as f64, 1.0], ..one.vortex } }
    }));
    assert_eq!(twice.half_strength_at(), Some(found));
}
