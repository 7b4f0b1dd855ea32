//! Rotors at held speed in a steady uniform wind, their wakes free.

use super::held::{AIR_DENSITY, Steady, Trial, flat, turn};
use crate::Row;
use crate::axisymmetric::{self, Flow, Swirl};
use crate::row::Tolerance::Within;
use farm::assemble::TurbineModel;
use flow::inflow::{MeanProfile, PrescribedWind};
use flow::vortex::{
    Accuracy, BodyWakes, Cores, FreeWake, MeanShear, Points, Resolution, WakeSettings,
};
use std::f64::consts::TAU;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::steady::{Coefficients, SteadyRotor};
use turbine::{Induction, N_ELEMENTS};

/// Accepted distance from blade elements in axisymmetric flow, and from blade-element momentum (–).
const TOGETHER: f64 = 0.02;
const MOMENTUM: f64 = 0.04;
/// The duct of the axisymmetric flow (radii): a disc in it has the blockage of 1/1600. Behind walls at 12
/// radii it would have a hundredth more power.
const DUCT: [f64; 3] = [10.0, 12.0, 40.0];
/// Turbines, and winds (m/s) in which they keep their best tip-speed ratio: from wind to wind only the growth
/// of cores makes another flow of it, so that one turbine is tried in all and two at the ends.
const ROTORS: [(&str, &[f64]); 3] =
    [("nrel-5mw", &[7.0, 8.0, 9.0, 10.0]), ("iea-15mw", &[7.0, 10.0]), ("iea-22mw", &[7.0, 10.0])];

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
    /// Time before the means begin, over the wind's time for a diameter (–).
    pub(super) settling: f64,
}

/// As cases have it, with a wake so long that its end takes 0.2 % from the induction, and ten degrees a step.
pub(super) const USUAL: Fineness = Fineness {
    steps_per_turn: 36.0,
    length: 8.0,
    near: 0.25,
    far_filaments: 9,
    far_stride: 2,
    core_widths: 0.23,
    settling: 40.0,
};

/// Power and thrust of three rotors without tilt, precone and prebend.
pub(super) fn rows() -> Vec<Row> {
    let trials = ROTORS
        .into_iter()
        .flat_map(|(name, speeds)| speeds.iter().map(move |&speed| (name, speed)));
    trials.flat_map(|(name, wind_speed)| compare(name, wind_speed)).collect()
}

fn compare(name: &str, wind_speed: f64) -> Vec<Row> {
    let model = flat(name);
    let (found, _) = turned(&model, wind_speed, USUAL, &[]);
    let [with_swirl, without] = [Swirl::Felt, Swirl::LeftOut].map(|swirl| {
        let ratio = model.rotor_speed(wind_speed) * model.definition.rotor_radius() / wind_speed;
        let pitch = model.constants.fine_pitch;
        axisymmetric::coefficients(&model.definition, ratio, pitch, duct(), swirl)
    });
    let momentum = momentum(&model, wind_speed);
    let references = [
        ("blade elements in axisymmetric flow with swirl", with_swirl, TOGETHER),
        ("blade elements in axisymmetric flow without swirl", without, TOGETHER),
        ("blade-element momentum", momentum, MOMENTUM),
    ];
    let Coefficients { power, thrust, .. } = found.coefficients;
    tell!("{name}, {wind_speed} m/s: power {power:.4}, thrust {thrust:.4}");
    let mut rows = Vec::new();
    for (source, theory, tolerance) in references {
        tell!("{source}: power {:.4}, thrust {:.4}", theory.power, theory.thrust);
        let values = [("power", power, theory.power), ("thrust", thrust, theory.thrust)];
        rows.extend(values.map(|(what, measured, expected)| Row {
            what: format!(
                "{name} flat, {wind_speed} m/s, best tip-speed ratio, 36 steps a turn, wake of 8 D: {what} over that of {source}"
            ),
            measured: measured / expected,
            expected: 1.0,
            tolerance: Within(tolerance),
            unit: "–",
            source,
        }));
    }
    rows
}

/// The duct that rotors are compared in.
pub(super) fn duct() -> Flow {
    let [upstream, downstream, wall] = DUCT;
    Flow::new(upstream, downstream, wall)
}

/// What blade-element momentum says of `model` at its best tip-speed ratio and least pitch.
fn momentum(model: &TurbineModel, wind_speed: f64) -> Coefficients {
    let ratio = model.rotor_speed(wind_speed) * model.definition.rotor_radius() / wind_speed;
    let rotor = SteadyRotor::new(&model.definition, Theory::default());
    rotor.along_shaft().coefficients(ratio, model.constants.fine_pitch)
}

/// `model` turned until its wake stands, with the wind at `distances` (diameters) behind it, and that wake.
pub(super) fn turned(
    model: &TurbineModel,
    wind_speed: f64,
    fineness: Fineness,
    distances: &[f64],
) -> (Steady, FreeWake) {
    let interval = TAU / model.rotor_speed(wind_speed) / fineness.steps_per_turn;
    let mut wake = wake(model, wind_speed, interval, fineness);
    let trial = Trial {
        wind_speed,
        interval,
        settling: fineness.settling * model.definition.rotor_diameter() / wind_speed,
        distances,
    };
    let induction = Induction::ByBoundVortices { dynamic_stall: false, tower: None };
    let found = turn(model, &mut wake, induction, &trial);
    (found, wake)
}

pub(super) fn wake(
    model: &TurbineModel,
    wind_speed: f64,
    interval: f64,
    fineness: Fineness,
) -> FreeWake {
    let definition = &model.definition;
    let diameter = definition.rotor_diameter();
    let rows = |diameters: f64, share: f64| {
        (diameters * diameter / (share * wind_speed * interval)).ceil() as usize
    };
    let far_rows = rows(fineness.length, 0.25) / fineness.far_stride;
    let settings = WakeSettings {
        interval,
        resolution: Resolution {
            near_rows: rows(fineness.near, 0.65),
            far_stride: fineness.far_stride,
            far_filaments: fineness.far_filaments,
            length: fineness.length * diameter,
            end: f64::INFINITY,
            far_rows,
        },
        cores: Cores {
            initial_widths: fineness.core_widths,
            kinematic_viscosity: 1.5e-5,
            eddy_constant: 1e-4,
            strain: false,
        },
        bodies: BodyWakes::NONE,
        air_density: AIR_DENSITY,
        accuracy: Accuracy::USUAL,
        shear: MeanShear::Carries,
        ground: false,
        shown: Points::NONE,
        n_blades: definition.n_blades,
        far_rows_in_all: definition.n_blades * far_rows,
        n_elements: N_ELEMENTS,
        threads: None,
    };
    let profile = MeanProfile::Uniform { speed: wind_speed };
    let wind = PrescribedWind::everywhere(Arc::new(profile));
    FreeWake::new(settings, wind).expect("such a wake can be")
}
