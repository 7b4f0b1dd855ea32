//! The lattice against closed forms: decay, conservation, momentum theory, the logarithmic law, an open
//! outlet, boxes of finer cells, models of unresolved eddies.

mod disc;
mod ground;
mod isotropy;
mod refinement;
mod subgrid;

pub use disc::momentum_theory;
pub use ground::log_profile;
pub use isotropy::isotropy;
pub use refinement::refinement;
pub use subgrid::{models, subgrid_models};

use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use flow::lattice::{Ends, Ground, Lattice, LatticeSettings, Subgrid};
use flow::{FlowSolver, Inflow, WindField};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Where the expected values come from.
const SOURCE: &str = "closed form";

/// All of the fast ones: Taylor-Green, free stream, mass, outlet, momentum theory.
pub fn flow() -> Vec<Row> {
    [taylor_green(), free_stream(), mass_drift(), outlet(), momentum_theory()].concat()
}

/// Wind given by a function of time and position.
struct Wind<F>(F);

impl<F: Fn(f64, Vector3) -> Vector3 + Send + Sync> Inflow for Wind<F> {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = (self.0)(time, *position);
        }
    }
}

/// A lattice of settings that this file answers for.
fn lattice(
    settings: LatticeSettings,
    wind: impl Fn(f64, Vector3) -> Vector3 + Send + Sync + 'static,
) -> Lattice {
    Lattice::new(settings, Arc::new(Wind(wind))).expect("settings of a validation are sound")
}

/// Moves `air` on by whole steps.
fn advance(air: &mut Lattice, n_steps: f64, forces: &[basis::PointForce]) {
    let duration = n_steps.round() * air.settings().interval;
    air.advance(duration, forces).expect("flows of a validation stay finite");
}

/// A box on all sides periodic whose SI units are lattice units.
fn periodic_box(n_cells: [usize; 3], viscosity: f64, smagorinsky: f64) -> LatticeSettings {
    let mut settings = LatticeSettings::new(Vector3::splat(-0.5), 1.0, n_cells, 1.0, 0.1);
    settings.air_density = 1.0;
    settings.kinematic_viscosity = viscosity;
    settings.ends = Ends::Periodic;
    settings.ground = Ground::Periodic;
    settings.subgrid = Subgrid::smagorinsky(smagorinsky);
    settings
}

/// Decay and error of the Taylor-Green vortex on four grids, refined with the square of the step.
pub fn taylor_green() -> Vec<Row> {
    let viscosity = 0.02;
    let sizes = [16, 32, 64, 128];
    let results = sizes.map(|n| taylor_green_on(n, viscosity));
    let mut rows = Vec::new();
    for (n, (measured, _)) in sizes.into_iter().zip(results).skip(1) {
        rows.push(Row {
            what: format!("Taylor-Green: viscosity over the target, {n} cells a side"),
            measured: measured / viscosity,
            expected: 1.0,
            tolerance: Within(0.01),
            unit: "-",
            source: SOURCE,
        });
    }
    for pair in 0..sizes.len() - 1 {
        rows.push(Row {
            what: format!(
                "Taylor-Green: order of convergence, {} to {} cells",
                sizes[pair],
                sizes[pair + 1]
            ),
            measured: (results[pair].1 / results[pair + 1].1).log2(),
            expected: 2.0,
            tolerance: Within(0.2),
            unit: "-",
            source: SOURCE,
        });
    }
    rows
}

/// Viscosity from the decay, and relative error of the velocity after one decay time.
fn taylor_green_on(n: usize, viscosity: f64) -> (f64, f64) {
    let k = TAU / n as f64;
    let speed = 0.04 * 16.0 / n as f64;
    let vortex = move |p: Vector3| {
        let (x, y) = (k * p.x, k * p.y);
        Vector3::new(x.cos() * y.sin(), -x.sin() * y.cos(), 0.0)
    };
    let mut air = lattice(periodic_box([n, n, 1], viscosity, 0.0), move |_, p| vortex(p) * speed);
    let rate = 2.0 * viscosity * k * k;
    let positions: Vec<Vector3> =
        (0..n * n).map(|i| Vector3::new((i % n) as f64, (i / n) as f64, 0.0)).collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    let mut amplitudes = [0.0; 2];
    let mut error = 0.0;
    for (amplitude, share) in amplitudes.iter_mut().zip([0.2, 0.8]) {
        advance(&mut air, share / rate, &[]);
        air.sample(&positions, &mut velocities);
        let (mut product, mut norm) = (0.0, 0.0);
        for (position, velocity) in positions.iter().zip(&velocities) {
            product += velocity.dot(vortex(*position));
            norm += vortex(*position).length_squared();
        }
        *amplitude = product / norm;
        let exact = speed * (-rate * air.time()).exp();
        let squares = positions.iter().zip(&velocities);
        let sum: f64 = squares.map(|(p, v)| (*v - vortex(*p) * exact).length_squared()).sum();
        error = (sum / norm).sqrt() / exact;
    }
    let duration = (0.8 / rate).round();
    ((amplitudes[0] / amplitudes[1]).ln() / (2.0 * k * k * duration), error)
}

/// Largest departure of a uniform wind from itself in an open box after ten flow-throughs.
pub fn free_stream() -> Vec<Row> {
    let speed = 10.0;
    let settings = LatticeSettings::new(Vector3::ZERO, 10.0, [96, 32, 32], 0.1, speed);
    let mut air = lattice(settings, move |_, _| Vector3::new(speed, 0.0, 0.0));
    advance(&mut air, 9600.0, &[]);
    let volume = air.volume(1);
    let [u, v, w] = &volume.velocity;
    let departures = u.iter().zip(v).zip(w).map(|((u, v), w)| {
        Vector3::new(f64::from(*u) - speed, f64::from(*v), f64::from(*w)).length() / speed
    });
    vec![Row {
        what: "free stream: largest departure from one, ten flow-throughs".to_owned(),
        measured: worst(departures),
        expected: 1e-5,
        tolerance: AtMost,
        unit: "-",
        source: SOURCE,
    }]
}

/// Change of the mass of turbulent air in a periodic box over ten thousand steps.
pub fn mass_drift() -> Vec<Row> {
    let n = 32;
    let k = TAU / n as f64;
    let mut air = lattice(periodic_box([n; 3], 1e-8, 0.12), move |_, p| {
        Vector3::new(0.05 + 0.04 * (k * p.y).sin(), 0.04 * (k * p.z).sin(), 0.04 * (k * p.x).sin())
    });
    let before = air.mass();
    advance(&mut air, 10_000.0, &[]);
    vec![Row {
        what: "mass: relative drift over 10 000 steps".to_owned(),
        measured: air.mass() / before - 1.0,
        expected: 0.0,
        tolerance: Within(1e-6),
        unit: "-",
        source: SOURCE,
    }]
}

/// What comes back from the outlet of a sound pulse, and what stays of a vortex that left.
pub fn outlet() -> Vec<Row> {
    let speed = 0.1;
    let open =
        |n_cells| LatticeSettings { ends: Ends::InletOutlet, ..periodic_box(n_cells, 1e-6, 0.12) };
    let mut air = lattice(open([320, 1, 1]), move |_, p| {
        let bump = (-((p.x - 160.0) / 8.0).powi(2)).exp();
        Vector3::new(speed + 0.004 * bump, 0.0, 0.0)
    });
    let largest = |air: &mut Lattice, n_steps: f64, from: u32, to: u32| {
        advance(air, n_steps, &[]);
        let positions: Vec<_> = (from..to).map(|x| Vector3::new(f64::from(x), 0.0, 0.0)).collect();
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        air.sample(&positions, &mut velocities);
        worst(velocities.iter().map(|v| (v.x - speed).abs()))
    };
    // At c + u the pulse meets the outlet after 236 steps; at c − u its reflection is back at 220 after 446.
    let sent = largest(&mut air, 100.0, 200, 260);
    let back = largest(&mut air, 346.0, 170, 270);

    let mut air = lattice(open([160, 64, 1]), move |_, p| {
        let (dx, dy) = (p.x - 90.0, p.y - 31.5);
        let swirl = 0.01 * (-(dx * dx + dy * dy) / 64.0).exp();
        Vector3::new(speed - swirl * dy / 8.0, swirl * dx / 8.0, 0.0)
    });
    let energy = |air: &mut Lattice, n_steps: f64| {
        advance(air, n_steps, &[]);
        let [u, v, _] = air.volume(1).velocity;
        u.iter()
            .zip(&v)
            .map(|(u, v)| (f64::from(*u) - speed).powi(2) + f64::from(*v).powi(2))
            .sum::<f64>()
    };
    let before = energy(&mut air, 10.0);
    let after = energy(&mut air, 1200.0);
    vec![
        Row {
            what: "outlet: share of a sound pulse that comes back".to_owned(),
            measured: back / sent,
            expected: 0.05,
            tolerance: AtMost,
            unit: "-",
            source: SOURCE,
        },
        Row {
            what: "outlet: energy left of a vortex that went out".to_owned(),
            measured: after / before,
            expected: 1e-3,
            tolerance: AtMost,
            unit: "-",
            source: SOURCE,
        },
    ]
}
