//! The flexible IEA 15 MW turbine in wind in closed form, under its own control with something added to its
//! pitch.

use basis::mbc::to_fixed_frame;
use basis::{FixedFrame, Measurements, PerBlade, Vector3};
use control::{Baseline, Controller};
use farm::tracking::coefficient_table;
use flow::Inflow;
use flow::inflow::DeterministicWind;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::TwoConstant;
use turbine::aero::{self, rotor};
use turbine::{Induction, Turbine};

/// Step of everything, control included (s).
pub(super) const INTERVAL: f64 = 0.02;
/// Density of the air (kg/m³).
const AIR_DENSITY: f64 = 1.225;
/// Slow time constant of the induction (s), of the turbine near rated speed.
const SLOW_CONSTANT: f64 = 29.03;

/// The moments of the source's table 4-3, by OpenFAST's names, and the exponents of their fatigue (–).
pub(super) const MOMENTS: [(&str, &str, f64); 7] = [
    ("blade root, edgewise", "RootMxb1", 10.0),
    ("blade root, flapwise", "RootMyb1", 10.0),
    ("tower top, fore-aft", "YawBrMyp", 4.0),
    ("tower top, side-side", "YawBrMxp", 4.0),
    ("tower top, torsion", "YawBrMzp", 4.0),
    ("tower base, fore-aft", "TwrBsMyt", 4.0),
    ("tower base, side-side", "TwrBsMxt", 4.0),
];

/// A turbine that can be run again and again from the same beginning.
#[derive(Clone)]
pub(super) struct Rig {
    turbine: Turbine,
    baseline: Baseline,
    wind: Arc<DeterministicWind>,
    winds: Vec<Vector3>,
    channels: Vec<f64>,
    places: [usize; 7],
    step: usize,
}

/// What one step gives.
pub(super) struct Reading {
    /// Time (s).
    pub(super) time: f64,
    /// Tilt and yaw moments of the blades (N m).
    pub(super) loads: FixedFrame,
    /// Tilt and yaw of the pitch that the actuators have reached (rad).
    pub(super) pitch: FixedFrame,
    /// Electrical power (W).
    pub(super) power: f64,
    /// [`MOMENTS`] (N m).
    pub(super) moments: [f64; 7],
}

impl Rig {
    /// The turbine in `wind` that starts at `rotor_speed` (rad/s).
    pub(super) fn new(wind: DeterministicWind, rotor_speed: f64) -> Self {
        let file = formats::library::load("iea-15mw").expect("the library's turbines are readable");
        let table = coefficient_table(&file.definition);
        let inertia = file.definition.drive_train_inertia();
        let constants = file.controller.with_estimator(inertia, AIR_DENSITY, table);
        let settings = turbine::TurbineSettings {
            induction: Induction::ByMomentum(rotor::BemSettings {
                induction: aero::Induction::TwoConstant(TwoConstant::fixed(SLOW_CONSTANT)),
                theory: Theory::default(),
                skewed_wake: true,
                dynamic_stall: true,
                tower: None,
            }),
            flexible: true,
            air_density: AIR_DENSITY,
            yaw: 0.0,
            rotor_speed,
            azimuth: 0.0,
            pitch: 0.0,
        };
        let turbine = Turbine::new(Arc::new(file.definition), Vector3::ZERO, settings)
            .expect("the library's turbines have a structure")
            .without_bodies();
        let places = MOMENTS
            .map(|(_, name, _)| turbine.structure().channel(name).expect("a channel's name"));
        Self {
            baseline: Baseline::new(constants),
            wind: Arc::new(wind),
            winds: vec![Vector3::ZERO; turbine.stations().len()],
            channels: vec![0.0; turbine.channels().len()],
            places,
            step: 0,
            turbine,
        }
    }

    /// One step; `add` adds to the pitch (rad) that the turbine's own control asks for.
    pub(super) fn advance(
        &mut self,
        add: impl FnOnce(&mut PerBlade<f64>, &Measurements),
    ) -> Reading {
        let time = self.step as f64 * INTERVAL;
        let measurements = self.turbine.truth(time, INTERVAL).measured();
        let mut commands = self.baseline.update(&measurements);
        add(&mut commands.pitch, &measurements);
        self.wind.sample(time, self.turbine.stations(), &mut self.winds);
        self.turbine.advance(INTERVAL, &self.winds, &commands);
        self.turbine.write_channels(&mut self.channels);
        self.step += 1;
        Reading {
            time,
            loads: to_fixed_frame(measurements.azimuth, &measurements.flap_moments),
            pitch: to_fixed_frame(measurements.azimuth, &measurements.pitch),
            power: measurements.power,
            moments: self.places.map(|place| self.channels[place]),
        }
    }
}
