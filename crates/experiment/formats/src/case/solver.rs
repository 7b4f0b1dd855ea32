//! `[flow]`: what moves the air, its own keys and those of all, read and written.

use super::document::{Value, find};
use super::keys;
use super::section::Section;
use super::values::{assignments, values_of};
use basis::keys::Key;
use farm::case::{Flow, Solver};
use std::fmt::Write;

/// The flow solver of the file `root`, with what its keys hold.
pub(super) fn flow_of(root: &Section) -> Flow {
    let solver = solver_of(root);
    let table = keys::flow(solver);
    let section = root.section("flow", table);
    // Notes what is no solver.
    section.choice("solver");
    let values = values_of(&section, solver.keys);
    let place_of = |key: Option<&str>| section.span_of(key.unwrap_or("solver"));
    section.findings().object("flow", place_of, (solver.check)(&values));
    // What other solvers would use has to be right all the same: one file is read for several of them.
    let is_others = |key: &&Key| {
        let ours = solver.keys.iter().chain(&keys::FLOW_COMMON);
        section.has(key.name)
            && key.name != "solver"
            && !ours.map(|k| k.name).any(|n| n == key.name)
    };
    let others: Vec<Key> = table.keys.iter().filter(is_others).copied().collect();
    values_of(&section, &others);
    let threads = section.optional_whole("threads");
    Flow {
        solver,
        values,
        step: section.optional_number("step"),
        threads: threads.and_then(|count| usize::try_from(count).ok()),
    }
}

/// The solver that the file `root` names; the one that holds without a choice where it names none that is
/// known.
fn solver_of(root: &Section) -> Solver {
    let named = || match &root.entry("flow")?.node.value {
        Value::Table(entries) => match &find(entries, "solver")?.node.value {
            Value::Text(name) => Solver::named(name),
            _ => None,
        },
        _ => None,
    };
    named().unwrap_or_default()
}

/// Writes the section of `flow`, with the keys of its solver alone.
pub(super) fn write_flow(text: &mut String, flow: &Flow) -> std::fmt::Result {
    writeln!(text, "\n[flow]\nsolver = \"{}\"", flow.solver.name)?;
    for key in assignments(&flow.values) {
        writeln!(text, "{key}")?;
    }
    if let Some(step) = flow.step {
        writeln!(text, "step = {step:?}")?;
    }
    if let Some(threads) = flow.threads {
        writeln!(text, "threads = {threads}")?;
    }
    Ok(())
}
