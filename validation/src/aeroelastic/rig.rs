//! One turbine in prescribed wind, run and read as the reference was.

use basis::Vector3;
use control::{Baseline, Excitation, Helix, Sense};
use farm::assemble::TurbineModel;
use farm::case::Solver;
use farm::farm::Recorder;
use farm::{Air, Farm, Machine};
use flow::inflow::planes::BoxPlanes;
use flow::inflow::prescribed::Placement;
use flow::inflow::{MeanProfile, PrescribedWind};
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::TwoConstant;
use turbine::aero::tower_influence::Effects;
use turbine::aero::{self, TowerInfluence};
use turbine::structure::Projection;
use turbine::{Induction, Turbine};

/// Step (s).
pub(super) const INTERVAL: f64 = 0.02;
/// Density of the air in the reference (kg/m³).
const AIR_DENSITY: f64 = 1.225;
/// Least and greatest x (m) of the planes that are held: the rotor's, with room for prebend, deflection and
/// tilt.
const EXTENT: [f64; 2] = [-80.0, 80.0];

/// Channels that are looked at.
pub(super) const CHANNELS: [&str; 7] =
    ["RootMyc1", "TwrBsMyt", "YawBrMyp", "YawBrMzp", "LSSTipMys", "OoPDefl1", "RootMxc1"];

/// What a run gives over its window.
pub(super) struct Run {
    /// Mean power (MW) and thrust (MN) of the air.
    pub(super) power: f64,
    pub(super) thrust: f64,
    /// Mean generator power (MW).
    pub(super) generator_power: f64,
    /// Mean rotor speed (rpm).
    pub(super) rotor_speed: f64,
    /// Time between samples (s).
    interval: f64,
    /// Azimuth of blade 1 (rad) at each sample.
    pub(super) azimuth: Vec<f64>,
    /// Samples of each of [`CHANNELS`], in MN m or m.
    pub(super) samples: [Vec<f64>; CHANNELS.len()],
}

impl Run {
    /// Mean of a channel, in its unit.
    pub(super) fn mean(&self, channel: usize) -> f64 {
        self.samples[channel].iter().sum::<f64>() / self.samples[channel].len() as f64
    }

    /// Standard deviation of a channel, in its unit.
    pub(super) fn deviation(&self, channel: usize) -> f64 {
        let mean = self.mean(channel);
        let samples = &self.samples[channel];
        (samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / samples.len() as f64).sqrt()
    }

    /// 1-Hz damage-equivalent load of a channel for `slope` (–), in its unit.
    pub(super) fn equivalent(&self, channel: usize, slope: f64) -> f64 {
        analysis::fatigue::damage_equivalent_load(&self.samples[channel], self.interval, slope, 1.0)
            .expect("loads are finite and the record is long")
    }
}

struct Silent;

impl Recorder for Silent {
    fn record(&mut self, _: usize, _: &basis::Truth, _: &basis::Commands) {}
}

/// What becomes of the rotor's speed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Speed {
    Held,
    /// Torque control k ω².
    Square,
    /// Torque control that tracks the tip-speed ratio on an estimated wind, as prescribed wind has it by
    /// default.
    Tracked,
}

/// How a turbine is run.
pub(super) struct Conditions<'a> {
    pub(super) model: &'a str,
    /// Wind at hub height (m/s), uniform and steady but for `planes`.
    pub(super) wind: f64,
    /// Planes of turbulence that blow instead of it.
    pub(super) planes: Option<BoxPlanes>,
    /// What the blades feel of the tower.
    pub(super) tower: Option<Effects>,
    /// Slow time constant of dynamic inflow (s).
    pub(super) slow_constant: f64,
    /// Rotor speed at the beginning (rpm).
    pub(super) rotor_speed: f64,
    pub(super) speed: Speed,
    /// Helix, degrees.
    pub(super) amplitude: f64,
    /// How the blades' sections are seen.
    pub(super) projection: Projection,
    /// From and to (s).
    pub(super) window: [f64; 2],
    /// Steps of [`INTERVAL`] from sample to sample (–).
    pub(super) steps_per_sample: u64,
}

impl Conditions<'_> {
    /// IEA 15 MW in 9 m/s without helix and tower, its speed held at the reference's and every step of the
    /// last 100 s read.
    pub(super) fn in_nine_metres_a_second() -> Self {
        Self {
            model: "iea-15mw",
            wind: 9.0,
            planes: None,
            tower: None,
            slow_constant: 29.03,
            rotor_speed: 6.44866,
            speed: Speed::Held,
            amplitude: 0.0,
            projection: Projection::Swept,
            window: [500.0, 600.0],
            steps_per_sample: 1,
        }
    }
}

/// Runs the turbine.
///
/// # Panics
/// For a model that the library does not have, which is the validation's own mistake.
pub(super) fn run(conditions: &Conditions<'_>) -> Run {
    let mut farm = Farm::new(vec![machine(conditions)], air(conditions), INTERVAL, 1)
        .expect("one turbine needs no threads");
    let turbine = &farm.machines()[0].turbine;
    let places = CHANNELS.map(|name| turbine.structure().channel(name).expect("a known channel"));
    let mut values = vec![0.0; turbine.channels().len()];
    let mut result = Run {
        power: 0.0,
        thrust: 0.0,
        generator_power: 0.0,
        rotor_speed: 0.0,
        interval: INTERVAL * conditions.steps_per_sample as f64,
        azimuth: Vec::new(),
        samples: Default::default(),
    };
    while farm.time() < conditions.window[1] {
        farm.advance(&mut Silent).expect("the wind does not end");
        if farm.time() > conditions.window[0]
            && farm.step().is_multiple_of(conditions.steps_per_sample)
        {
            let turbine = &farm.machines()[0].turbine;
            let read = turbine.truth(farm.time(), INTERVAL);
            result.power += 1e-6 * read.aerodynamic_torque * read.rotor_speed;
            result.thrust += 1e-6 * read.thrust;
            result.generator_power += 1e-6 * read.power;
            result.rotor_speed += read.rotor_speed * 30.0 / std::f64::consts::PI;
            result.azimuth.push(read.azimuth);
            turbine.write_channels(&mut values);
            for ((samples, place), name) in result.samples.iter_mut().zip(places).zip(CHANNELS) {
                samples.push(if name.contains('M') { 1e-6 } else { 1.0 } * values[place]);
            }
        }
    }
    let n = result.samples[0].len() as f64;
    for sum in [
        &mut result.power,
        &mut result.thrust,
        &mut result.generator_power,
        &mut result.rotor_speed,
    ] {
        *sum /= n;
    }
    result
}

/// The turbine with its controller.
fn machine(conditions: &Conditions<'_>) -> Machine {
    let file =
        formats::library::load(conditions.model).expect("the library's own turbines are readable");
    let definition = Arc::new(file.definition);
    let mut model =
        TurbineModel { definition: Arc::clone(&definition), constants: file.controller };
    if conditions.speed == Speed::Tracked {
        model = model.equipped(Solver::UNIFORM, AIR_DENSITY).into_owned();
    }
    let diameter = definition.rotor_diameter();
    let tower =
        conditions.tower.map(|effects| TowerInfluence::new(&definition, Vector3::ZERO, effects));
    let settings = turbine::TurbineSettings {
        induction: Induction::ByMomentum(aero::rotor::BemSettings {
            induction: aero::Induction::TwoConstant(TwoConstant::fixed(conditions.slow_constant)),
            theory: Theory::default(),
            skewed_wake: true,
            dynamic_stall: true,
            tower,
        }),
        flexible: true,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed: conditions.rotor_speed * std::f64::consts::PI / 30.0,
        azimuth: 0.0,
        pitch: 0.0,
    };
    let mut turbine = Turbine::new(definition, Vector3::ZERO, settings)
        .expect("the library's own turbines have a structure")
        .without_bodies()
        .projecting(conditions.projection);
    if conditions.speed == Speed::Held {
        turbine = turbine.at_held_speed();
    }
    let baseline = Box::new(Baseline::new(model.constants));
    if conditions.amplitude == 0.0 {
        return Machine::new(turbine, baseline);
    }
    let (amplitude, sense) = (conditions.amplitude.to_radians(), Sense::CounterClockwise);
    let helix = Helix::new(sense, amplitude, 0.25, conditions.wind, diameter);
    Machine::new(turbine, helix.on_top_of(baseline))
}

/// What blows.
fn air(conditions: &Conditions<'_>) -> Air {
    let wind = match &conditions.planes {
        None => {
            PrescribedWind::everywhere(Arc::new(MeanProfile::Uniform { speed: conditions.wind }))
        }
        Some(planes) => {
            let placement = Placement { origin_x: 0.0, shift_y: 0.0, extent: EXTENT };
            PrescribedWind::over_planes(Box::new(planes.clone()), placement)
                .expect("a box in memory has its planes")
        }
    };
    Box::new(wind)
}
