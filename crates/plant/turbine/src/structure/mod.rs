//! The flexible turbine: blades, tower and drive train in motion, and the loads inside them.
//!
//! ```text
//! blade: 2 flapwise + 1 edgewise mode        z up, x downwind, y left looking downwind
//!    \    hub ── shaft torsion ── generator  azimuth of generator + torsion = azimuth of the rotor
//!     ●══════╪═══ nacelle
//!    /       │    tower top: yaw bearing, nacelle, shaft tilted
//!            │    tower: 2 fore-aft + 2 side-to-side modes
//!         ───┴─── clamped
//! ```
//!
//! Blades and tower are beams whose modes bend them along two principal axes; the axes twist along the blade,
//! so that each mode moves out of plane and in plane. A point of a beam moves as p = p₀ + Σ φᵢ qᵢ − ½ Σ qᵢ
//! Aᵢⱼ qⱼ ẑ, the last term the shortening due to bending: through it centrifugal force stiffens the blades
//! and weight softens the tower. Positions are otherwise exact functions of the coordinates. Mass is lumped
//! at Gaussian points (see `quadrature`). Kane's equations project inertia, gravity and applied loads on the
//! coordinates through the partial velocities of these points. Internal loads are the sum of all forces
//! outboard of a cut, inertia included.
//!
//! Sources: Kane and Levinson, Dynamics (1985), ch. 6; Jonkman and Buhl, FAST User's Guide, NREL/EL-500-38230
//! (2005), for the degrees of freedom, mode shapes and channels.
//! Limits: no torsion and no extension of blades, sections' own rotary inertia left out, mass on the pitch
//! axis: prebend and sweep carry the aerodynamic forces, not the mass. Slopes are small rotations.

mod arrowhead;
mod beam;
mod cantilever;
mod channels;
mod coordinates;
mod energy;
mod equations_of_motion;
mod error;
mod frame;
mod loads;
mod machine;
mod midpoint;
mod modes;
mod projection;
mod quadrature;
mod shapes;
mod stations;
#[cfg(test)]
mod tests;

pub use beam::Wrench;
pub use cantilever::{BeamSection, BendingMode, EndBody, bending_modes};
pub use channels::canonical;
pub use coordinates::{Coordinates, DegreeOfFreedom};
pub use energy::Energy;
pub use error::StructureError;
pub use loads::{BladeLoads, Loads, N_GAUGES};
pub use machine::{Pitch, Yaw};
pub use modes::NaturalMode;
pub use projection::Projection;
pub use stations::{AppliedLoads, ElementLoad};

use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::{BladeFrame, Frame};
use basis::{Channel, PerBlade, Vector3};
use coordinates::{GENERATOR, Locks, TORSION};
use equations_of_motion::EquationsOfMotion;
use machine::Machine;
use midpoint::PhasePoint;
use serde::{Deserialize, Serialize};
use stations::{LoadResultants, Stations};

/// What a turbine of `n_blades` blades tells of itself, in the order of [`Structure::write_channels`].
pub fn channels_of(n_blades: usize) -> Vec<Channel> {
    channels::table(n_blades)
}

/// Standard acceleration of free fall (m/s²).
pub const GRAVITY: f64 = 9.806_65;

/// Position and initial condition of a flexible turbine.
#[derive(Clone, Copy, Debug)]
pub struct StructureSettings<'a> {
    /// Foot of the turbine on the ground or mean sea level, farm frame (m).
    pub position: Vector3,
    /// Turn of the nacelle about the vertical at the beginning, from facing −x, counter-clockwise from above
    /// (rad).
    pub yaw: f64,
    /// Acceleration of gravity (m/s²), see [`GRAVITY`].
    pub gravity: f64,
    /// Rotor speed at the beginning (rad/s).
    pub rotor_speed: f64,
    /// Azimuth of blade 1 at the beginning (rad).
    pub azimuth: f64,
    /// Pitch of all blades at the beginning (rad).
    pub pitch: f64,
    /// Middles of the blade elements with aerodynamic loads, from the rotor apex along the pitch axis (m).
    pub spans: &'a [f64],
    /// Points of the tower with aerodynamic loads, above ground or mean sea level (m).
    pub heights: &'a [f64],
}

impl StructureSettings<'_> {
    /// At the farm's origin, facing the wind, at rest, without elements.
    pub const AT_REST: StructureSettings<'static> = StructureSettings {
        position: Vector3::ZERO,
        yaw: 0.0,
        gravity: GRAVITY,
        rotor_speed: 0.0,
        azimuth: 0.0,
        pitch: 0.0,
        spans: &[],
        heights: &[],
    };
}

/// A flexible turbine: parameters, state, and the loads of its last step.
#[derive(Clone, Debug)]
pub struct Structure {
    machine: Machine,
    stations: Stations,
    locks: Locks,
    channels: Vec<Channel>,
    state: StructureState,
    equations: EquationsOfMotion,
}

/// State of a structure; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StructureState {
    /// Generalised coordinates.
    pub coordinates: Coordinates,
    /// Their velocities.
    pub velocities: Coordinates,
    /// Their accelerations, mean of the last step.
    pub accelerations: Coordinates,
    /// Accelerations of the step before.
    pub earlier_accelerations: Coordinates,
    /// Pitch during the last step.
    pub pitch: PerBlade<Pitch>,
    /// Turn of the nacelle in the middle of the last step.
    pub yaw: Yaw,
    /// Loads at the middle of the last step.
    pub loads: Loads,
}

impl StructureState {
    fn phase(&self) -> PhasePoint {
        PhasePoint {
            q: self.coordinates,
            v: self.velocities,
            a: self.accelerations,
            earlier: self.earlier_accelerations,
        }
    }
}

impl Structure {
    /// The structure of `definition`, undeflected.
    ///
    /// # Errors
    /// When sections do not span blade or tower, have no mass or stiffness, or a mode shape is not one at the
    /// free end.
    pub fn new(
        definition: &Definition,
        settings: &StructureSettings<'_>,
    ) -> Result<Self, StructureError> {
        let (machine, tables) =
            Machine::new(definition, settings.position, settings.yaw, settings.gravity)?;
        let stations = Stations::new(definition, &tables, settings.spans, settings.heights);
        let pitch = Pitch { angle: settings.pitch, ..Pitch::default() };
        let mut phase = PhasePoint::default();
        phase.q.shared[GENERATOR] = basis::angle::wrap_to_turn(settings.azimuth);
        phase.v.shared[GENERATOR] = settings.rotor_speed;
        let pitch = PerBlade::splat(machine.n_blades, pitch);
        let none = LoadResultants::default();
        let equations = machine.equations_of_motion(&phase.q, &phase.v, &pitch, &none);
        let loads = machine.loads(&phase, &equations, &none);
        let state = StructureState {
            coordinates: phase.q,
            velocities: phase.v,
            accelerations: phase.a,
            earlier_accelerations: phase.earlier,
            pitch,
            yaw: machine.yaw(),
            loads,
        };
        let channels = channels::table(machine.n_blades);
        let locks = Locks::default();
        Ok(Self { machine, stations, locks, channels, state, equations })
    }

    /// Locks exactly `degrees`: no acceleration from now on. A locked mode stops where it is; a locked
    /// generator keeps its speed.
    pub fn hold(&mut self, degrees: &[DegreeOfFreedom]) {
        self.locks = Locks::of(degrees);
        for (index, held) in self.locks.shared.into_iter().enumerate() {
            if held {
                self.state.accelerations.shared[index] = 0.0;
                self.state.earlier_accelerations.shared[index] = 0.0;
                if index != GENERATOR {
                    self.state.velocities.shared[index] = 0.0;
                }
            }
        }
        for mode in (0..coordinates::N_MODES).filter(|&mode| self.locks.modes[mode]) {
            for blade in 0..self.machine.n_blades {
                self.state.accelerations.blades[blade][mode] = 0.0;
                self.state.earlier_accelerations.blades[blade][mode] = 0.0;
                self.state.velocities.blades[blade][mode] = 0.0;
            }
        }
    }

    /// From now on blade elements are projected as `projection` says.
    pub fn project(&mut self, projection: Projection) {
        self.stations.projection = projection;
    }

    /// From now on the nacelle is turned as `yaw` says: prescribed, as pitch is. For a step it is its turn in
    /// the middle of it.
    pub fn turn(&mut self, yaw: Yaw) {
        self.machine.turn(yaw);
    }

    /// On return `elements` holds the motion of each blade element `ahead` (s) after now, blade after blade.
    ///
    /// Loads belong to the middle of their step: take `ahead` as half a step, and the `pitch` of that
    /// instant.
    ///
    /// # Panics
    /// When `elements` does not hold `n_blades × n_elements` values.
    pub fn observe(&self, ahead: f64, pitch: &[Pitch], elements: &mut [ElementMotion]) {
        let n = self.machine.n_blades * self.stations.n_elements();
        assert_eq!(elements.len(), n, "one motion for each blade element");
        if n > 0 {
            let phase = self.state.phase().ahead(ahead);
            let motion = self.machine.motion(&phase.q, &phase.v, pitch);
            self.stations.observe(&self.machine, &motion, &phase.q, &phase.v, elements);
        }
    }

    /// On return `positions` (m) and `axes` are those of the blade elements now, pitched by `pitch`, blade
    /// after blade, farm frame.
    ///
    /// # Panics
    /// When either does not hold `n_blades × n_elements` values.
    pub fn place(&self, pitch: &[Pitch], positions: &mut [Vector3], axes: &mut [BladeFrame]) {
        let n = self.machine.n_blades * self.stations.n_elements();
        assert_eq!((positions.len(), axes.len()), (n, n), "one place for each blade element");
        if n > 0 {
            let phase = self.state.phase();
            let motion = self.machine.motion(&phase.q, &phase.v, pitch);
            self.stations.place(&self.machine, &motion, &phase.q, positions, axes);
        }
    }

    /// On return `points` holds position (m) and velocity (m/s) of each point of the tower `ahead` (s) after
    /// now, farm frame.
    pub fn observe_tower(&self, ahead: f64, points: &mut [(Vector3, Vector3)]) {
        let phase = self.state.phase().ahead(ahead);
        self.stations.observe_tower(&self.machine, &phase.q, &phase.v, points);
    }

    /// Attitude of the rotor `ahead` (s) after now, deflection of the tower included.
    pub fn frame(&self, ahead: f64) -> Frame {
        let phase = self.state.phase().ahead(ahead);
        let shaft = self.machine.motion(&phase.q, &phase.v, &self.state.pitch).shaft;
        Frame {
            hub: shaft.origin,
            shaft: shaft.axes.x_axis,
            up: shaft.axes.z_axis,
            right: -shaft.axes.y_axis,
        }
    }

    /// Advances by `interval` (s) under constant `loads`, blades at `pitch` in the middle of the step.
    ///
    /// # Panics
    /// When `loads` or `pitch` do not fit the blades, elements and points that the structure was made with.
    pub fn advance(&mut self, interval: f64, loads: &AppliedLoads<'_>, pitch: &[Pitch]) {
        let machine = &self.machine;
        let fits = |given: usize, wanted: usize| given == 0 || given == wanted;
        assert_eq!(pitch.len(), machine.n_blades, "one pitch for each blade");
        let n_elements = machine.n_blades * self.stations.n_elements();
        assert!(fits(loads.elements.len(), n_elements), "one load for each blade element");
        assert!(fits(loads.tower.len(), self.stations.n_tower()), "one force for each tower point");
        let phase = self.state.phase();
        let middle = phase.middle(interval);
        let motion = machine.motion(&middle.q, &middle.v, pitch);
        let applied = self.stations.resultants(&motion, &middle.q, loads);
        let (mut after, middle) =
            machine.step(&phase, interval, pitch, &applied, &self.locks, &mut self.equations);
        after.q.shared[GENERATOR] = basis::angle::wrap_to_turn(after.q.shared[GENERATOR]);
        self.state.coordinates = after.q;
        self.state.velocities = after.v;
        self.state.accelerations = after.a;
        self.state.earlier_accelerations = after.earlier;
        self.state.pitch.copy_from_slice(pitch);
        self.state.yaw = machine.yaw();
        self.state.loads = machine.loads(&middle, &self.equations, &applied);
    }

    /// The state, for a checkpoint.
    pub fn state(&self) -> &StructureState {
        &self.state
    }

    /// Continues from `state`.
    ///
    /// # Panics
    /// When `state` is that of a turbine with another number of blades.
    pub fn restore(&mut self, state: StructureState) {
        assert_eq!(state.pitch.len(), self.machine.n_blades, "a state of as many blades");
        self.machine.turn(state.yaw);
        self.state = state;
    }

    /// Azimuth of blade 1 (rad, [0, 2π)).
    pub fn azimuth(&self) -> f64 {
        let shared = &self.state.coordinates.shared;
        basis::angle::wrap_to_turn(shared[GENERATOR] + shared[TORSION])
    }

    /// Rotor speed (rad/s).
    pub fn rotor_speed(&self) -> f64 {
        self.state.velocities.shared[GENERATOR] + self.state.velocities.shared[TORSION]
    }

    /// Generator speed, high-speed side (rad/s).
    pub fn generator_speed(&self) -> f64 {
        self.machine.gear_ratio * self.state.velocities.shared[GENERATOR]
    }

    /// Loads at the middle of the last step.
    pub fn loads(&self) -> &Loads {
        &self.state.loads
    }

    /// Names and units of what [`Structure::write_channels`] writes.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Index of the channel called `name`, one of OpenFAST's names, in [`Structure::channels`].
    pub fn channel(&self, name: &str) -> Option<usize> {
        channels::index(&self.channels, name)
    }

    /// On return `values` holds the channels in the middle of the last step, in SI units; `misalignment` is
    /// what of each blade's pitch its bearing does not show (rad).
    pub fn write_channels(&self, misalignment: &[f64], values: &mut [f64]) {
        let StructureState { loads, yaw, pitch, .. } = &self.state;
        channels::write(loads, yaw.angle, pitch, misalignment, values);
    }

    /// Mechanical energy now.
    pub fn energy(&self) -> Energy {
        self.machine.energy(&self.state.coordinates, &self.state.velocities, &self.state.pitch)
    }

    /// Undamped natural modes about the present state, lowest first; rotation stiffens the blades.
    ///
    /// Locked degrees of freedom take no part. Gyroscopic forces are left out: exact at standstill.
    pub fn natural_modes(&self) -> Vec<NaturalMode> {
        let state = &self.state;
        self.machine.natural_modes(&state.coordinates, &state.velocities, &state.pitch, &self.locks)
    }
}
