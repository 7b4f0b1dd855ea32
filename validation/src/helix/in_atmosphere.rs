//! Wake and helix in the wind of a neutral atmosphere, beside Mann's wind and published large-eddy figures.

use super::trials::{PLACES, Trial, rows, without_last_run};
use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use crate::studies::{Carried, failure, find, precursor, summaries};
use basis::records::Summary;
use formats::records::{PrecursorResult, ProfileRow};
use std::path::{Path, PathBuf};

/// A smaller and coarser `precursor-offshore`, so that it can be waited for.
const SMALLER: [&str; 7] = [
    "box.length=3360",
    "box.width=2800",
    "box.height=1120",
    "box.cell=28",
    "time.spin_up=21600",
    "time.record=4800",
    "planes.width=1700",
];
/// What the studies share in its atmosphere, and in Mann's wind.
const IN_ATMOSPHERE: [&str; 2] =
    ["wind.turbulence_intensity=0.05", "flow.ground={ roughness_length = 0.001 }"];
const IN_BOX: [&str; 4] = [
    "wind.turbulence_intensity=0.055",
    "wind.shear_exponent=0.08",
    "wind.length_scale=115",
    "wind.seed=1",
];
const HUB_WIND: f64 = 10.0;
/// Of the IEA 22 MW turbine (m).
const ROTOR_RADIUS: f64 = 142.0;
/// Turbulence intensity over the rotor (%): the middle of the published 3 to 6 %, and how far that reaches.
const INTENSITY: (f64, f64) = (4.5, 1.5);
const SOURCE: &str = "van der Hoek, Dammann, van Wingerden, section 2.1.1";
const CASE_ITSELF: &str = "the case itself";

/// The precursor of these studies, or what is there of it; gives what came of it, and its folder.
pub(crate) fn wind_of_precursor() -> Result<(PrecursorResult, PathBuf), String> {
    let own = SMALLER.map(str::to_owned).to_vec();
    let (wind, planes) = precursor("precursor-offshore", "helix-in-atmosphere-wind", own)?;
    let folder = planes.parent().map(Path::to_owned).unwrap_or_default();
    Ok((wind, folder))
}

/// A precursor's wind, the wake in it, and the gains of an array in it and in Mann's wind.
pub fn helix_in_atmosphere() -> Vec<Row> {
    let (wind, folder) = match wind_of_precursor() {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let itself = format!("wind.precursor=\"{}\"", folder.display());
    let keys = || [itself.as_str()].into_iter().chain(IN_ATMOSPHERE);
    let mut found = of_wind(&wind);

    let trial =
        Trial { name: "the wind of an atmosphere", folder: "helix-in-atmosphere-1", keys: &[] };
    let case = include_str!("../../cases/wake-in-atmosphere.toml");
    found.extend(rows(&trial, case, &keys().collect::<Vec<_>>(), &PLACES));

    let case = include_str!("../../cases/helix-in-atmosphere.toml");
    let (own, other) = (keys().collect::<Vec<_>>(), "helix-in-atmosphere-mann");
    found.extend(of_array("an atmosphere's wind", "helix-in-atmosphere-2", case, &own));
    found.extend(of_array("Mann's wind", other, without_last_run(case), &IN_BOX));
    found
}

/// What the precursor's wind is like.
fn of_wind(wind: &PrecursorResult) -> Vec<Row> {
    let row = |what: &str, measured, expected, tolerance, unit, source| Row {
        what: format!("precursor: {what}"),
        measured,
        expected,
        tolerance,
        unit,
        source,
    };
    let hub = wind.planes.hub_height;
    let [foot, top] = [hub - ROTOR_RADIUS, hub + ROTOR_RADIUS];
    let over_rotor = wind.profile.iter().filter(|level| (foot..=top).contains(&level.height));
    let intensities = over_rotor.map(|level| level.turbulence_intensity);
    let ends = [foot, top].map(|height| intensity_at(&wind.profile, height));
    let (least, greatest) = intensities
        .chain(ends)
        .map(|intensity| 100.0 * intensity)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), intensity| {
            (least.min(intensity), greatest.max(intensity))
        });
    let (middle, reach) = INTENSITY;
    let drift = wind.record.as_ref();
    vec![
        row("speed at the hub", speed_at_hub(wind), HUB_WIND, Within(0.1), "m/s", CASE_ITSELF),
        row("least intensity over the rotor", least, middle, Within(reach), "%", SOURCE),
        row("greatest intensity over the rotor", greatest, middle, Within(reach), "%", SOURCE),
        row("depth of the layer", wind.boundary_layer_height, 700.0, AtMost, "m", CASE_ITSELF),
        row(
            "change of the friction velocity from half to half of the record",
            drift.map_or(f64::NAN, |drift| 100.0 * drift.of_friction()),
            0.0,
            Within(3.0),
            "%",
            CASE_ITSELF,
        ),
    ]
}

/// Mean speed at the hub (m/s) over the record of `wind`.
pub(super) fn speed_at_hub(wind: &PrecursorResult) -> f64 {
    let record = wind.record.as_ref();
    record.map_or(f64::NAN, |record| 0.5 * (record.hub_speed[0] + record.hub_speed[1]))
}

/// Turbulence intensity (–) at `height` (m), linear between the levels of `profile`.
fn intensity_at(profile: &[ProfileRow], height: f64) -> f64 {
    let next = profile.partition_point(|level| level.height < height);
    let (Some(above), Some(below)) = (profile.get(next), next.checked_sub(1)) else {
        return f64::NAN;
    };
    let below = &profile[below];
    let weight = (height - below.height) / (above.height - below.height);
    below.turbulence_intensity + weight * (above.turbulence_intensity - below.turbulence_intensity)
}

/// Gains of two turbines, the runs of `case`, in the `wind` that `keys` set, in the folder of this name.
fn of_array(wind: &str, folder: &str, case: &'static str, keys: &[&str]) -> Vec<Row> {
    let keys = keys.iter().map(|&key| key.to_owned()).collect();
    let summaries = match summaries(Carried::Own(case), folder, keys) {
        Ok((summaries, _)) => summaries,
        Err(problem) => return failure(problem),
    };
    let runs = ["ccw-4", "cw-4"].into_iter().filter(|run| find(&summaries, run).is_some());
    runs.map(|run| of_gain(wind, &summaries, run)).collect()
}

/// Gain of the array in `run`: at 10 m/s no figure of large-eddy simulation is published, but its sign is.
fn of_gain(wind: &str, summaries: &[Summary], run: &str) -> Row {
    let gain = find(summaries, run).and_then(|summary| summary.array_power_gain);
    if let Some(gain) = gain {
        let half_width = gain.half_width_95.map_or(f64::NAN, |half| 100.0 * half);
        tell!("in {wind}: array gain, {run}: {:.2} ± {half_width:.2} %", 100.0 * gain.mean);
    }
    let what = format!("in {wind}: array gain, {run}, two turbines at 5 D, 10 m/s");
    super::positive(what, gain.map_or(f64::NAN, |gain| 100.0 * gain.mean))
}
