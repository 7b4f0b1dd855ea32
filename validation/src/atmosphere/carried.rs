//! Eddies in uniform wind, with nineteen directions and with twenty-seven: the wind must not feed them.

use super::lattice;
use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use flow::FlowSolver;
use flow::lattice::atmosphere::{Atmosphere, Driving, LevelStatistics, Perturbation, Reference};
use flow::lattice::{Ends, Ground, Lattice, LatticeSettings, Sides, Stencil, Subgrid};
use std::f64::consts::TAU;

/// Velocity sets, and how they are called.
const SETS: [(Stencil, &str); 2] = [(Stencil::D3Q19, "D3Q19"), (Stencil::D3Q27, "D3Q27")];

/// Turbulence and noise that the wind carries.
pub(super) fn carried_eddies() -> Vec<Row> {
    SETS.into_iter()
        .flat_map(|(stencil, name)| {
            let [still, windy] = [0.0, 10.0].map(|wind| decayed(stencil, wind));
            let row = |what: &str, measured, within| Row {
                what: format!("decaying turbulence, {name}, 320 s in wind of 10 m/s: {what}"),
                measured,
                expected: 1.0,
                tolerance: Within(within),
                unit: "-",
                source: "isotropy and frame of reference",
            };
            [
                row(
                    "streamwise deviation over the lateral one, less that in still air",
                    1.0 + windy[0] / windy[1] - still[0] / still[1],
                    0.05,
                ),
                row("lateral deviation over that in still air", windy[1] / still[1], 0.05),
                Row {
                    what: format!(
                        "noise of temperature in stratified air, {name}, 11 min in wind of 8 m/s: energy of the wind over that in still air"
                    ),
                    measured: stirred(stencil, 8.0) / stirred(stencil, 0.0),
                    expected: 2.0,
                    tolerance: AtMost,
                    unit: "-",
                    source: "frame of reference",
                },
            ]
        })
        .collect()
}

/// Deviations of u and v (m/s) after 320 s of decay, carried by `wind` (m/s) through a periodic box of 48
/// cells of 10 m.
fn decayed(stencil: Stencil, wind: f64) -> [f64; 2] {
    let (n, spacing) = (48, 10.0);
    let mut settings = LatticeSettings::new(Vector3::ZERO, spacing, [n; 3], 0.125, 10.0);
    settings.ends = Ends::Periodic;
    settings.sides = Sides::Periodic;
    settings.ground = Ground::Periodic;
    settings.stencil = stencil;
    settings.atmosphere = Some(Atmosphere { gravity: 0.0, ..Atmosphere::new(300.0) });
    let modes = modes(n as f64 * spacing);
    let at = move |x: Vector3| {
        modes.iter().fold(Vector3::new(wind, 0.0, 0.0), |sum, (wave, amplitude, phase)| {
            sum + *amplitude * (wave.dot(x) + phase).cos()
        })
    };
    let mut air = lattice(settings, at, |_| 300.0);
    air.advance(320.0, &[]).expect("flows of a validation stay finite");
    [0, 1]
        .map(|axis| {
            mean(&air, |level| level.variance[axis] + level.velocity[axis].powi(2))
                - mean(&air, |level| level.velocity[axis]).powi(2)
        })
        .map(f64::sqrt)
}

/// Wave number, amplitude and phase of waves without divergence in a box of edge `length` (m), down to a
/// tenth of it, with the spectrum of inertial turbulence.
fn modes(length: f64) -> Vec<(Vector3, Vector3, f64)> {
    let mut random = Random(1);
    let mut number = || (random.bits() >> 33) as f64 / (1_u64 << 31) as f64;
    let mut modes = Vec::new();
    let most = 10_i32;
    for (x, y, z) in (-most..=most)
        .flat_map(|x| (-most..=most).flat_map(move |y| (0..=most).map(move |z| (x, y, z))))
    {
        let squared = x * x + y * y + z * z;
        if squared == 0 || squared > most * most {
            continue;
        }
        let wave = Vector3::new(f64::from(x), f64::from(y), f64::from(z)) * (TAU / length);
        let along = wave.normalize();
        let any = Vector3::new(number() - 0.5, number() - 0.5, number() - 0.5);
        let across = (any - along * any.dot(along)).normalize();
        let amplitude = 0.5 * f64::from(squared).sqrt().max(3.0).powf(-11.0 / 6.0);
        modes.push((wave, across * amplitude, number() * TAU));
    }
    modes
}

/// Kinetic energy (m²/s²) of eddies that noise of temperature has stirred up in stratified air in uniform
/// `wind` (m/s), twice over.
fn stirred(stencil: Stencil, wind: f64) -> f64 {
    let (theta, slope) = (263.5, 0.01);
    let mut settings = LatticeSettings::new(Vector3::ZERO, 12.5, [32; 3], 0.1875, 10.0);
    settings.ends = Ends::Periodic;
    settings.stencil = stencil;
    settings.subgrid = Subgrid::smagorinsky(0.0);
    settings.atmosphere = Some(Atmosphere {
        driving: Driving::Geostrophic([wind, 0.0]),
        temperature: vec![[0.0, theta], [400.0, theta + slope * 400.0]],
        reference: Reference::Start,
        perturbation: Some(Perturbation { below: 400.0, amplitude: 0.1, seed: 1 }),
        ..Atmosphere::new(theta)
    });
    let profile = move |x: Vector3| theta + slope * x.z;
    let mut air = lattice(settings, move |_| Vector3::new(wind, 0.0, 0.0), profile);
    air.advance(660.0, &[]).expect("flows of a validation stay finite");
    mean(&air, |level| level.variance.iter().sum())
}

/// Mean over the levels of `air`.
fn mean(air: &Lattice, of: impl Fn(&LevelStatistics) -> f64) -> f64 {
    let levels = air.level_statistics();
    levels.iter().map(of).sum::<f64>() / levels.len() as f64
}
