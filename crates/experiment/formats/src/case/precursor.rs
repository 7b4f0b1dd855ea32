//! The file of a precursor: a box of atmosphere, read with the keys, places and fixes of case files.

use super::document::{self, Entry, Value as Written, find};
use super::error::{CaseError, Problem};
use super::findings::Findings;
use super::keys::PRECURSOR;
use super::section::Section;
use super::sources::Sources;
use super::values::{assignments, values_of};
use crate::atomic;
use basis::keys::{Objection, Value, Values};
use farm::domain::subgrid_of;
use farm::precursor::{AirColumn, PeriodicBox, Precursor, PrecursorTime, WantedPlanes};
use sha2::Digest;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Keys that decide nothing of the air before the end of a record.
const UNDECISIVE: [&str; 6] =
    ["name", "description", "threads", "spin_up", "record", "rotor_diameter"];
/// Time of an hour (s).
const HOUR: f64 = 3600.0;

/// A precursor with the file that it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecursorFile {
    /// The precursor, overrides applied.
    pub precursor: Precursor,
    /// The same as text: every key with its value, defaults and overrides included.
    pub text: String,
    /// What of it decides the air at any time: that text without names, threads and times.
    decisive: String,
    /// The file.
    pub path: PathBuf,
}

impl PrecursorFile {
    /// SHA-256 of what decides the bits of its air at any time, hexadecimal.
    pub fn fingerprint(&self) -> String {
        let digest: [u8; 32] = sha2::Sha256::digest(&self.decisive).into();
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Reads the file of a precursor at `path` and applies `overrides`, each `key.path=value`.
///
/// # Errors
/// [`CaseError::File`] when it cannot be read, [`CaseError::Invalid`] with everything that is wrong in it.
pub fn read_precursor(path: &Path, overrides: &[String]) -> Result<PrecursorFile, CaseError> {
    let text = atomic::read_text(path, "the precursor's file")?;
    parse_precursor(path, &text, overrides)
}

/// The same of the `text` of a file that would stand at `path`.
///
/// # Errors
/// [`CaseError::Invalid`] with everything that is wrong in it.
pub fn parse_precursor(
    path: &Path,
    text: &str,
    overrides: &[String],
) -> Result<PrecursorFile, CaseError> {
    let name = path.display().to_string();
    let (sources, document) = document::parse(&name, text, overrides);
    let checked = document.and_then(|entries| check(&entries, text.len(), &sources));
    let (precursor, values) = checked.map_err(|problems| CaseError::Invalid { name, problems })?;
    let (text, decisive) = (written(&values, &[]), written(&values, &UNDECISIVE));
    Ok(PrecursorFile { precursor, text, decisive, path: path.to_owned() })
}

/// The precursor that `entries` describe, with what its keys hold.
///
/// # Errors
/// Everything that is wrong, from top to bottom of the file.
fn check(
    entries: &[Entry],
    length: usize,
    sources: &Sources,
) -> Result<(Precursor, Values), Vec<Problem>> {
    let findings = Findings::new(entries, sources);
    let end = length.saturating_sub(1)..length;
    let (precursor, values) = {
        let root = Section::open(&PRECURSOR, entries, end.clone(), String::new(), &findings);
        let values = values_of(&root, PRECURSOR.keys);
        (precursor_of(&values), values)
    };
    let object = |findings: &Findings, faults: Vec<(&'static str, Objection)>| {
        for (table, objection) in faults {
            let place_of = |key: Option<&str>| place(entries, table, key).unwrap_or(end.clone());
            findings.object(table, place_of, vec![objection]);
        }
    };
    object(&findings, precursor.faults());
    let mut problems = findings.into_problems();
    if problems.is_empty() {
        let findings = Findings::new(entries, sources);
        object(&findings, precursor.misfit().into_iter().collect());
        problems = findings.into_problems();
    }
    if problems.is_empty() { Ok((precursor, values)) } else { Err(problems) }
}

/// Where `key` of `table` stands, or as much of that as is there.
fn place(entries: &[Entry], table: &str, key: Option<&str>) -> Option<Range<usize>> {
    let table = find(entries, table)?;
    let inner = match &table.node.value {
        Written::Table(inner) => key.and_then(|key| find(inner, key)),
        _ => None,
    };
    Some(inner.map_or(table.key_span.clone(), |entry| entry.node.span.clone()))
}

/// What `values` of the whole file say; not a number where something is missing.
fn precursor_of(values: &Values) -> Precursor {
    let table = |name| values.table(name).cloned().unwrap_or_default();
    let (domain, air) = (table("box"), table("atmosphere"));
    let (time, planes) = (table("time"), table("planes"));
    let whole = |values: &Values, key| match values.get(key) {
        Some(Value::Whole(number)) => Some(*number),
        _ => None,
    };
    let optional_angle = |key| air.has(key).then(|| air.angle(key));
    let text = |key| values.has(key).then(|| values.word(key).to_owned());
    Precursor {
        name: values.word("name").to_owned(),
        description: text("description"),
        seed: whole(values, "seed").unwrap_or(1),
        domain: PeriodicBox {
            size: ["length", "width", "height"].map(|key| domain.number(key)),
            cell: domain.number("cell"),
            subgrid: subgrid_of(&domain),
            threads: whole(&domain, "threads").map(|threads| threads as usize),
        },
        air: AirColumn {
            latitude: air.angle("latitude_deg"),
            roughness_length: air.number("roughness_length"),
            geostrophic_wind: air.optional_number("geostrophic_wind"),
            geostrophic_direction: optional_angle("geostrophic_direction_deg"),
            hub_wind: air.optional_number("hub_wind"),
            hub_direction: optional_angle("hub_direction_deg"),
            temperature: air.number("temperature"),
            inversion_height: air.number("inversion_height"),
            inversion_strength: air.number("inversion_strength"),
            inversion_depth: air.number("inversion_depth"),
            lapse_rate: air.number("lapse_rate"),
            heat_flux: air.optional_number("heat_flux"),
            cooling_rate: air.optional_number("cooling_rate").map(|rate| rate / HOUR),
            damping_from: air.optional_number("damping_from"),
            damping_rate: air.number("damping_rate"),
        },
        time: PrecursorTime {
            spin_up: time.number("spin_up"),
            record: time.number("record"),
            step: time.optional_number("step"),
            statistics_interval: time.number("statistics_interval"),
        },
        planes: WantedPlanes {
            hub_height: planes.number("hub_height"),
            rotor_diameter: planes.optional_number("rotor_diameter"),
            width: planes.optional_number("width"),
            height: planes.optional_number("height"),
            interval: planes.optional_number("interval"),
        },
    }
}

/// `values` of the whole file as a file, but for keys called `without`.
fn written(values: &Values, without: &[&str]) -> String {
    let (mut top, mut tables) = (Values::none(), String::new());
    for (key, value) in values.iter() {
        match value {
            Value::Table(inner) => tables += &format!("\n[{key}]\n{}", lines(inner, without)),
            value => top.set(key, value.clone()),
        }
    }
    lines(&top, without) + &tables
}

/// A line for each of `values`, but for keys called `without`.
fn lines(values: &Values, without: &[&str]) -> String {
    let mut kept = Values::none();
    let wanted = values.iter().filter(|(key, _)| !without.contains(key));
    kept.extend(wanted.map(|(key, value)| (key, value.clone())));
    assignments(&kept).map(|line| line + "\n").collect()
}

#[cfg(test)]
mod tests;
