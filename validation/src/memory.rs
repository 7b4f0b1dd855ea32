//! Memory of a run: ten minutes, an hour and three of one flexible turbine in turbulence, each in a process
//! of its own.

use crate::Row;
use crate::row::Tolerance::AtMost;
use crate::studies::{command, failure};
use formats::machine;
use formats::records::{RunFolder, read_summary};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

/// Where the expected values come from.
const SOURCE: &str = "aim of the project, set before it was measured";

/// The shipped case with the turbine, and the run of it.
const CASE: &str = "one-turbine";
const RUN: &str = "baseline";
/// Simulated time of the runs (s), the shortest first.
const DURATIONS: [u64; 3] = [600, 3600, 10_800];
/// Most memory that a run may take (MB).
const MOST: f64 = 200.0;
/// Most that a longer run may take beyond the shortest (MB): making the box of turbulence takes 88 MB for the
/// shortest, and 134 MB at most for any.
const MOST_GROWTH: f64 = 46.0;
/// Wall time between two looks at a running process.
const LOOK_INTERVAL: Duration = Duration::from_millis(5);

/// Most memory of a run as its summary tells it and as it is seen from outside, its report included; and how
/// it grows with length.
///
/// A process tells the most that it ever held, so each run has one of its own, which holds nothing of this
/// validation's.
pub fn memory() -> Vec<Row> {
    compare().unwrap_or_else(failure)
}

fn compare() -> Result<Vec<Row>, String> {
    let folder = std::env::temp_dir().join(format!("wakemix-memory-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let mut rows = Vec::new();
    let mut peaks = Vec::new();
    for duration in DURATIONS {
        let output = folder.join(duration.to_string());
        let mut run = command(Path::new(CASE), &output);
        run.args(["--run", RUN, "--set", &format!("time.duration={duration}")]);
        let seen = most_of(&mut run)?;
        let summary = read_summary(&RunFolder::new(&output, RUN));
        let reported = summary.map_err(|error| error.to_string())?.cost.peak_memory;
        let (Some(seen), Some(reported)) = (seen, reported) else {
            let problem = "this system does not tell what a process held; repeat it on Linux";
            return Err(problem.to_owned());
        };
        let what = |which: &str| format!("{duration} s of one turbine in turbulence: {which}");
        rows.push(row(what("most memory, as reported"), megabytes(reported), MOST));
        rows.push(row(what("report included, as seen"), megabytes(seen), MOST));
        peaks.push(megabytes(seen));
    }
    fs::remove_dir_all(&folder).map_err(|error| error.to_string())?;
    for (duration, peak) in DURATIONS.iter().zip(&peaks).skip(1) {
        let what = format!("growth from {} to {duration} s", DURATIONS[0]);
        rows.push(row(what, peak - peaks[0], MOST_GROWTH));
    }
    Ok(rows)
}

/// Most memory that `run` holds from its start to its end (bytes); none where the system does not report it.
fn most_of(run: &mut Command) -> Result<Option<u64>, String> {
    let mut child = run.spawn().map_err(|error| error.to_string())?;
    let mut most = None;
    let status = loop {
        most = machine::peak_memory_of(child.id()).max(most);
        match child.try_wait().map_err(|error| error.to_string())? {
            Some(status) => break status,
            None => sleep(LOOK_INTERVAL),
        }
    };
    if status.success() {
        Ok(most)
    } else {
        Err(format!("the run of {CASE} ended with {status}; `wakemix run {CASE}` says why"))
    }
}

fn megabytes(bytes: u64) -> f64 {
    1e-6 * bytes as f64
}

fn row(what: String, measured: f64, most: f64) -> Row {
    Row { what, measured, expected: most, tolerance: AtMost, unit: "MB", source: SOURCE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_process_held_is_seen_and_a_failure_reported() {
        // What this process holds is not what the other does.
        let held = std::hint::black_box(vec![1_u8; 64 << 20]);
        let seen = most_of(Command::new("sleep").arg("0.05")).unwrap();
        assert_eq!(seen.is_some(), machine::peak_memory().is_some());
        assert!(seen.is_none_or(|seen| seen > 0 && seen < held.len() as u64 / 2), "{seen:?}");
        let refused = most_of(&mut Command::new("false"));
        assert!(
            refused.is_err_and(|problem| problem.contains("`wakemix run one-turbine` says why"))
        );
    }
}
