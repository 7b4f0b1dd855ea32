//! Two turbines with a helix on the first in four winds, beside a published study with free vortices.

use crate::Row;
use crate::row::Tolerance::{AtLeast, AtMost};
use crate::studies::{Carried, failure, summaries_of};
use analysis::AnalysisError;
use analysis::fatigue::{REFERENCE_FREQUENCY, damage_equivalent_load};
use analysis::statistics::{change_together, mean};
use basis::records::Series;
use formats::records::{RunRecords, read_study, read_sweep};
use std::path::Path;

/// Where the expected signs come from: its text, for figure 11 shows bars without figures. It has one seed,
/// and gives no interval.
const SOURCE: &str = "Chen, van Vondelen, van Wingerden (2026), section 4.2";

/// The source's name of a wind, its shear exponent and turbulence intensity (–); the even one first.
const WINDS: [(&str, f64, f64); 4] =
    [("OL1", 0.0, 0.0), ("OL2", 0.2, 0.0), ("OL3", 0.0, 0.06), ("OL4", 0.2, 0.06)];
const HELIX: &str = "helix";
const N_TURBINES: usize = 2;
/// Two turns of the helix (s): the blocks of which intervals are made.
const BLOCK: f64 = 84.0;
/// Wöhler's exponent of composite blades (–), this program's choice: the source names none.
const SLOPE: f64 = 10.0;

/// What is compared: its name, the channel of a turbine, and whether its damage-equivalent load is meant.
const QUANTITIES: [(&str, &str, bool); 3] = [
    ("power", "GenPwr", false),
    ("flapwise equivalent load", "RootMyb1", true),
    ("edgewise equivalent load", "RootMxb1", true),
];
/// Whose: the turbines one by one, and both together.
const WHOSE: [&str; N_TURBINES + 1] = ["T1", "T2", "both"];

/// Signs that the source tells of, and no others: wind, quantity and whose by number, and whether it is
/// more than in OL1. Shear: power of both turbines is less, and so are the sums of their loads. Turbulence:
/// power and loads of each are more. Both: the sum of power is less, those of loads are more.
const SIGNS: [(usize, usize, usize, bool); 13] = [
    (1, 0, 0, false),
    (1, 0, 1, false),
    (1, 1, 2, false),
    (1, 2, 2, false),
    (2, 0, 0, true),
    (2, 0, 1, true),
    (2, 1, 0, true),
    (2, 1, 1, true),
    (2, 2, 0, true),
    (2, 2, 1, true),
    (3, 0, 2, false),
    (3, 1, 2, true),
    (3, 2, 2, true),
];

/// A change against even wind with the half width of its interval (%).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Change {
    mean: f64,
    half_width: f64,
}

/// Makes the four runs with a helix of `cases/lidar-open-loop.toml`, or takes up what is there of them;
/// prints all changes with their intervals, and gives those of whose sign the source tells as rows.
pub(super) fn rows() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let case = Carried::Shipped("lidar-open-loop");
    let (_, folder) = summaries_of(case, "free-vortex-open-loop", Vec::new(), &[HELIX])?;
    let mut series = Vec::new();
    for wind in WINDS {
        let records = records(&folder, wind)?;
        let run = records.iter().find(|records| records.summary.run == HELIX);
        let run = run.ok_or_else(|| format!("{}: there is no helix", wind.0))?;
        print_power(wind.0, run);
        series.push(analysed(run)?);
    }
    let mut found = Vec::new();
    for (index, now) in series.iter().enumerate() {
        let mut of_wind = Vec::new();
        for (name, channel, is_load) in QUANTITIES {
            let changes = changes(channel, is_load, now, &series[0])?;
            if index > 0 {
                print_changes(WINDS[index].0, name, changes);
            }
            of_wind.push(changes);
        }
        found.push(of_wind);
    }
    let row = |(wind, quantity, index, is_more): (usize, usize, usize, bool)| {
        let (name, shear, intensity) = WINDS[wind];
        let (what, ..) = QUANTITIES[quantity];
        let whose = WHOSE[index];
        Row {
            what: format!(
                "{name} (shear {shear}, intensity {intensity}), two nrel-5mw at 4 D, helix 3° ccw on T1, St 0.3, 10 m/s, 10 min, one seed: change of {what} of {whose} over OL1 (even)"
            ),
            measured: found[wind][quantity][index].mean,
            expected: 0.0,
            tolerance: if is_more { AtLeast } else { AtMost },
            unit: "%",
            source: SOURCE,
        }
    };
    Ok(SIGNS.into_iter().map(row).collect())
}

/// The runs in the wind of this shear exponent and turbulence intensity, of the sweep in `folder`.
fn records(
    folder: &Path,
    (name, shear, intensity): (&str, f64, f64),
) -> Result<Vec<RunRecords>, String> {
    let sweep = read_sweep(folder).map_err(|error| error.to_string())?;
    let sweep = sweep.ok_or_else(|| format!("{} holds no sweep", folder.display()))?;
    for study in &sweep.studies {
        let records = read_study(&folder.join(&study.folder)).map_err(|error| error.to_string())?;
        let is_it = records.runs.first().is_some_and(|run| {
            let wind = &run.summary.conditions;
            wind.shear_exponent == Some(shear) && wind.target_turbulence_intensity == intensity
        });
        if is_it {
            return Ok(records.runs);
        }
    }
    Err(format!("{name}: no study with shear {shear} and turbulence intensity {intensity}"))
}

/// The channels that are compared, over the analysed time of `run`.
fn analysed(run: &RunRecords) -> Result<Series, String> {
    let channels: Vec<String> = QUANTITIES
        .into_iter()
        .flat_map(|(_, channel, _)| ["T1", "T2"].map(|turbine| format!("{turbine}.{channel}")))
        .collect();
    let wanted = |name: &str| name == "Time" || channels.iter().any(|channel| channel == name);
    let mut series = run.series.read(wanted).map_err(|error| error.to_string())?;
    let spin_up = run.summary.conditions.spin_up;
    let time = series.column("Time").ok_or("the series has no times")?;
    let first = time.partition_point(|time| *time <= spin_up);
    for column in &mut series.columns {
        column.drain(..first);
    }
    Ok(series)
}

/// Changes of `channel` from `before` to `now`, of each turbine and of both together.
fn changes(
    channel: &str,
    is_load: bool,
    now: &Series,
    before: &Series,
) -> Result<[Change; N_TURBINES + 1], String> {
    let Some([first, .., last]) = now.column("Time") else {
        return Err("the series has no two times after the spin-up".to_owned());
    };
    let columns = |series: &Series| -> Result<Vec<Vec<f64>>, String> {
        let of = |turbine: &&str| {
            let name = format!("{turbine}.{channel}");
            let column = series.column(&name).ok_or_else(|| format!("there is no {name}"))?;
            Ok(column.to_vec())
        };
        WHOSE[..N_TURBINES].iter().map(of).collect()
    };
    let (now, before) = (columns(now)?, columns(before)?);
    let pairs: Vec<[&[f64]; 2]> =
        now.iter().zip(&before).map(|(now, before)| [&now[..], &before[..]]).collect();
    let interval = (last - first) / (now[0].len() - 1) as f64;
    let figure = |samples: &[f64]| -> Result<f64, AnalysisError> {
        if !is_load {
            return Ok(mean(samples));
        }
        damage_equivalent_load(samples, interval, SLOPE, REFERENCE_FREQUENCY)
    };
    let of = |pairs: &[[&[f64]; 2]]| {
        let found = change_together(pairs, interval, BLOCK, figure);
        found.map_err(|error| error.to_string()).map(|found| Change {
            mean: 100.0 * found.mean,
            half_width: 100.0 * found.half_width_95.unwrap_or(f64::NAN),
        })
    };
    Ok([of(&pairs[..1])?, of(&pairs[1..])?, of(&pairs)?])
}

fn print_changes(wind: &str, quantity: &str, changes: [Change; N_TURBINES + 1]) {
    let [first, second, both] =
        changes.map(|Change { mean, half_width }| format!("{mean:+.2} ± {half_width:.2} %"));
    tell!("{wind} over OL1, {quantity}: T1 {first}, T2 {second}, both {both}");
}

/// Power in this `wind`.
fn print_power(wind: &str, run: &RunRecords) {
    let powers = run
        .summary
        .turbines
        .iter()
        .map(|turbine| format!("{} {:.1} kW", turbine.name, 1e-3 * turbine.power.mean));
    tell!("{wind}: {}", powers.collect::<Vec<_>>().join(", "));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Power and moments of both turbines that are `factor` times those of a factor of 1.
    fn series(factors: [f64; N_TURBINES]) -> Series {
        let time: Vec<f64> = (1..=6000).map(|step| 300.0 + 0.1 * f64::from(step)).collect();
        let wave = |size: f64| time.iter().map(|t| size * (2.0 + (1.3 * t).sin())).collect();
        let mut series = Series { names: vec!["Time".to_owned()], columns: vec![time.clone()] };
        for (_, channel, _) in QUANTITIES {
            for (turbine, factor) in ["T1", "T2"].iter().zip(factors) {
                series.names.push(format!("{turbine}.{channel}"));
                series.columns.push(wave(factor * if *turbine == "T2" { 0.5 } else { 1.0 }));
            }
        }
        series
    }

    #[test]
    fn changes_are_those_of_each_and_of_the_sum() {
        let (now, before) = (series([1.1, 0.8]), series([1.0, 1.0]));
        for (_, channel, is_load) in QUANTITIES {
            let [first, second, both] = changes(channel, is_load, &now, &before).unwrap();
            assert!((first.mean - 10.0).abs() < 1e-9 && (second.mean + 20.0).abs() < 1e-9);
            // The second is half as much as the first.
            assert!(both.mean.abs() < 1e-9 && both.half_width < 1e-9, "{both:?}");
        }
    }

    #[test]
    fn signs_are_of_other_winds_than_the_even_one() {
        for (index, sign) in SIGNS.iter().enumerate() {
            assert!((1..WINDS.len()).contains(&sign.0), "{sign:?}");
            assert!(sign.1 < QUANTITIES.len() && sign.2 < WHOSE.len(), "{sign:?}");
            let same =
                |other: &&(usize, usize, usize, bool)| other.0 == sign.0 && other.1 == sign.1;
            let again = SIGNS[..index].iter().filter(same).any(|other| other.2 == sign.2);
            assert!(!again, "{sign:?}");
        }
    }
}
