//! From case to farm: turbines, controllers and air put together.

use crate::air::Air;
use crate::case::TowerInfluence as AskedInfluence;
use crate::case::{Case, Control, DynamicInflow, Ground, Placement, Run, Sides};
use crate::coefficients::coefficient_table;
use crate::plan::{Footprint, Plan};
use crate::solvers::{Smearing, Solver};
use crate::{Farm, Machine, wind};
use basis::keys::Objection;
use basis::{PerBlade, Vector3};
use control::baseline::Constants;
use control::{ControlError, Controller, Site};
use flow::{FlowSolver, lattice};
use sensing::{InstrumentError, Mount, Sensing};
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::{SnelSchepers, TwoConstant};
use turbine::aero::tower_influence::{Effects, Potential};
use turbine::aero::{self, TowerInfluence, rotor};
use turbine::structure::StructureError;
use turbine::{Definition, Induction, Turbine};

/// What about a further sensor of a turbine cannot be on its machine, or at its control interval.
#[derive(Debug, thiserror::Error)]
#[error("sensors.{sensor} of {turbine}: `{key}` {message}; {fix}")]
pub struct SensorObjection {
    /// Name of the turbine.
    pub turbine: String,
    /// Name of the sensor.
    pub sensor: String,
    /// Key that it is about, `kind` for the whole table.
    pub key: &'static str,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub fix: String,
}

/// Why no farm could be put together.
#[derive(Debug, thiserror::Error)]
pub enum AssemblyError {
    /// A model's masses, stiffnesses or mode shapes make no structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// A turbine cannot be controlled as the case has it.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// Nobody found the azimuth offset of a turbine's individual pitch control.
    #[error(
        "the azimuth offset of its individual pitch control was neither given nor identified before the run; give `azimuth_offset_deg` in `individual_pitch` of its turbine file's [controller]"
    )]
    NoIndividualPitchOffset,
    /// A turbine has not as many blades as errors of their mounting.
    #[error(
        "`pitch_misalignment_deg` of {turbine} names {given} blades, and its rotor has {n_blades}; give one angle for each, 0 for a blade that is mounted right"
    )]
    Misalignment {
        /// Turbine.
        turbine: String,
        /// Blades for which an angle is given (–).
        given: usize,
        /// Blades of its rotor (–).
        n_blades: usize,
    },
    /// A turbine's instruments cannot be.
    #[error(transparent)]
    Instruments(#[from] InstrumentError),
    /// A further sensor of a turbine cannot be on this machine, or at this control interval.
    #[error(transparent)]
    Sensor(Box<SensorObjection>),
    /// The system has no more threads to give.
    #[error("no threads for the turbines")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A turbine model with the constants of its controller.
#[derive(Clone, Debug)]
pub struct TurbineModel {
    /// The machine.
    pub definition: Arc<Definition>,
    /// Torque and collective pitch.
    pub constants: Constants,
}

impl TurbineModel {
    /// What the layout needs to know, in a mean wind of `wind_speed` (m/s).
    pub fn footprint(&self, wind_speed: f64) -> Footprint {
        Footprint {
            diameter: self.definition.rotor_diameter(),
            hub_height: self.definition.rotor.hub_height,
            tip_speed: self.rotor_speed(wind_speed) * self.definition.rotor_radius(),
            rated_tip_speed: self.constants.rated_rotor_speed * self.definition.rotor_radius(),
        }
    }

    /// Rotor speed (rad/s) at which the turbine settles in a steady wind of `wind_speed` (m/s), below rated.
    pub fn rotor_speed(&self, wind_speed: f64) -> f64 {
        let radius = 0.5 * self.definition.rotor_diameter();
        (self.constants.optimal_tip_speed_ratio * wind_speed / radius)
            .clamp(self.constants.minimum_rotor_speed, self.constants.rated_rotor_speed)
    }

    /// Azimuth offset with which its individual pitch control works (rad), given or found; none where there
    /// is no such control.
    pub fn individual_pitch_offset(&self) -> Option<f64> {
        self.constants.individual_pitch.and_then(|control| control.azimuth_offset)
    }

    /// Whether the azimuth offset of its individual pitch control is yet to be found; not where there is no
    /// such control.
    pub fn lacks_individual_pitch_offset(&self) -> bool {
        self.constants.individual_pitch.is_some_and(|control| control.azimuth_offset.is_none())
    }

    /// The same with its individual pitch control, if there is one, switched off.
    pub fn without_individual_pitch(mut self) -> Self {
        self.constants.individual_pitch = None;
        self
    }
}

/// Smagorinsky's constant above a rough ground (–): with nineteen directions and 0.16 the slope of the mean
/// wind gives the friction velocity 7 % above the logarithmic law's, with the 0.12 of wakes in free air 20 %
/// below it; with twenty-seven directions both give too much, 19 and 15 % (docs/validation/flow.md).
pub const SMAGORINSKY_OVER_GROUND: f64 = 0.16;

/// Settings of the air of `site`, boxes of finer cells aside.
pub fn lattice_settings(site: &wind::Site) -> lattice::LatticeSettings {
    let wind::Site { case, plan, surroundings, .. } = *site;
    let mut settings = lattice::LatticeSettings::new(
        plan.origin,
        plan.spacing,
        plan.n_cells,
        plan.base_interval(),
        case.wind.speed,
    );
    settings.air_density = case.wind.air_density;
    settings.kinematic_viscosity = case.wind.kinematic_viscosity;
    let domain = case.flow.domain();
    settings.sides = match domain.sides {
        Sides::Periodic => lattice::Sides::Periodic,
        Sides::Slip => lattice::Sides::Slip,
        Sides::Open => lattice::Sides::Open,
    };
    match domain.ground {
        Ground::Slip => settings.ground = lattice::Ground::Slip,
        Ground::Rough { roughness_length } => {
            settings.ground = lattice::Ground::WallStress { roughness_length };
            settings.subgrid = lattice::Subgrid::smagorinsky(SMAGORINSKY_OVER_GROUND);
        }
    }
    domain.method.apply(&mut settings);
    settings.threads = case.flow.threads;
    settings.atmosphere = surroundings.map(|surroundings| surroundings.atmosphere(plan));
    settings
}

/// What runs on a turbine of `model` under `control`, at time steps of `plan`.
///
/// # Errors
/// [`AssemblyError::Control`] for a controller that cannot be built,
/// [`AssemblyError::NoIndividualPitchOffset`] when individual pitch control cannot know where its pitch acts.
pub fn controller(
    control: &Control,
    model: &TurbineModel,
    case: &Case,
    plan: &Plan,
) -> Result<Box<dyn Controller>, AssemblyError> {
    if model.lacks_individual_pitch_offset() {
        return Err(AssemblyError::NoIndividualPitchOffset);
    }
    Ok(control.build(&site(model, case, plan))?)
}

/// What a controller of a turbine of `model` is built for, at time steps of `plan`; Strouhal numbers are
/// taken with the case's wind speed and the first turbine's diameter.
pub fn site<'a>(model: &'a TurbineModel, case: &Case, plan: &Plan) -> Site<'a> {
    Site {
        constants: &model.constants,
        rotor: &model.definition,
        coefficients: coefficient_table,
        wind_speed: case.wind.speed,
        diameter: plan.diameter,
        air_density: case.wind.air_density,
        interval: plan.interval,
        duration: case.time.duration,
        flow_resolves_induction: case.flow.solver.resolves_induction,
    }
}

/// How turbine number `index` of `case`, of `model`, stands in the air when time begins; `tower` is what its
/// blades feel of its tower, where the air does not feel the tower itself.
pub(crate) fn turbine_settings(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    tower: Option<TowerInfluence>,
) -> turbine::TurbineSettings {
    let placement = &case.turbines[index];
    turbine::TurbineSettings {
        induction: induction(case, plan, index, tower),
        flexible: placement.flexible,
        air_density: case.wind.air_density,
        yaw: placement.yaw,
        rotor_speed: model.rotor_speed(case.wind.speed),
        azimuth: 0.0,
        pitch: model.constants.fine_pitch,
    }
}

/// Errors with which the blades of a turbine of `model` are mounted as `placement` says (rad).
///
/// # Errors
/// [`AssemblyError::Misalignment`].
pub fn misalignment(
    placement: &Placement,
    model: &TurbineModel,
) -> Result<PerBlade<f64>, AssemblyError> {
    let (given, n_blades) = (&placement.pitch_misalignment, model.definition.n_blades);
    if given.is_empty() {
        return Ok(PerBlade::splat(n_blades, 0.0));
    }
    if given.len() != n_blades {
        let turbine = placement.name.clone();
        return Err(AssemblyError::Misalignment { turbine, given: given.len(), n_blades });
    }
    Ok(PerBlade::from_fn(n_blades, |blade| given[blade]))
}

/// The farm of one run, at time zero: the turbines that are there in it, in the case's order, in `air`.
/// `models` holds one entry per turbine of the case, in its order, each [equipped](TurbineModel::equipped)
/// for the case; the farm's machines are those of [`Run::present`].
///
/// # Errors
/// [`AssemblyError`].
///
/// # Panics
/// When `air` and the descriptor of the case's flow solver disagree on whether the wind contains the rotors'
/// induction.
pub fn farm(
    case: &Case,
    run: &Run,
    plan: &Plan,
    models: &[TurbineModel],
    air: Air,
) -> Result<Farm<Air>, AssemblyError> {
    let solver = case.flow.solver;
    // Turbines make their induction as the solver's descriptor says: once, and only if the air itself agrees.
    assert_eq!(
        air.resolves_induction(),
        solver.resolves_induction,
        "flow.solver = \"{}\" and its air disagree on whether the wind contains the rotors' induction",
        solver.name
    );
    let mut machines = Vec::with_capacity(models.len());
    for index in run.present() {
        let (model, placement, foot) =
            (&models[index], &case.turbines[index], plan.positions[index]);
        let tower = tower_influence(model, placement, foot);
        let settings = turbine_settings(case, plan, model, index, tower);
        let turbine = Turbine::new(Arc::clone(&model.definition), foot, settings)?;
        let turbine = turbine.misaligned(misalignment(placement, model)?);
        let turbine = match placement.structure_step {
            Some(step) => turbine.with_structural_steps(step),
            None => turbine,
        };
        let turbine = in_air_of(solver, turbine);
        let control = controller(&run.control[index], model, case, plan)?;
        let sensing = sensing(case, plan, model, index)?;
        let machine = Machine::new(turbine, control).named(&placement.name);
        machines.push(machine.with_instruments(sensing));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(Farm::new(machines, air, plan.interval, case.flow.threads.unwrap_or(cores))?)
}

/// `turbine` with as much of its forces as the air of `solver` asks for.
pub(crate) fn in_air_of(solver: Solver, turbine: Turbine) -> Turbine {
    if solver.uses_bound_vortices { turbine } else { turbine.without_bound_vortices() }
}

/// What stands between turbine number `index` of `case`, of `model`, and its controller.
///
/// # Errors
/// [`AssemblyError`] for instruments that cannot be.
pub fn sensing(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
) -> Result<Sensing, AssemblyError> {
    let (placement, foot) = (&case.turbines[index], plan.positions[index]);
    let seed = sensing::seed_of_turbine(case.wind.seed, index);
    let mut sensing = Sensing::new(placement.instruments, seed)?;
    for mounted in &placement.sensors {
        let mount = Mount { definition: &model.definition, foot, interval: plan.interval, seed };
        let objections = mounted.kind.check_at(&mounted.values, &mount);
        if let Some(Objection { key, message, fix, .. }) = objections.into_iter().next() {
            let (turbine, sensor) = (placement.name.clone(), mounted.name.clone());
            let key = key.unwrap_or("kind");
            let objection = SensorObjection { turbine, sensor, key, message, fix };
            return Err(AssemblyError::Sensor(Box::new(objection)));
        }
        sensing = sensing.with_sensor(&mounted.name, mounted.kind.build(&mounted.values, &mount));
    }
    Ok(sensing)
}

/// The tower of a turbine of `model`, with its foot at `foot` (m), as its blades feel it; none where
/// `placement` asks for none.
fn tower_influence(
    model: &TurbineModel,
    placement: &Placement,
    foot: Vector3,
) -> Option<TowerInfluence> {
    let (potential, shadow) = match placement.tower_influence {
        AskedInfluence::None => return None,
        AskedInfluence::Potential => (Potential::Cylinder, false),
        AskedInfluence::PotentialWithDrag => (Potential::WithDrag, false),
        AskedInfluence::PotentialAndShadow => (Potential::Cylinder, true),
    };
    Some(TowerInfluence::new(&model.definition, foot, Effects { potential, shadow }))
}

/// Who makes the induction: the flow itself, or momentum theory with the wake's delay and its skew.
fn induction(case: &Case, plan: &Plan, index: usize, tower: Option<TowerInfluence>) -> Induction {
    let placement = &case.turbines[index];
    let dynamic_stall = placement.dynamic_stall;
    let solver = case.flow.solver;
    if solver.resolves_induction && solver.uses_bound_vortices {
        Induction::ByBoundVortices { dynamic_stall, tower }
    } else if solver.resolves_induction {
        let Smearing { length, sample_spacing } = (solver.smearing)(plan, index);
        Induction::ByFlow { smearing_length: length, sample_spacing, dynamic_stall }
    } else {
        Induction::ByMomentum(rotor::BemSettings {
            induction: delay(placement.dynamic_inflow),
            theory: Theory::default(),
            skewed_wake: true,
            dynamic_stall,
            tower,
        })
    }
}

/// How the wake's delay is modelled.
fn delay(given: DynamicInflow) -> aero::Induction {
    match given {
        DynamicInflow::None => aero::Induction::QuasiSteady,
        DynamicInflow::TwoConstant { slow_constant } => aero::Induction::TwoConstant(
            slow_constant.map_or_else(TwoConstant::varying, TwoConstant::fixed),
        ),
        DynamicInflow::SnelSchepers => aero::Induction::SnelSchepers(SnelSchepers::default()),
    }
}
