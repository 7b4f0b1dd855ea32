//! The phase of a helix at the second of two turbines in resolved flow: by its blade loads, and through a
//! lidar that looks upwind; against the wind at its place in a run without it, as published.

use super::AIM;
use crate::Row;
use crate::row::Tolerance::AtMost;
use crate::studies::{Carried, failure, summaries};
use control::phase_sync::PhaseEstimator;
use postprocessing::{PhaseQuestion, Replayed, phase};
use std::path::Path;

/// Where the limit comes from.
const SOURCE: &str = "aim of the project, set before the first run";
/// Seeds of the turbulence: others than the first three, with which the preview was made what it is.
const SEEDS: [u64; 3] = [4, 5, 6];
/// The run in which the second turbine does not pitch: its loads alone are judged too.
const STILL: &str = "preview";
/// Runs of the case, and how the second turbine is driven in each.
const RUNS: [(&str, &str); 3] = [
    (STILL, "baseline"),
    ("preview-090", "pitching 4° at an offset of 90°"),
    ("preview-270", "pitching 4° at an offset of 270°"),
];

/// Makes the runs of `validation/cases/phase-preview.toml` with each seed, prints what each finds, and gives
/// the errors through the lidar as rows, root mean squares of all seeds.
pub fn phase_preview() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let mut squares = [[0.0; 2]; RUNS.len()];
    let mut by_loads = [0.0; 2];
    let add = |squares: &mut [f64; 2], errors: [f64; 2]| {
        for (square, error) in squares.iter_mut().zip(errors) {
            *square += error * error / SEEDS.len() as f64;
        }
    };
    for seed in SEEDS {
        let case = Carried::Own(include_str!("../../cases/phase-preview.toml"));
        let own = vec![format!("wind.seed={seed}")];
        let (_, folder) = summaries(case, &format!("phase-preview-{seed}"), own)?;
        for ((run, _), squares) in RUNS.iter().zip(&mut squares) {
            add(squares, errors(&folder.join(run), seed, None)?);
        }
        add(
            &mut by_loads,
            errors(&folder.join(STILL), seed, Some(Replayed::InRun(PhaseEstimator::Robust)))?,
        );
    }
    tell_all("blade loads alone", by_loads);
    let mut rows = Vec::new();
    for ((run, how), squares) in RUNS.iter().zip(squares) {
        let [tilt, yaw] = tell_all(run, squares);
        rows.extend([("tilt", tilt), ("yaw", yaw)].map(|(axis, error)| Row {
            what: format!(
                "two iea-15mw at 5 D, 10.5 m/s, turbulence 5 %, 12 cells a diameter, T2 {how}, its lidar upwind at 1.5 D: root mean square error of the phase of {axis}, {} seeds of 17 min",
                SEEDS.len()
            ),
            measured: error,
            expected: AIM,
            tolerance: AtMost,
            unit: "deg",
            source: SOURCE,
        }));
    }
    Ok(rows)
}

/// Prints and gives the roots (deg) of these mean `squares` of tilt and yaw.
fn tell_all(what: &str, squares: [f64; 2]) -> [f64; 2] {
    let [tilt, yaw] = squares.map(f64::sqrt);
    tell!("{what}, all seeds: {tilt:.1}° in tilt, {yaw:.1}° in yaw");
    [tilt, yaw]
}

/// Errors (deg) of tilt's and yaw's phase in the `run` in this folder, by its own estimate or by an
/// `estimator` over its records; prints them with bias and spread, and how late the loads are by a filter
/// that knows the future.
fn errors(run: &Path, seed: u64, estimator: Option<Replayed>) -> Result<[f64; 2], String> {
    let question = PhaseQuestion {
        run: run.to_owned(),
        turbine: Some("T2".to_owned()),
        truth: None,
        estimator,
        band: None,
        from: None,
    };
    let answer = phase(&question).map_err(|error| error.to_string())?;
    for (axis, name) in ["tilt", "yaw"].into_iter().enumerate() {
        let found = [&answer.tilt, &answer.yaw][axis].agreement;
        let [rmse, bias, spread] = [found.rmse, found.bias, found.spread].map(f64::to_degrees);
        let loads = answer.zero_phase.map(|found| found[axis].bias.to_degrees());
        let loads = loads.map_or(String::new(), |bias| format!(", of the loads {bias:+.1}°"));
        let by = if estimator.is_some() { ", by its loads" } else { "" };
        tell!(
            "seed {seed}, {}{by}, {name}: {rmse:.1}°, bias {bias:+.1}°, spread {spread:.1}°{loads}",
            answer.run
        );
    }
    Ok([&answer.tilt, &answer.yaw].map(|axis| axis.agreement.rmse.to_degrees()))
}
