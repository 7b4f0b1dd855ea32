//! A rough ground under turbulent wind: the mean stays logarithmic.

use super::{advance, lattice};
use crate::Row;
use crate::row::Tolerance::Within;
use basis::Vector3;
use farm::assemble::SMAGORINSKY_OVER_GROUND;
use flow::lattice::{Ends, Ground, LatticeSettings, Subgrid, VON_KARMAN};
use std::f64::consts::{PI, TAU};

/// Where the expected values come from.
const SOURCE: &str = "logarithmic law";

const HEIGHT: f64 = 1000.0;
const FRICTION_VELOCITY: f64 = 0.4;
const ROUGHNESS_LENGTH: f64 = 0.1;
const LATTICE_SPEED: f64 = 0.13;

fn logarithmic(z: f64) -> f64 {
    FRICTION_VELOCITY / VON_KARMAN * (z / ROUGHNESS_LENGTH).ln()
}

/// Half a channel driven by u*²/H, periodic, four turnovers H/u* to settle and six to average, with the
/// subgrid constant that studies over a rough ground run with.
pub fn log_profile() -> Vec<Row> {
    let n = [36, 36, 24];
    let spacing = HEIGHT / n[2] as f64;
    let top = logarithmic(HEIGHT);
    let mut settings =
        LatticeSettings::new(Vector3::ZERO, spacing, n, LATTICE_SPEED * spacing / top, top);
    settings.ends = Ends::Periodic;
    settings.ground = Ground::WallStress { roughness_length: ROUGHNESS_LENGTH };
    settings.acceleration = Vector3::new(FRICTION_VELOCITY.powi(2) / HEIGHT, 0.0, 0.0);
    settings.subgrid = Subgrid::smagorinsky(SMAGORINSKY_OVER_GROUND);
    // A box this small gains nothing from more threads.
    settings.threads = Some(1);
    let k = TAU / (n[0] as f64 * spacing);
    let mut air = lattice(settings, move |_, p| {
        let (x, y) = (k * p.x, k * p.y);
        let eddies = Vector3::new(
            (3.0 * y).sin() * (2.0 * x + p.z / 80.0).cos()
                + (5.0 * y + 1.0).cos() * (4.0 * x).sin(),
            (4.0 * x + 2.0 * y).sin() + (3.0 * x - 5.0 * y).cos(),
            (3.0 * x).sin() * (3.0 * y).cos() + (5.0 * x + 1.3).sin() * (2.0 * y).cos(),
        );
        let envelope = 1.5 * FRICTION_VELOCITY * (PI * p.z / HEIGHT).sin();
        Vector3::new(logarithmic(p.z), 0.0, 0.0) + eddies * envelope
    });
    let turnover = HEIGHT / FRICTION_VELOCITY / air.settings().interval;
    advance(&mut air, 4.0 * turnover, &[]);
    let n_instants = 300;
    let mut means = vec![0.0; n[2]];
    for _ in 0..n_instants {
        advance(&mut air, 6.0 * turnover / f64::from(n_instants), &[]);
        let volume = air.volume(1);
        for (mean, level) in means.iter_mut().zip(volume.velocity[0].chunks(n[0] * n[1])) {
            let sum: f64 = level.iter().copied().map(f64::from).sum();
            *mean += sum / level.len() as f64 / f64::from(n_instants);
        }
    }
    let height = |level: usize| (level as f64 + 0.5) * spacing;
    let mut rows: Vec<Row> = [1, 2, 4, 8, 12, 18]
        .into_iter()
        .map(|level| Row {
            what: format!("rough ground: mean speed at z/H = {:.3}", height(level) / HEIGHT),
            measured: means[level],
            expected: logarithmic(height(level)),
            tolerance: Within(0.05 * logarithmic(height(level))),
            unit: "m/s",
            source: SOURCE,
        })
        .collect();
    // u = u*/κ ln z: the slope over the surface layer gives the friction velocity back.
    let (low, high) = (1, n[2] / 4);
    rows.push(Row {
        what: "rough ground: friction velocity from the slope of the lowest quarter".to_owned(),
        measured: VON_KARMAN * (means[high] - means[low]) / (height(high) / height(low)).ln(),
        expected: FRICTION_VELOCITY,
        tolerance: Within(0.15 * FRICTION_VELOCITY),
        unit: "m/s",
        source: SOURCE,
    });
    rows
}
