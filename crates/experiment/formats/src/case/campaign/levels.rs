//! Factors and their levels: lists, ranges, keys that are linked, rows of a table.

use super::places::Places;
use super::points::{self, text_of};
use super::{Factor, Level, LevelSetting, name_of, object};
use crate::case::document::{Entry, Node, Value, find};
use crate::case::error::CaseError;
use crate::case::findings::Findings;
use crate::case::sweep;
use basis::records::SweptValue;
use std::ops::Range;
use std::path::Path;

/// Share of a step by which the end of a range may miss its last level (–).
const MISSED: f64 = 1e-6;
/// Most levels of a range (–): each is a run of its own and more, so that more of them are a slip.
const MOST: f64 = 1e4;

/// What is varied, as it is read.
pub(super) struct Levels<'a> {
    text: &'a str,
    places: &'a Places,
    findings: &'a Findings<'a>,
    factors: Vec<(Factor, Range<usize>)>,
}

/// Values of a key, each with its TOML.
type Values = Vec<(SweptValue, String)>;

impl<'a> Levels<'a> {
    /// None yet of a file of `text`.
    pub(super) fn new(text: &'a str, places: &'a Places, findings: &'a Findings<'a>) -> Self {
        Self { text, places, findings, factors: Vec::new() }
    }

    /// What was read; notes where a key is set by several factors, and where nothing is varied at all: then
    /// at `end` of the file.
    pub(super) fn into_factors(self, end: &Range<usize>) -> Vec<Factor> {
        let mut known: Vec<&str> = Vec::new();
        for (factor, span) in &self.factors {
            let settings = factor.levels.first().map_or(&[][..], |level| &level.settings);
            for setting in settings {
                if known.contains(&setting.key.as_str()) {
                    let message = format!("`{}` is varied twice", setting.key);
                    object(self.findings, span.clone(), message, "again", "leave one of them out");
                }
                known.push(&setting.key);
            }
        }
        if self.factors.is_empty() {
            let message = "nothing is varied".to_owned();
            let fix = "give [factors], [[linked]], table or seeds";
            object(self.findings, end.clone(), message, "nothing here", fix);
        }
        self.factors.into_iter().map(|(factor, _)| factor).collect()
    }

    /// Reads `[factors]`.
    pub(super) fn read_factors(&mut self, entry: Option<&Entry>) {
        let Some(entry) = entry else { return };
        let Value::Table(entries) = &entry.node.value else {
            let fix = "write [factors] and below it \"wind.speed\" = [8, 10]";
            let message = format!("`factors` must be a table, found {}", entry.node.kind());
            return object(self.findings, entry.node.span.clone(), message, "not a table", fix);
        };
        for (key, entry) in flat(entries, "") {
            self.read_factor(&key, entry);
        }
    }

    /// Reads the seeds under `key`.
    pub(super) fn read_seeds(&mut self, key: &str, entry: Option<&Entry>) {
        let Some(entry) = entry else { return };
        self.read_factor(key, entry);
        let seeds = self.factors.last().filter(|(_, span)| *span == entry.key_span);
        let is_whole = |level: &Level| matches!(level.name, SweptValue::Whole(0..));
        if seeds.is_some_and(|(factor, _)| !factor.levels.iter().all(is_whole)) {
            let message = "`seeds` must be whole numbers from 0".to_owned();
            let fix = "write seeds = [1, 2, 3], or { from = 1, to = 3, step = 1 }";
            object(self.findings, entry.node.span.clone(), message, "not such numbers", fix);
        }
    }

    fn read_factor(&mut self, key: &str, entry: &Entry) {
        let Some(values) = self.values(key, &entry.node) else { return };
        let Some(places) = self.places_of(key, &entry.key_span) else { return };
        let level = |(value, text): (SweptValue, String)| Level {
            name: value.clone(),
            settings: vec![LevelSetting {
                key: key.to_owned(),
                places: places.clone(),
                text,
                value,
            }],
        };
        let levels = values.into_iter().map(level).collect();
        self.add(Factor { name: key.to_owned(), is_linked: false, levels }, &entry.key_span);
    }

    /// Takes in `factor`, which stands at `span`; notes levels that are there twice.
    fn add(&mut self, factor: Factor, span: &Range<usize>) {
        let mut names: Vec<String> = factor.levels.iter().map(|level| level.name.words()).collect();
        names.sort();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("`{}` has the level {} twice", factor.name, twice[0]);
            object(self.findings, span.clone(), message, "again", "leave one of them out");
        }
        self.factors.push((factor, span.clone()));
    }

    /// Where `key`, which stands at `span`, goes in the case.
    fn places_of(&self, key: &str, span: &Range<usize>) -> Option<Vec<String>> {
        let found = self.places.of(key);
        let refuse = |message| {
            let fix = "write keys as `--set` has them, such as \"wind.speed\" or \"run.helix.control.T1.strouhal\"";
            object(self.findings, span.clone(), message, "no such place", fix);
        };
        found.map_err(refuse).ok()
    }

    /// The values of the list or range at `node`.
    fn values(&self, key: &str, node: &Node) -> Option<Values> {
        let found = match &node.value {
            Value::List(items) if !items.is_empty() => {
                Some(items.iter().map(|item| self.value(item)).collect())
            }
            Value::Table(entries) => range(entries),
            _ => None,
        };
        if found.is_none() {
            let message = format!(
                "`{key}` must have a list of levels, or a range that its steps fill, of {MOST} levels at most"
            );
            let fix = "write [8, 10], or { from = 6, to = 12, step = 2 }";
            object(self.findings, node.span.clone(), message, "no levels", fix);
        }
        found
    }

    /// The value at `node` with its TOML, as it stands in the file.
    fn value(&self, node: &Node) -> (SweptValue, String) {
        let text = self.text[node.span.clone()].to_owned();
        let value = sweep::value_of(node).unwrap_or_else(|| SweptValue::Text(text.clone()));
        (value, text)
    }

    /// Reads `[[linked]]`.
    pub(super) fn read_linked(&mut self, entry: Option<&Entry>) {
        let Some(entry) = entry else { return };
        let Value::List(items) = &entry.node.value else {
            return self.no_linked(&entry.node.span);
        };
        for item in items {
            match &item.value {
                Value::Table(entries) => self.read_one_linked(entries, &item.span),
                _ => self.no_linked(&item.span),
            }
        }
    }

    fn no_linked(&self, span: &Range<usize>) {
        const FIX: &str = "write [[linked]], name = \"control\" and levels = [{ name = \"helix\", \"control.T1.amplitude_deg\" = 3.0 }, ...]";
        let message = "a linked factor has a `name` and a list `levels` of tables, each with a `name` and the same keys".to_owned();
        object(self.findings, span.clone(), message, "not such a factor", FIX);
    }

    fn read_one_linked(&mut self, entries: &[Entry], span: &Range<usize>) {
        let levels = find(entries, "levels").map(|entry| &entry.node.value);
        let (Some(name), Some(Value::List(items))) = (name_of(entries), levels) else {
            return self.no_linked(span);
        };
        let mut levels: Vec<Level> = Vec::with_capacity(items.len());
        for item in items {
            let Value::Table(inner) = &item.value else { return self.no_linked(&item.span) };
            let Some(called) = name_of(inner) else { return self.no_linked(&item.span) };
            let mut settings = Vec::new();
            for (key, entry) in flat(inner, "").into_iter().filter(|(key, _)| key != "name") {
                let Some(places) = self.places_of(&key, &entry.key_span) else { return };
                let (value, text) = self.value(&entry.node);
                settings.push(LevelSetting { key, places, text, value });
            }
            settings.sort_by(|one, other| one.key.cmp(&other.key));
            let keys = |settings: &[LevelSetting]| -> Vec<String> {
                settings.iter().map(|setting| setting.key.clone()).collect()
            };
            let first = levels.first().map(|level| keys(&level.settings));
            if settings.is_empty() || first.is_some_and(|first| first != keys(&settings)) {
                return self.no_linked(&item.span);
            }
            levels.push(Level { name: SweptValue::Text(called.to_owned()), settings });
        }
        if levels.is_empty() {
            return self.no_linked(span);
        }
        self.add(Factor { name: name.to_owned(), is_linked: true, levels }, span);
    }

    /// Reads the table at `path`, which the file names at `span`.
    ///
    /// # Errors
    /// [`CaseError`] for a table that cannot be read.
    pub(super) fn read_table(&mut self, path: &Path, span: &Range<usize>) -> Result<(), CaseError> {
        let points = points::read(path)?;
        let mut places = Vec::with_capacity(points.keys.len());
        for key in &points.keys {
            let Some(found) = self.places_of(key, span) else { return Ok(()) };
            places.push(found);
        }
        let level = |(line, values): &(u64, Vec<SweptValue>)| {
            let columns = points.keys.iter().zip(&places).zip(values);
            let setting = |((key, places), value): ((&String, &Vec<String>), &SweptValue)| {
                let (text, value) = (text_of(value), value.clone());
                LevelSetting { key: key.clone(), places: places.clone(), text, value }
            };
            let name = SweptValue::Text(format!("line {line}"));
            Level { name, settings: columns.map(setting).collect() }
        };
        let levels = points.rows.iter().map(level).collect();
        self.add(Factor { name: "table".to_owned(), is_linked: false, levels }, span);
        Ok(())
    }
}

/// The levels of a range; none of what is no range.
fn range(entries: &[Entry]) -> Option<Values> {
    if !is_range(entries) {
        return None;
    }
    let number = |key: &str| match find(entries, key)?.node.value {
        Value::Whole(Some(whole)) => Some((whole as f64, true)),
        Value::Number(number) => Some((number, false)),
        _ => None,
    };
    let [(from, a), (to, b), (step, c)] = [number("from")?, number("to")?, number("step")?];
    let n = ((to - from) / step).round();
    let misses = (from + n * step - to).abs() > MISSED * step.abs();
    if !(0.0..=MOST - 1.0).contains(&n) || misses {
        return None;
    }
    let value = |index: u64| {
        let exact = from + index as f64 * step;
        if a && b && c {
            return SweptValue::Whole(exact as i64);
        }
        // 0.30000000000000004 is meant to be 0.3.
        SweptValue::Number(format!("{exact:.12e}").parse().unwrap_or(exact))
    };
    let values = (0..=n as u64).map(value);
    Some(values.map(|value| (value.clone(), text_of(&value))).collect())
}

/// Whether a table is a range, not one of further keys.
fn is_range(entries: &[Entry]) -> bool {
    ["from", "to", "step"].iter().all(|key| find(entries, key).is_some()) && entries.len() == 3
}

/// What stands in a table and in those in it, each with its key; a quoted key may be a path of its own.
fn flat<'e>(entries: &'e [Entry], above: &str) -> Vec<(String, &'e Entry)> {
    let mut found = Vec::new();
    for entry in entries {
        let own = entry.key.split('.').map(str::trim).collect::<Vec<_>>().join(".");
        let key = if above.is_empty() { own } else { format!("{above}.{own}") };
        match &entry.node.value {
            // A quoted key says where its table ends.
            Value::Table(inner) if !is_range(inner) && !entry.key.contains('.') => {
                found.extend(flat(inner, &key));
            }
            _ => found.push((key, entry)),
        }
    }
    found
}
