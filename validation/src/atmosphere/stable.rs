//! The stable boundary layer of the first intercomparison (GABLS1) in large-eddy simulation.
//!
//! Case and ensemble: Beare et al. (2006), Bound.-Layer Meteorol. 118, 247: 400 m cube, 8 m/s geostrophic,
//! 73° N, ground cooled by 0.25 K an hour, nine hours, profiles of the last.

use crate::Row;
use crate::flow::models;
use crate::folds::worst;
use crate::row::Tolerance::Within;
use basis::Vector3;
use flow::lattice::atmosphere::{
    Atmosphere, Damping, Driving, Heating, LevelStatistics, Perturbation, friction_velocity,
    layer_depth,
};
use flow::lattice::{
    DEFAULT_SMAGORINSKY, Ends, Ground, Lattice, LatticeSettings, Stencil, Subgrid,
};
use flow::{FlowSolver, Inflow};
use std::sync::Arc;

const SOURCE: &str = "spread of the simulations of Beare et al. (2006), read second hand";
const WIND: f64 = 8.0;
const EDGE: f64 = 400.0;
const HOUR: f64 = 3600.0;
/// Sampling interval of the statistics (s).
const INTERVAL: f64 = 10.0;

/// Profiles of hours 8 to 9 on cells of 6.25 m.
pub fn stable_boundary_layer() -> Vec<Row> {
    let run = stable(64, 9.0, Subgrid::smagorinsky(DEFAULT_SMAGORINSKY));
    run.tell();
    run.rows("6.25 m cells")
}

/// The same on cells of 12.5 m with each model of unresolved eddies as it is chosen.
pub fn stable_subgrid_models() -> Vec<Row> {
    models()
        .into_iter()
        .flat_map(|(name, subgrid)| {
            let run = stable(32, 9.0, subgrid);
            run.tell();
            run.rows(&format!("12.5 m cells, {name}"))
        })
        .collect()
}

/// The geostrophic wind everywhere.
struct Geostrophic;

impl Inflow for Geostrophic {
    fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(Vector3::new(WIND, 0.0, 0.0));
    }
}

/// What came of a simulation.
struct Stable {
    /// Means over the last hour.
    levels: Vec<LevelStatistics>,
    spacing: f64,
}

/// The case on `n` cells a side, for `hours`, with `subgrid`.
fn stable(n: usize, hours: f64, subgrid: Subgrid) -> Stable {
    let spacing = EDGE / n as f64;
    // The jet reaches 10 m/s: 0.15 cells a step.
    let step = 0.15 * spacing / 10.0;
    let interval = INTERVAL / (INTERVAL / step).ceil();
    let mut settings = LatticeSettings::new(Vector3::ZERO, spacing, [n; 3], interval, 10.0);
    settings.ends = Ends::Periodic;
    settings.subgrid = subgrid;
    // Nineteen directions let the wind feed eddies, which nothing but stratification holds down here.
    settings.stencil = Stencil::D3Q27;
    settings.ground = Ground::WallStress { roughness_length: 0.1 };
    settings.atmosphere = Some(Atmosphere {
        coriolis: 1.39e-4,
        driving: Driving::Geostrophic([WIND, 0.0]),
        reference_temperature: 263.5,
        temperature: vec![[0.0, 265.0], [100.0, 265.0], [400.0, 268.0]],
        heating: Heating::Ground { temperature: 265.0, rate: -0.25 / HOUR },
        // An e-fold in a minute at the top: waves of this air take five for a swing.
        damping: Some(Damping { from: 300.0, rate: 0.016 }),
        perturbation: Some(Perturbation { below: 50.0, amplitude: 0.1, seed: 1 }),
        ..Atmosphere::new(263.5)
    });
    let mut air =
        Lattice::new(settings, Arc::new(Geostrophic)).expect("settings of a validation are sound");
    let instants = (hours * HOUR / INTERVAL).round() as usize;
    let last = (HOUR / INTERVAL) as usize;
    let mut levels: Vec<LevelStatistics> = Vec::new();
    for instant in 1..=instants {
        air.advance(INTERVAL, &[]).expect("flows of a validation stay finite");
        if instant + last > instants {
            let now = air.level_statistics();
            if levels.is_empty() {
                levels = vec![LevelStatistics::default(); now.len()];
            }
            for (sum, level) in levels.iter_mut().zip(&now) {
                sum.add(level, 1.0 / last as f64);
            }
        }
        if instant.is_multiple_of(180) {
            let now = air.level_statistics();
            let jet = worst(now.iter().map(|level| level.velocity[0].hypot(level.velocity[1])));
            tell!(
                "{:.1} h: u* {:.3} m/s, jet {jet:.2} m/s, w'² {:.4}",
                air.time() / HOUR,
                friction_velocity(&now),
                now[4].variance[2]
            );
        }
    }
    Stable { levels, spacing }
}

impl Stable {
    /// Speed (m/s) and height (m) of the jet: the top of a parabola through three levels.
    fn jet(&self) -> [f64; 2] {
        let speed: Vec<f64> =
            self.levels.iter().map(|level| level.velocity[0].hypot(level.velocity[1])).collect();
        let best = (1..speed.len() - 1)
            .fold(1, |best, at| if speed[at] > speed[best] { at } else { best });
        let [below, at, above] = [speed[best - 1], speed[best], speed[best + 1]];
        let curvature = below - 2.0 * at + above;
        let shift = 0.5 * (below - above) / curvature;
        [at - 0.25 * (below - above) * shift, self.levels[best].height + shift * self.spacing]
    }

    /// The claims, `on` these cells.
    fn rows(&self, on: &str) -> Vec<Row> {
        let [jet, height] = self.jet();
        [
            (
                "depth of the boundary layer",
                layer_depth(&self.levels).unwrap_or(EDGE),
                [150.0, 200.0],
                "m",
            ),
            ("friction velocity", friction_velocity(&self.levels), [0.25, 0.30], "m/s"),
            ("speed of the jet", jet, [9.4, 9.7], "m/s"),
            ("height of the jet", height, [160.0, 180.0], "m"),
        ]
        .into_iter()
        .map(|(what, measured, [low, high], unit)| Row {
            what: format!("stable boundary layer, {on}, hours 8 to 9: {what}"),
            measured,
            expected: 0.5 * (low + high),
            tolerance: Within(0.5 * (high - low)),
            unit,
            source: SOURCE,
        })
        .collect()
    }

    fn tell(&self) {
        for level in &self.levels {
            let [u, v, _] = level.velocity;
            tell!(
                "{:6.1} m: u {u:.2} v {v:.2} m/s, θ {:.2} K, uw {:.4}+{:.4} vw {:.4}+{:.4}, wθ {:.5}+{:.5}, w'² {:.4}",
                level.height,
                level.temperature,
                level.stress[0],
                level.subgrid_stress[0],
                level.stress[1],
                level.subgrid_stress[1],
                level.heat_flux,
                level.subgrid_heat_flux,
                level.variance[2]
            );
        }
    }
}
