//! What shows only once the turbines are known, pointed at in the case file all the same.

use super::CaseFile;
use super::document::{self, Entry, Node, Value, find, named};
use super::error::{CaseError, Problem, ProblemKind};
use super::sources::Sources;
use super::sweep;
use std::ops::Range;

/// That the case of `file` cannot be run for the reason in `message`, which the key at `path` decides: keys
/// from the top, a name where several tables stand under one heading. The arrow points at as much of the path
/// as the file has.
pub fn objection(file: &CaseFile, path: &[&str], message: String) -> CaseError {
    let name = file.path.display().to_string();
    let (sources, tree) = tree_of(file, &name);
    let span = tree.and_then(|entries| place(&entries, path)).unwrap_or(0..0);
    let problem = Problem::new(&sources, span, ProblemKind::Unfit { message });
    CaseError::Invalid { name, problems: vec![problem] }
}

/// The tree of the study of `file`; none where its text is no case file.
pub(super) fn entries_of(file: &CaseFile) -> Option<Vec<Entry>> {
    tree_of(file, &file.path.display().to_string()).1
}

fn tree_of(file: &CaseFile, name: &str) -> (Sources, Option<Vec<Entry>>) {
    let (sources, document) = document::parse(name, &file.text, &file.overrides);
    let expanded = document.and_then(|entries| sweep::expand(entries, file.text.len(), &sources));
    let tree = expanded.ok().and_then(|expanded| expanded.studies.into_iter().nth(file.study));
    (sources, tree)
}

fn place(entries: &[Entry], path: &[&str]) -> Option<Range<usize>> {
    let (first, rest) = path.split_first()?;
    let entry = find(entries, first)?;
    Some(within(&entry.node, rest).unwrap_or_else(|| entry.key_span.clone()))
}

fn within(node: &Node, path: &[&str]) -> Option<Range<usize>> {
    match &node.value {
        _ if path.is_empty() => Some(node.span.clone()),
        Value::Table(entries) => place(entries, path),
        Value::List(items) => {
            let by_name = items.iter().find(|item| named(item, path[0]));
            let item = by_name.or_else(|| items.get(path[0].parse::<usize>().ok()?))?;
            within(item, &path[1..]).or_else(|| Some(item.span.clone()))
        }
        _ => None,
    }
}
