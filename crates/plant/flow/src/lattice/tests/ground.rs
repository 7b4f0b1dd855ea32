//! The ground holds the wind back as the logarithmic law says.

use super::*;
use crate::FlowSolver;
use std::f64::consts::{PI, TAU};

pub(in crate::lattice) const HEIGHT: f64 = 1000.0;
pub(in crate::lattice) const FRICTION_VELOCITY: f64 = 0.4;
const ROUGHNESS_LENGTH: f64 = 0.1;

pub(in crate::lattice) fn logarithmic(z: f64) -> f64 {
    FRICTION_VELOCITY / VON_KARMAN * (z / ROUGHNESS_LENGTH).ln()
}

/// Half a channel with a rough floor, `n` cells across, driven by u*²/H.
pub(in crate::lattice) fn half_channel(n: [usize; 3]) -> LatticeSettings {
    let spacing = HEIGHT / n[2] as f64;
    let top = logarithmic(HEIGHT);
    let mut settings = LatticeSettings::new(Vector3::ZERO, spacing, n, 0.13 * spacing / top, top);
    settings.ends = Ends::Periodic;
    settings.ground = Ground::WallStress { roughness_length: ROUGHNESS_LENGTH };
    settings.acceleration = Vector3::new(FRICTION_VELOCITY.powi(2) / HEIGHT, 0.0, 0.0);
    settings.threads = Some(1);
    settings
}

/// Logarithmic wind with eddies in a half channel of `length` (m).
pub(in crate::lattice) fn eddies(length: f64, p: Vector3) -> Vector3 {
    let k = TAU / length;
    let (x, y) = (k * p.x, k * p.y);
    let eddies = Vector3::new(
        (3.0 * y).sin() * (2.0 * x + p.z / 80.0).cos() + (5.0 * y + 1.0).cos() * (4.0 * x).sin(),
        (4.0 * x + 2.0 * y).sin() + (3.0 * x - 5.0 * y).cos(),
        (3.0 * x).sin() * (3.0 * y).cos() + (5.0 * x + 1.3).sin() * (2.0 * y).cos(),
    );
    let envelope = 1.5 * FRICTION_VELOCITY * (PI * p.z / HEIGHT).sin();
    Vector3::new(logarithmic(p.z), 0.0, 0.0) + eddies * envelope
}

#[test]
fn a_rough_ground_keeps_a_logarithmic_profile() {
    let n = [24, 24, 16];
    let settings = half_channel(n);
    let (interval, length) = (settings.interval, n[0] as f64 * settings.spacing);
    let mut air = lattice(settings, move |_, p| eddies(length, p));
    let turnover = (HEIGHT / FRICTION_VELOCITY / interval).round() * interval;
    air.advance(2.0 * turnover, &[]).expect("no divergence");
    let mut means = vec![0.0; n[2]];
    let n_instants = 60;
    for _ in 0..n_instants {
        air.advance((turnover / 30.0 / interval).round() * interval, &[]).expect("no divergence");
        let volume = air.volume(1);
        for (mean, level) in means.iter_mut().zip(volume.velocity[0].chunks(n[0] * n[1])) {
            *mean += level.iter().copied().map(f64::from).sum::<f64>()
                / (level.len() * n_instants) as f64;
        }
    }
    for (level, mean) in means.iter().enumerate().skip(1) {
        let expected = logarithmic((level as f64 + 0.5) * HEIGHT / n[2] as f64);
        println!("{level} {mean:.3} {expected:.3} {:+.3}", mean / expected - 1.0);
        assert!(
            (mean / expected - 1.0).abs() < 0.05,
            "level {level}: {mean} m/s for {expected} m/s"
        );
    }
}

#[test]
fn what_the_ground_takes_is_what_the_air_loses() {
    // Uniform wind, slip top, periodic: one step takes the drag of the logarithmic law out of the momentum.
    let n = [8, 6, 5];
    let mut settings = periodic_box(n, 1e-6);
    settings.origin = Vector3::ZERO;
    settings.ground = Ground::WallStress { roughness_length: 0.01 };
    let mut air = lattice(settings, |_, _| Vector3::new(0.08, 0.06, 0.0));
    let before = air.momentum();
    air.advance(1.0, &[]).expect("no divergence");
    let lost = before - air.momentum();
    let friction = (VON_KARMAN / (1.5_f64 / 0.01).ln()).powi(2);
    let expected = Vector3::new(0.08, 0.06, 0.0) * (0.1 * friction * (n[0] * n[1]) as f64);
    assert!(
        (lost - expected).length() < 1e-3 * expected.length(),
        "lost {lost}, stress {expected}"
    );
}
