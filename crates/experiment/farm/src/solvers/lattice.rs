//! `lattice`: the flow is resolved by lattice-Boltzmann large-eddy simulation.

use super::{Alone, Fault, Objection, Smearing, SolverError, SolverKind, Start, WindSource};
use crate::air::Air;
use crate::assemble::{SMEARING_CELLS, lattice_settings};
use crate::case::{Flow, Sides, TurbulenceModel, Wind};
use crate::plan;
use basis::keys::LeftOut::{Required, Value};
use basis::keys::{Holds, Key, Slip, Table, above, from, key};
use flow::lattice::Lattice;

/// Bytes of a cell in the flow field, boundaries included.
const CELL_BYTES: u64 = 80;

/// Lattice-Boltzmann large-eddy simulation, which feels the turbines.
pub static LATTICE: SolverKind = SolverKind {
    name: "lattice",
    about: "lattice Boltzmann large-eddy simulation with actuator lines; turbines feel each other's wakes",
    keys: &KEYS,
    wind: WindSource::AtInlet,
    resolves_induction: true,
    has_wakes: true,
    smearing: |plan| Smearing {
        length: SMEARING_CELLS * plan.spacing,
        sample_spacing: plan.spacing,
    },
    needs_self_check: true,
    objections,
    plan: plan::in_a_box,
    memory: |plan| plan.cells() as u64 * CELL_BYTES,
    begin,
    begin_alone,
    updates_alone: |tunnel, diameter| tunnel.n_cells(diameter).iter().product::<usize>() as f64,
};

static KEYS: [Key; 7] = [
    key(
        "cells_per_diameter",
        from(8.0, 200.0),
        "–",
        Value("16"),
        "Cells across the first rotor: the one figure that trades time for detail. Time grows with its fourth power.",
    ),
    key(
        "upstream_diameters",
        from(1.0, 50.0),
        "D",
        Value("3"),
        "Air upstream of the foremost turbine.",
    ),
    key(
        "downstream_diameters",
        from(1.0, 100.0),
        "D",
        Value("4"),
        "Air downstream of the last turbine.",
    ),
    key(
        "width_diameters",
        from(2.0, 100.0),
        "D",
        Value("6"),
        "Width of the domain, on top of the lateral spread of the layout. Narrow domains block the flow.",
    ),
    key("height_diameters", from(1.0, 50.0), "D", Value("4"), "Height of the domain."),
    key(
        "ground",
        Holds::Ground(&GROUND),
        "",
        Value("\"slip\""),
        "`\"slip\"`: the air slips along the ground. `{ roughness_length = 0.001 }`: wall stress after the logarithmic law.",
    ),
    key(
        "sides",
        Holds::Choice(&["periodic", "slip"]),
        "",
        Value("\"periodic\""),
        "`periodic`: what leaves on one side enters on the other. `slip`: the air slips along them.",
    ),
];

/// `flow.ground` of a rough ground.
pub static GROUND: Table = Table {
    heading: "flow.ground = { … }",
    about: "A rough ground.",
    keys: &[key(
        "roughness_length",
        above(0.0, 5.0),
        "m",
        Required,
        "Roughness length z₀: about 0.0002 on calm sea, 0.001 on open sea, 0.03 on farmland.",
    )
    .mistaken(&[Slip { unit: "mm", factor: 0.001 }])],
};

fn begin(start: Start) -> Result<Air, SolverError> {
    let settings = lattice_settings(start.site.case, start.site.plan);
    Ok(Box::new(Lattice::new(settings, start.inflow)?))
}

fn begin_alone(alone: &Alone) -> Result<Air, SolverError> {
    let Alone { tunnel, wind, diameter, threads } = *alone;
    Ok(Box::new(tunnel.air(wind, diameter, threads)?))
}

fn objections(wind: &Wind, flow: &Flow) -> Vec<Objection> {
    let mut objections = Vec::new();
    let mut object = |key, fault, fix| objections.push(Objection { key, fault, fix });
    if wind.planes.is_some() {
        let why = "flow.solver = \"lattice\" reads no wind from a file";
        object("planes", Fault::NoUse(why), "leave it out, or take flow.solver = \"planes\"");
    }
    if wind.turbulence_model == TurbulenceModel::Kaimal {
        let why = "Kaimal's turbulence has divergence, which the lattice would turn into sound";
        let fix = "take turbulence_model = \"mann\", or flow.solver = \"turbulence\"";
        object("turbulence_model", Fault::Refused(why), fix);
    }
    if wind.veer != 0.0 && flow.sides == Sides::Slip {
        let why = "a wind that veers blows through sides along which the air is to slip";
        let fix = "leave it out, or take flow.sides = \"periodic\"";
        object("veer_deg_per_m", Fault::NoUse(why), fix);
    }
    if wind.event.is_some() {
        let why = "the air of flow.solver = \"lattice\" would answer it with sound";
        object("event", Fault::NoUse(why), "leave it out, or take flow.solver = \"uniform\"");
    }
    objections
}
