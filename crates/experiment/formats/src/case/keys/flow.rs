//! Keys of `[flow]`: what moves the air, what the kinds of flow solver need, what all need.

use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Key, Slip, Table, from, key};
use farm::case::Solver;
use farm::solvers::{SOLVERS, SolverKind};
use std::sync::{Mutex, PoisonError};

/// Keys that all solvers have.
pub(in crate::case) static COMMON: [Key; 2] = [
    key(
        "step",
        from(1e-4, 10.0),
        "s",
        Otherwise("chosen from tip speed and wind speed; 0.02 s in prescribed wind, less for rotors that turn faster than 24 times a minute"),
        "Time step of the flow, which is the control interval too.",
    )
    .mistaken(&[Slip { unit: "ms", factor: 0.001 }]),
    key(
        "threads",
        Holds::Whole { least: 1, most: 1024 },
        "–",
        Otherwise("all cores"),
        "Threads. The result does not depend on it.",
    ),
];

/// `[flow]` of a case whose air `solver` moves. Keys of other solvers may stand there too; where they have
/// names that `solver` knows, they are what they are to `solver`.
pub(in crate::case) fn flow(solver: Solver) -> &'static Table {
    // Tables of keys last as long as the process: one for each solver, and anew when a kind was added.
    static MADE: Mutex<Vec<(&str, usize, &Table)>> = Mutex::new(Vec::new());
    let kinds = SOLVERS.all();
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let known = made.iter().find(|(name, n, _)| *name == solver.name && *n == kinds.len());
    if let Some((.., table)) = known {
        return table;
    }
    let table: &'static Table = Box::leak(Box::new(Table {
        heading: "[flow]",
        about: "The flow solver. The domain is sized from the layout; lengths are in diameters of the first turbine.",
        keys: keys_of(solver, &kinds).leak(),
    }));
    made.push((solver.name, kinds.len(), table));
    table
}

/// `solver`, the keys of all `kinds`, each name once, and those that all have.
fn keys_of(solver: Solver, kinds: &[&SolverKind]) -> Vec<Key> {
    let names: &'static [&'static str] =
        kinds.iter().map(|kind| kind.name).collect::<Vec<_>>().leak();
    let mut keys = vec![key(
        "solver",
        Holds::Choice(names),
        "",
        Value("\"lattice\""),
        "The flow solver. The page docs/case-file.md says under `flow.solver` what each does and which keys it alone uses.",
    )];
    let own = |name: &str| solver.keys.iter().find(|key| key.name == name);
    let of_kinds = kinds.iter().flat_map(|kind| kind.keys).chain(solver.keys);
    for key in of_kinds {
        let is_known = keys.iter().chain(&COMMON).any(|other| other.name == key.name);
        if !is_known {
            keys.push(*own(key.name).unwrap_or(key));
        }
    }
    keys.extend(COMMON);
    keys
}
