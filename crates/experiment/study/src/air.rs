//! The air that a run starts with.

use crate::StudyError;
use crate::atmosphere;
use crate::companion::companion;
use crate::prepared::Prepared;
use farm::Air;
use farm::case::Case;
use farm::precursor::Accompanied;
use farm::solvers::{SolverError, Start, WindSource};
use farm::wind::Site;
use flow::Inflow;
use flow::inflow::{InflowError, Planes};
use flow::lattice::refinement::RefinementError;
use formats::FileError;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The air of the study `setup` at time zero, which `inflow` enters; `progress` receives the share of its
/// turbulence that is made, and a break ends that.
///
/// # Errors
/// [`StudyError`] when its solver cannot be set up, turbulence cannot be made, or a file of wind cannot be
/// read or does not cover the rotors; [`StudyError::Inflow`] after a break.
pub(crate) fn begin(
    setup: &Prepared,
    inflow: &Arc<dyn Inflow>,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Air, StudyError> {
    let planes =
        if setup.case.wind_source() == WindSource::Planes { Some(planes(setup)?) } else { None };
    let start = Start { site: setup.site(), inflow: Arc::clone(inflow), planes, progress };
    beside(setup, start).map_err(|error| told(setup, error))
}

/// The air of `start`, that of `setup`, which the wind of a precursor enters that goes on beside it, where
/// one is to.
fn beside(setup: &Prepared, start: Start) -> Result<Air, StudyError> {
    let Some(companion) = companion(&setup.case, setup.folder())? else {
        return begun(start);
    };
    let companion = Arc::new(companion);
    let inflow = Arc::clone(&companion) as Arc<dyn Inflow>;
    let air = begun(Start { inflow, ..start })?;
    Ok(Box::new(Accompanied::new(air, companion)))
}

/// The air of `case`, that of `setup`, in which on return the wind is steady: neither turbulence nor planes,
/// but that of a precursor beside it, and the planes of a solver that knows no other wind.
///
/// # Errors
/// [`StudyError`] when its solver cannot be set up, or its planes cannot be read.
pub(crate) fn steady(setup: &Prepared, case: &mut Case) -> Result<Air, StudyError> {
    case.wind.turbulence_intensity = 0.0;
    case.wind.planes = None;
    let planes = if case.wind_source() == WindSource::Planes {
        case.wind.planes = setup.case.wind.planes.clone();
        Some(planes(setup)?)
    } else {
        None
    };
    let site = Site { case, ..setup.site() };
    let inflow = Arc::clone(&setup.mean_inflow);
    beside(setup, Start { site, inflow, planes, progress: &|_| ControlFlow::Continue(()) })
}

fn begun(start: Start) -> Result<Air, StudyError> {
    (start.site.case.flow.solver.begin)(start).map_err(|error| match error {
        SolverError::Lattice(error) | SolverError::Refinement(RefinementError::Lattice(error)) => {
            error.into()
        }
        SolverError::Refinement(error) => StudyError::Solver(Box::new(error)),
        SolverError::Inflow(error) => error.into(),
        error @ SolverError::Wake(_) => StudyError::Solver(Box::new(error)),
        SolverError::Other(error) => StudyError::Solver(error),
        error @ SolverError::NoPlanes { .. } => StudyError::Solver(Box::new(error)),
    })
}

/// The recorded planes of wind that `setup` names, as much of them as it takes.
///
/// # Errors
/// [`StudyError::File`] when they cannot be read, or do not hold any more what is taken.
pub(crate) fn planes(setup: &Prepared) -> Result<Box<dyn Planes>, StudyError> {
    let planes = atmosphere::open_planes(&setup.case, setup.folder())?;
    let cut = atmosphere::cut(&setup.case, &setup.plan, planes);
    Ok(cut.map_err(|error| of_cut(setup, error.to_string(), "record it again"))?)
}

/// That what `setup` takes of the file of its planes is not what it needs.
fn of_cut(setup: &Prepared, problem: String, fix: &str) -> FileError {
    let name = setup.case.wind.planes.as_deref().unwrap_or_default();
    FileError::content("a part of recorded wind", &setup.folder().join(name), problem, fix)
}

/// `error` of the air of `setup`, with the keys of its cut where that ends before the run does.
fn told(setup: &Prepared, error: StudyError) -> StudyError {
    match error {
        StudyError::Inflow(InflowError::Ended { length, time })
            if setup.case.wind.cut.is_some() =>
        {
            let problem =
                format!("wind.cut takes {length:.1} s of it, and the run needs {time:.1} s");
            let fix = "raise wind.cut.duration, or lower time.duration";
            of_cut(setup, problem, fix).into()
        }
        error => error,
    }
}

/// Begins the wind that `setup` reads from a file, where it does, and lets it go: what is wrong with the
/// file, or does not fit the rotors, shows here and not when a run begins.
///
/// # Errors
/// Those of [`begin`].
pub(crate) fn try_recorded(setup: &Prepared) -> Result<(), StudyError> {
    if setup.case.wind_source() == WindSource::Planes {
        begin(setup, &setup.mean_inflow, &|_| ControlFlow::Continue(()))?;
    }
    Ok(())
}
