//! The wind over rough ground, in a box that stands on it.

use super::*;
use crate::fields::FieldSource;
use crate::lattice::tests::ground::{FRICTION_VELOCITY, HEIGHT, eddies, half_channel, logarithmic};
use crate::lattice::wall::VON_KARMAN;

#[test]
fn a_logarithmic_profile_stays_in_a_box_on_the_ground() {
    let n = [24, 24, 16];
    let settings = half_channel(n);
    let (interval, length) = (settings.interval, n[0] as f64 * settings.spacing);
    let place = cells([6, 6, 0], [12, 12, 6]);
    let covered = place.covered();
    let mut air = refined(settings, &[place], move |_, p| eddies(length, p));
    let turnover = (HEIGHT / FRICTION_VELOCITY / interval).round() * interval;
    air.advance(2.0 * turnover, &[]).expect("no divergence");
    // Means over each level, without the box and within it.
    let mut means = vec![[0.0; 2]; n[2]];
    let n_instants = 60;
    for _ in 0..n_instants {
        air.advance((turnover / 30.0 / interval).round() * interval, &[]).expect("no divergence");
        let volume = air.volume(1);
        for (index, value) in volume.velocity[0].iter().enumerate() {
            let cell = [index % n[0], index / n[0] % n[1], index / n[0] / n[1]];
            let inside = covered.contains([cell[0], cell[1], 0]);
            let share = f64::from(n_instants) * if inside { 144.0 } else { 432.0 };
            means[cell[2]][usize::from(inside)] += f64::from(*value) / share;
        }
    }
    // Up to three levels above the box; further up the law is none.
    for (level, mean) in means.iter().enumerate().take(9) {
        let expected = logarithmic((level as f64 + 0.5) * HEIGHT / n[2] as f64);
        let [outside, inside] = mean.map(|mean| mean / expected - 1.0);
        println!("{level} {expected:.3} m/s: {outside:+.3} outside, {inside:+.3} inside");
        // The lowest level is where the law's own stress acts.
        assert!(level == 0 || outside.abs() < 0.05, "level {level}: {outside} outside the box");
        assert!(level == 0 || inside.abs() < 0.05, "level {level}: {inside} inside the box");
    }
}

#[test]
fn what_the_ground_takes_in_a_box_is_what_the_air_loses() {
    // One step of a uniform wind: the drag of the logarithmic law at the second level of either grid.
    let mut settings = periodic_box([12, 10, 8], 1e-6);
    settings.origin = Vector3::ZERO;
    settings.ground = Ground::WallStress { roughness_length: 0.01 };
    let wind = Vector3::new(0.08, 0.06, 0.0);
    let mut air = refined(settings, &[cells([3, 2, 0], [5, 4, 3])], move |_, _| wind);
    let before = air.momentum();
    air.advance(1.0, &[]).expect("no divergence");
    let lost = before - air.momentum();
    let drag = |height: f64| (VON_KARMAN / (height / 0.01).ln()).powi(2);
    let expected = wind * wind.length() * (20.0 * drag(0.75) + 100.0 * drag(1.5));
    assert!((lost - expected).length() < 1e-3 * expected.length(), "lost {lost}, not {expected}");
}
