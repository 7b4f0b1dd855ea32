//! The page of a precursor.

use super::{drawing, filled};
use crate::ReportError;
use crate::draw::Figure;
use crate::precursor::{DriftRow, PrecursorRecords};
use crate::words::{self, SPACE, duration, number, percent, signed, signed_percent};
use minijinja::context;

const TEMPLATE: &str = include_str!("precursor.html");

/// The page of `records` with `figures`.
pub(crate) fn render(
    records: &PrecursorRecords,
    figures: &[Figure],
) -> Result<String, ReportError> {
    let drawings = figures.iter().map(drawing).collect::<Result<Vec<_>, _>>()?;
    let warnings = records.warnings.iter().map(|warning| words::capitalised(warning));
    let own = context! {
        title => records.name.clone(),
        description => records.description.clone(),
        version => records.version.clone(),
        headline => headline(records),
        verdicts => records.drifts.iter().map(verdict).collect::<Vec<_>>(),
        warnings => warnings.collect::<Vec<_>>(),
        facts => records.facts.clone(),
        drifts => records.drifts.iter().map(row).collect::<Vec<_>>(),
        figures => drawings,
        case_text => records.case_text.clone(),
    };
    filled("precursor.html", TEMPLATE, own)
}

/// The wind at hub height, in a sentence.
fn headline(records: &PrecursorRecords) -> String {
    let hub = &records.hub;
    format!(
        "{}{SPACE}m/s from {}° at {}{SPACE}m, turbulence intensity {}.",
        number(hub.speed, 2),
        number(hub.direction_deg, 1),
        number(hub.height, 0),
        percent(hub.turbulence_intensity),
    )
}

/// Whether a time was steady, in a sentence.
fn verdict(drift: &DriftRow) -> String {
    let steady = if drift.is_steady { "steady" } else { "not steady" };
    format!(
        "{}: {steady}; from one block of {} to the next speed {}, direction {}°, friction velocity {}",
        words::capitalised(&drift.name),
        duration(drift.block),
        signed_percent(drift.speed_change),
        signed(drift.turn_deg, 1),
        signed_percent(drift.friction_change),
    )
}

/// A line of the table: name, block, then each quantity before and after.
fn row(drift: &DriftRow) -> Vec<String> {
    let pair = |[before, after]: [f64; 2], decimals| {
        format!("{} → {}", number(before, decimals), number(after, decimals))
    };
    vec![
        words::capitalised(&drift.name),
        duration(drift.block),
        pair(drift.speed, 2),
        pair(drift.direction_deg, 1),
        pair(drift.friction_velocity, 3),
        if drift.is_steady { "steady" } else { "not steady" }.to_owned(),
    ]
}
