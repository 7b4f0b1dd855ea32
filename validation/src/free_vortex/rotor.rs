//! Rotors at held speed in a steady uniform wind, their wakes free.

use crate::Row;
use crate::axisymmetric::{self, Flow};
use crate::row::Tolerance::Within;
use basis::{Commands, PerBlade, Vector3};
use farm::assemble::TurbineModel;
use flow::inflow::{MeanProfile, PrescribedWind};
use flow::vortex::{Accuracy, BodyWakes, Cores, FreeWake, Points, Resolution, WakeSettings};
use flow::{FlowSolver, WindField};
use std::f64::consts::TAU;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::steady::{Coefficients, SteadyRotor};
use turbine::{Induction, N_ELEMENTS, Turbine, TurbineSettings};

/// Accepted distance from blade elements in axisymmetric flow, and from blade-element momentum (–).
const TOGETHER: f64 = 0.02;
const MOMENTUM: f64 = 0.04;
const AIR_DENSITY: f64 = 1.225;
/// The duct of the axisymmetric flow (radii): so wide that its walls are not felt.
const DUCT: [f64; 3] = [10.0, 12.0, 12.0];

/// How a rotor's wake is resolved.
#[derive(Clone, Copy)]
pub(super) struct Fineness {
    pub(super) steps_per_turn: f64,
    /// Length of the whole wake, and of its part that keeps every element (diameters).
    pub(super) length: f64,
    pub(super) near: f64,
    pub(super) far_filaments: usize,
    pub(super) far_stride: usize,
    pub(super) core_widths: f64,
    /// Time over the wind's time for a diameter (–).
    pub(super) duration: f64,
}

/// What cases have.
pub(super) const USUAL: Fineness = Fineness {
    steps_per_turn: 48.0,
    length: 4.0,
    near: 0.25,
    far_filaments: 9,
    far_stride: 2,
    core_widths: 0.3,
    duration: 8.0,
};

/// Power and thrust of three rotors without tilt, precone and prebend at 8 m/s.
pub(super) fn rows() -> Vec<Row> {
    ["nrel-5mw", "iea-15mw", "iea-22mw"].into_iter().flat_map(|name| compare(name, 8.0)).collect()
}

fn compare(name: &str, wind_speed: f64) -> Vec<Row> {
    let model = flat(name);
    let found = coefficients(&model, wind_speed, USUAL);
    let ratio = model.rotor_speed(wind_speed) * model.definition.rotor_radius() / wind_speed;
    let pitch = model.constants.fine_pitch;
    let [upstream, downstream, wall] = DUCT;
    let together = axisymmetric::coefficients(
        &model.definition,
        ratio,
        pitch,
        Flow::new(upstream, downstream, wall),
    );
    let momentum = SteadyRotor::new(&model.definition, Theory::default())
        .along_shaft()
        .coefficients(ratio, pitch);
    tell!(
        "{name}, {wind_speed} m/s: power {:.4}, thrust {:.4}; axisymmetric flow {:.4}, {:.4}; momentum {:.4}, {:.4}",
        found.power,
        found.thrust,
        together.power,
        together.thrust,
        momentum.power,
        momentum.thrust
    );
    let row = |what: &str, over: &'static str, tolerance: f64, measured: f64, expected: f64| Row {
        what: format!(
            "{name} flat, {wind_speed} m/s, best tip-speed ratio, 48 steps a turn, wake of 4 D: {what} over that of {over}"
        ),
        measured: measured / expected,
        expected: 1.0,
        tolerance: Within(tolerance),
        unit: "–",
        source: over,
    };
    let [by_rings, by_momentum] = ["blade elements in axisymmetric flow", "blade-element momentum"];
    vec![
        row("power", by_rings, TOGETHER, found.power, together.power),
        row("thrust", by_rings, TOGETHER, found.thrust, together.thrust),
        row("power", by_momentum, MOMENTUM, found.power, momentum.power),
        row("thrust", by_momentum, MOMENTUM, found.thrust, momentum.thrust),
    ]
}

/// The library's turbine `name` without tilt, precone and prebend: what the theories are about.
fn flat(name: &str) -> TurbineModel {
    let file = formats::library::load(name).expect("the library's own turbines are readable");
    let mut definition = file.definition;
    definition.rotor.precone = 0.0;
    definition.rotor.shaft_tilt = 0.0;
    definition.blade.iter_mut().for_each(|station| station.prebend = 0.0);
    TurbineModel { definition: Arc::new(definition), constants: file.controller }
}

/// Coefficients over the last turn of the stiff rotor of `model` at its best tip-speed ratio and least pitch.
pub(super) fn coefficients(
    model: &TurbineModel,
    wind_speed: f64,
    fineness: Fineness,
) -> Coefficients {
    let (definition, rotor_speed) = (&model.definition, model.rotor_speed(wind_speed));
    let diameter = definition.rotor_diameter();
    let interval = TAU / rotor_speed / fineness.steps_per_turn;
    let mut wake = wake(model, wind_speed, interval, fineness);
    let pitch = model.constants.fine_pitch;
    let foot = Vector3::Z * -definition.rotor.hub_height;
    let settings = TurbineSettings {
        induction: Induction::ByBoundVortices { dynamic_stall: false, tower: None },
        flexible: false,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed,
        azimuth: 0.0,
        pitch,
    };
    let rotor = Turbine::new(Arc::clone(definition), foot, settings);
    let mut rotor =
        rotor.expect("the library's own turbines stand").without_bodies().at_held_speed();
    let commands = Commands {
        pitch: PerBlade::splat(definition.n_blades, pitch),
        generator_torque: 0.0,
        yaw_rate: 0.0,
    };
    let n_steps = (fineness.duration * diameter / wind_speed / interval).ceil() as usize;
    let n_averaged = fineness.steps_per_turn as usize;
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let (mut power, mut thrust) = (0.0, 0.0);
    for step in 0..n_steps {
        wake.sample(rotor.stations(), &mut winds);
        rotor.advance_answered(interval, &winds, wake.answer(0), &commands);
        wake.advance(interval, rotor.forces()).expect("a wake in steady wind stays finite");
        if step + n_averaged >= n_steps {
            let read = rotor.truth(wake.time(), interval);
            power += read.aerodynamic_torque * read.rotor_speed / n_averaged as f64;
            thrust += read.thrust / n_averaged as f64;
        }
        if step % (n_steps / 8) == 0 {
            let read = rotor.truth(wake.time(), interval);
            tell!(
                "{step} of {n_steps}: {} segments, thrust {:.1} kN",
                wake.segments().len(),
                1e-3 * read.thrust
            );
        }
    }
    let force = 0.5 * AIR_DENSITY * definition.rotor_area() * wind_speed * wind_speed;
    let torque = power / rotor_speed / (force * definition.rotor_radius());
    Coefficients { power: power / (force * wind_speed), thrust: thrust / force, torque }
}

fn wake(model: &TurbineModel, wind_speed: f64, interval: f64, fineness: Fineness) -> FreeWake {
    let definition = &model.definition;
    let diameter = definition.rotor_diameter();
    let rows = |diameters: f64, share: f64| {
        (diameters * diameter / (share * wind_speed * interval)).ceil() as usize
    };
    let settings = WakeSettings {
        interval,
        resolution: Resolution {
            near_rows: rows(fineness.near, 0.65),
            far_stride: fineness.far_stride,
            far_filaments: fineness.far_filaments,
            length: fineness.length * diameter,
            far_rows: rows(fineness.length, 0.4) / fineness.far_stride,
        },
        cores: Cores {
            initial_widths: fineness.core_widths,
            kinematic_viscosity: 1.5e-5,
            eddy_constant: 1e-4,
            strain: false,
        },
        bodies: BodyWakes::NONE,
        air_density: AIR_DENSITY,
        accuracy: Accuracy { degree: 3, opening: 0.6 },
        ground: false,
        shown: Points::NONE,
        n_blades: definition.n_blades,
        n_elements: N_ELEMENTS,
        threads: None,
    };
    let profile = MeanProfile::Uniform { speed: wind_speed };
    let wind = PrescribedWind::everywhere(Arc::new(profile));
    FreeWake::new(settings, wind).expect("such a wake can be")
}
