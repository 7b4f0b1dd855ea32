//! One table of the file, read key by key against the table of keys.

use super::document::{Entry, Node, Value, find};
use super::error::ProblemKind;
use super::findings::Findings;
use super::spelling::{list, nearest};
use basis::keys::{Holds, Key, LeftOut, Range, Table};
use std::ops;

/// Tables under one heading at most (–): what the turbines do in the runs takes memory by the product of
/// both.
const MOST_TABLES: usize = 1000;
/// Characters of a name at most (–).
pub(super) const LONGEST_NAME: usize = 64;

/// One table of the file. Reading notes what is wrong and goes on with a value that passes every check.
pub(super) struct Section<'a> {
    table: &'static Table,
    entries: &'a [Entry],
    span: ops::Range<usize>,
    path: String,
    findings: &'a Findings<'a>,
}

impl<'a> Section<'a> {
    /// The table of `entries` that stands at `path` (dotted, empty for the whole file); notes unknown keys.
    pub(super) fn open(
        table: &'static Table,
        entries: &'a [Entry],
        span: ops::Range<usize>,
        path: String,
        findings: &'a Findings<'a>,
    ) -> Self {
        let section = Self { table, entries, span, path, findings };
        for entry in entries {
            // To look for what may have been meant takes longer than to read.
            if !findings.are_full() && !table.keys.iter().any(|key| key.name == entry.key) {
                let kind = ProblemKind::UnknownKey { key: section.key_path(&entry.key) };
                findings.note(entry.key_span.clone(), kind, Some(section.suggest(&entry.key)));
            }
        }
        section
    }

    fn suggest(&self, misspelt: &str) -> String {
        let names = || self.table.keys.iter().map(|key| key.name);
        match (self.table.renamed(misspelt), nearest(misspelt, names())) {
            (Some(name), _) => format!("it is called `{name}` now"),
            (_, Some(name)) => format!("did you mean `{name}`?"),
            _ => format!("{} knows {}", self.table.heading, list(names())),
        }
    }

    /// The section of `key`, which holds `table`; of no entries when it is left out or no table.
    pub(super) fn section(&self, key: &str, table: &'static Table) -> Section<'a> {
        let path = self.key_path(key);
        match self.entry(key).map(|entry| &entry.node) {
            Some(Node { value: Value::Table(entries), span }) => {
                Section::open(table, entries, span.clone(), path, self.findings)
            }
            other => {
                let span = other.map_or(self.span.clone(), |node| node.span.clone());
                if let Some(node) = other {
                    self.wrong_type(key, node, "a table");
                }
                // Nothing more can be said of what is not there.
                Section { table, entries: &[], span, path, findings: self.findings }
            }
        }
    }

    /// The sections of `key`, one per `[[key]]`; notes when there is none.
    pub(super) fn sections(&self, key: &str, table: &'static Table) -> Vec<Section<'a>> {
        let expected = format!("one {} or more", table.heading);
        let Some(entry) = self.entry(key) else { return Vec::new() };
        let Value::List(items) = &entry.node.value else {
            self.wrong_type(key, &entry.node, &expected);
            return Vec::new();
        };
        if items.is_empty() {
            self.wrong_type(key, &entry.node, &expected);
        }
        if items.len() > MOST_TABLES {
            let value = format!("{} tables", items.len());
            let range = format!("at most {MOST_TABLES}");
            let kind = ProblemKind::OutOfRange { key: self.key_path(key), value, range };
            let fix = "split it into several case files";
            self.findings.note(entry.node.span.clone(), kind, Some(fix.into()));
            return Vec::new();
        }
        let mut sections = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let Value::Table(entries) = &item.value else {
                self.wrong_type(key, item, "a table");
                continue;
            };
            let name = match find(entries, "name").map(|entry| &entry.node.value) {
                Some(Value::Text(name)) => name.clone(),
                _ => index.to_string(),
            };
            let path = format!("{}.{name}", self.key_path(key));
            sections.push(Section::open(table, entries, item.span.clone(), path, self.findings));
        }
        sections
    }

    /// The entry of `key`; notes when it is missing but must be there.
    pub(super) fn entry(&self, key: &str) -> Option<&'a Entry> {
        let entry = find(self.entries, key);
        if entry.is_none() && matches!(self.key(key).left_out, LeftOut::Required) {
            let kind = ProblemKind::Missing { key: self.key_path(key) };
            let about = self.key(key).about;
            self.findings.note(self.span.clone(), kind, Some(format!("add it: {about}")));
        }
        entry
    }

    /// Whether `key` stands in the file.
    pub(super) fn has(&self, key: &str) -> bool {
        find(self.entries, key).is_some()
    }

    /// Place of the value of `key`, of the table when it is not there.
    pub(super) fn span_of(&self, key: &str) -> ops::Range<usize> {
        find(self.entries, key).map_or(self.span.clone(), |entry| entry.node.span.clone())
    }

    /// A number; not a number when what stands there is wrong.
    pub(super) fn number(&self, key: &str) -> f64 {
        self.optional_number(key).or_else(|| self.default(key)?.parse().ok()).unwrap_or(f64::NAN)
    }

    /// A number that may be left out.
    pub(super) fn optional_number(&self, key: &str) -> Option<f64> {
        let Holds::Number(range) = self.key(key).holds else { return None };
        self.entry(key).map(|entry| self.number_in(key, range, &entry.node))
    }

    fn number_in(&self, key: &str, range: Range, node: &Node) -> f64 {
        let value = match node.value {
            Value::Number(value) => value,
            Value::Whole(Some(value)) => value as f64,
            _ => {
                self.wrong_type(key, node, "a number");
                return f64::NAN;
            }
        };
        if range.contains(value) {
            return value;
        }
        let spec = self.key(key);
        let kind = ProblemKind::OutOfRange {
            key: self.key_path(key),
            value: format!("{value}"),
            range: range.describe(spec.name, spec.unit),
        };
        self.findings.note(node.span.clone(), kind, Some(fix_of(spec, range, value)));
        f64::NAN
    }

    /// A whole number; 1 when what stands there is wrong.
    pub(super) fn whole(&self, key: &str) -> u64 {
        self.optional_whole(key).or_else(|| self.default(key)?.parse().ok()).unwrap_or(1)
    }

    /// A whole number that may be left out.
    pub(super) fn optional_whole(&self, key: &str) -> Option<u64> {
        let Holds::Whole { least, most } = self.key(key).holds else { return None };
        let entry = self.entry(key)?;
        let Value::Whole(value) = entry.node.value else {
            self.wrong_type(key, &entry.node, "a whole number");
            return None;
        };
        let fitting = value.and_then(|value| u64::try_from(value).ok());
        let value = fitting.filter(|value| (least..=most).contains(value));
        if value.is_none() {
            let written = match entry.node.value {
                Value::Whole(Some(value)) => value.to_string(),
                _ => "too long a number".to_owned(),
            };
            let range = format!("{least} <= {key} <= {most}");
            let kind = ProblemKind::OutOfRange { key: self.key_path(key), value: written, range };
            self.findings.note(entry.node.span.clone(), kind, None);
        }
        value
    }

    /// Any text that may be left out.
    pub(super) fn optional_text(&self, key: &str) -> Option<String> {
        let entry = self.entry(key)?;
        let Value::Text(text) = &entry.node.value else {
            self.wrong_type(key, &entry.node, "text in quotes");
            return None;
        };
        let is_bad = match self.key(key).holds {
            Holds::Name => !is_name(text),
            Holds::Folder => !is_folder(text),
            _ => false,
        };
        if is_bad {
            let kind = ProblemKind::BadName { key: self.key_path(key), name: text.clone() };
            let fix = Some(format!("try \"{}\"", tidied(text)));
            self.findings.note(entry.node.span.clone(), kind, fix);
        }
        Some(text.clone())
    }

    /// A text; empty when what stands there is wrong.
    pub(super) fn text(&self, key: &str) -> String {
        self.optional_text(key).unwrap_or_default()
    }

    /// One of the words of the key; the default, or else the first one, when what stands there is wrong.
    pub(super) fn choice(&self, key: &str) -> &'static str {
        let Holds::Choice(words) = self.key(key).holds else { return "" };
        let default = self.default(key).map(|default| default.trim_matches('"'));
        let fallback =
            words.iter().copied().find(|word| Some(*word) == default).unwrap_or(words[0]);
        let Some(entry) = self.entry(key) else { return fallback };
        let expected = || format!("one of {}", quoted(words));
        let Value::Text(text) = &entry.node.value else {
            self.wrong_type(key, &entry.node, &expected());
            return fallback;
        };
        words.iter().copied().find(|word| word == text).unwrap_or_else(|| {
            let known = quoted(words);
            let kind =
                ProblemKind::UnknownChoice { key: self.key_path(key), value: text.clone(), known };
            // Between words as short as "cw" and "ccw" a guess would as often be the wrong one.
            let candidates = words.iter().copied().filter(|word| word.len() > 3);
            let fix = nearest(text, candidates)
                .map_or_else(expected, |word| format!("did you mean \"{word}\"?"));
            self.findings.note(entry.node.span.clone(), kind, Some(fix));
            fallback
        })
    }

    /// Two numbers; not numbers when what stands there is wrong.
    pub(super) fn pair(&self, key: &str) -> [f64; 2] {
        let Holds::Pair(range) = self.key(key).holds else { return [f64::NAN; 2] };
        let Some(entry) = self.entry(key) else { return [f64::NAN; 2] };
        match &entry.node.value {
            Value::List(items) if items.len() == 2 => {
                [self.number_in(key, range, &items[0]), self.number_in(key, range, &items[1])]
            }
            _ => {
                self.wrong_type(key, &entry.node, "two numbers, such as [5.0, 0.0]");
                [f64::NAN; 2]
            }
        }
    }

    /// Any count of numbers.
    pub(super) fn numbers(&self, key: &str) -> Vec<f64> {
        let Holds::Numbers(range) = self.key(key).holds else { return Vec::new() };
        let Some(entry) = self.entry(key) else { return Vec::new() };
        let Value::List(items) = &entry.node.value else {
            self.wrong_type(key, &entry.node, "a list of numbers, such as [2.0, 4.0]");
            return Vec::new();
        };
        items.iter().map(|item| self.number_in(key, range, item)).collect()
    }

    /// Any count of names, each with its place.
    fn names(&self, key: &str) -> Vec<(String, ops::Range<usize>)> {
        let expected = "a list of names, such as [\"T2\"]";
        let Some(entry) = self.entry(key) else { return Vec::new() };
        let Value::List(items) = &entry.node.value else {
            self.wrong_type(key, &entry.node, expected);
            return Vec::new();
        };
        items
            .iter()
            .filter_map(|item| match &item.value {
                Value::Text(name) => Some((name.clone(), item.span.clone())),
                _ => {
                    self.wrong_type(key, item, expected);
                    None
                }
            })
            .collect()
    }

    /// Any count of names of turbines of the layout; notes others.
    pub(super) fn turbines(&self, key: &str) -> Vec<String> {
        let known = |(name, span): &(String, ops::Range<usize>)| {
            self.findings.is_turbine(self.key_path(key), name, span)
        };
        self.names(key).into_iter().filter(known).map(|(name, _)| name).collect()
    }

    /// Notes that the value of `key` is no `expected`.
    pub(super) fn wrong_type(&self, key: &str, node: &Node, expected: &str) {
        let found = match &node.value {
            Value::Text(text) if text.chars().count() <= 40 => format!("text \"{text}\""),
            _ => node.kind().to_owned(),
        };
        let fix = match &node.value {
            Value::Text(text) if expected == "a number" => digits_of(text).map(|digits| {
                format!("write {digits}, without quotes or unit ({})", self.key(key).unit)
            }),
            _ => None,
        };
        let kind = ProblemKind::WrongType {
            key: self.key_path(key),
            expected: expected.to_owned(),
            found,
        };
        self.findings.note(node.span.clone(), kind, fix);
    }

    /// Dotted path of `key` in this table.
    pub(super) fn key_path(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Where problems are noted.
    pub(super) fn findings(&self) -> &'a Findings<'a> {
        self.findings
    }

    fn key(&self, name: &str) -> &'static Key {
        let key = self.table.keys.iter().find(|key| key.name == name);
        // The reader asks only for keys of the table, whatever the file holds; a test reads every table.
        key.unwrap_or_else(|| panic!("the table {} has no key `{name}`", self.table.heading))
    }

    fn default(&self, key: &str) -> Option<&'static str> {
        match self.key(key).left_out {
            LeftOut::Value(value) => Some(value),
            _ => None,
        }
    }
}

fn fix_of(key: &Key, range: Range, value: f64) -> String {
    let guess = key.slips.iter().find(|slip| range.contains(value * slip.factor));
    match guess {
        Some(slip) => {
            let right = (value * slip.factor * 1e4).round() / 1e4;
            let unit = if key.unit == "–" { "" } else { key.unit };
            format!(
                "did you mean {right}{}{unit}? {value} {} would be that",
                if unit.is_empty() { "" } else { " " },
                slip.unit
            )
        }
        None => key.about.to_owned(),
    }
}

/// The number at the start of a text such as `9 m/s`.
fn digits_of(text: &str) -> Option<&str> {
    let text = text.trim();
    let end = text.find(|c: char| !c.is_ascii_digit() && !".-+".contains(c)).unwrap_or(text.len());
    text[..end].parse::<f64>().is_ok().then_some(&text[..end])
}

/// Whether `text` may name folders, channels and keys.
pub(super) fn is_name(text: &str) -> bool {
    (1..=LONGEST_NAME).contains(&text.len())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

/// Whether `text` may name folders: a name that may have points inside.
fn is_folder(text: &str) -> bool {
    is_name(&text.replace('.', "-")) && !text.starts_with('.') && !text.ends_with('.')
}

fn tidied(text: &str) -> String {
    let name: String = text
        .trim()
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' })
        .take(64)
        .collect();
    if name.is_empty() { "a-name".to_owned() } else { name }
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_number_in_a_text() {
        assert_eq!(digits_of(" 9.5 m/s"), Some("9.5"));
        assert_eq!(digits_of("fast"), None);
        assert_eq!(digits_of("-"), None);
    }
}
