//! Waves on layered air and the turning of the wind, against their closed forms.

use super::*;

/// Length and height of the channel (m).
const LENGTH: f64 = 32.0;
const HEIGHT: f64 = 24.0;
const SPEED: f64 = 0.004;

/// Upward wind and wind along x of a standing wave at its start.
fn wave(x: Vector3) -> Vector3 {
    let [k, m] = [TAU / LENGTH, 0.5 * TAU / HEIGHT];
    let z = x.z + 0.5;
    let up = (k * x.x).cos() * (m * z).sin();
    Vector3::new(-m / k * (k * x.x).sin() * (m * z).cos(), 0.0, up) * SPEED
}

/// Share of the wave in the wind, step by step.
fn swing(halved: bool, boxes: &[Refinement], n_steps: usize) -> Vec<f64> {
    let mut coarse = periodic_box([32, 4, 24], 1e-5);
    coarse.ground = Ground::Slip;
    let slope = 0.0122;
    coarse.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 300.0], [HEIGHT, 300.0 + slope * HEIGHT]],
        reference: Reference::Start,
        ..Atmosphere::new(300.0)
    });
    let settings = if halved { fine(&coarse) } else { coarse };
    let mut air = refined(settings, boxes, |_, x| wave(x));
    let mut shares = Vec::new();
    for _ in 0..n_steps {
        air.advance(1.0, &[]).expect("no divergence");
        let (mut share, mut norm) = (0.0, 0.0);
        for (centre, velocity, volume) in all_cells(&air) {
            let wave = wave(centre);
            share += volume * velocity.dot(wave);
            norm += volume * wave.length_squared();
        }
        shares.push(share / norm);
    }
    shares
}

/// Time of the second sign change of `shares` (s), in steps of a second from the first one.
fn crossing(shares: &[f64]) -> f64 {
    let mut crossings = shares.windows(2).enumerate().filter(|(_, pair)| pair[0] * pair[1] <= 0.0);
    let (step, pair) = crossings.nth(1).expect("it swings");
    step as f64 + 1.0 + pair[0] / (pair[0] - pair[1])
}

#[test]
fn a_gravity_wave_swings_through_a_box_as_without_it() {
    let [k, m] = [TAU / LENGTH, 0.5 * TAU / HEIGHT];
    let frequency = (9.81 / 300.0 * 0.0122_f64).sqrt() * k / k.hypot(m);
    // Three quarters of a period.
    let expected = 0.75 * TAU / frequency;
    let n_steps = (1.1 * TAU / frequency) as usize;
    let place = [cells([9, 0, 7], [12, 4, 10])];
    let (fine, boxed) = (swing(true, &[], n_steps), swing(false, &place, n_steps));
    let [of_fine, of_box] = [&fine, &boxed].map(|shares| crossing(shares));
    let last = (TAU / frequency) as usize;
    println!("{of_fine:.2} s fine, {of_box:.2} s with a box, {expected:.2} s expected");
    println!("left {:.4} fine, {:.4} with a box", fine[last], boxed[last]);
    assert!((of_box / of_fine - 1.0).abs() < 0.01, "{of_box} s, {of_fine} s on fine cells");
    assert!((of_box / expected - 1.0).abs() < 0.03, "{of_box} s for {expected} s");
    assert!((boxed[last] - fine[last]).abs() < 0.03, "{} for {}", boxed[last], fine[last]);
    assert!(boxed[last] > 0.9, "{} is left", boxed[last]);
}

#[test]
fn wind_turns_alike_within_a_box_and_without() {
    let coriolis = 0.002;
    let mut settings = periodic_box([16, 14, 12], 3e-3);
    settings.atmosphere = Some(Atmosphere {
        coriolis,
        driving: Driving::Geostrophic([0.05, 0.01]),
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 4, 3], [8, 7, 6]);
    place.within.push(cells([4, 4, 3], [8, 6, 6]));
    let mut air = refined(settings, &[place], |_, _| Vector3::new(0.08, 0.0, 0.0));
    for _ in 0..4 {
        air.advance(500.0, &[]).expect("no divergence");
        // The departure turns to the right (Ekman 1905).
        let (s, c) = (coriolis * air.time()).sin_cos();
        let expected = Vector3::new(0.05 + 0.03 * c - 0.01 * s, 0.01 - 0.01 * c - 0.03 * s, 0.0);
        let found: Vec<Vector3> = all_cells(&air).iter().map(|(_, wind, _)| *wind).collect();
        let off = found.iter().map(|wind| (*wind - expected).length()).fold(0.0, f64::max);
        let jump = found.iter().map(|wind| (*wind - found[0]).length()).fold(0.0, f64::max);
        println!("{} s: off by {off:e}, jump {jump:e}", air.time());
        // What is told lacks half of the last step's force, 3e-5 on coarse cells and 8e-6 on the finest;
        // where both meet, whatever pushes all air leaves as much.
        assert!(off < 1.6e-4 && jump < 1.6e-4, "{} s: off by {off}, jump {jump}", air.time());
    }
}
