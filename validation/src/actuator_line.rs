//! The actuator line on coarse grids against blade-element momentum, and against blade elements in the flow
//! that rings make together: power and thrust in a steady uniform wind.

use crate::Row;
use crate::axisymmetric::{self, Swirl};
use crate::row::Tolerance::Within;
use basis::keys::Values;
use farm::assemble::TurbineModel;
use farm::case::{Flow, Shear, Solver, TurbulenceModel, Wind};
use farm::self_check::{Tunnel, self_check};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::steady::{Coefficients, SteadyRotor};

/// Accepted distance of power and thrust from their expectations (–).
const TOLERANCE: f64 = 0.03;
/// Cells that the tip moves in a step (–): below the lattice's speed of sound, 0.577, beyond which a blade
/// outruns the pressure that should make room for it and meets its own bound vortex.
const TIP_CELLS: f64 = 0.5;
/// The tunnel, in diameters: large enough for what its walls and its inlet do to be below a percent of the
/// power, and time enough for the near wake to stand.
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
    CASES.iter().flat_map(|&(name, cells, speed)| compare(name, cells, speed, false)).collect()
}

/// The same on 16 cells per diameter alone, a few minutes instead of an hour.
pub fn actuator_line_coarse() -> Vec<Row> {
    on(16.0)
}

/// The same on 32 cells per diameter alone.
pub fn actuator_line_fine() -> Vec<Row> {
    on(32.0)
}

/// The three rotors on 16 and 24 cells per diameter without tilt, precone and prebend: what the theories are
/// about.
pub fn actuator_line_flat() -> Vec<Row> {
    let rotors = ["iea-15mw", "iea-22mw", "nrel-5mw"];
    [16.0, 24.0]
        .into_iter()
        .flat_map(|cells| rotors.map(|name| (name, cells)))
        .flat_map(|(name, cells)| compare(name, cells, 9.0, true))
        .collect()
}

/// Those of the comparisons that are made on `cells_per_diameter`.
fn on(cells_per_diameter: f64) -> Vec<Row> {
    CASES
        .iter()
        .filter(|case| case.1 == cells_per_diameter)
        .flat_map(|&(name, cells, speed)| compare(name, cells, speed, false))
        .collect()
}

fn compare(name: &str, cells_per_diameter: f64, wind_speed: f64, flat: bool) -> Vec<Row> {
    let file = formats::library::load(name).expect("the library's own turbines are readable");
    let mut definition = file.definition;
    if flat {
        definition.rotor.precone = 0.0;
        definition.rotor.shaft_tilt = 0.0;
        definition.blade.iter_mut().for_each(|station| station.prebend = 0.0);
    }
    let shape = if flat { " flat" } else { "" };
    let model = TurbineModel { definition: Arc::new(definition), constants: file.controller };
    let spacing = model.definition.rotor_diameter() / cells_per_diameter;
    let tunnel = Tunnel {
        upstream: UPSTREAM,
        downstream: DOWNSTREAM,
        width: WIDTH,
        settling: SETTLING,
        averaging: AVERAGING,
        spacing,
        interval: TIP_CELLS * spacing / model.footprint(wind_speed).tip_speed,
        method: Default::default(),
    };
    let wind = Wind {
        speed: wind_speed,
        direction: farm::case::FROM_WEST,
        turbulence_intensity: 0.0,
        shear: Shear::PowerLaw { exponent: 0.0 },
        length_scale: None,
        anisotropy: 0.0,
        seed: 0,
        air_density: 1.225,
        kinematic_viscosity: 1.5e-5,
        turbulence_model: TurbulenceModel::Mann,
        grid: None,
        planes: None,
        precursor: None,
        precursor_beside: false,
        beyond_planes: None,
        cut: None,
        table: None,
        veer: 0.0,
        event: None,
    };
    let mut whole = |_| ControlFlow::Continue(());
    let flow = Flow { solver: Solver::LATTICE, values: Values::none(), step: None, threads: None };
    let check = self_check(&model, &wind, &tunnel, &flow, &mut whole)
        .expect("a rotor in a steady wind stays finite");
    let together = in_axisymmetric_flow(&model, check.tip_speed_ratio);
    let definition = &model.definition;
    let force = 0.5 * wind.air_density * definition.rotor_area() * wind_speed * wind_speed;
    let (flow_power, flow_thrust) = (together.power * force * wind_speed, together.thrust * force);
    // The runs take minutes each: what is known is printed at once.
    let percent = |measured: f64, expected: f64| 100.0 * (measured / expected - 1.0);
    tell!(
        "{name}{shape}, {cells_per_diameter} cells per diameter, {wind_speed} m/s: power {:+.2} %, thrust {:+.2} % of blade-element momentum; \
         {:+.2} %, {:+.2} % of the axisymmetric flow",
        percent(check.power, check.expected_power),
        percent(check.thrust, check.expected_thrust),
        percent(check.power, flow_power),
        percent(check.thrust, flow_thrust),
    );
    let row = |what: &str, over: &'static str, measured: f64, expected: f64| Row {
        what: format!(
            "{name}{shape}, {cells_per_diameter} cells per diameter, {wind_speed} m/s, best tip-speed ratio: {what} over that of {over}"
        ),
        measured: measured / expected,
        expected: 1.0,
        tolerance: Within(TOLERANCE),
        unit: "–",
        source: over,
    };
    let [momentum, flow] = ["blade-element momentum", "blade elements in axisymmetric flow"];
    vec![
        row("power", momentum, check.power, check.expected_power),
        row("thrust", momentum, check.thrust, check.expected_thrust),
        row("power", flow, check.power, flow_power),
        row("thrust", flow, check.thrust, flow_thrust),
    ]
}

/// Coefficients of `model` at its least pitch in the axisymmetric flow of the tunnel, its tilt as
/// blade-element momentum has it.
fn in_axisymmetric_flow(model: &TurbineModel, tip_speed_ratio: f64) -> Coefficients {
    let pitch = model.constants.fine_pitch;
    // A round duct as wide as the square tunnel is, in radii.
    let wall = 2.0 * WIDTH / PI.sqrt();
    let flow = axisymmetric::Flow::new(2.0 * UPSTREAM, 2.0 * DOWNSTREAM, wall);
    let together =
        axisymmetric::coefficients(&model.definition, tip_speed_ratio, pitch, flow, Swirl::LeftOut);
    let mut upright = (*model.definition).clone();
    upright.rotor.shaft_tilt = 0.0;
    let [tilted, upright] = [&*model.definition, &upright].map(|definition| {
        SteadyRotor::new(definition, Theory::default())
            .along_shaft()
            .coefficients(tip_speed_ratio, pitch)
    });
    Coefficients {
        power: together.power * tilted.power / upright.power,
        thrust: together.thrust * tilted.thrust / upright.thrust,
        torque: together.torque * tilted.torque / upright.torque,
    }
}
