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
    match key.label.strip_suffix("_deg") {
        Some(name) => format!("{} (°)", name.replace('_', " ")),
        None => key.label.replace('_', " "),
    }
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
    for key in table.keys.iter().filter(|key| !but.iter().any(|other| other.key == key.key)) {
        if let Some(value) = row.value(&key.key) {
            words.push(format!("{} {}", key.label.replace('_', " "), value.words()));
        }
    }
    if words.is_empty() { row.base.clone() } else { words.join(", ") }
}

#[cfg(test)]
mod tests;
