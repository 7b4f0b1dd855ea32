//! One turbine in the air: handed wind at its stations and commands, it turns, pitches and pushes on the air.

use crate::actuator_line::{ActuatorLine, Load, Onset, Scratch};
use crate::actuators::PitchState;
use crate::bodies::{self, Body};
use crate::definition::Definition;
use crate::drivetrain::{Drivetrain, RotorState};
use crate::rotor::Frame;
use basis::mbc::blade_azimuth;
use basis::{Commands, Measurements, PerBlade, PointForce, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Elements, and so point forces, of each blade.
pub const N_ELEMENTS: usize = 32;

/// How a turbine stands in the air when time begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Gaussian width of its forces (m).
    pub smearing_length: f64,
    /// Distance of the points between which the flow interpolates the wind (m); 0 where it does not.
    pub sample_spacing: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Azimuth of blade 1 (rad).
    pub azimuth: f64,
    /// Pitch of all blades (rad).
    pub pitch: f64,
}

/// A turbine: definition and what follows from it, state, and working memory.
#[derive(Clone, Debug)]
pub struct Turbine {
    definition: Arc<Definition>,
    line: ActuatorLine,
    bodies: Vec<Body>,
    drivetrain: Drivetrain,
    frame: Frame,
    air_density: f64,
    smearing_length: f64,
    state: State,
    workspace: Workspace,
}

/// Everything of a turbine that time changes; restoring it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    rotor: RotorState,
    pitch: PerBlade<PitchState>,
    /// Axial and tangential velocity hidden by smearing (m/s), blade after blade.
    missing: Vec<[f64; 2]>,
    readings: Readings,
    n_instants: u64,
    n_limited: u64,
}

/// What the instruments read over the last interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Readings {
    generator_torque: f64,
    thrust: f64,
    aerodynamic_torque: f64,
    rotor_wind_speed: f64,
    flap_moments: PerBlade<f64>,
}

impl State {
    /// Velocity that smearing hides from each blade element, axial and along the rotation (m/s), blade after blade.
    pub fn missing(&self) -> &[[f64; 2]] {
        &self.missing
    }
}

#[derive(Clone, Debug)]
struct Workspace {
    stations: Vec<Vector3>,
    onsets: Vec<Onset>,
    loads: Vec<Load>,
    scratch: Scratch,
    forces: Vec<PointForce>,
}

impl Turbine {
    /// A turbine of `definition` with the foot of its tower at `position` (m), facing the wind.
    pub fn new(definition: Arc<Definition>, position: Vector3, settings: Settings) -> Self {
        let geometry = definition.rotor;
        let smearing_length = settings.smearing_length;
        let line = ActuatorLine::new(
            Arc::clone(&definition),
            N_ELEMENTS,
            settings.air_density,
            smearing_length,
            settings.sample_spacing,
        );
        let shaft = Frame::new(Vector3::ZERO, geometry.shaft_tilt).shaft;
        // The overhang runs along the shaft; the hub height is the apex's own.
        let apex = position + Vector3::new(-geometry.overhang * shaft.x, 0.0, geometry.hub_height);
        let frame = Frame::new(apex, geometry.shaft_tilt);
        let bodies = bodies::of(&definition, position, &frame, smearing_length);
        let n_blades = definition.n_blades;
        let n = n_blades * N_ELEMENTS;
        let pitch = PitchState { pitch: settings.pitch, rate: 0.0 };
        let state = State {
            rotor: RotorState {
                azimuth: basis::angle::wrap_to_turn(settings.azimuth),
                speed: settings.rotor_speed,
            },
            pitch: PerBlade::splat(n_blades, pitch),
            missing: vec![[0.0; 2]; n],
            readings: Readings {
                generator_torque: 0.0,
                thrust: 0.0,
                aerodynamic_torque: 0.0,
                rotor_wind_speed: 0.0,
                flap_moments: PerBlade::splat(n_blades, 0.0),
            },
            n_instants: 0,
            n_limited: 0,
        };
        let workspace = Workspace {
            stations: vec![Vector3::ZERO; n + bodies.len()],
            onsets: vec![Onset::default(); n],
            loads: vec![Load::default(); n],
            scratch: Scratch::new(n_blades, N_ELEMENTS),
            forces: Vec::with_capacity(n + bodies.len()),
        };
        let drivetrain = Drivetrain {
            inertia: definition.drive_train_inertia(),
            efficiency: definition.efficiency(),
        };
        let air_density = settings.air_density;
        let mut turbine = Self {
            definition,
            line,
            bodies,
            drivetrain,
            frame,
            air_density,
            smearing_length,
            state,
            workspace,
        };
        turbine.place_stations();
        turbine
    }

    /// The same turbine without tower and nacelle: the rotor alone, as blade-element momentum sees it.
    pub fn without_bodies(mut self) -> Self {
        self.bodies.clear();
        self.place_stations();
        self
    }

    /// The same turbine on a test rig that holds its rotor speed whatever the torques.
    pub fn at_held_speed(mut self) -> Self {
        self.drivetrain.inertia = f64::INFINITY;
        self
    }

    /// Points where the turbine wants to know the wind, farm frame (m): blade elements, then bodies.
    pub fn stations(&self) -> &[Vector3] {
        &self.workspace.stations
    }

    /// Moves the turbine on by `interval` (s) under `commands`, held meanwhile.
    ///
    /// `winds` (m/s) holds the wind at each of [`Turbine::stations`] now, the rotor's induction included as far as the
    /// flow resolves it. On return [`Turbine::forces`] holds the forces that act on the air throughout the interval.
    pub fn advance(&mut self, interval: f64, winds: &[Vector3], commands: &Commands) {
        self.advance_pitch(interval, commands);
        self.meet(winds);
        let pitch = self.state.pitch.map(|actuator| actuator.pitch);
        let Workspace { onsets, loads, scratch, .. } = &mut self.workspace;
        let rotor = self.state.rotor;
        self.line.loads(onsets, rotor.speed, &pitch, &mut self.state.missing, loads, scratch);
        let readings = self.read_loads(commands);
        let after = self.drivetrain.after(
            rotor,
            interval,
            readings.aerodynamic_torque,
            readings.generator_torque,
        );
        self.push(winds);
        self.state.readings = readings;
        self.state.rotor = after;
        self.place_stations();
    }

    /// Forces on the air over the last interval: blade elements, then bodies.
    pub fn forces(&self) -> &[PointForce] {
        &self.workspace.forces
    }

    /// What the instruments read now, at `time` (s), for a command that will hold for `interval` (s).
    ///
    /// Azimuth, speed and pitch are those of the instant; loads and power those of the interval before it.
    pub fn measurements(&self, time: f64, interval: f64) -> Measurements {
        let State { rotor, pitch, readings, .. } = &self.state;
        Measurements {
            time,
            interval,
            azimuth: rotor.azimuth,
            rotor_speed: rotor.speed,
            generator_speed: rotor.speed,
            pitch: pitch.map(|actuator| actuator.pitch),
            generator_torque: readings.generator_torque,
            power: self.drivetrain.power(rotor.speed, readings.generator_torque),
            thrust: readings.thrust,
            aerodynamic_torque: readings.aerodynamic_torque,
            rotor_wind_speed: readings.rotor_wind_speed,
            flap_moments: readings.flap_moments,
            edge_moments: pitch.map(|_| 0.0),
            tower_top_acceleration: 0.0,
        }
    }

    /// Instants so far, and those at which a pitch limit held a command back (–).
    pub fn limited_instants(&self) -> (u64, u64) {
        (self.state.n_instants, self.state.n_limited)
    }

    /// What the machine is.
    pub fn definition(&self) -> &Definition {
        &self.definition
    }

    /// Centre and attitude of the rotor.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The blades.
    pub fn line(&self) -> &ActuatorLine {
        &self.line
    }

    /// Loads of the blade elements over the last interval, blade after blade.
    pub fn loads(&self) -> &[Load] {
        &self.workspace.loads
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Continues from `state`, which a turbine of the same definition gave.
    pub fn restore(&mut self, state: State) {
        self.state = state;
        self.place_stations();
    }

    fn advance_pitch(&mut self, interval: f64, commands: &Commands) {
        let actuator = &self.definition.pitch_actuator;
        let mut limited = false;
        for (blade, command) in self.state.pitch.iter_mut().zip(commands.pitch.iter()) {
            limited |= actuator.advance(blade, interval, *command);
        }
        self.state.n_instants += 1;
        self.state.n_limited += u64::from(limited);
    }

    /// On return the workspace holds the `winds` in the frames of the blades that move through them.
    fn meet(&mut self, winds: &[Vector3]) {
        let elements = self.line.elements();
        let State { rotor, .. } = &self.state;
        for (index, (onset, wind)) in self.workspace.onsets.iter_mut().zip(winds).enumerate() {
            let (blade, element) = (index / elements.len(), &elements[index % elements.len()]);
            let azimuth = blade_azimuth(rotor.azimuth, blade, self.definition.n_blades);
            let axes = self.frame.blade(azimuth, element.cone);
            *onset = Onset {
                normal: wind.dot(axes.normal),
                tangential: rotor.speed * element.radius - wind.dot(axes.tangent),
            };
        }
    }

    fn read_loads(&self, commands: &Commands) -> Readings {
        let elements = self.line.elements();
        let hub_radius = self.definition.rotor.hub_radius;
        let (mut thrust, mut torque) = (0.0, 0.0);
        let mut flap_moments = PerBlade::splat(self.definition.n_blades, 0.0);
        for (index, load) in self.workspace.loads.iter().enumerate() {
            let (blade, element) = (index / elements.len(), &elements[index % elements.len()]);
            let normal = load.normal * element.width;
            thrust += normal * element.cone.cos();
            torque += load.tangential * element.width * element.radius;
            flap_moments[blade] += normal * (element.span - hub_radius);
        }
        Readings {
            generator_torque: commands.generator_torque,
            thrust,
            aerodynamic_torque: torque,
            rotor_wind_speed: self.line.mean_wind(&self.workspace.onsets),
            flap_moments,
        }
    }

    /// On return the workspace holds the forces on the air, where the winds were sampled: half the force of a step acts
    /// before the instant and half after it, so that a blade's bound vortex does not induce a velocity on itself.
    fn push(&mut self, winds: &[Vector3]) {
        let elements = self.line.elements();
        let Workspace { loads, forces, stations, .. } = &mut self.workspace;
        forces.clear();
        for (index, load) in loads.iter().enumerate() {
            let (blade, element) = (index / elements.len(), &elements[index % elements.len()]);
            let azimuth = blade_azimuth(self.state.rotor.azimuth, blade, self.definition.n_blades);
            let axes = self.frame.blade(azimuth, element.cone);
            let force = axes.normal * load.normal + axes.tangent * load.tangential;
            forces.push(PointForce {
                position: stations[index],
                force: force * -element.width,
                smearing_length: self.smearing_length,
            });
        }
        for (body, wind) in self.bodies.iter().zip(&winds[loads.len()..]) {
            forces.push(body.force(*wind, self.air_density, self.smearing_length));
        }
    }

    fn place_stations(&mut self) {
        let elements = self.line.elements();
        let stations = &mut self.workspace.stations;
        stations.clear();
        for blade in 0..self.definition.n_blades {
            let azimuth = blade_azimuth(self.state.rotor.azimuth, blade, self.definition.n_blades);
            let precone = self.definition.rotor.precone;
            stations.extend(elements.iter().map(|e| e.position(&self.frame, azimuth, precone)));
        }
        stations.extend(self.bodies.iter().map(|body| body.position));
    }
}

#[cfg(test)]
mod tests;
