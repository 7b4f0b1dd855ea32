//! One turbine in the air: handed wind at its stations and commands, it turns, pitches, bends and pushes on the air.

mod aerodynamics;
mod separation;

use crate::actuator_line::ActuatorLine;
use crate::actuators::PitchState;
use crate::aero::rotor;
use crate::bodies::{self, Body};
use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::{BladeFrame, Frame};
use crate::structure::{
    AppliedLoads, Channel, ElementLoad, Freedom, GRAVITY, Pitch, Projection, Structure,
    StructureError,
};
use aerodynamics::Aerodynamics;
use basis::{BoundVortex, Commands, PerBlade, PointForce, Truth, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Elements, and so point forces, of each blade.
pub const N_ELEMENTS: usize = 32;
/// Longest step of the structure (s): a sixtieth of the period of the fastest mode that carries load, the blades' second
/// flapwise one. Longer intervals are cut into equal steps, over which the wind at each element is held.
pub const LONGEST_STRUCTURAL_STEP: f64 = 0.025;

/// How a turbine stands in the air when time begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Who solves what the rotor does to the air.
    pub induction: Induction,
    /// Whether blades, tower and drive train bend; otherwise only the rotor turns.
    pub flexible: bool,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Azimuth of blade 1 (rad).
    pub azimuth: f64,
    /// Pitch of all blades (rad).
    pub pitch: f64,
}

/// Who solves what the rotor does to the air.
#[derive(Clone, Debug, PartialEq)]
pub enum Induction {
    /// The flow: winds that the turbine is handed contain it, and the flow feels the turbine's forces.
    ByFlow {
        /// Gaussian width of the forces (m).
        smearing_length: f64,
        /// Distance of the points between which the flow interpolates the wind (m); 0 where it does not.
        sample_spacing: f64,
        /// Whether flow about the sections separates with delay; otherwise their polars hold at once.
        dynamic_stall: bool,
    },
    /// The turbine itself, by momentum theory: winds are those without it.
    ByMomentum(rotor::Settings),
}

/// A turbine: definition and what follows from it, state, and working memory.
#[derive(Clone, Debug)]
pub struct Turbine {
    definition: Arc<Definition>,
    line: ActuatorLine,
    aerodynamics: Aerodynamics,
    structure: Structure,
    bodies: Vec<Body>,
    held: Vec<Freedom>,
    frame: Frame,
    air_density: f64,
    smearing_length: f64,
    state: State,
    workspace: Workspace,
}

/// Everything of a turbine that time changes; restoring it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    structure: crate::structure::State,
    pitch: PerBlade<PitchState>,
    aerodynamics: aerodynamics::State,
    readings: Readings,
    n_instants: u64,
    n_limited: u64,
}

/// What the instruments read over the last interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Readings {
    generator_torque: f64,
    thrust: f64,
    aerodynamic_torque: f64,
    rotor_wind_speed: f64,
}

impl State {
    /// Velocity that smearing hides from each blade element, axial and along the rotation (m/s), blade after blade; empty
    /// where momentum theory makes the induction.
    pub fn missing(&self) -> &[[f64; 2]] {
        match &self.aerodynamics {
            aerodynamics::State::Line(missing)
            | aerodynamics::State::SeparatingLine(missing, _) => missing,
            aerodynamics::State::Momentum(_) => &[],
        }
    }
}

#[derive(Clone, Debug)]
struct Workspace {
    stations: Vec<Vector3>,
    /// Directions at the blade elements where the winds are sampled.
    axes: Vec<BladeFrame>,
    motions: Vec<ElementMotion>,
    loads: Vec<ElementLoad>,
    /// Sums over the steps of an interval: force on each element along normal and tangent (N).
    sums: Vec<[f64; 2]>,
    /// Mean circulation of each element over the steps of an interval (m²/s).
    circulations: Vec<f64>,
    /// Forces on the tower's points (N).
    tower: Vec<Vector3>,
    forces: Vec<PointForce>,
}

impl Turbine {
    /// A turbine of `definition` with the foot of its tower at `position` (m), facing the wind, undeflected.
    ///
    /// # Errors
    /// [`StructureError`] when the definition's masses, stiffnesses or mode shapes do not make a structure.
    pub fn new(
        definition: Arc<Definition>,
        position: Vector3,
        settings: Settings,
    ) -> Result<Self, StructureError> {
        let (smearing_length, sample_spacing) = match settings.induction {
            Induction::ByFlow { smearing_length, sample_spacing, .. } => {
                (smearing_length, sample_spacing)
            }
            // Nothing is spread; the length only cuts the tower into segments.
            Induction::ByMomentum(_) => (0.1 * definition.rotor_radius(), 0.0),
        };
        let line = ActuatorLine::new(
            Arc::clone(&definition),
            N_ELEMENTS,
            settings.air_density,
            smearing_length,
            sample_spacing,
        );
        let geometry = definition.rotor;
        let shaft = Frame::new(Vector3::ZERO, geometry.shaft_tilt).shaft;
        // The overhang runs along the shaft; the hub height is the apex's own.
        let apex = position + Vector3::new(-geometry.overhang * shaft.x, 0.0, geometry.hub_height);
        let frame = Frame::new(apex, geometry.shaft_tilt);
        let mut bodies = bodies::of(&definition, position, &frame, smearing_length);
        if matches!(settings.induction, Induction::ByMomentum(_)) {
            bodies.iter_mut().for_each(Body::feel_free_wind);
        }
        let aerodynamics = Aerodynamics::new(&definition, &line, &settings);
        let spans: Vec<f64> = line.elements().iter().map(|element| element.span).collect();
        // The last body is the nacelle.
        let heights: Vec<f64> =
            bodies[..bodies.len() - 1].iter().map(|body| body.position.z - position.z).collect();
        let structure = Structure::new(
            &definition,
            &crate::structure::Settings {
                position,
                yaw: 0.0,
                gravity: GRAVITY,
                rotor_speed: settings.rotor_speed,
                azimuth: settings.azimuth,
                pitch: settings.pitch,
                spans: &spans,
                heights: &heights,
            },
        )?;
        let n_blades = definition.n_blades;
        let n = n_blades * N_ELEMENTS;
        let pitch = PitchState { pitch: settings.pitch, rate: 0.0 };
        let state = State {
            structure: structure.state().clone(),
            pitch: PerBlade::splat(n_blades, pitch),
            aerodynamics: aerodynamics.start(),
            readings: Readings::default(),
            n_instants: 0,
            n_limited: 0,
        };
        let still = ElementMotion {
            position: Vector3::ZERO,
            velocity: Vector3::ZERO,
            axes: frame.blade(0.0, 0.0),
            pitch: 0.0,
        };
        let workspace = Workspace {
            stations: Vec::with_capacity(n + bodies.len()),
            axes: vec![still.axes; n],
            motions: vec![still; n],
            loads: vec![ElementLoad::default(); n],
            sums: vec![[0.0; 2]; n],
            circulations: vec![0.0; n],
            tower: vec![Vector3::ZERO; heights.len()],
            forces: Vec::with_capacity(n + bodies.len()),
        };
        let held = if settings.flexible {
            Vec::new()
        } else {
            Freedom::ALL.into_iter().filter(|freedom| *freedom != Freedom::Generator).collect()
        };
        let mut turbine = Self {
            definition,
            line,
            aerodynamics,
            structure,
            bodies,
            held,
            frame,
            air_density: settings.air_density,
            smearing_length,
            state,
            workspace,
        };
        turbine.structure.hold(&turbine.held);
        turbine.frame = turbine.structure.frame(0.0);
        turbine.place_stations();
        Ok(turbine)
    }

    /// The same turbine without tower and nacelle in the wind: the rotor alone, as blade-element momentum sees it.
    pub fn without_bodies(mut self) -> Self {
        self.bodies.clear();
        self.workspace.tower.clear();
        self.place_stations();
        self
    }

    /// The same turbine on a test rig that holds its rotor speed whatever the torques.
    pub fn at_held_speed(mut self) -> Self {
        self.held.push(Freedom::Generator);
        self.structure.hold(&self.held);
        self
    }

    /// The same turbine, its blade elements seen as `projection` has them.
    pub fn projecting(mut self, projection: Projection) -> Self {
        self.structure.project(projection);
        self.place_stations();
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
        let n_steps = (interval / LONGEST_STRUCTURAL_STEP - 1e-9).ceil().max(1.0) as usize;
        let step = interval / n_steps as f64;
        // A generator holds the rotor back and never drives it backwards.
        let turning = self.structure.generator_speed() > 0.0;
        let generator_torque = if turning { commands.generator_torque } else { 0.0 };
        let (element_winds, body_winds) = winds.split_at(self.workspace.motions.len());
        let nacelle = self.hold_back(body_winds);
        self.workspace.sums.fill([0.0; 2]);
        self.workspace.circulations.fill(0.0);
        let mut readings = Readings {
            generator_torque,
            rotor_wind_speed: self.line.mean_axial(element_winds, self.frame.shaft),
            ..Readings::default()
        };
        let mut limited = false;
        for index in 0..n_steps {
            let pitch = self.pitch_blades(step, commands, &mut limited);
            let Workspace { motions, loads, sums, circulations, tower, .. } = &mut self.workspace;
            self.structure.observe(0.5 * step, &pitch, motions);
            let frame = self.structure.frame(0.5 * step);
            let now = aerodynamics::Instant {
                interval: step,
                first: index == 0,
                winds: element_winds,
                motions,
                pitch: &pitch,
                frame: &frame,
                rotor_speed: self.structure.rotor_speed(),
            };
            self.aerodynamics.loads(&self.line, &now, &mut self.state.aerodynamics, loads);
            self.aerodynamics.add_circulations(&self.line, 1.0 / n_steps as f64, circulations);
            for ((load, motion), sum) in loads.iter().zip(&*motions).zip(sums) {
                let share = 1.0 / n_steps as f64;
                sum[0] += share * load.force.dot(motion.axes.normal);
                sum[1] += share * load.force.dot(motion.axes.tangent);
                let arm = motion.position - frame.hub;
                readings.thrust += share * load.force.dot(frame.shaft);
                readings.aerodynamic_torque += share * arm.cross(load.force).dot(frame.shaft);
            }
            let applied = AppliedLoads { elements: loads, tower, nacelle, generator_torque };
            self.structure.advance(step, &applied, &pitch);
        }
        self.state.n_instants += 1;
        self.state.n_limited += u64::from(limited);
        self.state.readings = readings;
        self.state.structure.clone_from(self.structure.state());
        self.push();
        self.place_stations();
    }

    /// Forces on the air over the last interval: blade elements with their bound vortices, blade after blade from root to tip,
    /// then bodies.
    pub fn forces(&self) -> &[PointForce] {
        &self.workspace.forces
    }

    /// How the turbine fares now, at `time` (s), for a command that will hold for `interval` (s).
    ///
    /// Azimuth, speed and pitch are those of the instant; loads and power those of the interval before it.
    pub fn truth(&self, time: f64, interval: f64) -> Truth {
        let State { pitch, readings, .. } = &self.state;
        let loads = self.structure.loads();
        let low_speed = self.structure.generator_speed() / self.definition.drive_train.gear_ratio;
        Truth {
            time,
            interval,
            azimuth: self.structure.azimuth(),
            rotor_speed: self.structure.rotor_speed(),
            generator_speed: low_speed,
            pitch: pitch.map(|actuator| actuator.pitch),
            generator_torque: readings.generator_torque,
            power: self.definition.efficiency() * readings.generator_torque * low_speed,
            thrust: readings.thrust,
            aerodynamic_torque: readings.aerodynamic_torque,
            rotor_wind_speed: readings.rotor_wind_speed,
            flap_moments: loads.blades.map(|blade| blade.root.moment.y),
            edge_moments: loads.blades.map(|blade| blade.root.moment.x),
            tower_top_acceleration: loads.nacelle_acceleration.x,
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

    /// Centre and attitude of the rotor at the beginning.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The blades.
    pub fn line(&self) -> &ActuatorLine {
        &self.line
    }

    /// Blades, tower and drive train in motion.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Names and units of what [`Turbine::write_channels`] writes: loads and motions under OpenFAST's names.
    pub fn channels(&self) -> &[Channel] {
        self.structure.channels()
    }

    /// On return `values` holds each of [`Turbine::channels`] in SI units, in the middle of the last step.
    pub fn write_channels(&self, values: &mut [f64]) {
        self.structure.write_channels(values);
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Continues from `state`, which a turbine of the same definition gave.
    pub fn restore(&mut self, state: State) {
        self.structure.restore(state.structure.clone());
        self.state = state;
        self.place_stations();
    }

    /// Moves the pitch actuators on by `step` (s); gives pitch in the middle of it.
    fn pitch_blades(
        &mut self,
        step: f64,
        commands: &Commands,
        limited: &mut bool,
    ) -> PerBlade<Pitch> {
        let actuator = &self.definition.pitch_actuator;
        let mut blades = self.state.pitch;
        let mut pitch = PerBlade::splat(blades.len(), Pitch::default());
        for (index, blade) in blades.iter_mut().enumerate() {
            let before = *blade;
            *limited |= actuator.advance(blade, step, commands.pitch[index]);
            pitch[index] = Pitch {
                angle: 0.5 * (before.pitch + blade.pitch),
                rate: (blade.pitch - before.pitch) / step,
                acceleration: (blade.rate - before.rate) / step,
            };
        }
        self.state.pitch = blades;
        pitch
    }

    /// On return the workspace holds the drag of the tower in `winds` (m/s), and the forces of all bodies on the air are
    /// the last of its forces; gives the drag of the nacelle (N).
    fn hold_back(&mut self, winds: &[Vector3]) -> Vector3 {
        let Workspace { forces, tower, .. } = &mut self.workspace;
        forces.clear();
        let mut nacelle = Vector3::ZERO;
        for (index, (body, wind)) in self.bodies.iter().zip(winds).enumerate() {
            let force = body.force(*wind, self.air_density, self.smearing_length);
            match tower.get_mut(index) {
                Some(point) => *point = -force.force,
                None => nacelle = -force.force,
            }
            forces.push(force);
        }
        nacelle
    }

    /// On return the workspace holds the forces on the air, where the winds were sampled: half the force of a step acts
    /// before the instant and half after it, so that a blade's bound vortex does not induce a velocity on itself.
    fn push(&mut self) {
        let Workspace { forces, stations, axes, sums, circulations, .. } = &mut self.workspace;
        let n_bodies = forces.len();
        let elements = self.line.elements();
        for (index, ((axes, sum), position)) in axes.iter().zip(&*sums).zip(&*stations).enumerate()
        {
            let (blade, station) = (index / elements.len(), index % elements.len());
            let force = axes.normal * sum[0] + axes.tangent * sum[1];
            forces.push(PointForce {
                position: *position,
                force: -force,
                smearing_length: self.smearing_length,
                turbine: 0,
                bound: Some(BoundVortex {
                    blade,
                    station,
                    circulation: circulations[index],
                    along: axes.span * elements[station].width,
                }),
            });
        }
        forces.rotate_left(n_bodies);
    }

    /// On return the workspace's motions, stations and their axes are those of now.
    fn place_stations(&mut self) {
        let pitch = self.state.pitch.map(|blade| Pitch {
            angle: blade.pitch,
            rate: blade.rate,
            acceleration: 0.0,
        });
        let Workspace { stations, axes, motions, .. } = &mut self.workspace;
        self.structure.observe(0.0, &pitch, motions);
        for (axes, motion) in axes.iter_mut().zip(&*motions) {
            *axes = motion.axes;
        }
        stations.clear();
        stations.extend(motions.iter().map(|motion| motion.position));
        stations.extend(self.bodies.iter().map(|body| body.position));
    }
}

#[cfg(test)]
mod circulation_tests;
#[cfg(test)]
mod tests;
