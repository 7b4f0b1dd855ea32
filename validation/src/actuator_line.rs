//! The actuator line on coarse grids against blade-element momentum: power and thrust in a steady uniform wind.

use crate::Row;
use farm::assemble::Model;
use farm::case::{Shear, TurbulenceModel, Wind};
use farm::self_check::{Tunnel, self_check};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Accepted distance of power and thrust from blade-element momentum (–).
const TOLERANCE: f64 = 0.03;
/// Cells that the tip moves in a step (–): below the lattice's speed of sound, 0.577, beyond which a blade outruns the
/// pressure that should make room for it and meets its own bound vortex.
const TIP_CELLS: f64 = 0.5;
/// The tunnel, in diameters: large enough for what its walls and its inlet do to be below a percent of the power, and time
/// enough for the near wake to stand.
const UPSTREAM: f64 = 5.0;
const DOWNSTREAM: f64 = 5.0;
const WIDTH: f64 = 6.0;
const SETTLING: f64 = 14.0;
const AVERAGING: f64 = 1.0;

/// Turbines, cells per diameter and wind speeds (m/s) that are compared.
const CASES: &[(&str, f64, f64)] = &[
    ("iea-15mw", 16.0, 7.0),
    ("iea-15mw", 16.0, 9.0),
    ("iea-15mw", 16.0, 10.0),
    ("iea-22mw", 16.0, 9.0),
    ("nrel-5mw", 16.0, 9.0),
    ("iea-15mw", 24.0, 9.0),
    ("iea-22mw", 24.0, 9.0),
    ("nrel-5mw", 24.0, 9.0),
    ("iea-22mw", 32.0, 9.0),
    ("nrel-5mw", 32.0, 9.0),
    ("iea-15mw", 32.0, 9.0),
];

/// Power and thrust of three rotors at their best tip-speed ratio on 16, 24 and 32 cells per diameter.
pub fn actuator_line() -> Vec<Row> {
    CASES.iter().flat_map(|&(name, cells, speed)| compare(name, cells, speed)).collect()
}

/// The same on 16 cells per diameter alone, a few minutes instead of an hour.
pub fn actuator_line_coarse() -> Vec<Row> {
    on(16.0)
}

/// The same on 32 cells per diameter alone.
pub fn actuator_line_fine() -> Vec<Row> {
    on(32.0)
}

/// Those of the comparisons that are made on `cells_per_diameter`.
fn on(cells_per_diameter: f64) -> Vec<Row> {
    CASES
        .iter()
        .filter(|case| case.1 == cells_per_diameter)
        .flat_map(|&(name, cells, speed)| compare(name, cells, speed))
        .collect()
}

fn compare(name: &str, cells_per_diameter: f64, wind_speed: f64) -> Vec<Row> {
    let file = formats::library::load(name).expect("the library's own turbines are readable");
    let model = Model { definition: Arc::new(file.definition), constants: file.controller };
    let spacing = model.definition.rotor_diameter() / cells_per_diameter;
    let tunnel = Tunnel {
        upstream: UPSTREAM,
        downstream: DOWNSTREAM,
        width: WIDTH,
        settling: SETTLING,
        averaging: AVERAGING,
        spacing,
        interval: TIP_CELLS * spacing / model.footprint(wind_speed).tip_speed,
    };
    let wind = Wind {
        speed: wind_speed,
        turbulence_intensity: 0.0,
        shear: Shear::PowerLaw { exponent: 0.0 },
        length_scale: 0.0,
        anisotropy: 0.0,
        seed: 0,
        air_density: 1.225,
        kinematic_viscosity: 1.5e-5,
        turbulence_model: TurbulenceModel::Mann,
        planes: None,
        veer: 0.0,
        event: None,
    };
    let mut whole = |_| ControlFlow::Continue(());
    let check = self_check(&model, &wind, &tunnel, None, &mut whole)
        .expect("a rotor in a steady wind stays finite");
    // The runs take minutes each: what is known is told at once.
    eprintln!(
        "{name}, {cells_per_diameter} cells per diameter, {wind_speed} m/s: power {:+.2} %, thrust {:+.2} % of blade-element momentum",
        100.0 * (check.power / check.expected_power - 1.0),
        100.0 * (check.thrust / check.expected_thrust - 1.0),
    );
    let row = |what: &str, measured: f64, expected: f64| Row {
        what: format!(
            "{name}, {cells_per_diameter} cells per diameter, {wind_speed} m/s, tip-speed ratio {:.2}: {what} over that of blade-element momentum",
            check.tip_speed_ratio
        ),
        measured: measured / expected,
        expected: 1.0,
        tolerance: TOLERANCE,
        unit: "–",
    };
    vec![
        row("power", check.power, check.expected_power),
        row("thrust", check.thrust, check.expected_thrust),
    ]
}
