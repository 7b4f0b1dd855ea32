//! The actuator line on coarse grids against blade-element momentum: power and thrust in a steady uniform wind.

use crate::Row;
use basis::{Commands, PerBlade, Vector3};
use flow::inflow::MeanProfile;
use flow::lattice::{Ground, Lattice, Settings};
use flow::{FlowSolver, WindField};
use std::f64::consts::PI;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::blockage::equivalent_speed_ratio;
use turbine::steady::SteadyRotor;
use turbine::{Definition, Turbine};

/// Accepted distance of power and thrust from blade-element momentum (–).
const TOLERANCE: f64 = 0.03;
/// Smearing length over cell size (–).
const SMEARING_CELLS: f64 = 2.0;
/// Cells that the tip moves in a step (–): below the lattice's speed of sound, 0.577, beyond which a blade outruns the
/// pressure that should make room for it and meets its own bound vortex.
const TIP_CELLS: f64 = 0.5;
/// Box in diameters: upstream, downstream, width and height.
const UPSTREAM: f64 = 3.0;
const DOWNSTREAM: f64 = 4.0;
const WIDTH: f64 = 6.0;
/// Time until the near wake stands, and time averaged after it (diameters over wind speed).
const SETTLING: f64 = 7.0;
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
    ("iea-15mw", 32.0, 9.0),
    ("iea-22mw", 32.0, 9.0),
    ("nrel-5mw", 32.0, 9.0),
];

/// Power and thrust of three rotors at their best tip-speed ratio on 16, 24 and 32 cells per diameter.
pub fn actuator_line() -> Vec<Row> {
    CASES.iter().flat_map(|&(name, cells, speed)| compare(name, cells, speed)).collect()
}

/// The same on 16 cells per diameter alone, a few minutes instead of an hour.
pub fn actuator_line_coarse() -> Vec<Row> {
    CASES
        .iter()
        .filter(|case| case.1 == 16.0)
        .flat_map(|&(name, cells, speed)| compare(name, cells, speed))
        .collect()
}

fn compare(name: &str, cells_per_diameter: f64, wind_speed: f64) -> Vec<Row> {
    let file = formats::library::load(name).expect("the library's own turbines are readable");
    let tip_speed_ratio = file.controller.optimal_tip_speed_ratio;
    let definition = Arc::new(file.definition);
    let scale =
        [3, 2].map(|power| 0.5 * AIR_DENSITY * definition.rotor_area() * wind_speed.powi(power));
    let [power, thrust] = measure(&definition, tip_speed_ratio, cells_per_diameter, wind_speed);
    let area_ratio = PI / (4.0 * WIDTH * WIDTH);
    let [expected_power, expected_thrust] = expected(&definition, tip_speed_ratio, area_ratio);
    let row = |what: &str, measured: f64, expected: f64| Row {
        what: format!(
            "{name}, {cells_per_diameter} cells per diameter, {wind_speed} m/s, tip-speed ratio {tip_speed_ratio}: {what} coefficient"
        ),
        measured,
        expected,
        tolerance: TOLERANCE * expected,
        unit: "–",
    };
    vec![
        row("power", power / scale[0], expected_power),
        row("thrust", thrust / scale[1], expected_thrust),
    ]
}

/// Density of the air (kg/m³).
const AIR_DENSITY: f64 = 1.225;

/// Power (W) and thrust (N) of the actuator line with its rotor speed held, tower and nacelle left out.
fn measure(
    definition: &Arc<Definition>,
    tip_speed_ratio: f64,
    cells_per_diameter: f64,
    wind_speed: f64,
) -> [f64; 2] {
    let diameter = definition.rotor_diameter();
    let spacing = diameter / cells_per_diameter;
    let interval = TIP_CELLS * spacing / (tip_speed_ratio * wind_speed);
    let n = |diameters: f64| (diameters * cells_per_diameter).round() as usize;
    let corner = Vector3::new(-UPSTREAM, -0.5 * WIDTH, -0.5 * WIDTH) * diameter;
    let n_cells = [n(UPSTREAM + DOWNSTREAM), n(WIDTH), n(WIDTH)];
    let mut settings = Settings::new(corner, spacing, n_cells, interval, wind_speed);
    settings.air_density = AIR_DENSITY;
    settings.ground = Ground::Periodic;
    let mut air = Lattice::new(settings, Arc::new(MeanProfile::Uniform { speed: wind_speed }))
        .expect("the box is within the lattice's limits");
    let rotor_speed = tip_speed_ratio * wind_speed / definition.rotor_radius();
    let mut rotor = Turbine::new(
        Arc::clone(definition),
        Vector3::new(0.0, 0.0, -definition.rotor.hub_height),
        turbine::Settings {
            smearing_length: SMEARING_CELLS * spacing,
            sample_spacing: spacing,
            air_density: AIR_DENSITY,
            rotor_speed,
            azimuth: 0.0,
            pitch: 0.0,
        },
    )
    .without_bodies()
    .at_held_speed();
    let commands =
        Commands { pitch: PerBlade::splat(definition.n_blades, 0.0), generator_torque: 0.0 };
    let steps = |diameters: f64| (diameters * diameter / wind_speed / interval).ceil() as usize;
    let (n_settling, n_averaging) = (steps(SETTLING), steps(AVERAGING));
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let mut sums = [0.0; 2];
    for step in 0..n_settling + n_averaging {
        air.sample(rotor.stations(), &mut winds);
        rotor.advance(interval, &winds, &commands);
        air.advance(interval, rotor.forces()).expect("a rotor in a steady wind stays finite");
        if step >= n_settling {
            let read = rotor.measurements(air.time(), interval);
            sums[0] += read.aerodynamic_torque * read.rotor_speed;
            sums[1] += read.thrust;
        }
    }
    sums.map(|sum| sum / n_averaging as f64)
}

/// Power and thrust coefficient by blade-element momentum in a channel of which the rotor takes `area_ratio` (–), at pitch 0,
/// both on the channel's inflow speed.
pub fn expected(definition: &Definition, tip_speed_ratio: f64, area_ratio: f64) -> [f64; 2] {
    let rotor = SteadyRotor::new(definition, Theory::default());
    let at = |ratio: f64| {
        let coefficients = rotor.coefficients(tip_speed_ratio / ratio, 0.0);
        [coefficients.power * ratio.powi(3), coefficients.thrust * ratio * ratio]
    };
    // The speed-up depends on the thrust, which hardly depends on the speed-up.
    let ratio = (0..8).fold(1.0, |ratio, _| equivalent_speed_ratio(at(ratio)[1], area_ratio));
    at(ratio)
}
