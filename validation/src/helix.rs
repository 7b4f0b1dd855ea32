//! What the helix costs the first turbine, what it gives the array, and how the wake recovers, beside
//! published large-eddy figures.

mod in_atmosphere;
mod joined;
mod pitch;
mod profile;
mod trials;

pub use in_atmosphere::helix_in_atmosphere;
pub(crate) use in_atmosphere::wind_of_precursor;
pub use joined::joined_in_atmosphere;
pub use pitch::helix_pitch;
pub use profile::wake_profile;
pub use trials::{wake_grid, wake_trials};

use crate::Row;
use crate::row::Tolerance::{AtLeast, Within};
use crate::studies::{Carried, failure, find, summaries};
use basis::records::{Plane, PlaneAxes, Summary};

/// Where the expected values come from.
const RATIOS: &str = "published large-eddy tables";
const ARRAY: &str = "van der Hoek, Dammann, van Wingerden";
const POSITIVE: &str = "published large-eddy figures: the helix gains, ccw more than cw";
const CASE_ITSELF: &str = "the case itself";

/// Power of the first turbine over its baseline at St 0.25, IEA 22 MW: fit to published large-eddy tables
/// (amplitude in degrees, ratio).
const POWER_RATIOS: [(u32, f64); 4] = [(2, 0.994), (3, 0.986), (4, 0.975), (5, 0.963)];
const RATIO_TOLERANCE: f64 = 0.01;
/// Array gain of a tuned helix, two IEA 22 MW turbines at 5 D in 8 m/s (van der Hoek, Dammann, van Wingerden:
/// 7.5 % ccw, about 3 % cw, near 4° and St 0.25), and how far ours may lie from it: the half width of the
/// 95 % interval that ours had when it was recorded (2026-11-22), frozen, so that a gain that scatters more
/// is no easier to meet.
const ARRAY_GAINS: [(&str, f64, f64); 2] = [("ccw-4", 7.5, 2.3), ("cw-4", 3.0, 1.34)];
/// Hub-height centre-line speed (m/s) behind one IEA 22 MW turbine in 10 m/s: distance (D), baseline, helix
/// ccw 4° (published large-eddy tables).
const CENTRE_LINE: [(f64, f64, f64); 6] = [
    (3.0, 5.04, 4.85),
    (4.0, 5.02, 5.53),
    (5.0, 5.45, 6.47),
    (6.0, 6.05, 7.04),
    (7.0, 6.52, 7.39),
    (8.0, 6.87, 7.77),
];

/// The claim that `what` (%), measured as `gain`, is not below zero.
fn positive(what: String, gain: f64) -> Row {
    Row { what, measured: gain, expected: 0.0, tolerance: AtLeast, unit: "%", source: POSITIVE }
}

/// `cases/helix-two-turbines.toml`: power ratio of the first turbine and gain of the array against amplitude
/// and sense, and the delivered pitch of helix and pulse.
pub fn helix() -> Vec<Row> {
    let case = Carried::Shipped("helix-two-turbines");
    let (summaries, _) = match summaries(case, "helix", Vec::new()) {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let mut rows = power_ratios(&summaries);
    rows.extend(array_gains(&summaries));
    rows.extend(delivered(&summaries));
    rows
}

/// What the helix costs the first turbine.
fn power_ratios(summaries: &[Summary]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (degrees, expected) in POWER_RATIOS {
        let gain =
            find(summaries, &format!("ccw-{degrees}")).and_then(|s| s.turbines[0].power_gain);
        rows.push(Row {
            what: format!("T1 power over baseline, ccw {degrees}°, St 0.25, 8 m/s"),
            measured: gain.map_or(f64::NAN, |gain| 1.0 + gain.mean),
            expected,
            tolerance: Within(RATIO_TOLERANCE),
            unit: "-",
            source: RATIOS,
        });
    }
    rows
}

/// What it gives the array.
fn array_gains(summaries: &[Summary]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut gains = [f64::NAN; 2];
    for ((run, expected, accepted), measured) in ARRAY_GAINS.iter().zip(&mut gains) {
        let gain = find(summaries, run).and_then(|summary| summary.array_power_gain);
        *measured = gain.map_or(f64::NAN, |gain| 100.0 * gain.mean);
        rows.push(Row {
            what: format!("array gain, {run}, two turbines at 5 D"),
            measured: *measured,
            expected: *expected,
            tolerance: Within(*accepted),
            unit: "%",
            source: ARRAY,
        });
    }
    for run in ["ccw-1", "ccw-2", "ccw-3", "ccw-5", "cw-1", "cw-2", "cw-3", "cw-5"] {
        if let Some(gain) = find(summaries, run).and_then(|summary| summary.array_power_gain) {
            rows.push(positive(format!("array gain, {run}"), 100.0 * gain.mean));
        }
    }
    rows.push(positive("array gain of ccw 4° less that of cw 4°".to_owned(), gains[0] - gains[1]));
    rows
}

/// Excitation that the actuators delivered.
fn delivered(summaries: &[Summary]) -> Vec<Row> {
    let mut rows = Vec::new();
    for run in ["ccw-4", "cw-4", "pulse-4"] {
        let delivered = find(summaries, run).and_then(|s| s.turbines[0].delivered_pitch);
        rows.push(Row {
            what: format!("delivered amplitude, {run}"),
            measured: delivered.map_or(f64::NAN, |pitch| pitch.delivered_amplitude_deg),
            expected: 4.0,
            tolerance: Within(0.2),
            unit: "deg",
            source: CASE_ITSELF,
        });
        rows.push(Row {
            what: format!("delivered excitation frequency, {run}, St 0.25"),
            measured: delivered.map_or(f64::NAN, |pitch| 1e3 * pitch.excitation_frequency_hz),
            expected: find(summaries, run).map_or(f64::NAN, |summary| {
                let wind = &summary.conditions;
                1e3 * 0.25 * wind.target_wind_speed / wind.rotor_diameter
            }),
            tolerance: Within(0.05),
            unit: "mHz",
            source: CASE_ITSELF,
        });
    }
    rows
}

/// `validation/cases/centre-line.toml`: mean hub-height speed behind one turbine, baseline and helix.
pub fn centre_line() -> Vec<Row> {
    let case = Carried::Own(include_str!("../cases/centre-line.toml"));
    let (summaries, folder) = match summaries(case, "centre-line", Vec::new()) {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let study = match formats::records::read_study(&folder) {
        Ok(study) => study,
        Err(error) => return failure(error.to_string()),
    };
    let Some(diameter) = summaries.first().map(|summary| summary.conditions.rotor_diameter) else {
        return failure("no summary was written".to_owned());
    };
    let mut rows = Vec::new();
    for (run, published) in [("baseline", 0), ("ccw-4", 1)] {
        let plane =
            study.runs.iter().find(|records| records.summary.run == run).and_then(|records| {
                records.mean_planes.iter().find(|plane| plane.axes == PlaneAxes::Horizontal)
            });
        for (distance, baseline, helix) in CENTRE_LINE {
            rows.push(Row {
                what: format!("centre-line speed at {distance} D, {run}, 10 m/s"),
                measured: plane.map_or(f64::NAN, |plane| along_x(plane, distance * diameter)),
                expected: if published == 0 { baseline } else { helix },
                tolerance: Within(0.5),
                unit: "m/s",
                source: RATIOS,
            });
        }
    }
    rows
}

/// Streamwise speed (m/s) of a horizontal plane at x (m) and y = 0, bilinear.
fn along_x(plane: &Plane, x: f64) -> f64 {
    let place = |position: f64, axis: usize| {
        let index = (position - plane.origin[axis]) / plane.spacing[axis];
        let low = index.floor().clamp(0.0, plane.n_points[axis] as f64 - 2.0);
        (low as usize, index - low)
    };
    let ((i, wx), (j, wy)) = (place(x, 0), place(0.0, 1));
    let u = |i: usize, j: usize| f64::from(plane.velocity[0][j * plane.n_points[0] + i]);
    (1.0 - wy) * ((1.0 - wx) * u(i, j) + wx * u(i + 1, j))
        + wy * ((1.0 - wx) * u(i, j + 1) + wx * u(i + 1, j + 1))
}
