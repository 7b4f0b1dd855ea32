//! `[flow]`: what moves the air, its own keys and those of all, read and written.

use super::CaseFile;
use super::document::{Value, find};
use super::keys;
use super::objection::entries_of;
use super::section::Section;
use super::values::{assignments, values_of};
use basis::keys::Key;
use farm::case::{Flow, Solver};
use farm::solvers::{SOLVERS, SolverKind};
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
    let is_others = |key: &&Key| section.has(key.name) && !is_used(solver, key.name);
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

/// Whether `solver` reads the key `name` of `[flow]`.
fn is_used(solver: Solver, name: &str) -> bool {
    name == "solver" || solver.keys.iter().chain(&keys::FLOW_COMMON).any(|key| key.name == name)
}

/// That `[flow]` of the case of `file` has keys which its solver does not read, but others do; none where
/// there are no such keys. They are no error, so that one file can be run with several solvers.
pub fn unused_flow_keys(file: &CaseFile) -> Option<String> {
    let solver = file.case.flow.solver;
    let entries = entries_of(file)?;
    let Value::Table(flow) = &find(&entries, "flow")?.node.value else { return None };
    let names = flow.iter().map(|entry| entry.key.as_str());
    let unused: Vec<&str> = names.filter(|name| !is_used(solver, name)).collect();
    let reads = |kind: &&&'static SolverKind| unused.iter().any(|name| is_used(Solver(kind), name));
    let kinds = SOLVERS.all();
    let readers: Vec<String> =
        kinds.iter().filter(reads).map(|kind| format!("\"{}\"", kind.name)).collect();
    let keys: Vec<String> = unused.iter().map(|name| format!("flow.{name}")).collect();
    let (verb, them) = if keys.len() == 1 { ("has", "it") } else { ("have", "them") };
    (!keys.is_empty()).then(|| {
        format!(
            "{} {verb} no effect with flow.solver = \"{}\", for {} to read; leave {them} out, or use that solver",
            keys.join(", "),
            solver.name,
            readers.join(" and ")
        )
    })
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
