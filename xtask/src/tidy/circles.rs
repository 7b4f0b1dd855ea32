//! No file needs, through others, itself: circles of files inside a room.
//!
//! A file that others lie under may hold what they share and name them in turn: what a file needs from those
//! above it makes no circle. A name that a file only passes on (`pub use`, `use`) is looked up where it comes
//! from.

use super::Finding;
use super::exceptions::Exceptions;
use super::room::Modules;
use super::source::paths;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

type Name = Vec<String>;

/// Adds the circles of `modules` that `exceptions` do not allow; gives the files of all.
pub(super) fn check(
    modules: &Modules,
    exceptions: &Exceptions,
    findings: &mut Vec<Finding>,
) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for circle in circles(&edges(modules)) {
        let files: BTreeSet<PathBuf> =
            circle.iter().map(|name| modules[name].file.clone()).collect();
        found.extend(files.iter().cloned());
        if exceptions.circles.iter().any(|allowed| files.is_subset(&allowed.files)) {
            continue;
        }
        let list: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        let message = format!("needs itself, through others: a circle of {}", list.join(", "));
        let first = files.into_iter().next().unwrap_or_else(|| Path::new("").to_owned());
        findings.push(Finding { file: first, line: None, message });
    }
    found
}

/// Which files each file needs, apart from those above it and from tests.
fn edges(modules: &Modules) -> BTreeMap<&Name, BTreeSet<Name>> {
    let named: BTreeMap<&Name, Vec<Name>> = modules
        .iter()
        .map(|(name, module)| (name, absolute(modules, name, paths(module.product()))))
        .collect();
    let needs = |name: &Name| {
        let targets = named[name].iter().filter_map(|path| owner(modules, &named, path, 0));
        targets.filter(|target| !name.starts_with(target)).collect()
    };
    modules.keys().map(|name| (name, needs(name))).collect()
}

/// `paths` that `name` says, from the crate on; what is no part of the crate is left out.
fn absolute(modules: &Modules, name: &Name, paths: Vec<Vec<String>>) -> Vec<Name> {
    let from_crate = |path: Vec<String>| {
        let n_up = path.iter().take_while(|part| *part == "super").count();
        match path.first()?.as_str() {
            "crate" => Some(path[1..].to_vec()),
            "self" => Some([name.as_slice(), &path[1..]].concat()),
            "super" => Some([&name[..name.len().checked_sub(n_up)?], &path[n_up..]].concat()),
            first => {
                let below = [name.as_slice(), &[first.to_owned()]].concat();
                modules.contains_key(&below).then(|| [name.as_slice(), path.as_slice()].concat())
            }
        }
    };
    paths.into_iter().filter_map(from_crate).collect()
}

/// The module that `path` (from the crate on) leads to, past modules that only pass a name on.
fn owner(
    modules: &Modules,
    named: &BTreeMap<&Name, Vec<Name>>,
    path: &Name,
    n_passed: usize,
) -> Option<Name> {
    let n_known = (0..=path.len()).rev().find(|n| modules.contains_key(&path[..*n]))?;
    let (module, item) = (path[..n_known].to_vec(), path.get(n_known));
    let passed_on = item.filter(|item| *item != "*").and_then(|item| {
        let from = named.get(&module)?;
        from.iter().find(|other| other.last() == Some(item) && *other != path)
    });
    match passed_on {
        // Names passed on in a ring, as by a macro, end somewhere.
        Some(other) if n_passed < 8 => owner(modules, named, other, n_passed + 1),
        _ => Some(module),
    }
}

/// Groups of two and more that all need each other.
fn circles(edges: &BTreeMap<&Name, BTreeSet<Name>>) -> Vec<BTreeSet<Name>> {
    let reach = |from: &Name| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(name) = next.pop() {
            for target in edges.get(&name).into_iter().flatten() {
                if seen.insert(target.clone()) {
                    next.push(target.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&Name, BTreeSet<Name>> =
        edges.keys().map(|name| (*name, reach(name))).collect();
    let mut circles: Vec<BTreeSet<Name>> = Vec::new();
    for (name, targets) in &reached {
        if !targets.contains(*name) || circles.iter().any(|circle| circle.contains(*name)) {
            continue;
        }
        let back = |other: &&Name| reached.get(*other).is_some_and(|back| back.contains(*name));
        circles.push(targets.iter().filter(back).cloned().collect());
    }
    circles
}
