//! Figures of a sweep: gain over one swept number with a line for each of the others, as a map over two, and
//! wind by wind.

mod lines;
mod map;
mod winds;

use crate::draw::Figure;
use basis::records::{SweepRow, SweepTable, SweptKey};

/// Those that the table allows.
pub(crate) fn all(table: &SweepTable) -> Vec<Figure> {
    let figures = [lines::lines(table), map::map(table), winds::winds(table)];
    figures.into_iter().flatten().collect()
}

/// Swept keys that hold two different numbers or more, with these numbers from the least on.
fn numeric(table: &SweepTable) -> Vec<(&SweptKey, Vec<f64>)> {
    let values = |key: &SweptKey| {
        let rows = table.rows.iter().filter_map(|row| row.value(&key.key));
        let mut values: Vec<f64> = rows.map(|value| value.number()).collect::<Option<_>>()?;
        values.sort_by(f64::total_cmp);
        values.dedup();
        (values.len() > 1).then_some(values)
    };
    table.keys.iter().filter_map(|key| Some((key, values(key)?))).collect()
}

/// Names of what gains are drawn of: all together where turbines feel one another, then turbine by turbine;
/// only those that have a gain in a row.
fn parts(table: &SweepTable) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for part in table.rows.iter().flat_map(|row| &row.parts).filter(|part| part.gain.is_some()) {
        if !names.contains(&part.name.as_str()) {
            names.push(&part.name);
        }
    }
    names.sort_by_key(|name| *name != "all");
    names
}

/// What is drawn of the part called `name`, in words.
fn title(name: &str) -> &str {
    if name == "all" { "all together" } else { name }
}

/// The number that `row` was made with under `key`.
fn number(row: &SweepRow, key: &SweptKey) -> Option<f64> {
    row.value(&key.key)?.number()
}

/// A key as a label of an axis.
fn axis_name(key: &SweptKey) -> String {
    let unit = if key.label.ends_with("_deg") { " (°)" } else { "" };
    key_name(key) + unit
}

/// A key in words.
pub(crate) fn key_name(key: &SweptKey) -> String {
    let name = key.label.strip_suffix("_deg").unwrap_or(&key.label);
    name.replace("strouhal", "Strouhal number").replace('_', " ")
}

/// What a row was made with, in words: "Strouhal number 0.25" and "amplitude 2°".
pub(crate) fn settings<'a>(
    table: &'a SweepTable,
    row: &'a SweepRow,
    is_told: impl Fn(&SweptKey) -> bool + 'a,
) -> impl Iterator<Item = String> + 'a {
    table.keys.iter().filter(move |key| is_told(key)).filter_map(|key| {
        let degree = if key.label.ends_with("_deg") { "°" } else { "" };
        Some(format!("{} {}{degree}", key_name(key), row.value(&key.key)?.words()))
    })
}

/// What tells `row` from others beside the keys `but`: the run of the case file, where several were swept,
/// and the values of the other keys.
fn series_name(table: &SweepTable, row: &SweepRow, but: &[&SweptKey]) -> String {
    let swept = || table.rows.iter().filter(|row| !row.settings.is_empty());
    let several = swept().any(|other| other.base != row.base);
    let mut words: Vec<String> = Vec::new();
    if several {
        words.push(row.base.clone());
    }
    words.extend(settings(table, row, |key| !but.iter().any(|other| other.key == key.key)));
    if words.is_empty() { row.base.clone() } else { words.join(", ") }
}

#[cfg(test)]
mod tests;
