//! A stiff rotor at held speed in steady uniform wind, in any air: what it feels and what it leaves.

use basis::{Commands, PerBlade, PointForce, Vector3};
use farm::assemble::TurbineModel;
use flow::{FlowSolver, WindField};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use turbine::steady::Coefficients;
use turbine::{Induction, Turbine, TurbineSettings};

pub(super) const AIR_DENSITY: f64 = 1.225;
/// Rings on which the wake is looked at, their places around, and the radius of the last one (radii).
const N_RINGS: usize = 36;
const N_AROUND: usize = 24;
const REACH: f64 = 1.5;
/// Steps from one look at the wake to the next (–).
const STRIDE: usize = 4;

/// How long a rotor turns and where its wake is looked at.
pub(super) struct Trial<'a> {
    pub(super) wind_speed: f64,
    pub(super) interval: f64,
    /// Time before the means begin (s); they last a turn.
    pub(super) settling: f64,
    /// Distances behind the rotor (diameters).
    pub(super) distances: &'a [f64],
}

/// Means over the last turn.
pub(super) struct Steady {
    pub(super) coefficients: Coefficients,
    /// Along the blade: radius over the rotor's, force along the wind and around the shaft (N/m).
    pub(super) loading: Vec<[f64; 3]>,
    /// At each distance: radius over the rotor's, and mean streamwise wind over the free stream.
    pub(super) wakes: Vec<Vec<[f64; 2]>>,
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

/// `model` on its `foot`, stiff and without bodies, at its best tip-speed ratio in `wind_speed` (m/s) and
/// least pitch, and what it is told to keep both.
pub(super) fn at_held_speed(
    model: &TurbineModel,
    wind_speed: f64,
    foot: Vector3,
    induction: Induction,
) -> (Turbine, Commands) {
    let pitch = model.constants.fine_pitch;
    let settings = TurbineSettings {
        induction,
        flexible: false,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed: model.rotor_speed(wind_speed),
        azimuth: 0.0,
        pitch,
    };
    let rotor = Turbine::new(Arc::clone(&model.definition), foot, settings);
    let commands = Commands {
        pitch: PerBlade::splat(model.definition.n_blades, pitch),
        generator_torque: 0.0,
        yaw_rate: 0.0,
    };
    let rotor = rotor.expect("the library's own turbines stand");
    (rotor.without_bodies().at_held_speed(), commands)
}

/// Turns `model` at its best tip-speed ratio and least pitch, its foot at the origin, in `air`.
pub(super) fn turn(
    model: &TurbineModel,
    air: &mut impl FlowSolver,
    induction: Induction,
    trial: &Trial,
) -> Steady {
    let Trial { wind_speed, interval, settling, distances } = *trial;
    let definition = &model.definition;
    let rotor_speed = model.rotor_speed(wind_speed);
    let (mut rotor, commands) = at_held_speed(model, wind_speed, Vector3::ZERO, induction);
    let n_settling = (settling / interval).ceil() as usize;
    let n_mean = (TAU / rotor_speed / interval).round() as usize;
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let mut means = Means::new(model, distances);
    let (mut power, mut thrust) = (0.0, 0.0);
    for step in 0..n_settling + n_mean {
        air.sample(rotor.stations(), &mut winds);
        rotor.advance_answered(interval, &winds, air.answer(0), &commands);
        air.advance(interval, rotor.forces()).expect("a wake in steady wind stays finite");
        if step >= n_settling {
            let read = rotor.truth((step + 1) as f64 * interval, interval);
            power += read.aerodynamic_torque * read.rotor_speed / n_mean as f64;
            thrust += read.thrust / n_mean as f64;
            means.add(rotor.forces(), air, step);
        }
        if step % (n_settling / 8) == 0 {
            let read = rotor.truth((step + 1) as f64 * interval, interval);
            tell!("step {step} of {n_settling}: thrust {:.2} kN", 1e-3 * read.thrust);
        }
    }
    let force = 0.5 * AIR_DENSITY * definition.rotor_area() * wind_speed * wind_speed;
    let torque = power / rotor_speed / (force * definition.rotor_radius());
    let coefficients =
        Coefficients { power: power / (force * wind_speed), thrust: thrust / force, torque };
    Steady { coefficients, loading: means.loading(), wakes: means.wakes(wind_speed) }
}

/// Sums of what is looked at.
struct Means {
    hub: Vector3,
    radius: f64,
    /// Radius (m), forces (N), width (m) of every element of a blade.
    elements: Vec<[f64; 4]>,
    n_blades: usize,
    n_loads: usize,
    /// Places in the wake, distance by distance, ring by ring.
    places: Vec<Vector3>,
    winds: Vec<Vector3>,
    sums: Vec<f64>,
    n_winds: usize,
}

impl Means {
    fn new(model: &TurbineModel, distances: &[f64]) -> Self {
        let (radius, hub) = (model.definition.rotor_radius(), model.definition.rotor.hub_height);
        let hub = Vector3::Z * hub;
        let places = distances.iter().flat_map(|distance| {
            (0..N_RINGS * N_AROUND).map(move |index| {
                let from_axis = ring(index / N_AROUND) * radius;
                let (sine, cosine) = (TAU * (index % N_AROUND) as f64 / N_AROUND as f64).sin_cos();
                hub + Vector3::new(2.0 * distance * radius, from_axis * sine, from_axis * cosine)
            })
        });
        let places: Vec<Vector3> = places.collect();
        Self {
            hub,
            radius,
            elements: Vec::new(),
            n_blades: model.definition.n_blades,
            n_loads: 0,
            winds: vec![Vector3::ZERO; places.len()],
            sums: vec![0.0; places.len() / N_AROUND],
            places,
            n_winds: 0,
        }
    }

    fn add(&mut self, forces: &[PointForce], air: &impl WindField, step: usize) {
        self.n_loads += 1;
        for (force, bound) in forces.iter().filter_map(|force| Some((force, force.bound?))) {
            self.elements.resize(self.elements.len().max(bound.station + 1), [0.0; 4]);
            let from_hub = force.position - self.hub;
            let radial = Vector3::new(0.0, from_hub.y, from_hub.z);
            // Clockwise seen from upwind.
            let around = Vector3::X.cross(radial.normalize());
            let sums = &mut self.elements[bound.station];
            let share = 1.0 / self.n_blades as f64;
            sums[0] += share * radial.length();
            sums[1] -= share * force.force.x;
            sums[2] -= share * force.force.dot(around);
            sums[3] += share * bound.along.length();
        }
        if step.is_multiple_of(STRIDE) {
            self.n_winds += 1;
            air.sample(&self.places, &mut self.winds);
            for (sum, winds) in self.sums.iter_mut().zip(self.winds.chunks(N_AROUND)) {
                *sum += winds.iter().map(|wind| wind.x).sum::<f64>() / N_AROUND as f64;
            }
        }
    }

    fn loading(&self) -> Vec<[f64; 3]> {
        let n = self.n_loads as f64;
        let of = |[radius, along, around, width]: &[f64; 4]| {
            [radius / n / self.radius, along / width, around / width]
        };
        self.elements.iter().map(of).collect()
    }

    fn wakes(&self, wind_speed: f64) -> Vec<Vec<[f64; 2]>> {
        let scale = 1.0 / (wind_speed * self.n_winds.max(1) as f64);
        let wake = |sums: &[f64]| {
            sums.iter().enumerate().map(|(index, sum)| [ring(index), scale * sum]).collect()
        };
        self.sums.chunks(N_RINGS).map(wake).collect()
    }
}

/// Radius of ring number `index` over the rotor's.
fn ring(index: usize) -> f64 {
    (index as f64 + 0.5) / N_RINGS as f64 * REACH
}

/// Mean of the wind on `wake` over the rotor's disc (free streams).
pub(super) fn over_disc(wake: &[[f64; 2]]) -> f64 {
    let disc = || wake.iter().filter(|[radius, _]| *radius < 1.0);
    disc().map(|[radius, wind]| radius * wind).sum::<f64>()
        / disc().map(|[radius, _]| radius).sum::<f64>()
}

/// Root of the mean square difference of two wakes over all rings, each weighted with its area (free
/// streams).
pub(super) fn difference(wake: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for ([radius, wind], [_, theirs]) in wake.iter().zip(other) {
        sum += radius * (wind - theirs).powi(2);
        area += radius;
    }
    (sum / area).sqrt()
}

/// Area of the disc of `diameter`, of a box `width` across, its share (–).
pub(super) fn blockage(diameter: f64, width: f64) -> f64 {
    PI / 4.0 * (diameter / width).powi(2)
}
