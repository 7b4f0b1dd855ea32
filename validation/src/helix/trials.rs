//! What moves a wake: the study of its profile in one wind, one thing changed at a time.

use super::profile::{
    BASELINE, CORE, HELIX, Profile, ROTOR, SOURCE, gain, mean, profiles, published,
};
use crate::Row;
use crate::row::Tolerance::Within;
use crate::studies::{Carried, failure, find, summaries};
use basis::records::Summary;

/// One change of the case.
pub(super) struct Trial {
    /// What is changed, in words that follow "with".
    pub(super) name: &'static str,
    /// Name of its folder.
    pub(super) folder: &'static str,
    /// The keys that it sets.
    pub(super) keys: &'static [&'static str],
}

/// The study as it is, then with one thing changed at a time.
const CHANGES: [Trial; 10] = [
    Trial { name: "nothing changed", folder: "as-it-is", keys: &[] },
    Trial { name: "27 directions", folder: "d3q27", keys: &["flow.velocity_set=d3q27"] },
    Trial {
        name: "a Smagorinsky constant of 0.08",
        folder: "constant-8",
        keys: &["flow.smagorinsky_constant=0.08"],
    },
    Trial {
        name: "a Smagorinsky constant of 0.16",
        folder: "constant-16",
        keys: &["flow.smagorinsky_constant=0.16"],
    },
    Trial {
        name: "a ground of roughness 1 mm",
        folder: "ground",
        keys: &["flow.ground={ roughness_length = 0.001 }", "flow.smagorinsky_constant=0.12"],
    },
    Trial {
        name: "6 D from inlet to rotor",
        folder: "inlet",
        keys: &["flow.upstream_diameters=6"],
    },
    Trial {
        name: "veer of 0.02 degrees a metre",
        folder: "veer",
        keys: &["wind.veer_deg_per_m=0.02"],
    },
    Trial {
        name: "an intensity of 4 %",
        folder: "intensity",
        keys: &["wind.turbulence_intensity=0.04"],
    },
    Trial { name: "a length scale of 33.6 m", folder: "length", keys: &["wind.length_scale=33.6"] },
    Trial {
        name: "a box of 10 D by 6 D",
        folder: "wide",
        keys: &["flow.width_diameters=10", "flow.height_diameters=6"],
    },
];

/// Grids, in a smaller box and for a shorter time, so that the finest can be waited for; without the helix.
const GRIDS: [Trial; 3] = [
    Trial { name: "16 cells", folder: "cells-16", keys: &["flow.cells_per_diameter=16"] },
    Trial { name: "24 cells", folder: "cells-24", keys: &["flow.cells_per_diameter=24"] },
    Trial { name: "32 cells", folder: "cells-32", keys: &["flow.cells_per_diameter=32"] },
];
/// What they share: 900 s are analysed, behind 2.5 D of wind, in a box of 4 D by 3.2 D.
const SMALL: [&str; 5] = [
    "time.duration=1400",
    "flow.upstream_diameters=2.5",
    "flow.downstream_diameters=6.5",
    "flow.width_diameters=4",
    "flow.height_diameters=3.2",
];

/// The case: one turbine in its first wind.
const CASE: &str = include_str!("../../cases/wake-profile.toml");

/// Where the mean wind is told of (diameters behind the turbine), with its place among the published ones.
pub(super) const PLACES: [(f64, usize); 3] = [(3.0, 0), (5.0, 2), (8.0, 5)];
/// Accepted distance from the published speed (m/s) and power (MW), as for the profile itself, and from the
/// published gain of the cube (percentage points).
const SPEED: f64 = 0.2;
const POWER: f64 = 0.5;
const GAIN: f64 = 8.0;

/// What each change does to the wake with and without a helix.
pub fn wake_trials() -> Vec<Row> {
    CHANGES.iter().flat_map(|trial| rows(trial, CASE, &[], &PLACES)).collect()
}

/// What the grid does to the wake without a helix.
pub fn wake_grid() -> Vec<Row> {
    let baseline = without_last_run(CASE);
    GRIDS.iter().flat_map(|trial| rows(trial, baseline, &SMALL, &PLACES[..2])).collect()
}

/// The text of a case without its last run.
pub(super) fn without_last_run(case: &str) -> &str {
    case.rfind("[[run]]").map_or(case, |end| &case[..end])
}

/// The rows of `trial` of the `case` with the `shared` keys, with speeds at `places`.
pub(super) fn rows(
    trial: &Trial,
    case: &'static str,
    shared: &[&str],
    places: &[(f64, usize)],
) -> Vec<Row> {
    let name = format!("wake-{}", trial.folder);
    let keys = shared.iter().chain(trial.keys).map(|&key| key.to_owned()).collect();
    let read = summaries(Carried::Own(case), &name, keys).and_then(|(summaries, folder)| {
        let runs = [BASELINE, HELIX].map(|run| find(&summaries, run).is_some());
        let baseline = profiles(&folder, BASELINE)?;
        let helix = if runs[1] { Some(profiles(&folder, HELIX)?) } else { None };
        Ok((summaries, baseline, helix))
    });
    let (summaries, baseline, helix) = match read {
        Ok(read) => read,
        Err(problem) => return failure(problem),
    };
    let mut rows = vec![of_power(trial, &summaries)];
    rows.extend(of_speed(trial, BASELINE, &baseline, places));
    if let Some(helix) = helix {
        rows.extend(of_speed(trial, HELIX, &helix, places));
        rows.push(of_gain(trial, [&baseline, &helix]));
    }
    rows
}

/// Power of the turbine without a helix.
fn of_power(trial: &Trial, summaries: &[Summary]) -> Row {
    let power = find(summaries, BASELINE).map_or(f64::NAN, |run| run.turbines[0].power.mean);
    Row {
        what: format!("with {}: power, {BASELINE}", trial.name),
        measured: 1e-6 * power,
        expected: 1e-6 * super::profile::POWER,
        tolerance: Within(POWER),
        unit: "MW",
        source: SOURCE,
    }
}

/// Mean speeds behind it, at `places`.
fn of_speed(trial: &Trial, run: &str, found: &[Profile], places: &[(f64, usize)]) -> Vec<Row> {
    let row = |&(distance, index): &(f64, usize)| Row {
        what: format!("with {}: mean speed over |y| < {CORE} D, {run}, {distance} D", trial.name),
        measured: mean(&found[index], CORE, 1),
        expected: mean(&published(run, index), CORE, 1),
        tolerance: Within(SPEED),
        unit: "m/s",
        source: SOURCE,
    };
    places.iter().map(row).collect()
}

/// What the helix gives the cube of the wind where a second turbine would stand.
fn of_gain(trial: &Trial, [baseline, helix]: [&[Profile]; 2]) -> Row {
    let (distance, index) = PLACES[1];
    let published = [BASELINE, HELIX].map(|run| published(run, index));
    Row {
        what: format!(
            "with {}: gain of the mean cube over |y| < {ROTOR} D at {distance} D, {HELIX}",
            trial.name
        ),
        measured: gain([&baseline[index], &helix[index]], ROTOR, 3),
        expected: gain([&published[0], &published[1]], ROTOR, 3),
        tolerance: Within(GAIN),
        unit: "%",
        source: SOURCE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_case_without_its_helix_keeps_the_turbine() {
        let baseline = without_last_run(CASE);
        assert!(baseline.contains("[[turbine]]") && baseline.contains("name = \"baseline\""));
        assert!(!baseline.contains(HELIX));
    }

    #[test]
    fn changes_are_told_apart() {
        let mut folders: Vec<&str> =
            CHANGES.iter().chain(&GRIDS).map(|trial| trial.folder).collect();
        folders.sort_unstable();
        folders.dedup();
        assert_eq!(folders.len(), CHANGES.len() + GRIDS.len());
    }
}
