//! A stiff rotor at held speed in steady uniform wind, in any air: its power and thrust.

use basis::{Commands, PerBlade, Vector3};
use farm::assemble::TurbineModel;
use flow::FlowSolver;
use std::f64::consts::TAU;
use std::sync::Arc;
use turbine::steady::Coefficients;
use turbine::{Induction, Turbine, TurbineSettings};

pub(super) const AIR_DENSITY: f64 = 1.225;

/// How long a rotor turns.
pub(super) struct Trial {
    pub(super) wind_speed: f64,
    pub(super) interval: f64,
    /// Time before the means begin (s); they last a turn.
    pub(super) settling: f64,
}

/// The library's turbine `name` without tilt, precone and prebend: what the theories are about.
pub(super) fn flat(name: &str) -> TurbineModel {
    let file = formats::library::load(name).expect("the library's own turbines are readable");
    let mut definition = file.definition;
    definition.rotor.precone = 0.0;
    definition.rotor.shaft_tilt = 0.0;
    definition.blade.iter_mut().for_each(|station| station.prebend = 0.0);
    TurbineModel { definition: Arc::new(definition), constants: file.controller }
}

/// Means over the last turn of `model` at its best tip-speed ratio and least pitch, its foot at the origin,
/// in `air`.
pub(super) fn turn(
    model: &TurbineModel,
    air: &mut impl FlowSolver,
    induction: Induction,
    trial: &Trial,
) -> Coefficients {
    let Trial { wind_speed, interval, settling } = *trial;
    let definition = &model.definition;
    let rotor_speed = model.rotor_speed(wind_speed);
    let pitch = model.constants.fine_pitch;
    let settings = TurbineSettings {
        induction,
        flexible: false,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed,
        azimuth: 0.0,
        pitch,
    };
    let rotor = Turbine::new(Arc::clone(definition), Vector3::ZERO, settings);
    let mut rotor =
        rotor.expect("the library's own turbines stand").without_bodies().at_held_speed();
    let commands = Commands {
        pitch: PerBlade::splat(definition.n_blades, pitch),
        generator_torque: 0.0,
        yaw_rate: 0.0,
    };
    let n_settling = (settling / interval).ceil() as usize;
    let n_mean = (TAU / rotor_speed / interval).round() as usize;
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let (mut power, mut thrust) = (0.0, 0.0);
    for step in 0..n_settling + n_mean {
        air.sample(rotor.stations(), &mut winds);
        rotor.advance_answered(interval, &winds, air.answer(0), &commands);
        air.advance(interval, rotor.forces()).expect("a wake in steady wind stays finite");
        if step >= n_settling {
            let read = rotor.truth((step + 1) as f64 * interval, interval);
            power += read.aerodynamic_torque * read.rotor_speed / n_mean as f64;
            thrust += read.thrust / n_mean as f64;
        }
        if step % (n_settling / 8) == 0 {
            let read = rotor.truth((step + 1) as f64 * interval, interval);
            tell!("step {step} of {n_settling}: thrust {:.2} kN", 1e-3 * read.thrust);
        }
    }
    let force = 0.5 * AIR_DENSITY * definition.rotor_area() * wind_speed * wind_speed;
    let torque = power / rotor_speed / (force * definition.rotor_radius());
    Coefficients { power: power / (force * wind_speed), thrust: thrust / force, torque }
}
