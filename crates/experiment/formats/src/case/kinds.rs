//! Tables whose key `kind` says which keys they have: controllers, sensors and further outputs, each with its
//! own table of keys.

use super::document::{Entry, Value as Written, find};
use super::error::ProblemKind;
use super::findings::Findings;
use super::section::{Section, is_name};
use super::spelling::nearest;
use super::text::quoted;
use super::values::{assignments, values_of};
use basis::keys::{Objection, Table, Values};
use basis::registry::{Named, Registry};
use std::ops::Range;

/// The table of one kind as it stands in the file: the kind, its keys read one by one, and its place.
pub(super) struct Kinded<'a, K: ?Sized + 'static> {
    pub(super) kind: &'static K,
    pub(super) values: Values,
    path: String,
    entries: &'a [Entry],
    span: Range<usize>,
    findings: &'a Findings<'a>,
}

/// Reads the table of `entries` at `path`, of one of the kinds of `registry`, whose `table_of` gives their
/// keys; `what` says what the kind means. None where there is no such kind, which is noted.
pub(super) fn read<'a, K: Named + ?Sized>(
    registry: &Registry<K>,
    table_of: impl Fn(&K) -> &'static Table,
    what: &str,
    entries: &'a [Entry],
    (span, path): (Range<usize>, String),
    findings: &'a Findings<'a>,
) -> Option<Kinded<'a, K>> {
    let kind = kind_of(registry, what, entries, (&span, &path), findings)?;
    let own: Vec<Entry> = entries.iter().filter(|entry| entry.key != "kind").cloned().collect();
    let section = Section::open(table_of(kind), &own, span.clone(), path.clone(), findings);
    let values = values_of(&section, table_of(kind).keys);
    Some(Kinded { kind, values, path, entries, span, findings })
}

fn kind_of<K: Named + ?Sized>(
    registry: &Registry<K>,
    what: &str,
    entries: &[Entry],
    (span, path): (&Range<usize>, &str),
    findings: &Findings,
) -> Option<&'static K> {
    let key = format!("{path}.kind");
    let names: Vec<&str> = registry.all().iter().map(|kind| kind.name()).collect();
    let known = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let expected = format!("one of {known}");
    let Some(entry) = find(entries, "kind") else {
        let fix = format!("add it: {what}");
        findings.note(span.clone(), ProblemKind::Missing { key }, Some(fix));
        return None;
    };
    let Written::Text(name) = &entry.node.value else {
        let found = entry.node.kind().to_owned();
        let kind = ProblemKind::WrongType { key, expected, found };
        findings.note(entry.node.span.clone(), kind, None);
        return None;
    };
    let kind = registry.find(name);
    if kind.is_none() {
        let fix = nearest(name, names.iter().copied().filter(|name| name.len() > 3))
            .map_or(expected, |name| format!("did you mean \"{name}\"?"));
        let problem = ProblemKind::UnknownChoice { key, value: name.clone(), known };
        findings.note(entry.node.span.clone(), problem, Some(fix));
    }
    kind
}

impl<K: ?Sized> Kinded<'_, K> {
    /// Dotted path of the table.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Place of what stands under `key`, of the table where there is no such key.
    pub(super) fn place_of(&self, key: &str) -> Range<usize> {
        find(self.entries, key).map_or(self.span.clone(), |entry| entry.node.span.clone())
    }

    /// Notes `objections`, each at its key.
    pub(super) fn note(&self, objections: Vec<Objection>) {
        let place_of = |key: Option<&str>| self.place_of(key.unwrap_or("kind"));
        self.findings.object(&self.path, place_of, objections);
    }
}

/// Reads the tables under `key` of `section`, each with a name of its own and of one of the kinds of
/// `registry`; the rest is as for [`read`].
pub(super) fn named<'a, K: Named + ?Sized>(
    section: &Section<'a>,
    key: &str,
    registry: &Registry<K>,
    table_of: impl Fn(&K) -> &'static Table,
    what: &str,
) -> Vec<(String, Kinded<'a, K>)> {
    let Some(entry) = section.entry(key) else { return Vec::new() };
    let Written::Table(entries) = &entry.node.value else {
        let expected = format!("tables, such as {key}.NAME = {{ kind = … }}");
        section.wrong_type(key, &entry.node, &expected);
        return Vec::new();
    };
    let findings = section.findings();
    let read_one = |entry: &'a Entry| {
        let (name, span) = (entry.key.clone(), entry.node.span.clone());
        let path = format!("{}.{name}", section.key_path(key));
        if !is_name(&name) {
            let kind = ProblemKind::BadName { key: path.clone(), name: name.clone() };
            findings.note(entry.key_span.clone(), kind, Some("give it another name".to_owned()));
        }
        let Written::Table(inner) = &entry.node.value else {
            let expected = "a table, such as { kind = … }".to_owned();
            let found = entry.node.kind().to_owned();
            findings.note(span, ProblemKind::WrongType { key: path, expected, found }, None);
            return None;
        };
        Some((name, read(registry, &table_of, what, inner, (span, path), findings)?))
    };
    entries.iter().filter_map(read_one).collect()
}

/// `{ kind = "KIND", key = value, … }`: what reads back as `values`.
pub(super) fn text(kind: &str, values: &Values) -> String {
    let keys: String = assignments(values).map(|key| format!(", {key}")).collect();
    format!("{{ kind = {}{keys} }}", quoted(kind))
}
