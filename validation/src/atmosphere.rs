//! Air with temperature on a turning earth against closed forms: conduction, waves, Ekman's layer, the onset
//! of convection.

mod capped;
mod carried;
mod in_study;
mod stable;

pub use capped::capped_boundary_layer;
pub use in_study::study_in_atmosphere;
pub use stable::{stable_boundary_layer, stable_subgrid_models};

use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use flow::lattice::atmosphere::{Atmosphere, Driving, Heating, Reference};
use flow::lattice::{Ends, Ground, Lattice, LatticeSettings, Stencil, Subgrid};
use flow::{FlowSolver, Inflow};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Where the expected values come from.
const SOURCE: &str = "closed form";
const REFERENCE: f64 = 300.0;

/// All of the fast ones.
pub fn atmosphere() -> Vec<Row> {
    [
        conduction(),
        inertial_oscillation(),
        internal_wave(),
        ekman(),
        convection(),
        carried::carried_eddies(),
        memory(),
    ]
    .concat()
}

/// Wind and temperature (K) given by functions of position.
struct Air<F, G>(F, G);

impl<F, G> Inflow for Air<F, G>
where
    F: Fn(Vector3) -> Vector3 + Send + Sync,
    G: Fn(Vector3) -> f64 + Send + Sync,
{
    fn sample(&self, _: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = (self.0)(*position);
        }
    }

    fn sample_temperature(&self, _: f64, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = (self.1)(*position);
        }
        true
    }
}

fn lattice(
    settings: LatticeSettings,
    wind: impl Fn(Vector3) -> Vector3 + Send + Sync + 'static,
    temperature: impl Fn(Vector3) -> f64 + Send + Sync + 'static,
) -> Lattice {
    Lattice::new(settings, Arc::new(Air(wind, temperature)))
        .expect("settings of a validation are sound")
}

fn advance(air: &mut Lattice, n_steps: f64) {
    air.advance(n_steps.round(), &[]).expect("flows of a validation stay finite");
}

/// A box whose SI units are lattice units, periodic all around, with air of Prandtl number one that
/// temperature does not move.
fn periodic_box(n_cells: [usize; 3], viscosity: f64) -> LatticeSettings {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 1.0, n_cells, 1.0, 0.1);
    settings.air_density = 1.0;
    settings.kinematic_viscosity = viscosity;
    settings.ends = Ends::Periodic;
    settings.ground = Ground::Periodic;
    settings.subgrid = Subgrid::smagorinsky(0.0);
    settings.atmosphere =
        Some(Atmosphere { gravity: 0.0, prandtl: 1.0, ..Atmosphere::new(REFERENCE) });
    settings
}

fn row(what: &str, measured: f64, expected: f64, within: f64, unit: &'static str) -> Row {
    Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance: Within(within),
        unit,
        source: SOURCE,
    }
}

/// Waves of temperature that are carried and conducted.
fn conduction() -> Vec<Row> {
    let mut rows = Vec::new();
    let sizes = [16, 32, 64];
    let errors = sizes.map(|n| {
        let [diffusivity, lag] = carried(n);
        rows.push(row(
            &format!("wave of temperature, {n} cells, carried along: diffusivity over the target"),
            diffusivity,
            1.0,
            0.01,
            "-",
        ));
        lag
    });
    for pair in 0..sizes.len() - 1 {
        let what = format!(
            "wave of temperature, carried along: order of its speed's error, {} to {} cells",
            sizes[pair],
            sizes[pair + 1]
        );
        rows.push(row(&what, (errors[pair] / errors[pair + 1]).abs().log2(), 2.0, 0.2, "-"));
    }
    for (name, wind) in [
        ("in still air", Vector3::ZERO),
        ("in wind along it", Vector3::new(0.07, 0.0, 0.07)),
        ("in wind across it", Vector3::new(0.07, 0.0, -0.07)),
    ] {
        let what =
            format!("oblique wave of temperature, 32 cells, {name}: diffusivity over the target");
        rows.push(row(&what, oblique(32, wind), 1.0, 0.01, "-"));
    }
    rows
}

/// Diffusivity over the target, and relative error of the speed, of a wave along z on `n` cells in wind along
/// z.
fn carried(n: usize) -> [f64; 2] {
    let (k, diffusivity, speed) = (TAU / n as f64, 0.01, 0.1);
    let mut air = lattice(
        periodic_box([4, 1, n], diffusivity),
        move |_| Vector3::new(0.0, 0.0, speed),
        move |x| REFERENCE + (k * x.z).sin(),
    );
    let part = |air: &Lattice| {
        let mut sums = [0.0; 2];
        for level in air.level_statistics() {
            let (s, c) = (k * level.height).sin_cos();
            sums[0] += (level.temperature - REFERENCE) * s;
            sums[1] += (level.temperature - REFERENCE) * c;
        }
        sums
    };
    advance(&mut air, 20.0);
    let before = part(&air);
    let duration = (4.0 * n as f64).round();
    advance(&mut air, duration);
    let after = part(&air);
    let decay = (before[0].hypot(before[1]) / after[0].hypot(after[1])).ln();
    let phase = |[s, c]: [f64; 2]| (-c).atan2(s);
    let turned = k * speed * duration;
    let lag = (phase(after) - phase(before) - turned + PI).rem_euclid(TAU) - PI;
    [decay / (k * k * duration * diffusivity), lag / turned]
}

/// Diffusivity over the target of a wave along x and z on `n` cells.
fn oblique(n: usize, wind: Vector3) -> f64 {
    let (k, diffusivity) = (TAU / n as f64, 0.01);
    let mut air = lattice(
        periodic_box([n, 1, n], diffusivity),
        move |_| wind,
        move |x| REFERENCE + (k * (x.x + x.z)).sin(),
    );
    let variance = |air: &Lattice| -> f64 {
        air.level_statistics().iter().map(|level| level.temperature_variance).sum()
    };
    advance(&mut air, 20.0);
    let before = variance(&air);
    let duration = 400.0;
    advance(&mut air, duration);
    (before / variance(&air)).ln() / (4.0 * k * k * diffusivity * duration)
}

/// A wind that only the earth's turning moves.
fn inertial_oscillation() -> Vec<Row> {
    let (coriolis, speed) = (1e-3, 0.08);
    let mut settings = periodic_box([16, 1, 4], 1e-5);
    if let Some(atmosphere) = &mut settings.atmosphere {
        atmosphere.coriolis = coriolis;
    }
    let mut air = lattice(settings, move |_| Vector3::new(speed, 0.0, 0.0), |_| REFERENCE);
    let period = TAU / coriolis;
    // Not a whole number of periods, after which no wind that stood still would be told from this one.
    advance(&mut air, 10.25 * period);
    let [u, v, _] = air.level_statistics()[0].velocity;
    let turned = v.atan2(u) + coriolis * air.time();
    let error = (turned + PI).rem_euclid(TAU) - PI;
    let drift = (u.hypot(v) / speed).powi(2) - 1.0;
    vec![
        Row {
            what: "inertial oscillation, 10.25 periods: energy gained or lost over energy"
                .to_owned(),
            measured: drift.abs(),
            expected: 1e-4,
            tolerance: AtMost,
            unit: "-",
            source: SOURCE,
        },
        row(
            "inertial oscillation: frequency over f",
            1.0 - error / (coriolis * air.time()),
            1.0,
            1e-3,
            "-",
        ),
    ]
}

/// A standing wave in stratified air: ω = N k/√(k² + m²).
fn internal_wave() -> Vec<Row> {
    let n = [32, 1, 33];
    let (k, m) = (TAU / n[0] as f64, PI / n[2] as f64);
    let (slope, gravity) = (0.01, 9.81e-3);
    let mut settings = periodic_box(n, 1e-6);
    settings.ground = Ground::Slip;
    let height = n[2] as f64;
    settings.atmosphere = Some(Atmosphere {
        gravity,
        reference: Reference::Start,
        temperature: vec![[0.0, REFERENCE], [height, REFERENCE + slope * height]],
        prandtl: 1.0,
        ..Atmosphere::new(REFERENCE)
    });
    let wave = move |x: Vector3| 0.01 * (k * x.x).cos() * (m * x.z).sin();
    let mut air = lattice(settings, |_| Vector3::ZERO, move |x| REFERENCE + slope * x.z + wave(x));
    let expected = (gravity / REFERENCE * slope).sqrt() * k / k.hypot(m);
    // The variance of temperature vanishes twice a period.
    let step = (TAU / expected / 100.0).round();
    let mut series = Vec::new();
    for _ in 0..420 {
        advance(&mut air, step);
        series.push(air.level_statistics()[n[2] / 2].temperature_variance);
    }
    let zeros: Vec<f64> = series
        .windows(3)
        .enumerate()
        .filter(|(_, part)| part[1] < part[0] && part[1] <= part[2])
        .map(|(at, part)| {
            let shift = 0.5 * (part[0] - part[2]) / (part[0] - 2.0 * part[1] + part[2]);
            (at as f64 + 2.0 + shift) * step
        })
        .collect();
    let found = match zeros[..] {
        [first, .., last] => PI * (zeros.len() - 1) as f64 / (last - first),
        _ => f64::NAN,
    };
    vec![row(
        "internal gravity wave, 32 cells: frequency over N cos(inclination)",
        found / expected,
        1.0,
        0.01,
        "-",
    )]
}

/// The laminar layer over a ground that holds the air fast, after three inertial periods.
fn ekman() -> Vec<Row> {
    let (coriolis, viscosity, wind): (f64, f64, f64) = (1e-3, 0.05, 0.05);
    let depth = (2.0 * viscosity / coriolis).sqrt();
    let mut settings = periodic_box([16, 1, 64], viscosity);
    settings.ground = Ground::NoSlip;
    settings.atmosphere = Some(Atmosphere {
        coriolis,
        gravity: 0.0,
        driving: Driving::Geostrophic([wind, 0.0]),
        ..Atmosphere::new(REFERENCE)
    });
    let exact = move |z: f64| {
        let decay = (-z / depth).exp();
        let (s, c) = (z / depth).sin_cos();
        Vector3::new(wind * (1.0 - decay * c), wind * decay * s, 0.0)
    };
    let mut air = lattice(settings, move |x| exact(x.z), |_| REFERENCE);
    advance(&mut air, 3.0 * TAU / coriolis);
    let worst = worst(
        air.level_statistics()
            .iter()
            .map(|level| Vector3::from(level.velocity).distance(exact(level.height)) / wind),
    );
    vec![Row {
        what:
            "laminar Ekman layer of ten cells: largest error of the wind over the geostrophic one"
                .to_owned(),
        measured: worst,
        expected: 0.01,
        tolerance: AtMost,
        unit: "-",
        source: SOURCE,
    }]
}

/// The Rayleigh number at which air between plates begins to move: where the growth of a roll vanishes.
fn convection() -> Vec<Row> {
    // Rolls as wide as the plates are apart: their wave number π is next to the most dangerous one, 3.117, at
    // which the number is 1707.76 (Chandrasekhar 1961, section 15); the difference is 0.01 %.
    let found = [16, 32].map(|height| {
        let (low, high) = (1600.0, 1800.0);
        let (at_low, at_high) = (growth(height, low), growth(height, high));
        low - at_low * (high - low) / (at_high - at_low)
    });
    [16, 32]
        .into_iter()
        .zip(found)
        .map(|(height, found)| {
            let what =
                format!("onset of convection between plates {height} cells apart: Rayleigh number");
            row(&what, found, 1707.8, 0.02 * 1707.8, "-")
        })
        .collect()
}

/// Growth of a roll between plates `height` cells apart at a Rayleigh number, over the time of conduction.
fn growth(height: usize, rayleigh: f64) -> f64 {
    let h = height as f64;
    let viscosity = 0.03;
    let mut settings = periodic_box([2 * height, 1, height], viscosity);
    settings.ground = Ground::Plates;
    let (ground, top) = (REFERENCE + 0.5, REFERENCE - 0.5);
    settings.atmosphere = Some(Atmosphere {
        gravity: rayleigh * viscosity * viscosity / (h * h * h) * REFERENCE,
        reference: Reference::Start,
        temperature: vec![[0.0, ground], [h, top]],
        heating: Heating::Plates { ground, top },
        prandtl: 1.0,
        ..Atmosphere::new(REFERENCE)
    });
    let roll = move |x: Vector3| 0.003 * (PI * x.x / h).cos() * (PI * x.z / h).sin();
    let mut air = lattice(settings, |_| Vector3::ZERO, move |x| ground - x.z / h + roll(x));
    let conduction = h * h / viscosity;
    let variance = |air: &Lattice| air.level_statistics()[height / 2].temperature_variance;
    advance(&mut air, 0.5 * conduction);
    let before = variance(&air);
    advance(&mut air, conduction);
    0.5 * (variance(&air) / before).ln()
}

/// What a cell takes with temperature.
fn memory() -> Vec<Row> {
    [(Stencil::D3Q19, "D3Q19"), (Stencil::D3Q27, "D3Q27")]
        .into_iter()
        .map(|(stencil, name)| {
            let mut settings = periodic_box([126, 128, 128], 1e-3);
            settings.ground = Ground::WallStress { roughness_length: 0.01 };
            settings.stencil = stencil;
            settings.atmosphere =
                Some(Atmosphere { heating: Heating::Flux(0.0), ..Atmosphere::new(REFERENCE) });
            let cells = settings.cells() as f64;
            let air = lattice(settings, |_| Vector3::ZERO, |_| REFERENCE);
            Row {
                what: format!("memory of a cell with temperature, {name}, rows of 126 cells"),
                measured: air.memory() as f64 / cells,
                expected: 110.0,
                tolerance: AtMost,
                unit: "bytes",
                source: "aim",
            }
        })
        .collect()
}
