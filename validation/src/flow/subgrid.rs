//! Models of the eddies that cells do not resolve, side by side: laminar shear, decaying turbulence behind a
//! grid, the wind over a rough ground.

mod decay;

use super::ground::{FRICTION_VELOCITY, HalfChannel, logarithmic};
use super::{advance, lattice, periodic_box};
use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use farm::assemble::SMAGORINSKY_OVER_GROUND;
use flow::lattice::{DEFAULT_SMAGORINSKY, Stencil, Subgrid, SubgridModel, VON_KARMAN};
use std::f64::consts::TAU;

/// The models as they are chosen: Smagorinsky's with the constants of free air and of rough ground.
pub fn models() -> Vec<(String, Subgrid)> {
    SubgridModel::ALL
        .into_iter()
        .flat_map(|model| match model {
            SubgridModel::Smagorinsky => [DEFAULT_SMAGORINSKY, SMAGORINSKY_OVER_GROUND]
                .map(|constant| (format!("smagorinsky {constant}"), Subgrid::smagorinsky(constant)))
                .to_vec(),
            model => vec![(model.word().to_owned(), Subgrid::new(model))],
        })
        .collect()
}

/// All comparisons.
pub fn subgrid_models() -> Vec<Row> {
    [shear(), decay::decay(), rough_ground()].concat()
}

/// Eddies of laminar shear, over those that Smagorinsky's model finds there.
fn shear() -> Vec<Row> {
    let n = 32;
    let k = TAU / f64::from(n);
    let amplitude = 0.05;
    models()
        .into_iter()
        .filter(|(_, subgrid)| subgrid.model.needs_neighbours())
        .map(|(name, subgrid)| {
            let mut settings = periodic_box([8, 4, n as usize], 1e-4, 0.0);
            settings.subgrid = subgrid;
            let wind = move |x: Vector3| Vector3::new(amplitude * (k * x.z).sin(), 0.0, 0.0);
            let mut air = lattice(settings, move |_, x| wind(x));
            advance(&mut air, 50.0, &[]);
            let eddies = worst(air.eddy_viscosity().into_iter().flatten());
            Row {
                what: format!(
                    "laminar shear, {name}: greatest viscosity of eddies over that of Smagorinsky's model"
                ),
                measured: eddies / (DEFAULT_SMAGORINSKY.powi(2) * amplitude * k),
                expected: 0.001,
                tolerance: AtMost,
                unit: "-",
                source: "closed form",
            }
        })
        .collect()
}

/// The mean wind of half a channel over a rough ground.
fn rough_ground() -> Vec<Row> {
    models()
        .into_iter()
        .flat_map(|(name, subgrid)| {
            let channel = HalfChannel::run(subgrid, Stencil::D3Q27);
            let slopes = gradients(&channel);
            for (level, (mean, slope)) in channel.means.iter().zip(&slopes).enumerate() {
                tell!(
                    "{name}: {:.0} m: {mean:.3} m/s, logarithmic {:.3}; slope to the next over its own {slope:.3}",
                    channel.height(level),
                    logarithmic(channel.height(level))
                );
            }
            let quarter = channel.means.len() / 4;
            let lowest = &slopes[1..quarter];
            let row = |what: &str, measured, expected, tolerance| Row {
                what: format!(
                    "rough ground, 4 to 10 turnovers after the law's own wind, D3Q27, {name}: {what}"
                ),
                measured,
                expected,
                tolerance,
                unit: "-",
                source: "logarithmic law",
            };
            let off = |level: usize| {
                (channel.means[level] / logarithmic(channel.height(level)) - 1.0).abs()
            };
            [
                row(
                    "mean slope of the lowest quarter over that of the law",
                    channel.slope_of_quarter() / FRICTION_VELOCITY,
                    1.0,
                    Within(0.15),
                ),
                row(
                    "greatest slope between two levels of the lowest quarter, over that of the law",
                    worst(lowest.iter().copied()),
                    1.0,
                    Within(0.2),
                ),
                row(
                    "largest error of the mean speed from the second level to 0.77 of the height",
                    worst((1..=18).map(off)),
                    0.05,
                    AtMost,
                ),
            ]
        })
        .collect()
}

/// Difference of the mean wind between each level and the next, over that of the logarithmic law.
fn gradients(channel: &HalfChannel) -> Vec<f64> {
    let steps = channel.means.windows(2).enumerate();
    steps
        .map(|(level, pair)| {
            let ratio = channel.height(level + 1) / channel.height(level);
            VON_KARMAN * (pair[1] - pair[0]) / (FRICTION_VELOCITY * ratio.ln())
        })
        .collect()
}
