//! The source's section 4-2-2: the aeroelastic turbine in the recorded wake of a helix, loads brought to
//! factors of their own amplitude.

use super::judge::{beside, percent, print_line, reached};
use super::rig::MOMENTS;
use crate::Row;
use crate::row::Tolerance::Within;
use crate::studies::{Carried, failure, find, summaries};
use basis::records::{Load, LoadKind, Statistic, TurbineSummary};
use std::path::absolute;

/// Where the expected values come from.
const SOURCE: &str = "van Veldhoven (2024), section 4-2-2";

/// Where the wake is recorded, and the turbine put into it.
const WAKE: Carried = Carried::Shipped("wake-inflow");
const TURBINE: Carried = Carried::Shipped("meandering-in-wake");

/// Runs of the second, factor, and changes (%) of the seven deviations and of power in the source's table
/// 4-6.
type Published = (&'static str, f64, Option<[f64; 8]>);
const PUBLISHED: [Published; 7] = [
    ("factor-2", 2.0, Some([2.7, 40.6, 80.8, 17.6, 84.6, 6.2, 1.1, -1.8])),
    ("factor-1-75", 1.75, Some([2.0, 28.4, 63.4, 11.1, 57.6, 6.4, 7.1, -0.1])),
    ("factor-1-5", 1.5, Some([1.2, 18.5, 38.6, 6.8, 42.5, 3.6, 5.0, 0.6])),
    ("factor-1-25", 1.25, Some([0.9, 7.0, 19.7, 9.4, 18.5, 0.4, 3.6, -0.3])),
    ("factor-0-75", 0.75, Some([-0.5, -7.8, -21.0, -2.3, -19.2, -3.1, -1.6, -1.1])),
    ("factor-0-5", 0.5, Some([-0.7, -13.7, -38.8, -2.0, -37.7, -5.9, -3.3, -2.7])),
    ("factor-0-35", 0.35, None),
];

/// Records the wake, runs the turbine in it; prints the table with intervals, gives what is claimed as rows.
pub fn wake() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let (_, folder) = summaries(WAKE, "wake-inflow", Vec::new())?;
    let planes = folder.join("helix").join("inflow-T2.bts");
    // A path in a case file counts from that file.
    let planes = absolute(planes).map_err(|error| error.to_string())?;
    let overrides = vec![format!("wind.planes={}", planes.display())];
    let (summaries, _) = summaries(TURBINE, "meandering-in-wake", overrides)?;
    let turbine = |run: &str| {
        let summary = find(&summaries, run).ok_or_else(|| format!("the run {run} is missing"))?;
        Ok::<&TurbineSummary, String>(&summary.turbines[0])
    };
    let baseline = turbine("baseline")?;
    let mut runs = Vec::new();
    for (run, factor, published) in PUBLISHED {
        runs.push(Run { factor, published, turbine: turbine(run)? });
    }
    print(baseline, &runs)?;
    let locked = baseline.meandering.map_or(f64::NAN, |found| found.locked_share);
    let mut rows = vec![Row {
        what: "wake of a helix: share of the time in lock".to_owned(),
        measured: locked,
        expected: 1.0,
        tolerance: Within(0.1),
        unit: "–",
        source: SOURCE,
    }];
    for run in &runs {
        rows.extend(run.rows()?);
    }
    Ok(rows)
}

/// A run beside the one without control.
struct Run<'a> {
    /// Target factor (–).
    factor: f64,
    published: Option<[f64; 8]>,
    turbine: &'a TurbineSummary,
}

impl Run<'_> {
    /// Factors reached in tilt and yaw (–).
    fn reached(&self) -> [f64; 2] {
        let found = self.turbine.meandering;
        [found.and_then(|found| found.tilt), found.and_then(|found| found.yaw)]
            .map(|axis| axis.and_then(|axis| axis.factor).unwrap_or(f64::NAN))
    }

    fn change(&self, channel: &str, load: Option<&Load>) -> Result<Statistic, String> {
        let change = load.and_then(|load| load.change);
        change.ok_or_else(|| format!("the records hold no change of {channel}"))
    }

    /// Changes of the seven deviations and of power, by name.
    fn changes(&self) -> Result<Vec<(&'static str, Statistic)>, String> {
        let mut changes = Vec::new();
        for (name, channel, _) in MOMENTS {
            changes.push((name, self.change(channel, self.turbine.deviation(channel))?));
        }
        let power = self.turbine.power_gain.ok_or("the records hold no gain of power")?;
        changes.push(("power", power));
        Ok(changes)
    }

    fn rows(&self) -> Result<Vec<Row>, String> {
        const NAME: &str = "wake of a helix";
        let factor = self.factor;
        let mut rows: Vec<Row> = ["tilt", "yaw"]
            .into_iter()
            .zip(self.reached())
            .map(|(axis, share)| reached(NAME, factor, axis, share))
            .collect();
        if let Some(published) = self.published {
            for ((name, change), expected) in self.changes()?.iter().zip(published) {
                let what = format!("{NAME}, factor {factor}: {name}, beside table 4-6");
                rows.push(beside(what, name, change, expected));
            }
        }
        Ok(rows)
    }
}

/// Prints all changes with their intervals, the published ones behind.
fn print(baseline: &TurbineSummary, runs: &[Run]) -> Result<(), String> {
    let cells = |of: &dyn Fn(&Run) -> String| runs.iter().map(of).collect::<Vec<_>>();
    print_line("target factor", &cells(&|run| run.factor.to_string()));
    print_line("---", &cells(&|_| "---".into()));
    for (axis, name) in ["tilt", "yaw"].into_iter().enumerate() {
        print_line(
            &format!("reached in {name}"),
            &cells(&|run| format!("{:.2}", run.reached()[axis])),
        );
    }
    let mut changes = Vec::new();
    for run in runs {
        changes.push(run.changes()?);
    }
    for index in 0..=MOMENTS.len() {
        let of = |(run, changes): (&Run, &Vec<(&str, Statistic)>)| {
            let published =
                run.published.map_or_else(String::new, |all| format!(" / {:+.1}", all[index]));
            percent(&changes[index].1) + &published
        };
        let name = match MOMENTS.get(index) {
            Some((name, channel, _)) => {
                let before = baseline.deviation(channel).map_or(f64::NAN, |load| load.value);
                format!("{name}, deviation ({before:.0} kN m)")
            }
            None => format!("power ({:.0} kW)", 1e-3 * baseline.power.mean),
        };
        print_line(&name, &runs.iter().zip(&changes).map(of).collect::<Vec<_>>());
    }
    for (name, channel, slope) in MOMENTS {
        let mut row = Vec::new();
        for run in runs {
            let found = run.turbine.damage_equivalent(channel);
            let is_same = |load: &&Load| match load.kind {
                LoadKind::DamageEquivalent { slope: counted, .. } => counted == slope,
                LoadKind::Deviation => false,
            };
            row.push(percent(&run.change(channel, found.filter(is_same))?));
        }
        print_line(&format!("{name}, equivalent load (m = {slope})"), &row);
    }
    Ok(())
}
