//! Tuning of the helix on the published array, in resolved flow: what twenty runs find beside the published
//! optimum, and how many runs a plain grid takes to know the gain as well.

use crate::Row;
use crate::row::Tolerance::{self, AtLeast, AtMost, Within};
use crate::studies::{Lines, failure, folder_of, words};
use formats::atomic;
use search::{Normal, Optimum, SearchError, Sum};
use std::sync::atomic::AtomicBool;
use tuning::{TuneOptions, TuneOutcome, Tuned};

const SOURCE: &str = "van der Hoek, Dammann, van Wingerden (2026), section 3.2";
const OWN: &str = "this program's claim";

/// The tuning: that of the counter-clockwise helix.
const STUDY: &str = include_str!("../../examples/tune-helix.toml");
/// How it takes in the clockwise one, and makes two runs at a time.
const OTHERWISE: [(&str, &str); 2] = [
    ("key = \"control.T1.strouhal\"\n", "key = \"control.T1.strouhal\"\nmirrored = true\n"),
    ("runs = 20\n", "runs = 20\nparallel = 2\n"),
];

/// Most runs (–).
const BUDGET: f64 = 20.0;
/// Published optimum: Strouhal number (–) and amplitude (°), and how far ours may lie from each.
const PLACE: [(&str, f64, f64, &str); 2] =
    [("Strouhal number", 0.25, 0.05, "-"), ("amplitude", 4.0, 1.0, "deg")];
/// Published gains of the best helix of either sense (%), and how far ours may lie from each: as in
/// `wakemix validate helix`, the half width of a run's 95 % interval.
const GAINS: [(&str, f64, f64, f64); 2] =
    [("counter-clockwise", 1.0, 7.5, 2.3), ("clockwise", -1.0, 3.0, 1.34)];
/// Levels along each variable of the grids that are tried (–).
const GRIDS: std::ops::RangeInclusive<usize> = 2..=30;

/// Tunes amplitude and Strouhal number of both senses on two IEA 22 MW at 5 D in 8 m/s.
pub fn tuning_of_the_published_array() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let (folder, _lock) = folder_of("tuning-array")?;
    let study = folder.join("tune-helix.toml");
    let text = OTHERWISE.iter().fold(STUDY.to_owned(), |text, (from, to)| text.replace(from, to));
    atomic::write(&study, "a study of a tuning", text.as_bytes()).map_err(|error| words(&error))?;
    let output = folder.join("tuning");
    let resume = output.join("points.json").is_file();
    let options = TuneOptions { study, output: Some(output), resume, dry_run: false };
    let outcome = tuning::tune(&options, &AtomicBool::new(false), &mut Lines::default());
    match outcome.map_err(|error| words(&error))? {
        TuneOutcome::Done(tuned) => rows(&tuned).map_err(|error| error.to_string()),
        other => Err(format!("the tuning ended early: {other:?}")),
    }
}

fn rows(tuned: &Tuned) -> Result<Vec<Row>, SearchError> {
    let found = &tuned.found;
    let n_runs = found.history.len();
    let clockwise = found.history.points.iter().filter(|point| point[0] < 0.0).count();
    tell!("{n_runs} runs, {clockwise} of them clockwise; {}", tuned.page.display());
    tell_optimum(&found.optimum);
    let candidates = found.sum.space().candidates(tuned.file.seed);
    let values = found.sum.at(&candidates)?;
    let mut rows =
        vec![row("runs made, the baseline aside", n_runs as f64, (BUDGET, AtMost), ("-", OWN))];
    for (name, sign, gain, within) in GAINS {
        let Some((point, value)) = best(&candidates, &values, sign) else { continue };
        let deviation = value.deviation.hypot(found.sum.shared_deviation());
        let [low, high] = Normal { deviation, ..value }.band_95().map(|gain| 100.0 * gain);
        tell!(
            "best {name} helix: St {:.2}, {:.2}°, {:.2} % of the array's power, {low:.2} to {high:.2} %",
            point[0].abs(),
            point[1],
            100.0 * value.mean
        );
        let what = format!("gain of the array with the best {name} helix");
        rows.push(row(&what, 100.0 * value.mean, (gain, Within(within)), ("%", SOURCE)));
        // A gain that nothing is known of could lie anywhere.
        let what = format!("half of the 95 % interval of that gain, {name}");
        rows.push(row(&what, 0.5 * (high - low), (within, AtMost), ("%", OWN)));
    }
    for ((name, published, within, unit), at) in PLACE.into_iter().zip(&found.optimum.point) {
        let what = format!("{name} of the optimum");
        rows.push(row(&what, *at, (published, Within(within)), (unit, SOURCE)));
    }
    let n_of_grid = runs_of_grid(&found.sum, &found.optimum)?;
    let what = "runs of the smallest grid that leaves as little variance of the gain where the optimum may lie";
    rows.push(row(what, n_of_grid, (BUDGET, AtLeast), ("-", OWN)));
    Ok(rows)
}

fn tell_optimum(optimum: &Optimum) {
    let [strouhal, amplitude] = [optimum.place_95[0], optimum.place_95[1]];
    let [low, high] = optimum.value.band_95().map(|gain| 100.0 * gain);
    let [least, most] = optimum.greatest_95.map(|gain| 100.0 * gain);
    tell!(
        "optimum: St {:.2} ({:.2} to {:.2}), {:.2}° ({:.2} to {:.2}), gain {:.2} % ({low:.2} to {high:.2}); the greatest gain anywhere {least:.2} to {most:.2} %; 95 % intervals",
        optimum.point[0],
        strouhal[0],
        strouhal[1],
        optimum.point[1],
        amplitude[0],
        amplitude[1],
        100.0 * optimum.value.mean
    );
}

/// The point of the greatest mean among `points` whose Strouhal number has this `sign`, and what is there.
fn best<'a>(
    points: &'a [Vec<f64>],
    values: &[Normal],
    sign: f64,
) -> Option<(&'a Vec<f64>, Normal)> {
    let of_sense = points.iter().zip(values.iter().copied()).filter(|(at, _)| sign * at[0] > 0.0);
    of_sense.max_by(|a, b| a.1.mean.total_cmp(&b.1.mean))
}

/// Runs of the smallest grid (–) after which the `sum` has as little variance as it has now, the mean over
/// where its `optimum` may lie; infinite where no grid that is tried has.
fn runs_of_grid(sum: &Sum, optimum: &Optimum) -> Result<f64, SearchError> {
    let variance = |sum: &Sum| {
        let points: Vec<Vec<f64>> = optimum.places.iter().map(|place| place.0.clone()).collect();
        let values = sum.at(&points)?.into_iter().zip(&optimum.places);
        Ok::<_, SearchError>(
            values.map(|(at, (_, share))| share * at.deviation.powi(2)).sum::<f64>(),
        )
    };
    let own = variance(sum)?;
    for levels in GRIDS {
        let grid = sum.space().lattice(levels);
        let left = variance(&sum.instead(&grid)?)?;
        tell!(
            "a grid of {} runs: deviation of the gain {:.2} % where the optimum may lie, {:.2} % after the tuning",
            grid.len(),
            100.0 * left.sqrt(),
            100.0 * own.sqrt()
        );
        if left <= own {
            return Ok(grid.len() as f64);
        }
    }
    Ok(f64::INFINITY)
}

fn row(
    what: &str,
    measured: f64,
    (expected, tolerance): (f64, Tolerance),
    (unit, source): (&'static str, &'static str),
) -> Row {
    let what = format!("two iea-22mw at 5 D, 8 m/s, 16 cells a diameter: {what}");
    Row { what, measured, expected, tolerance, unit, source }
}
