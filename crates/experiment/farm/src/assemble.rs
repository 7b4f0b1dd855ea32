//! From case to farm: turbines, controllers and air put together.

use crate::air::Air;
use crate::case::Meandering as MeanderingSettings;
use crate::case::PhaseSync as PhaseSyncSettings;
use crate::case::TowerInfluence as AskedInfluence;
use crate::case::{
    Case, Control, DynamicInflow, Ground, PhaseEstimator, Placement, Run, Sides, Solver,
};
use crate::plan::{Footprint, Plan};
use crate::{Farm, Machine};
use basis::Vector3;
use basis::angle::wrap_to_turn;
use control::baseline::{Baseline, Constants};
use control::meandering::{self, Decoupling, MeanderingError, TwoAxisSettings};
use control::phase_sync::{self, SyncSettings};
use control::{
    Excitation, Helix, Meandering, PhaseSync, Pulse, TurbineController, excitation_rate,
};
use estimation::helix::{HelixSettings, Options, Wake};
use estimation::phase_locked;
use estimation::{EstimationError, HelixEstimator};
use flow::lattice;
use sensing::{InstrumentError, Sensing};
use std::f64::consts::TAU;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::{SnelSchepers, TwoConstant};
use turbine::aero::tower_influence::{Effects, Potential};
use turbine::aero::{self, TowerInfluence, rotor};
use turbine::structure::StructureError;
use turbine::{Definition, Induction, Turbine};

/// Why no farm could be put together.
#[derive(Debug, thiserror::Error)]
pub enum AssemblyError {
    /// A model's masses, stiffnesses or mode shapes make no structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// The phase of a helix cannot be sought as asked.
    #[error("the phase of the helix cannot be estimated")]
    Estimation(#[from] EstimationError),
    /// Meandering cannot be followed as asked.
    #[error("the meandering cannot be followed")]
    Meandering(#[from] MeanderingError),
    /// Nobody found how pitch acts on the loads.
    #[error("how pitch acts on the loads was neither given nor found before")]
    NotDecoupled,
    /// Nobody found the azimuth offset of a turbine that joins a helix.
    #[error("the azimuth offset with which it pitches was neither given nor found before")]
    NoAzimuthOffset,
    /// Nobody found the azimuth offset of a turbine's individual pitch control.
    #[error(
        "the azimuth offset of its individual pitch control was neither given nor found before; give `azimuth_offset_deg` in `individual_pitch` of its turbine file's [controller]"
    )]
    NoIndividualPitchOffset,
    /// An excitation that fades out before it has faded in.
    #[error(
        "stop = {stop} s comes before the excitation is whole: it starts at {start} s and fades in over one period of {period:.1} s; stop at {earliest} s or later, or leave `stop` out"
    )]
    StopsTooEarly {
        /// Asked stop (s).
        stop: f64,
        /// Start (s).
        start: f64,
        /// Excitation period (s).
        period: f64,
        /// Earliest stop, in whole seconds (s).
        earliest: f64,
    },
    /// A turbine's instruments cannot be.
    #[error(transparent)]
    Instruments(#[from] InstrumentError),
    /// The system has no more threads to give.
    #[error("no threads for the turbines")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A turbine model with the constants of its controller.
#[derive(Clone, Debug)]
pub struct Model {
    /// The machine.
    pub definition: Arc<Definition>,
    /// Torque and collective pitch.
    pub constants: Constants,
}

impl Model {
    /// What the layout needs to know, in a mean wind of `wind_speed` (m/s).
    pub fn footprint(&self, wind_speed: f64) -> Footprint {
        Footprint {
            diameter: self.definition.rotor_diameter(),
            hub_height: self.definition.rotor.hub_height,
            tip_speed: self.rotor_speed(wind_speed) * self.definition.rotor_radius(),
        }
    }

    /// Rotor speed (rad/s) at which the turbine settles in a steady wind of `wind_speed` (m/s), below rated.
    pub fn rotor_speed(&self, wind_speed: f64) -> f64 {
        let radius = 0.5 * self.definition.rotor_diameter();
        (self.constants.optimal_tip_speed_ratio * wind_speed / radius)
            .clamp(self.constants.minimum_rotor_speed, self.constants.rated_rotor_speed)
    }

    /// Azimuth offset with which its individual pitch control works (rad), given or found; none where there is no such control.
    pub fn individual_pitch_offset(&self) -> Option<f64> {
        self.constants.individual_pitch.and_then(|control| control.azimuth_offset)
    }

    /// Whether the azimuth offset of its individual pitch control is yet to be found; not where there is no such control.
    pub fn lacks_individual_pitch_offset(&self) -> bool {
        self.constants.individual_pitch.is_some_and(|control| control.azimuth_offset.is_none())
    }

    /// The same with its individual pitch control, if there is one, switched off.
    pub fn without_individual_pitch(mut self) -> Self {
        self.constants.individual_pitch = None;
        self
    }
}

/// Gaussian width over cell size (–): two cells is the least that the lattice carries without ringing.
pub const SMEARING_CELLS: f64 = 2.0;

/// Smagorinsky's constant above a rough ground (–): with 0.16 the friction velocity lies within 3 % of the logarithmic law's,
/// with the 0.12 of wakes in free air 20 % below it (docs/validation/flow.md).
pub const SMAGORINSKY_OVER_GROUND: f64 = 0.16;

/// Settings of the air for `plan`.
pub fn lattice_settings(case: &Case, plan: &Plan) -> lattice::Settings {
    let mut settings = lattice::Settings::new(
        plan.origin,
        plan.spacing,
        plan.n_cells,
        plan.interval,
        case.wind.speed,
    );
    settings.air_density = case.wind.air_density;
    settings.kinematic_viscosity = case.wind.kinematic_viscosity;
    settings.sides = match case.flow.sides {
        Sides::Periodic => lattice::Sides::Periodic,
        Sides::Slip => lattice::Sides::Slip,
    };
    match case.flow.ground {
        Ground::Slip => settings.ground = lattice::Ground::Slip,
        Ground::Rough { roughness_length } => {
            settings.ground = lattice::Ground::WallStress { roughness_length };
            settings.smagorinsky = SMAGORINSKY_OVER_GROUND;
        }
    }
    settings.threads = case.flow.threads;
    settings
}

/// What runs on a turbine of `model`, at time steps of `plan`; Strouhal numbers are taken with the case's wind speed and the first turbine's diameter.
///
/// # Errors
/// [`AssemblyError::Estimation`] when the phase of a helix cannot be sought as asked, [`AssemblyError::NoAzimuthOffset`] when it
/// cannot be joined, [`AssemblyError::NoIndividualPitchOffset`] when individual pitch control cannot be told where its pitch acts,
/// [`AssemblyError::Meandering`] and [`AssemblyError::NotDecoupled`] when meandering cannot be followed,
/// [`AssemblyError::StopsTooEarly`] for an excitation that ends before it has begun.
pub fn controller(
    control: &Control,
    model: &Model,
    case: &Case,
    plan: &Plan,
) -> Result<TurbineController, AssemblyError> {
    if model.lacks_individual_pitch_offset() {
        return Err(AssemblyError::NoIndividualPitchOffset);
    }
    let (wind_speed, diameter) = (case.wind.speed, plan.diameter);
    let excitation = match control {
        Control::Baseline | Control::Absent => Excitation::None,
        Control::Helix(asked) => {
            let mut helix =
                Helix::new(asked.sense, asked.amplitude, asked.strouhal, wind_speed, diameter);
            helix.phase = asked.phase;
            helix.azimuth_offset = asked.azimuth_offset;
            helix.start = asked.start;
            helix.stop = stop_of(asked.start, asked.stop, helix.rate)?;
            Excitation::Helix(helix)
        }
        Control::Pulse(asked) => {
            let mut pulse = Pulse::new(asked.amplitude, asked.strouhal, wind_speed, diameter);
            pulse.phase = asked.phase;
            pulse.start = asked.start;
            pulse.stop = stop_of(asked.start, asked.stop, pulse.rate)?;
            Excitation::Pulse(pulse)
        }
        Control::PhaseSync(asked) => {
            let setting = estimator_setting(asked, case, plan);
            let options = estimator_options(asked.estimator, case.flow.solver);
            let options = asked.noise.apply(options);
            let options = asked.calibration.map_or(options, |found| found.apply(options));
            let estimator = HelixEstimator::new(&model.definition, &setting, options)?;
            let settings = SyncSettings {
                sense: asked.sense,
                amplitude: asked.amplitude,
                rate: setting.rate,
                offset: wrap_to_turn(asked.offset),
                azimuth_offset: asked.azimuth_offset.ok_or(AssemblyError::NoAzimuthOffset)?,
                start: asked.start,
                trust: asked.fallback.then_some(phase_sync::TRUST),
            };
            Excitation::PhaseSync(Box::new(PhaseSync::new(settings, estimator)))
        }
        Control::Meandering(asked) => {
            let settings = meandering_settings(asked, case, plan)?;
            Excitation::Meandering(Box::new(Meandering::new(settings, plan.interval)?))
        }
    };
    Ok(TurbineController::new(Baseline::new(model.constants.clone()), excitation))
}

/// The `stop` (s) of an excitation of `rate` (rad/s) that begins at `start` (s), which is to be whole before it ends.
fn stop_of(start: f64, stop: Option<f64>, rate: f64) -> Result<Option<f64>, AssemblyError> {
    let period = TAU / rate;
    match stop {
        Some(stop) if stop < start + period => {
            let earliest = (start + period).ceil();
            Err(AssemblyError::StopsTooEarly { stop, start, period, earliest })
        }
        stop => Ok(stop),
    }
}

/// What meandering control is told.
fn meandering_settings(
    asked: &MeanderingSettings,
    case: &Case,
    plan: &Plan,
) -> Result<meandering::Settings, AssemblyError> {
    let rate = |strouhal| excitation_rate(strouhal, case.wind.speed, plan.diameter);
    let signal = phase_locked::PhaseLockedSettings::between(asked.strouhal.map(rate));
    let watches = asked.amplitude == 0.0;
    let decoupling = match asked.decoupling {
        Some(decoupling) => decoupling,
        // Nothing is pitched.
        None if watches => Decoupling { azimuth_offset: 0.0, delay: 0.0, gain: 1.0 },
        None => return Err(AssemblyError::NotDecoupled),
    };
    Ok(meandering::Settings {
        follower: TwoAxisSettings { signal, sense: asked.sense, leader: asked.leader },
        followed: asked.followed,
        factor: asked.factor,
        reference: asked.reference,
        decoupling,
        bandwidth: asked.bandwidth,
        proportional: 0.0,
        maximum_amplitude: asked.amplitude,
        maximum_offset: if watches { 0.0 } else { asked.offset },
        needs_lock: asked.fallback,
        start: asked.start,
    })
}

/// What the phase estimator of `sync` is told.
pub fn estimator_setting(sync: &PhaseSyncSettings, case: &Case, plan: &Plan) -> HelixSettings {
    HelixSettings {
        sense: sync.sense,
        rate: excitation_rate(sync.strouhal, case.wind.speed, plan.diameter),
        interval: plan.interval,
        air_density: case.wind.air_density,
        n_elements: HelixSettings::N_ELEMENTS,
    }
}

/// Choices of an estimator in the air of `solver`, before calibration, with its own noise.
pub fn estimator_options(estimator: PhaseEstimator, solver: Solver) -> Options {
    match estimator {
        PhaseEstimator::Robust if solver.is_prescribed() => {
            // Momentum theory keeps the wake's delay with the blade, solved air where the blade has passed.
            let mut options = Options::default();
            options.rotor.wake = Wake::WithBlades { time_factor: 1.0 };
            options
        }
        PhaseEstimator::Robust => Options::default(),
        PhaseEstimator::Published => Options::published(),
    }
}

/// How a turbine of `model` at `placement` stands in the air when time begins; `tower` is what its blades feel of its tower,
/// where the wind is prescribed.
pub(crate) fn turbine_settings(
    case: &Case,
    plan: &Plan,
    model: &Model,
    placement: &Placement,
    tower: Option<TowerInfluence>,
) -> turbine::TurbineSettings {
    turbine::TurbineSettings {
        induction: induction(case, plan, placement, tower),
        flexible: placement.flexible,
        air_density: case.wind.air_density,
        rotor_speed: model.rotor_speed(case.wind.speed),
        azimuth: 0.0,
        pitch: model.constants.fine_pitch,
    }
}

/// The farm of one run, at time zero: the turbines that are there in it, in the case's order, in `air`. `models` holds one
/// entry per turbine of the case, in its order, each [equipped](Model::equipped) for the case; the farm's machines are those of [`Run::present`].
///
/// # Errors
/// [`AssemblyError`].
pub fn farm(
    case: &Case,
    run: &Run,
    plan: &Plan,
    models: &[Model],
    air: Air,
) -> Result<Farm<Air>, AssemblyError> {
    let mut machines = Vec::with_capacity(models.len());
    for index in run.present() {
        let (model, placement, foot) =
            (&models[index], &case.turbines[index], plan.positions[index]);
        let tower = tower_influence(model, placement, foot);
        let settings = turbine_settings(case, plan, model, placement, tower);
        let turbine = Turbine::new(Arc::clone(&model.definition), foot, settings)?;
        let control = controller(&run.control[index], model, case, plan)?;
        let seed = sensing::seed_of_turbine(case.wind.seed, index);
        let sensing = Sensing::new(placement.instruments, seed)?;
        machines.push(Machine::new(turbine, control).with_instruments(sensing));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(Farm::new(machines, air, plan.interval, case.flow.threads.unwrap_or(cores))?)
}

/// The tower of a turbine of `model`, with its foot at `foot` (m), as its blades feel it; none where `placement` asks for none.
fn tower_influence(model: &Model, placement: &Placement, foot: Vector3) -> Option<TowerInfluence> {
    let (potential, shadow) = match placement.tower_influence {
        AskedInfluence::None => return None,
        AskedInfluence::Potential => (Potential::Cylinder, false),
        AskedInfluence::PotentialWithDrag => (Potential::WithDrag, false),
        AskedInfluence::PotentialAndShadow => (Potential::Cylinder, true),
    };
    Some(TowerInfluence::new(&model.definition, foot, Effects { potential, shadow }))
}

/// Who solves the induction: the lattice itself, or momentum theory with the wake's delay and its skew.
fn induction(
    case: &Case,
    plan: &Plan,
    placement: &Placement,
    tower: Option<TowerInfluence>,
) -> Induction {
    let dynamic_stall = placement.dynamic_stall;
    match case.flow.solver {
        Solver::Lattice => Induction::ByFlow {
            smearing_length: SMEARING_CELLS * plan.spacing,
            sample_spacing: plan.spacing,
            dynamic_stall,
        },
        Solver::Uniform | Solver::Turbulence | Solver::Planes => {
            Induction::ByMomentum(rotor::BemSettings {
                induction: delay(placement.dynamic_inflow),
                theory: Theory::default(),
                skewed_wake: true,
                dynamic_stall,
                tower,
            })
        }
    }
}

/// How the wake's delay is modelled.
fn delay(asked: DynamicInflow) -> aero::Induction {
    match asked {
        DynamicInflow::None => aero::Induction::QuasiSteady,
        DynamicInflow::TwoConstant { slow_constant } => aero::Induction::TwoConstant(
            slow_constant.map_or_else(TwoConstant::varying, TwoConstant::fixed),
        ),
        DynamicInflow::SnelSchepers => aero::Induction::SnelSchepers(SnelSchepers::default()),
    }
}
