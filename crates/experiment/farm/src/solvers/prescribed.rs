//! `uniform`, `turbulence`, `planes`: the wind is prescribed, and turbines make their own induction by
//! momentum theory.

use super::{Alone, Fault, Objection, Smearing, SolverError, SolverKind, Start, WindSource};
use crate::air::Air;
use crate::case::{Flow, Shear, Wind};
use crate::self_check::Tunnel;
use crate::{plan, wind};
use flow::inflow::{MeanProfile, PrescribedWind};
use std::sync::Arc;

/// What kinds share in which the wind is prescribed; a base for others.
pub const PRESCRIBED: SolverKind = SolverKind {
    name: "prescribed",
    about: "wind that the turbines do not change",
    limits: "",
    keys: &[],
    check: |_| Vec::new(),
    wind: WindSource::Deterministic,
    stands_in_atmosphere: false,
    resolves_induction: false,
    has_wakes: false,
    smearing: |_, _| Smearing { length: 0.0, sample_spacing: 0.0 },
    uses_bound_vortices: false,
    most_filaments: None,
    needs_self_check: false,
    tunnel: |plan, _| Tunnel::of_study(plan),
    equivalent_speed: |_, _, _, _| 1.0,
    objections: |_, _| Vec::new(),
    warnings: |_, _| Vec::new(),
    sound_speed: |_| None,
    plan: plan::without_cells,
    reach: |_, _| 0.0,
    memory: |_, _| 0,
    less_memory: "time.duration, for which turbulence is made",
    steadier: "a shorter flow.step may carry it",
    begin,
    begin_alone,
    updates_alone: |_, _| 1.0,
};

/// The mean profile.
pub static UNIFORM: SolverKind = SolverKind {
    name: "uniform",
    about: "prescribed wind without turbulence: the mean profile with `wind.veer_deg_per_m` and `wind.event`, or `wind.table`",
    objections: uniform_objections,
    ..PRESCRIBED
};

/// The mean profile with turbulence made for it.
pub static TURBULENCE: SolverKind = SolverKind {
    name: "turbulence",
    about: "prescribed wind: the mean profile with turbulence on it",
    wind: WindSource::AroundRotors,
    objections: turbulence_objections,
    ..PRESCRIBED
};

/// Planes of wind from a file.
pub static PLANES: SolverKind = SolverKind {
    name: "planes",
    about: "prescribed wind from the file `wind.planes`",
    wind: WindSource::Planes,
    objections: planes_objections,
    ..PRESCRIBED
};

fn begin(start: Start) -> Result<Air, SolverError> {
    let solver = start.site.case.flow.solver;
    if start.site.case.wind_source() == WindSource::Planes && start.planes.is_none() {
        return Err(SolverError::NoPlanes { solver: solver.name });
    }
    Ok(Box::new(wind::prescribed(&start.site, start.inflow, start.planes, start.progress)?))
}

fn begin_alone(alone: &Alone) -> Result<Air, SolverError> {
    let profile = MeanProfile::Uniform { speed: alone.wind.speed };
    Ok(Box::new(PrescribedWind::everywhere(Arc::new(profile))))
}

pub(super) fn uniform_objections(wind: &Wind, _: &Flow) -> Vec<Objection> {
    let why = "flow.solver = \"uniform\" reads no wind from a file";
    Vec::from_iter(wind.planes.is_some().then(|| no_file(why)))
}

pub(super) fn turbulence_objections(wind: &Wind, _: &Flow) -> Vec<Objection> {
    let file = wind.planes.is_some().then(|| no_file("flow.solver = \"turbulence\" makes its own"));
    let event = wind.event.is_some().then(|| no_event("events are for wind without turbulence"));
    file.into_iter().chain(event).collect()
}

pub(super) fn planes_objections(wind: &Wind, _: &Flow) -> Vec<Objection> {
    const AS_IT_IS: &str = "the wind is taken as the file has it";
    let no_use = |key, fix| Objection { key, fault: Fault::NoUse(AS_IT_IS), fix };
    let mut objections = Vec::new();
    if wind.planes.is_none() {
        let fix = "flow.solver = \"planes\" reads the wind from a file: planes = \"field.bts\"";
        let fault = Fault::Missing("wind.planes");
        objections.push(Objection { key: "speed", fault, fix });
    }
    if matches!(wind.shear, Shear::LogLaw { .. }) {
        objections.push(no_use("roughness_length", "leave it out"));
    }
    if wind.veer != 0.0 {
        objections.push(no_use("veer_deg_per_m", "leave it out, or take another flow.solver"));
    }
    if wind.event.is_some() {
        objections.push(no_event(AS_IT_IS));
    }
    objections
}

fn no_file(why: &'static str) -> Objection {
    let fix = "leave it out, or use flow.solver = \"planes\" or \"lattice\"";
    Objection { key: "planes", fault: Fault::NoUse(why), fix }
}

fn no_event(why: &'static str) -> Objection {
    let fix = "leave it out, or use flow.solver = \"uniform\"";
    Objection { key: "event", fault: Fault::NoUse(why), fix }
}
