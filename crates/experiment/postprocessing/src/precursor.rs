//! The report of a precursor, from what it left.

mod facts;
mod histories;
mod wind;

use crate::PostprocessingError;
use formats::case::parse_precursor;
use formats::netcdf::{StoredStatistics, read_statistics};
use formats::records::{self, Drift, PrecursorFolder, PrecursorResult, ProfileRow};
use formats::{leftovers, turbulence_box};
use report::{DriftRow, HubWind, LevelRow, PrecursorRecords, TimeHeightMap};
use std::path::{Path, PathBuf};
use wind::HubRow;

/// Whether a complete precursor lies in `directory`.
pub(crate) fn is_precursor(directory: &Path) -> bool {
    PrecursorFolder::new(directory).is_complete()
}

/// Makes the report of the complete precursor in `directory`; gives the page's path.
///
/// # Errors
/// [`PostprocessingError::File`] for what cannot be read, [`PostprocessingError::Precursor`] for a file of
/// another program, [`PostprocessingError::Planes`] for planes that are damaged,
/// [`PostprocessingError::Report`] for a report that cannot be written.
pub fn report_of_precursor(directory: &Path) -> Result<PathBuf, PostprocessingError> {
    let folder = PrecursorFolder::new(directory);
    let result = folder.read_result()?;
    let _lock = records::lock_shared(directory, "report")?;
    for place in [directory.to_owned(), directory.join("figures")] {
        if place.is_dir() {
            leftovers::remove_abandoned(&place, None)?;
        }
    }
    let precursor = parse_precursor(&folder.case_path(), &result.case_text, &[])?.precursor;
    let statistics = read_statistics(
        &folder.statistics_path(),
        &histories::SERIES,
        &[&histories::PROFILES[..], &MAPS.map(|(column, ..)| column)].concat(),
    )?;
    let mut planes = turbulence_box::open(&folder.planes_path())?;
    let row = HubRow::read(&mut *planes, result.planes.hub_height)?;
    let record_from = precursor.plan().time(precursor.plan().first_plane);
    let hub = HubWind {
        height: result.planes.hub_height,
        rotor_diameter: precursor.planes.rotor_diameter,
        speed: result.planes.hub_speed,
        direction_deg: result.planes.direction_deg,
        turbulence_intensity: result.planes.turbulence_intensity,
    };
    let page = PrecursorRecords {
        name: result.name.clone(),
        description: precursor.description.clone(),
        case_text: result.case_text.clone(),
        version: result.version.clone(),
        warnings: result.warnings.clone(),
        hub,
        facts: facts::facts(&result, &precursor),
        drifts: drifts(&result),
        levels: result.profile.iter().map(level).collect(),
        tracks: vec![histories::histories(&statistics, record_from)],
        maps: maps(&statistics),
        spectra: wind::spectra(&row, &hub),
        coherence: wind::coherence(&row, &hub),
        record_from,
    };
    Ok(report::write_precursor(&page, directory)?)
}

/// What is shown over time and height: column, what it is, unit.
const MAPS: [(&str, &str, &str); 2] =
    [("speed", "Speed", "m/s"), ("temperature", "Potential temperature", "K")];

fn maps(statistics: &StoredStatistics) -> Vec<TimeHeightMap> {
    let map = |(column, name, unit): (&str, &str, &str)| TimeHeightMap {
        name: name.to_owned(),
        unit: unit.to_owned(),
        times: statistics.times.clone(),
        heights: statistics.heights.clone(),
        values: statistics.column(column).to_vec(),
    };
    MAPS.map(map).to_vec()
}

fn drifts(result: &PrecursorResult) -> Vec<DriftRow> {
    let row = |(name, drift): (&str, &Drift)| DriftRow {
        name: name.to_owned(),
        block: drift.block,
        speed: drift.hub_speed,
        direction_deg: drift.direction_deg,
        friction_velocity: drift.friction_velocity,
        speed_change: drift.of_speed(),
        turn_deg: drift.of_direction(),
        friction_change: drift.of_friction(),
        is_steady: drift.is_steady(),
    };
    let spin_up = result.spin_up.as_ref().map(|drift| ("end of the spin-up", drift));
    spin_up
        .into_iter()
        .chain(result.record.as_ref().map(|drift| ("record", drift)))
        .map(row)
        .collect()
}

fn level(row: &ProfileRow) -> LevelRow {
    LevelRow {
        height: row.height,
        speed: row.speed,
        direction_deg: row.direction_deg,
        turbulence_intensity: row.turbulence_intensity,
        stress: row.stress,
        temperature: row.temperature,
    }
}
