//! One turbine: given commands and the wind at its stations, it turns, pitches, bends and exerts forces on
//! the flow.

mod aerodynamics;
mod answering;
mod nacelle;
mod pitching;
mod separation;
mod set_up;
mod settings;
mod state;
mod workspace;

pub use settings::{Induction, TurbineSettings};
pub use state::TurbineState;

use crate::actuator_line::ActuatorLine;
use crate::bodies::{self, Body};
use crate::breakdown::Breakdown;
use crate::definition::Definition;
use crate::rotor::Frame;
use crate::structure::{
    AppliedLoads, DegreeOfFreedom, GRAVITY, Pitch, Projection, Structure, StructureError,
};
use aerodynamics::Aerodynamics;
use basis::{Answer, Channel, Commands, PerBlade, PointForce, Truth, Vector3};
use nacelle::Facing;
use set_up::{all_but_the_generator, frame_at, lengths, longest_step};
use state::Readings;
use std::sync::Arc;
use workspace::Workspace;

/// Elements, and so point forces, of each blade.
pub const N_ELEMENTS: usize = 32;
/// Longest step of the structure (s): a sixtieth of the period of the fastest mode that carries load, the
/// blades' second flapwise one. Longer intervals are cut into equal steps, over which the wind at each
/// element is held.
pub const LONGEST_STRUCTURAL_STEP: f64 = 0.025;
/// Farthest that a small, fast rotor turns in such a step at rated speed (rad): its modes are as much faster
/// as it turns faster. Rotors that make less than 19 turns a minute never come so far.
pub const FARTHEST_STRUCTURAL_STEP: f64 = 0.05;

/// A turbine: definition, derived parameters, state, and working memory.
#[derive(Clone, Debug)]
pub struct Turbine {
    definition: Arc<Definition>,
    line: ActuatorLine,
    aerodynamics: Aerodynamics,
    structure: Structure,
    bodies: Vec<Body>,
    held: Vec<DegreeOfFreedom>,
    facing: Facing,
    frame: Frame,
    air_density: f64,
    smearing_length: f64,
    /// Longest step of the structure (s).
    longest_step: f64,
    /// By how much each blade's pitch is mounted wrong (rad).
    misalignment: PerBlade<f64>,
    state: TurbineState,
    workspace: Workspace,
}

impl Turbine {
    /// A turbine of `definition` with the foot of its tower at `position` (m), undeflected.
    ///
    /// # Errors
    /// [`StructureError`] when the definition's masses, stiffnesses or mode shapes do not make a structure.
    pub fn new(
        definition: Arc<Definition>,
        position: Vector3,
        settings: TurbineSettings,
    ) -> Result<Self, StructureError> {
        let (smearing_length, sample_spacing) = lengths(&settings.induction, &definition);
        let line = ActuatorLine::new(
            Arc::clone(&definition),
            N_ELEMENTS,
            settings.air_density,
            smearing_length,
            sample_spacing,
        );
        let frame = frame_at(position, &definition);
        let mut bodies = bodies::of(&definition, position, &frame, smearing_length);
        if !matches!(settings.induction, Induction::ByFlow { .. }) {
            bodies.iter_mut().for_each(Body::use_free_wind);
        }
        let aerodynamics = Aerodynamics::new(&definition, &line, &settings);
        let spans: Vec<f64> = line.elements().iter().map(|element| element.span).collect();
        // The last body is the nacelle.
        let heights: Vec<f64> =
            bodies[..bodies.len() - 1].iter().map(|body| body.position.z - position.z).collect();
        let structure = Structure::new(
            &definition,
            &crate::structure::StructureSettings {
                position,
                yaw: settings.yaw,
                gravity: GRAVITY,
                rotor_speed: settings.rotor_speed,
                azimuth: settings.azimuth,
                pitch: settings.pitch,
                spans: &spans,
                heights: &heights,
            },
        )?;
        let plate = definition.swashplate.map(|plate| plate.at_rest(settings.pitch));
        let state = TurbineState::at_start(structure.state().clone(), aerodynamics.start(), plate);
        let n_points = definition.n_blades * N_ELEMENTS;
        let mut turbine = Self {
            longest_step: longest_step(&definition),
            misalignment: PerBlade::splat(definition.n_blades, 0.0),
            workspace: Workspace::new(n_points, bodies.len(), frame.blade(0.0, 0.0)),
            held: if settings.flexible { Vec::new() } else { all_but_the_generator() },
            definition,
            line,
            aerodynamics,
            structure,
            bodies,
            facing: Facing { axis: position, rotor: frame, drag: frame.hub },
            frame,
            air_density: settings.air_density,
            smearing_length,
            state,
        };
        turbine.structure.hold(&turbine.held);
        turbine.facing.rotor = turbine.structure.frame(0.0).turned(position, -settings.yaw);
        turbine.place_stations();
        Ok(turbine)
    }

    /// The same turbine whose blades are mounted at their bearings with these errors of pitch (rad, positive
    /// to feather): an aerodynamic imbalance. Air and structure feel it; actuators know nothing of it, nor
    /// does what tells of pitch, which is that of the bearings.
    pub fn misaligned(mut self, misalignment: PerBlade<f64>) -> Self {
        self.misalignment = misalignment;
        self.place_stations();
        self
    }

    /// The same turbine without tower and nacelle in the wind: the rotor alone, as blade-element momentum
    /// sees it.
    pub fn without_bodies(mut self) -> Self {
        self.bodies.clear();
        self.workspace.tower.clear();
        self.place_stations();
        self
    }

    /// The same turbine on a test rig that holds its rotor speed whatever the torques.
    pub fn at_held_speed(mut self) -> Self {
        self.held.push(DegreeOfFreedom::Generator);
        self.structure.hold(&self.held);
        self
    }

    /// The same turbine in air that asks for no bound vortices: its forces come without them, and nothing is
    /// spent on circulation.
    pub fn without_bound_vortices(mut self) -> Self {
        self.workspace.circulations = Vec::new();
        self
    }

    /// The same turbine, its blade elements projected as `projection` says.
    pub fn projecting(mut self, projection: Projection) -> Self {
        self.structure.project(projection);
        self.place_stations();
        self
    }

    /// Points at which the turbine needs the wind, farm frame (m): blade elements, then bodies.
    pub fn stations(&self) -> &[Vector3] {
        &self.workspace.stations
    }

    /// The same, whose structure takes steps of at most `step` (s) in place of
    /// [`LONGEST_STRUCTURAL_STEP`]: shorter ones, or longer ones that cost less and follow the fast modes
    /// less well. At rated speed they never turn the rotor by more than [`FARTHEST_STRUCTURAL_STEP`], and
    /// they are never longer than the intervals in which it is advanced.
    pub fn with_structural_steps(self, step: f64) -> Self {
        let farthest = FARTHEST_STRUCTURAL_STEP / self.definition.rated_rotor_speed;
        Self { longest_step: step.min(farthest), ..self }
    }

    /// Advances the turbine by `interval` (s) under constant `commands`.
    ///
    /// `winds` (m/s) holds the wind at each of [`Turbine::stations`] now, the rotor's induction included as
    /// far as the flow resolves it. On return [`Turbine::forces`] holds the forces that act on the air
    /// throughout the interval.
    pub fn advance(&mut self, interval: f64, winds: &[Vector3], commands: &Commands) {
        self.advance_answered(interval, winds, None, commands);
    }

    /// As [`advance`](Self::advance), in winds that answer to the circulation of the blades as `answer` says:
    /// circulation and what it brings about are found together ([`Induction::ByBoundVortices`]; others have
    /// no use for it).
    pub fn advance_answered(
        &mut self,
        interval: f64,
        winds: &[Vector3],
        answer: Option<Answer<'_>>,
        commands: &Commands,
    ) {
        let n_steps = (interval / self.longest_step - 1e-9).ceil().max(1.0) as usize;
        let step = interval / n_steps as f64;
        // A generator holds the rotor back and never drives it backwards.
        let turning = self.structure.generator_speed() > 0.0;
        let generator_torque = if turning { commands.generator_torque } else { 0.0 };
        let (element_winds, body_winds) = winds.split_at(self.workspace.motions.len());
        let nacelle = self.workspace.drag_of_bodies(
            &self.bodies,
            body_winds,
            answer.map_or(Vector3::ZERO, |answer| answer.at_nacelle),
            self.air_density,
            self.smearing_length,
        );
        self.workspace.sums.fill([0.0; 2]);
        self.workspace.circulations.fill(0.0);
        let mut readings = Readings {
            generator_torque,
            rotor_wind_speed: self.line.mean_axial(element_winds, self.frame.shaft),
            ..Readings::default()
        };
        let (asked, mut limited) = (self.asked(commands), false);
        for index in 0..n_steps {
            let pitch = self.pitch_blades(step, &asked, &mut limited);
            self.structure.turn(self.state.nacelle.advance(step, commands.yaw_rate));
            let Workspace { motions, loads, circulations, .. } = &mut self.workspace;
            self.structure.observe(0.5 * step, &pitch, motions);
            let frame = self.structure.frame(0.5 * step);
            let now = aerodynamics::Instant {
                interval: step,
                first: index == 0,
                winds: element_winds,
                answer,
                motions,
                pitch: &pitch,
                frame: &frame,
                rotor_speed: self.structure.rotor_speed(),
            };
            self.aerodynamics.loads(&self.line, &now, &mut self.state.aerodynamics, loads);
            self.aerodynamics.add_circulations(&self.line, 1.0 / n_steps as f64, circulations);
            self.workspace.add_loads(1.0 / n_steps as f64, &frame, &mut readings);
            let Workspace { loads, tower, .. } = &self.workspace;
            let applied = AppliedLoads { elements: loads, tower, nacelle, generator_torque };
            self.structure.advance(step, &applied, &pitch);
        }
        self.state.n_instants += 1;
        self.state.n_limited += u64::from(limited);
        self.state.readings = readings;
        self.state.structure.clone_from(self.structure.state());
        self.workspace.push(self.line.elements(), self.smearing_length);
        self.place_stations();
        self.workspace.tell_places(self.line.elements());
    }

    /// Forces on the air over the last interval: blade elements with their bound vortices, blade after blade
    /// from root to tip, then bodies.
    pub fn forces(&self) -> &[PointForce] {
        &self.workspace.forces
    }

    /// State of the turbine now, at `time` (s), for a command that will hold for `interval` (s).
    ///
    /// Azimuth, speed and pitch are those of the instant; loads and power those of the interval before it.
    pub fn truth(&self, time: f64, interval: f64) -> Truth {
        let TurbineState { pitch, nacelle, readings, .. } = &self.state;
        let loads = self.structure.loads();
        let low_speed = self.structure.generator_speed() / self.definition.drive_train.gear_ratio;
        Truth {
            time,
            interval,
            azimuth: self.structure.azimuth(),
            rotor_speed: self.structure.rotor_speed(),
            generator_speed: low_speed,
            pitch: pitch.map(|actuator| actuator.pitch),
            yaw: nacelle.angle,
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

    /// Whether it is still a machine: everything that it stands, turns, bends and pulls with is finite.
    ///
    /// # Errors
    /// [`Breakdown`] names what is not. Nothing that follows from such a turbine means anything.
    pub fn check(&self) -> Result<(), Breakdown> {
        let TurbineState { structure, pitch, nacelle, readings, .. } = &self.state;
        let first = [
            ("rotor speed", self.structure.rotor_speed(), "rad/s"),
            ("thrust", readings.thrust, "N"),
            ("aerodynamic torque", readings.aerodynamic_torque, "N m"),
            ("generator torque", readings.generator_torque, "N m"),
            ("wind at the rotor", readings.rotor_wind_speed, "m/s"),
            ("yaw", nacelle.angle, "rad"),
        ];
        let motions = [
            ("deflection", &structure.coordinates, "m"),
            ("speed of deflection", &structure.velocities, "m/s"),
        ];
        let motions = motions.into_iter().flat_map(|(quantity, motion, unit)| {
            let values = motion.shared.iter().chain(motion.blades.as_flattened());
            values.map(move |value| (quantity, *value, unit))
        });
        let pitch = pitch.iter().map(|blade| ("pitch", blade.pitch, "rad"));
        Breakdown::among(first.into_iter().chain(motions).chain(pitch))
    }

    /// Instants so far, and those at which a pitch limit held a command back (–).
    pub fn limited_instants(&self) -> (u64, u64) {
        (self.state.n_instants, self.state.n_limited)
    }

    /// The definition of the turbine.
    pub fn definition(&self) -> &Definition {
        &self.definition
    }

    /// Centre and attitude of the undeflected rotor, as the nacelle stands now.
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
        self.structure.write_channels(&self.misalignment, values);
    }

    /// The state, for a checkpoint.
    pub fn state(&self) -> &TurbineState {
        &self.state
    }

    /// Continues from `state`, which a turbine of the same definition gave.
    pub fn restore(&mut self, state: TurbineState) {
        self.structure.restore(state.structure.clone());
        self.state = state;
        self.place_stations();
    }

    /// How the blades are pitched now, errors of their mounting included.
    fn pitch_now(&self) -> PerBlade<Pitch> {
        PerBlade::from_fn(self.state.pitch.len(), |blade| Pitch {
            angle: self.state.pitch[blade].pitch + self.misalignment[blade],
            rate: self.state.pitch[blade].rate,
            acceleration: 0.0,
        })
    }

    /// On return the workspace's stations and their axes are those of now.
    fn place_stations(&mut self) {
        let pitch = self.pitch_now();
        let (frame, drag) = self.facing.turned(self.state.nacelle.angle);
        self.frame = frame;
        if let Some(nacelle) = self.bodies.last_mut() {
            nacelle.position = drag;
        }
        self.structure.turn(self.state.nacelle.now());
        let Workspace { stations, axes, .. } = &mut self.workspace;
        let (elements, bodies) = stations.split_at_mut(axes.len());
        self.structure.place(&pitch, elements, axes);
        for (station, body) in bodies.iter_mut().zip(&self.bodies) {
            *station = body.position;
        }
    }
}

#[cfg(test)]
mod circulation_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod yaw_tests;
