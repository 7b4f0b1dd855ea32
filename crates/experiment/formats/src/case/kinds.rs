//! Tables whose key `kind` says which keys they have: controllers and sensors, each with its own table of
//! keys.

use super::document::{Entry, Value as Written, find};
use super::error::ProblemKind;
use super::findings::Findings;
use super::section::Section;
use super::spelling::nearest;
use super::write::quoted;
use basis::keys::{Holds, Objection, Table, Value, Values};
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
    let values = values_of(&section, table_of(kind));
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

/// What the keys of `table` hold in `section`, defaults included, in the order of the table.
fn values_of(section: &Section, table: &Table) -> Values {
    let mut values = Values::default();
    for key in table.keys {
        let read = match key.holds {
            Holds::Number(_) => section.optional_number(key.name).map(Value::Number),
            Holds::Whole { .. } => section.optional_whole(key.name).map(Value::Whole),
            Holds::Choice(_) if section.has(key.name) => {
                Some(Value::Text(section.choice(key.name).to_owned()))
            }
            Holds::Choice(_) => {
                section.entry(key.name);
                None
            }
            Holds::Pair(_) => {
                section.entry(key.name).map(|_| Value::Numbers(section.pair(key.name).to_vec()))
            }
            Holds::Numbers(_) => {
                section.entry(key.name).map(|_| Value::Numbers(section.numbers(key.name)))
            }
            _ => section.optional_text(key.name).map(Value::Text),
        };
        values.extend(read.map(|value| (key.name, value)).or_else(|| key.default()));
    }
    values
}

impl<K: ?Sized> Kinded<'_, K> {
    /// Notes `objections`, each at its key.
    pub(super) fn note(&self, objections: Vec<Objection>) {
        for Objection { key, message, label, fix } in objections {
            let entry = find(self.entries, key.unwrap_or("kind"));
            let span = entry.map_or(self.span.clone(), |entry| entry.node.span.clone());
            let message = match key {
                Some(key) => format!("`{}.{key}` {message}", self.path),
                None => message,
            };
            self.findings.note(span, ProblemKind::Objection { message, label }, Some(fix));
        }
    }
}

/// `{ kind = "KIND", key = value, … }`: what reads back as `values`.
pub(super) fn text(kind: &str, values: &Values) -> String {
    let mut text = format!("{{ kind = {}", quoted(kind));
    for (key, value) in values.iter() {
        let value = match value {
            Value::Number(number) => format!("{number:?}"),
            Value::Whole(number) => number.to_string(),
            Value::Text(word) => quoted(word),
            Value::Numbers(numbers) => format!("{numbers:?}"),
        };
        text += &format!(", {key} = {value}");
    }
    text + " }"
}
