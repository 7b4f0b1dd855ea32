//! Before a study: does each rotor, alone in a steady wind in air like the study's, give what blade-element
//! momentum says?

use crate::Progress;
use crate::assemble::{self, TurbineModel};
use crate::case::{Flow, Method, Solver, Wind};
use crate::domain::SMEARING_CELLS;
use crate::plan::Plan;
use crate::solvers::{Alone, SolverError};
use basis::{Commands, PerBlade, Vector3};
use flow::inflow::MeanProfile;
use flow::lattice::{self, Lattice};
use flow::{FlowError, FlowSolver, WindField};
use std::sync::Arc;
use std::time::{Duration, Instant};
use thiserror::Error;
use turbine::aero::blade_element::Theory;
use turbine::steady::SteadyRotor;
use turbine::structure::StructureError;
use turbine::{Definition, Induction, Turbine};

/// Power and thrust of one turbine in steady uniform flow, by the air of a study and by blade-element
/// momentum.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfCheck {
    /// Turbine model.
    pub model: String,
    /// Free-stream speed (m/s).
    pub wind_speed: f64,
    /// Tip-speed ratio held during the check (–).
    pub tip_speed_ratio: f64,
    /// Aerodynamic power in that air (W).
    pub power: f64,
    /// Power of blade-element momentum in the unbounded air that gives the rotor the same state (W).
    pub expected_power: f64,
    /// Thrust in that air (N).
    pub thrust: f64,
    /// Thrust of blade-element momentum, likewise (N).
    pub expected_thrust: f64,
    /// Cell updates a second that the check reached, everything included (1/s); steps where there are no
    /// cells.
    pub updates_per_second: f64,
}

/// Difference beyond which the self-check warns (–).
pub const TOLERANCE: f64 = 0.05;
/// Wall time for which a machine is timed.
pub const TIMED: Duration = Duration::from_millis(300);

impl SelfCheck {
    /// Power over its expectation, minus one (–).
    pub fn power_error(&self) -> f64 {
        self.power / self.expected_power - 1.0
    }

    /// Thrust over its expectation, minus one (–).
    pub fn thrust_error(&self) -> f64 {
        self.thrust / self.expected_thrust - 1.0
    }

    /// Whether both lie within [`TOLERANCE`].
    pub fn passes(&self) -> bool {
        self.power_error().abs() <= TOLERANCE && self.thrust_error().abs() <= TOLERANCE
    }
}

/// A wind tunnel for one rotor, and how long it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tunnel {
    /// Inlet to rotor (diameters).
    pub upstream: f64,
    /// Rotor to outlet (diameters).
    pub downstream: f64,
    /// Width and height (diameters).
    pub width: f64,
    /// Time for the near wake to settle (diameters over wind speed).
    pub settling: f64,
    /// Time averaged after it (diameters over wind speed).
    pub averaging: f64,
    /// Edge of a cell (m).
    pub spacing: f64,
    /// Step (s).
    pub interval: f64,
    /// How its air is computed.
    pub method: Method,
}

impl Tunnel {
    /// The one of the check before a study: as small as the walls' effect still follows its closed form.
    pub fn of_study(plan: &Plan) -> Self {
        let Plan { spacing, interval, method, .. } = *plan;
        let [upstream, downstream, width] = [4.0, 4.0, 6.0];
        Self {
            upstream,
            downstream,
            width,
            settling: 10.0,
            averaging: 1.0,
            spacing,
            interval,
            method,
        }
    }

    /// The one in which a turbine's pitch response is identified: smaller, since walls change little of what
    /// pitch does. What is averaged is counted in periods of the pitch instead.
    pub fn for_identification(plan: &Plan) -> Self {
        let Plan { spacing, interval, method, .. } = *plan;
        let [upstream, downstream, width] = [3.0, 3.0, 5.0];
        Self {
            upstream,
            downstream,
            width,
            settling: 8.0,
            averaging: 0.0,
            spacing,
            interval,
            method,
        }
    }

    /// The one in which a machine is timed around a rotor of `diameter` (m): of some 800 000 cells, more than
    /// caches hold and few enough to be there at once.
    pub fn for_timing(diameter: f64, plan: &Plan) -> Self {
        let Plan { spacing, interval, method, .. } = *plan;
        const CELLS_ACROSS: f64 = 84.0;
        let width = (CELLS_ACROSS * spacing / diameter).max(1.5);
        let [upstream, downstream] = [0.5 * width, 0.83 * width];
        Self {
            upstream,
            downstream,
            width,
            settling: 0.0,
            averaging: 0.0,
            spacing,
            interval,
            method,
        }
    }

    /// Cells along x, y and z around a rotor of `diameter` (m).
    pub fn n_cells(&self, diameter: f64) -> [usize; 3] {
        let cells = |diameters: f64| (diameters * diameter / self.spacing).round() as usize;
        let n_across = cells(self.width);
        [cells(self.upstream + self.downstream), n_across, n_across]
    }

    /// The steady speed of `wind` in the tunnel, a rotor of `diameter` (m) at its origin.
    ///
    /// # Errors
    /// [`lattice::LatticeError`] when the flow cannot be set up.
    pub fn air(
        &self,
        wind: &Wind,
        diameter: f64,
        threads: Option<usize>,
    ) -> Result<Lattice, lattice::LatticeError> {
        let n_cells = self.n_cells(diameter);
        let half_width = 0.5 * n_cells[1] as f64 * self.spacing;
        let origin = Vector3::new(-self.upstream * diameter, -half_width, -half_width);
        let mut settings =
            lattice::LatticeSettings::new(origin, self.spacing, n_cells, self.interval, wind.speed);
        settings.air_density = wind.air_density;
        settings.kinematic_viscosity = wind.kinematic_viscosity;
        settings.ground = lattice::Ground::Periodic;
        settings.threads = threads;
        self.method.apply(&mut settings);
        Lattice::new(settings, Arc::new(MeanProfile::Uniform { speed: wind.speed }))
    }
}

/// Checks `model` in the steady speed of `wind` in `tunnel`, its air that of `flow`, rotor speed held at its
/// optimum (or rated), pitch at its least, tower and nacelle left out, polars holding at once; `progress`
/// receives the share done.
///
/// The tunnel is small, so the expectation is taken in the wind that an open sky would need for the same
/// rotor state ([`SolverKind::equivalent_speed`](crate::solvers::SolverKind::equivalent_speed)).
///
/// # Errors
/// [`SelfCheckError`] when the flow cannot be set up or does not stay finite.
pub fn self_check(
    model: &TurbineModel,
    wind: &Wind,
    tunnel: &Tunnel,
    flow: &Flow,
    progress: Progress,
) -> Result<SelfCheck, SelfCheckError> {
    let definition = &model.definition;
    let diameter = definition.rotor_diameter();
    let interval = tunnel.interval;
    let mut air = (flow.solver.begin_alone)(&Alone { tunnel: *tunnel, wind, diameter, flow })?;
    let pitch = model.constants.fine_pitch;
    let rotor_speed = model.rotor_speed(wind.speed);
    let mut rotor = bare_rotor(model, wind, tunnel, flow.solver)?;
    let commands = Commands {
        pitch: PerBlade::splat(definition.n_blades, pitch),
        generator_torque: 0.0,
        yaw_rate: 0.0,
    };

    let steps = |diameters: f64| (diameters * diameter / wind.speed / interval).ceil() as u64;
    let (n_settling, n_averaging) = (steps(tunnel.settling), steps(tunnel.averaging));
    let n_steps = n_settling + n_averaging;
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let (mut power, mut thrust) = (0.0, 0.0);
    let started = Instant::now();
    for step in 0..n_steps {
        air.sample(rotor.stations(), &mut winds);
        rotor.advance_answered(interval, &winds, air.answer(0), &commands);
        air.advance(interval, rotor.forces())?;
        if step >= n_settling {
            let read = rotor.truth((step + 1) as f64 * interval, interval);
            power += read.aerodynamic_torque * read.rotor_speed / n_averaging as f64;
            thrust += read.thrust / n_averaging as f64;
        }
        if progress((step + 1) as f64 / n_steps as f64).is_break() {
            return Err(SelfCheckError::BrokenOff);
        }
    }
    let wall_time = started.elapsed().as_secs_f64();

    let equivalent = |thrust| (flow.solver.equivalent_speed)(tunnel, flow, diameter, thrust);
    let expected = expectation(definition, wind, rotor_speed, pitch, equivalent);
    let updates = (flow.solver.updates_alone)(tunnel, diameter) * n_steps as f64;
    Ok(SelfCheck {
        model: definition.name.clone(),
        wind_speed: wind.speed,
        tip_speed_ratio: rotor_speed * 0.5 * diameter / wind.speed,
        power,
        expected_power: expected.0,
        thrust,
        expected_thrust: expected.1,
        updates_per_second: updates / wall_time,
    })
}

/// Cell updates a second (1/s) of `model` in `tunnel` of a lattice, everything included, timed for [`TIMED`].
///
/// # Errors
/// Those of [`self_check`].
pub fn updates_per_second(
    model: &TurbineModel,
    wind: &Wind,
    tunnel: &Tunnel,
    threads: Option<usize>,
) -> Result<f64, SelfCheckError> {
    let air = tunnel.air(wind, model.definition.rotor_diameter(), threads);
    let mut air = air.map_err(SolverError::from)?;
    let mut rotor = bare_rotor(model, wind, tunnel, Solver::LATTICE)?;
    let n_blades = model.definition.n_blades;
    let pitch = PerBlade::splat(n_blades, model.constants.fine_pitch);
    let commands = Commands { pitch, generator_torque: 0.0, yaw_rate: 0.0 };
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let mut step = || -> Result<(), SelfCheckError> {
        air.sample(rotor.stations(), &mut winds);
        rotor.advance(tunnel.interval, &winds, &commands);
        Ok(air.advance(tunnel.interval, rotor.forces())?)
    };
    // The first step touches memory for the first time.
    step()?;
    let started = Instant::now();
    let mut n_steps = 0;
    while n_steps == 0 || started.elapsed() < TIMED {
        step()?;
        n_steps += 1;
    }
    let wall_time = started.elapsed().as_secs_f64();
    Ok(air.n_cells().iter().product::<usize>() as f64 * f64::from(n_steps) / wall_time)
}

/// The rotor of `model` at the origin of `tunnel` in air of `solver`, stiff, with no tower or nacelle in the
/// wind, at held speed.
fn bare_rotor(
    model: &TurbineModel,
    wind: &Wind,
    tunnel: &Tunnel,
    solver: Solver,
) -> Result<Turbine, StructureError> {
    let definition = &model.definition;
    let induction = if solver.uses_bound_vortices {
        Induction::ByBoundVortices { dynamic_stall: false, tower: None }
    } else {
        Induction::ByFlow {
            smearing_length: SMEARING_CELLS * tunnel.spacing,
            sample_spacing: tunnel.spacing,
            dynamic_stall: false,
        }
    };
    let rotor = Turbine::new(
        Arc::clone(definition),
        Vector3::new(0.0, 0.0, -definition.rotor.hub_height),
        turbine::TurbineSettings {
            induction,
            flexible: false,
            air_density: wind.air_density,
            yaw: 0.0,
            rotor_speed: model.rotor_speed(wind.speed),
            azimuth: 0.0,
            pitch: model.constants.fine_pitch,
        },
    )?;
    Ok(assemble::in_air_of(solver, rotor.without_bodies()).at_held_speed())
}

/// Power (W) and thrust (N) of blade-element momentum in unbounded air of the speed, over that of `wind`,
/// that is `equivalent` for a rotor of such a thrust coefficient there.
fn expectation(
    definition: &Definition,
    wind: &Wind,
    rotor_speed: f64,
    pitch: f64,
    equivalent: impl Fn(f64) -> f64,
) -> (f64, f64) {
    let rotor = SteadyRotor::new(definition, Theory::default()).along_shaft();
    let at = |ratio: f64| {
        let speed = ratio * wind.speed;
        (speed, rotor.coefficients(rotor_speed * definition.rotor_radius() / speed, pitch))
    };
    // The speed-up depends on the thrust, which hardly depends on the speed-up: a few rounds are plenty.
    let mut ratio = 1.0;
    for _ in 0..8 {
        let (_, coefficients) = at(ratio);
        ratio = equivalent(coefficients.thrust * ratio * ratio);
    }
    let (speed, coefficients) = at(ratio);
    let dynamic = 0.5 * wind.air_density * definition.rotor_area() * speed * speed;
    (coefficients.power * dynamic * speed, coefficients.thrust * dynamic)
}

/// Why a self-check could not be made.
#[derive(Debug, Error)]
pub enum SelfCheckError {
    /// The receiver of its progress stopped it.
    #[error("the self-check was interrupted")]
    BrokenOff,
    /// The flow cannot be set up.
    #[error("the flow of the self-check cannot be set up")]
    Settings(#[from] SolverError),
    /// The turbine has no structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// The air did not stay finite.
    #[error("the flow of the self-check diverged")]
    Flow(#[from] FlowError),
}
