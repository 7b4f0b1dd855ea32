//! The turbulence that enters a lattice: how much of it is needed, and its making.

use crate::StudyError;
use crate::air;
use crate::prepared::Prepared;
use crate::watcher::Watcher;
use farm::Plan;
use farm::assemble::Model;
use farm::case::{Case, Solver};
use flow::Inflow;
use flow::inflow::sizing::Need;
use flow::inflow::turbulent::BLOCKING_HEIGHT;
use flow::inflow::{TurbulentInflow, mann, size_box};
use std::cell::RefCell;
use std::sync::Arc;

/// Most memory that the turbulence may take (bytes); a longer run then meets the same wind again, and is warned of it.
const MEMORY_LIMIT: u64 = 6 << 30;

/// Whether the inlet of a lattice is fed from a box of turbulence.
fn needs_box(case: &Case) -> bool {
    case.flow.solver == Solver::Lattice && case.wind.turbulence_intensity > 0.0
}

/// What the inlet needs of the turbulence: the box of air at the start, then a plane for every later step.
fn need(case: &Case, plan: &Plan) -> Need {
    let [length, width, height] = plan.n_cells.map(|n| n as f64 * plan.spacing);
    Need {
        length,
        width,
        height,
        hub_speed: case.wind.speed,
        duration: case.time.duration,
        spacing: plan.spacing,
        length_scale: case.wind.length_scale,
        memory_limit: MEMORY_LIMIT,
    }
}

/// Memory that the turbulence of `case` takes at most (bytes).
pub(crate) fn memory(case: &Case, plan: &Plan, models: &[Model]) -> u64 {
    if needs_box(case) {
        size_box(&need(case, plan)).peak_memory
    } else {
        air::made_grid(case, plan, models).map_or(0, |grid| grid.memory)
    }
}

/// A warning where the same turbulence comes again before the end of the run.
pub(crate) fn returns(case: &Case, plan: &Plan, models: &[Model]) -> Option<String> {
    if needs_box(case) {
        let size = size_box(&need(case, plan));
        return (!size.covers).then(|| {
            format!(
                "the turbulence returns after {:.0} s: more would not fit in memory",
                size.repeats_after
            )
        });
    }
    let time = air::made_grid(case, plan, models)?.repeats_after?;
    Some(format!(
        "the turbulence returns after {time:.0} s: more would not fit in the memory that one turbine may take; for a longer one \
         write a file with `wakemix inflow generate` and read it with flow.solver = \"planes\""
    ))
}

/// The wind that enters, with the turbulence of the case where it is a lattice that has some.
///
/// # Errors
/// [`StudyError::Inflow`] when it cannot be made.
pub(crate) fn inflow(
    prepared: &Prepared,
    watcher: &mut dyn Watcher,
) -> Result<Arc<dyn Inflow>, StudyError> {
    let (case, plan) = (&prepared.case, &prepared.plan);
    if !needs_box(case) {
        return Ok(Arc::clone(&prepared.mean_inflow));
    }
    let wind = &case.wind;
    let size = size_box(&need(case, plan));
    let settings = mann::Settings {
        n_points: size.n_points,
        spacing: size.spacing,
        length_scale: wind.length_scale,
        anisotropy: wind.anisotropy,
        standard_deviation: wind.turbulence_intensity * wind.speed,
        seed: wind.seed,
        threads: case.flow.threads,
    };
    let watcher = RefCell::new(watcher);
    let turbulence = mann::generate(&settings, |share| {
        watcher.borrow_mut().preparing("turbulence", share);
    })?;
    let inflow = TurbulentInflow::aligned(Arc::new(turbulence), prepared.profile(), plan.origin)?;
    let inflow = inflow.blocked(BLOCKING_HEIGHT * wind.length_scale);
    Ok(Arc::new(inflow.veering(wind.veer, plan.hub_height)))
}
