//! Tuning of a helix on two turbines in resolved flow from few runs, beside the optimum of a published study.

use crate::Row;
use crate::row::Tolerance::{self, AtLeast, Within};
use crate::studies::{Lines, failure, folder_of, words};
use formats::atomic;
use search::{Found, Normal, Sum};
use std::sync::atomic::AtomicBool;
use tuning::{TuneOptions, TuneOutcome, Tuned, Watch, tune};

const SOURCE: &str = "van der Hoek, Dammann, van Wingerden (2026), section 3.2, Figs. 7 and 8";
const OWN: &str = "this program's claim";
/// The study, of which the Strouhal number is mirrored: below zero the helix is clockwise.
const STUDY: &str = include_str!("../../examples/tune-helix.toml");
const PLAIN: &str = "key = \"control.T1.strouhal\"\n";
const MIRRORED: &str = "key = \"control.T1.strouhal\"\nmirrored = true\n";
/// The published optimum: Strouhal number (–), amplitude (°), gain of the array (%), and of the clockwise
/// helix at best (%).
const STROUHAL: f64 = 0.25;
const AMPLITUDE: f64 = 4.0;
const GAIN: f64 = 7.5;
const CLOCKWISE: f64 = 3.0;
/// How near to that is as good as there, by this program: with 2.5° the source's gain hardly changes from St
/// 0.2 to 0.4, and blocks of ten minutes differ by some percent.
const NEAR: [f64; 3] = [0.1, 1.0, 2.0];
/// Points along each side of the grids that are tried (–).
const GRIDS: std::ops::RangeInclusive<usize> = 3..=20;
/// Points along each side where the clockwise helix is looked for (–).
const FINE: usize = 200;

impl Watch for Lines {
    fn proposed(&mut self, first: usize, n_runs: usize, words: &[String], gain: Option<f64>) {
        for (place, words) in words.iter().enumerate() {
            let expected = gain.map_or(String::new(), |gain| {
                format!(", {:.2} % more are expected of the first", 100.0 * gain)
            });
            tell!("run {} of at most {n_runs}: {words}{expected}", first + place + 1);
        }
    }
}

/// Tunes amplitude and Strouhal number of a helix in either sense on two IEA 22 MW turbines, and gives the
/// optimum beside the published one, and what a plain grid costs for the same, as rows.
pub fn tuning_array() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let (folder, _lock) = folder_of("tuning-array")?;
    let study = folder.join("study.toml");
    let text = STUDY.replace(PLAIN, MIRRORED);
    atomic::write(&study, "the study", text.as_bytes()).map_err(|error| words(&error))?;
    let output = folder.join("tuning");
    let resume = output.join("points.json").is_file();
    let options = TuneOptions { study, output: Some(output), resume, dry_run: false };
    let outcome = tune(&options, &AtomicBool::new(false), &mut Lines::default());
    match outcome.map_err(|error| words(&error))? {
        TuneOutcome::Done(tuned) => rows(&tuned),
        other => Err(format!("the tuning ended early: {other:?}")),
    }
}

fn rows(tuned: &Tuned) -> Result<Vec<Row>, String> {
    let Found { optimum, sum, history, .. } = &tuned.found;
    let n_runs = history.len() as f64;
    let [strouhal, amplitude] = [optimum.point[0], optimum.point[1]];
    let best = 100.0 * optimum.value.mean;
    tell!(
        "{n_runs} runs: best at St {strouhal:.2} (95 % {:.2?}), {amplitude:.2}° (95 % {:.2?}): {best:+.2} ± {:.2} %",
        optimum.place_95[0],
        optimum.place_95[1],
        100.0 * optimum.half_width_95()
    );
    let (point, other) = best_clockwise(sum)?;
    for (point, gave) in history.points.iter().zip(&history.evaluations) {
        let of_one = |blocks: &Vec<f64>| blocks.iter().sum::<f64>() / blocks.len() as f64;
        let gain = gave.outputs.iter().map(of_one).sum::<f64>();
        tell!("run at St {:+.2}, {:.2}°: {:+.2} %", point[0], point[1], 100.0 * gain);
    }
    tell!(
        "clockwise: best at St {:.2}, {:.2}°: {:+.2} ± {:.2} %",
        point[0],
        point[1],
        100.0 * other.mean,
        50.0 * (other.band_95()[1] - other.band_95()[0])
    );
    let of_grid = grid(sum, &optimum.point)?;
    Ok(vec![
        row(
            "best Strouhal number, below zero were clockwise",
            strouhal,
            STROUHAL,
            Within(NEAR[0]),
            "–",
            SOURCE,
        ),
        row("best amplitude", amplitude, AMPLITUDE, Within(NEAR[1]), "°", SOURCE),
        row("gain of the array at its best", best, GAIN, Within(NEAR[2]), "%", SOURCE),
        row(
            "gain of the array by the clockwise helix at its best",
            100.0 * other.mean,
            CLOCKWISE,
            Within(NEAR[2]),
            "%",
            SOURCE,
        ),
        row(
            "runs of a plain square grid that leave as little variance at the optimum found as the tuning's own do",
            of_grid,
            n_runs,
            AtLeast,
            "runs",
            OWN,
        ),
    ])
}

/// Where the clockwise helix gains most, and what.
fn best_clockwise(sum: &Sum) -> Result<(Vec<f64>, Normal), String> {
    let mut points = sum.space().lattice(FINE);
    points.retain(|point| point[0] < 0.0);
    let values = sum.at(&points).map_err(|error| error.to_string())?;
    let best = points.into_iter().zip(values).max_by(|a, b| a.1.mean.total_cmp(&b.1.mean));
    let (point, value) = best.ok_or("no point is clockwise")?;
    let deviation = value.deviation.hypot(sum.shared_deviation());
    Ok((point, Normal { deviation, ..value }))
}

/// Runs of the smallest square grid that leave no more uncertainty at `point` than `sum` has, under its
/// processes (–).
fn grid(sum: &Sum, point: &[f64]) -> Result<f64, String> {
    let point = [point.to_vec()];
    let deviation = |sum: &Sum| {
        let found = sum.at(&point).map_err(|error| error.to_string())?;
        Ok::<_, String>(found[0].deviation)
    };
    let own = deviation(sum)?;
    for side in GRIDS {
        let other = deviation(
            &sum.instead(&sum.space().lattice(side)).map_err(|error| error.to_string())?,
        )?;
        tell!("grid of {side} by {side}: {:.2} % there, tuned {:.2} %", 100.0 * other, 100.0 * own);
        if other <= own {
            return Ok((side * side) as f64);
        }
    }
    Err(format!("no grid of up to {0} by {0} tells as much", GRIDS.end()))
}

fn row(
    what: &str,
    measured: f64,
    expected: f64,
    tolerance: Tolerance,
    unit: &'static str,
    source: &'static str,
) -> Row {
    let what = format!("two iea-22mw at 5 D, 8 m/s, TI 5.5 %, 16 cells a diameter: {what}");
    Row { what, measured, expected, tolerance, unit, source }
}
