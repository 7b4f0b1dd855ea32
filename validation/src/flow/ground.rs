//! A rough ground under turbulent wind: the mean stays logarithmic.

use super::{advance, lattice};
use crate::Row;
use crate::row::Tolerance::Within;
use basis::Vector3;
use farm::assemble::SMAGORINSKY_OVER_GROUND;
use flow::lattice::{Ends, Ground, LatticeSettings, Stencil, Subgrid, VON_KARMAN};
use std::f64::consts::{PI, TAU};

/// Where the expected values come from.
const SOURCE: &str = "logarithmic law";

const HEIGHT: f64 = 1000.0;
pub(super) const FRICTION_VELOCITY: f64 = 0.4;
const ROUGHNESS_LENGTH: f64 = 0.1;
const LATTICE_SPEED: f64 = 0.13;

/// Speed of the logarithmic law at height `z` (m), in m/s.
pub(super) fn logarithmic(z: f64) -> f64 {
    FRICTION_VELOCITY / VON_KARMAN * (z / ROUGHNESS_LENGTH).ln()
}

/// Half a channel driven by u*²/H, periodic, after four turnovers H/u* to settle and six to average.
pub(super) struct HalfChannel {
    /// Mean speed of each level, from the ground up (m/s).
    pub(super) means: Vec<f64>,
    spacing: f64,
}

impl HalfChannel {
    /// That with `subgrid` on the lattice of `stencil`.
    pub(super) fn run(subgrid: Subgrid, stencil: Stencil) -> Self {
        let n = [36, 36, 24];
        let spacing = HEIGHT / n[2] as f64;
        let top = logarithmic(HEIGHT);
        let mut settings =
            LatticeSettings::new(Vector3::ZERO, spacing, n, LATTICE_SPEED * spacing / top, top);
        settings.ends = Ends::Periodic;
        settings.ground = Ground::WallStress { roughness_length: ROUGHNESS_LENGTH };
        settings.acceleration = Vector3::new(FRICTION_VELOCITY.powi(2) / HEIGHT, 0.0, 0.0);
        settings.subgrid = subgrid;
        settings.stencil = stencil;
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
        Self { means, spacing }
    }

    /// Height of the middle of `level` (m).
    pub(super) fn height(&self, level: usize) -> f64 {
        (level as f64 + 0.5) * self.spacing
    }

    /// Friction velocity that the mean slope of the lowest quarter stands for (m/s): u = u*/κ ln z.
    pub(super) fn slope_of_quarter(&self) -> f64 {
        let (low, high) = (1, self.means.len() / 4);
        VON_KARMAN * (self.means[high] - self.means[low])
            / (self.height(high) / self.height(low)).ln()
    }
}

/// Half a channel with the subgrid constant that studies over a rough ground run with.
pub fn log_profile() -> Vec<Row> {
    let channel = HalfChannel::run(Subgrid::smagorinsky(SMAGORINSKY_OVER_GROUND), Stencil::D3Q19);
    let height = |level: usize| channel.height(level);
    let mut rows: Vec<Row> = [1, 2, 4, 8, 12, 18]
        .into_iter()
        .map(|level| Row {
            what: format!("rough ground: mean speed at z/H = {:.3}", height(level) / HEIGHT),
            measured: channel.means[level],
            expected: logarithmic(height(level)),
            tolerance: Within(0.05 * logarithmic(height(level))),
            unit: "m/s",
            source: SOURCE,
        })
        .collect();
    rows.push(Row {
        what: "rough ground: friction velocity from the slope of the lowest quarter".to_owned(),
        measured: channel.slope_of_quarter(),
        expected: FRICTION_VELOCITY,
        tolerance: Within(0.15 * FRICTION_VELOCITY),
        unit: "m/s",
        source: SOURCE,
    });
    rows
}
