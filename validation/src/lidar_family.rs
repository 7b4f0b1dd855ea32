//! Laws of a lidar's loop made at three wind speeds, blended in a wind that rises from the first to the last:
//! what they hold, beside one law alone.

use crate::Row;
use crate::lidar_loop::{Asked, designed, identified};
use crate::row::Tolerance::{self, AtLeast, AtMost};
use crate::studies::{Carried, failure, summaries};
use analysis::statistics::mean;
use basis::records::Series;
use formats::records::read_study;
use std::path::Path;

/// Where the bounds come from.
const OWN: &str = "this program's claim: the source has one wind speed";
/// Rate of the helix at all speeds: Strouhal number times wind speed (m/s).
const STROUHAL_SPEED: f64 = 3.0;
/// The laws of the family: name of the folder, wind speed (m/s), delay given (s).
const LAWS: [(&str, f64, f64); 3] = [("8", 8.0, 20.0), ("9p5", 9.5, 16.0), ("11", 11.0, 14.0)];
/// Samples of the record for one of the model: two seconds.
const DECIMATE: usize = 10;
/// Order of the models (–).
const ORDER: usize = 12;
/// The wind of the case: speed (m/s) of each hold, and how long it is (s).
const HOLDS: [f64; 5] = [8.0, 8.75, 9.5, 10.25, 11.0];
const HOLD: f64 = 400.0;
/// Last part of a hold that is judged (s): four periods of the helix.
const JUDGED: f64 = 168.0;
/// Where the wake is to be (m), up and to the right, of the case.
const REFERENCE: [f64; 2] = [1.8, -0.8];
/// Runs of the case.
const RUNS: [&str; 3] = ["open", "one-law", "family"];

/// Makes a law at each of three wind speeds, of a record of its own, and runs
/// `validation/cases/lidar-family.toml` with them; prints how far from its reference the wake stands in each
/// wind, and gives it as rows.
pub fn lidar_family() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

/// What a run has in a hold.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// Distance of the wake's mean from its reference (m), and root mean square about that mean (m).
    distance: f64,
    spread: f64,
}

fn made() -> Result<Vec<Row>, String> {
    for law in LAWS {
        make(law)?;
    }
    let case = Carried::Own(include_str!("../cases/lidar-family.toml"));
    let (_, folder) = summaries(case, "lidar-family", Vec::new())?;
    let [open, one, family] = RUNS.map(|run| holds(&folder, run));
    let (open, one, family) = (open?, one?, family?);
    let mut rows = Vec::new();
    for (hold, speed) in HOLDS.into_iter().enumerate() {
        let share = family[hold].distance / open[hold].distance;
        // Half of the way is more than chance, and less than a loop of its own wind leaves.
        let what = format!(
            "{speed} m/s: distance of the wake's mean from its reference, family over open"
        );
        rows.push(row(&what, share, 0.5, AtMost));
    }
    for hold in [0, HOLDS.len() - 1] {
        let ratio = one[hold].distance.hypot(one[hold].spread)
            / family[hold].distance.hypot(family[hold].spread);
        let what = format!(
            "{} m/s: root mean square distance of the wake from its reference, law of 9.5 m/s alone over family",
            HOLDS[hold]
        );
        rows.push(row(&what, ratio, 1.0, AtLeast));
    }
    Ok(rows)
}

fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
    Row {
        what: format!(
            "nrel-5mw in a free wake, wind in steps from 8 to 11 m/s, helix 3° ccw at one rate, {what}"
        ),
        measured,
        expected,
        tolerance,
        unit: "–",
        source: OWN,
    }
}

/// A record, a model and a controller at one wind speed; prints what they are.
fn make((name, speed, delay): (&str, f64, f64)) -> Result<(), String> {
    let case = Carried::Own(include_str!("../cases/lidar-family-record.toml"));
    let own = vec![
        format!("wind.speed={speed}"),
        format!("run.probing.control.T1.strouhal={:.6}", STROUHAL_SPEED / speed),
    ];
    let (_, folder) = summaries(case, &format!("lidar-family-{name}"), own)?;
    let asked = Asked { decimate: DECIMATE, delay, order: ORDER };
    let found = identified(&folder, asked)?;
    let designed = designed(&folder, &found)?;
    let [_, aside] = &found.accounted_for;
    let offset = found.azimuth_offset.as_ref().ok_or("there is no azimuth offset")?;
    tell!(
        "{speed} m/s: variance kept aside that the model accounts for {aside:.0?} %, gain at rest {:.2?} m/deg, azimuth offset that decouples at rest {:.0}°; law: norm {:.2?}, bandwidth {:.4?} rad/s, disc margin of all outputs at once {:.2?}",
        found.gain,
        offset.angle.to_degrees(),
        designed.achieved,
        designed.bandwidth,
        designed.disc.size,
    );
    Ok(())
}

/// What `run` of the study in `folder` has at the end of each hold; prints it.
fn holds(folder: &Path, run: &str) -> Result<[Held; HOLDS.len()], String> {
    let study = read_study(folder).map_err(|error| error.to_string())?;
    let records = study.runs.iter().find(|records| records.summary.run == run);
    let records = records.ok_or_else(|| format!("there is no run {run}"))?;
    let wanted = ["Time", "T1.HubVortexTilt", "T1.HubVortexYaw", "T1.LoopWind"];
    let series = records.series.read(|name: &str| wanted.contains(&name));
    let series = series.map_err(|error| error.to_string())?;
    let mut all = [Held { distance: f64::NAN, spread: f64::NAN }; HOLDS.len()];
    for (hold, (speed, held)) in HOLDS.into_iter().zip(&mut all).enumerate() {
        let end = HOLD * (hold as f64 + 1.0);
        *held = held_over(&series, [end - JUDGED, end])?;
        let seen = series.column("T1.LoopWind").map_or(String::new(), |wind| {
            let wind = mean(&wind[rows_of(&series, [end - JUDGED, end])]);
            format!(", schedules by {wind:.2} m/s")
        });
        tell!(
            "{run}, {speed} m/s: {:.2} m off its reference, spread {:.2} m{seen}",
            held.distance,
            held.spread
        );
    }
    Ok(all)
}

/// The rows of `series` after the first of these times (s), up to the second.
fn rows_of(series: &Series, [from, to]: [f64; 2]) -> std::ops::Range<usize> {
    let times = series.column("Time").unwrap_or(&[]);
    times.partition_point(|time| *time <= from)..times.partition_point(|time| *time <= to)
}

fn held_over(series: &Series, span: [f64; 2]) -> Result<Held, String> {
    let rows = rows_of(series, span);
    let (mut off, mut squares) = (0.0, 0.0);
    for (name, reference) in ["T1.HubVortexTilt", "T1.HubVortexYaw"].into_iter().zip(REFERENCE) {
        let column = series.column(name).ok_or_else(|| format!("there is no {name}"))?;
        let column = column.get(rows.clone()).ok_or("the series ends early")?;
        let at = mean(column);
        off += (at - reference).powi(2);
        squares += mean(&column.iter().map(|value| (value - at).powi(2)).collect::<Vec<f64>>());
    }
    Ok(Held { distance: off.sqrt(), spread: squares.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_and_spread_are_those_of_the_judged_time() {
        let time: Vec<f64> = (0..=400).map(f64::from).collect();
        let of = |within: f64, amplitude: f64| {
            let one = |time: &f64| match *time > 232.0 {
                true => within + amplitude * (std::f64::consts::TAU * time / 42.0).sin(),
                false => 99.0,
            };
            time.iter().map(one).collect::<Vec<f64>>()
        };
        let (tilt, yaw) = (of(REFERENCE[0] + 3.0, 1.0), of(REFERENCE[1] - 4.0, 0.0));
        let names = ["Time", "T1.HubVortexTilt", "T1.HubVortexYaw"].map(str::to_owned).to_vec();
        let series = Series { names, columns: vec![time, tilt, yaw] };
        let held = held_over(&series, [HOLD - JUDGED, HOLD]).unwrap();
        assert!((held.distance - 5.0).abs() < 1e-9 && (held.spread - 0.5_f64.sqrt()).abs() < 1e-9);
    }
}
