//! `lattice`: the flow is resolved by lattice-Boltzmann large-eddy simulation.

use super::{Alone, Fault, Objection, Smearing, SolverError, SolverKind, Start, WindSource};
use crate::air::Air;
use crate::assemble::lattice_settings;
use crate::case::{Case, Flow, TurbulenceModel, Wind};
use crate::domain::{self, SMEARING_CELLS, Sides};
use crate::plan::{self, Layout, Plan, PlanError};
use crate::refinement;
use crate::self_check::Tunnel;
use crate::wind::Site;
use basis::keys::Key;
use flow::lattice::atmosphere::Atmosphere;
use flow::lattice::refinement::{Refined, Refinement, RefinementError, check};
use flow::lattice::{Lattice, LatticeError};
use std::f64::consts::FRAC_PI_4;
use turbine::blockage::equivalent_speed_ratio;

/// Bytes of a cell in the flow field beside its populations of four bytes, boundaries included.
const FURTHER_BYTES: u64 = 4;

/// Cells per diameter below which wakes are smeared (–).
const CELLS_TO_WARN: f64 = 16.0;
/// Memory of a cell whose eddies follow from the wind of neighbours (bytes): that wind and a viscosity, 16,
/// and what lies beyond the ends of rows of some sixty cells and more.
const EDDY_BYTES: u64 = 20;
/// Memory of a cell for its temperature, and for the viscosity of its eddies besides (bytes), as precursors
/// have it.
const TEMPERATURE_BYTES: u64 = 34;
const WARM_EDDY_BYTES: u64 = 4;

/// Temperature of an atmosphere of which nothing is known yet (K).
const ANY_TEMPERATURE: f64 = 288.15;

/// Those of a box of cells, and that of finer ones in it.
static KEYS: [Key; domain::KEYS.len() + 1] = {
    let mut keys = [refinement::KEY; domain::KEYS.len() + 1];
    let mut n = 0;
    while n < domain::KEYS.len() {
        keys[n] = domain::KEYS[n];
        n += 1;
    }
    keys
};

/// Lattice-Boltzmann large-eddy simulation, which feels the turbines.
pub static LATTICE: SolverKind = SolverKind {
    name: "lattice",
    about: "lattice Boltzmann large-eddy simulation with actuator lines; turbines are in each other's wakes",
    limits: "",
    keys: &KEYS,
    check: |values| [refinement::check(values), domain::check(values)].concat(),
    wind: WindSource::AtInlet,
    stands_in_atmosphere: true,
    resolves_induction: true,
    has_wakes: true,
    smearing: |plan, index| Smearing {
        length: SMEARING_CELLS * plan.spacing_at(index),
        sample_spacing: plan.spacing_at(index),
    },
    uses_bound_vortices: false,
    most_filaments: None,
    needs_self_check: true,
    tunnel: |plan, _| Tunnel::of_study(plan),
    equivalent_speed: in_a_channel,
    objections,
    warnings,
    sound_speed: |plan| Some(plan::LATTICE_SOUND_SPEED * plan.spacing / plan.base_interval()),
    plan: lay_out,
    reach: |_, _| 0.0,
    memory,
    less_memory: "flow.cells_per_diameter, or the domain: flow.width_diameters, flow.height_diameters",
    steadier: "a shorter flow.step or more cells (flow.cells_per_diameter) may carry it",
    begin,
    begin_alone,
    updates_alone: |tunnel, diameter| tunnel.n_cells(diameter).iter().product::<usize>() as f64,
};

fn lay_out(case: &Case, layout: &Layout) -> Result<Plan, PlanError> {
    let plan = plan::in_a_box(case, layout)?;
    check_cells(case, &plan)?;
    Ok(plan)
}

/// Whether the lattice takes the domain of `plan` and its boxes: what it would refuse when a run begins. Room
/// around boxes is seen to where they are laid out, with a fix for each. None is too thin for temperature: a
/// box has a diameter each way, and that has eight cells.
///
/// # Errors
/// [`PlanError`] with the key that decides.
fn check_cells(case: &Case, plan: &Plan) -> Result<(), PlanError> {
    let mut settings = lattice_settings(&Site { case, plan, models: &[], surroundings: None });
    // Which atmosphere it is the precursor tells later; that there is one decides on the boxes' room now.
    settings.atmosphere = case.wind.precursor.as_ref().map(|_| Atmosphere::new(ANY_TEMPERATURE));
    // Threads have a check of their own, which knows where they were asked for.
    settings.threads = None;
    let of = |boxes: &[Refinement], place, fix| {
        check(&settings, boxes).map_err(|error| match error {
            RefinementError::Lattice(LatticeError::Roughness { roughness_length, highest }) => {
                // To the millimetre below, so that what is printed can be taken.
                let highest = (highest * 1e3).floor() * 1e-3;
                PlanError::RoughGround { roughness_length, highest, place, fix }
            }
            error => PlanError::Cells { place, reason: error.to_string().into() },
        })
    };
    of(&[], "flow", "lower flow.cells_per_diameter")?;
    of(&plan.boxes, "flow.refinement", "lower flow.cells_per_diameter, or leave out a box")
}

fn begin(start: Start) -> Result<Air, SolverError> {
    let settings = lattice_settings(&start.site);
    let boxes = &start.site.plan.boxes;
    if boxes.is_empty() {
        return Ok(Box::new(Lattice::new(settings, start.inflow)?));
    }
    Ok(Box::new(Refined::new(settings, boxes, start.inflow)?))
}

fn memory(case: &Case, plan: &Plan) -> u64 {
    let is_stratified = case.wind.precursor.is_some();
    let of_eddies = match (plan.method.subgrid.needs_neighbours(), is_stratified) {
        (true, false) => EDDY_BYTES,
        // Wind and a diffusivity are kept with the temperature already.
        (true, true) => WARM_EDDY_BYTES,
        (false, _) => 0,
    };
    let of_temperature = if is_stratified { TEMPERATURE_BYTES } else { 0 };
    let bytes = 4 * plan.method.stencil.n_directions() + FURTHER_BYTES + of_eddies + of_temperature;
    plan.cells() as u64 * bytes + plan.exchange_memory(is_stratified)
}

fn begin_alone(alone: &Alone) -> Result<Air, SolverError> {
    let Alone { tunnel, wind, diameter, flow } = *alone;
    Ok(Box::new(tunnel.air(wind, diameter, flow.threads)?))
}

/// The speed-up between the walls of `tunnel`, as [`SolverKind::equivalent_speed`] has it.
fn in_a_channel(tunnel: &Tunnel, _: &Flow, diameter: f64, thrust_coefficient: f64) -> f64 {
    let width = tunnel.n_cells(diameter)[1] as f64 * tunnel.spacing;
    let area_ratio = FRAC_PI_4 * (diameter / width).powi(2);
    equivalent_speed_ratio(thrust_coefficient, area_ratio)
}

fn warnings(case: &Case, plan: &Plan) -> Vec<String> {
    let level = plan.levels.iter().copied().min().unwrap_or(0);
    let cells = case.flow.domain().cells_per_diameter * f64::from(1_u32 << level);
    let coarse = || {
        format!(
            "{cells:.0} cells per diameter are coarse: wakes mix later than they should; 16 and more are for results"
        )
    };
    Vec::from_iter((cells < CELLS_TO_WARN).then(coarse))
}

fn objections(wind: &Wind, flow: &Flow) -> Vec<Objection> {
    let mut objections = Vec::new();
    let mut object = |key, fault, fix| objections.push(Objection { key, fault, fix });
    if wind.turbulence_model == TurbulenceModel::Kaimal {
        let why =
            "Kaimal's turbulence has divergence, which the lattice would turn into pressure waves";
        let fix = "take turbulence_model = \"mann\", or flow.solver = \"turbulence\"";
        object("turbulence_model", Fault::Refused(why), fix);
    }
    let in_atmosphere = wind.precursor.is_some();
    if wind.veer != 0.0 && in_atmosphere {
        let why = "the atmosphere of wind.precursor brings its own veer";
        object("veer_deg_per_m", Fault::NoUse(why), "leave one of the two out");
    } else if wind.veer != 0.0 && wind.planes.is_some() {
        let why = "the file of wind.planes brings its own veer";
        object("veer_deg_per_m", Fault::NoUse(why), "leave one of the two out");
    } else if in_atmosphere && flow.domain().sides == Sides::Slip {
        let why = "its wind veers, and would blow through sides along which the air is to slip";
        let fix = "use flow.sides = \"periodic\" or \"open\"";
        object("precursor", Fault::Refused(why), fix);
    } else if wind.veer != 0.0 && flow.domain().sides == Sides::Slip {
        let why = "a wind that veers blows through sides along which the air is to slip";
        let fix = "leave it out, or use flow.sides = \"periodic\"";
        object("veer_deg_per_m", Fault::NoUse(why), fix);
    }
    if wind.event.is_some() {
        let why = "flow.solver = \"lattice\" would answer it with pressure waves";
        object("event", Fault::NoUse(why), "leave it out, or use flow.solver = \"uniform\"");
    }
    objections
}
