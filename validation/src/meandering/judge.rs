//! Loads and power of a run in the rotating disk beside those without control.

use super::rig::{INTERVAL, MOMENTS, Reading};
use crate::Row;
use crate::folds::{larger, worst};
use crate::least_squares::Fit;
use crate::row::Tolerance::{AtLeast, AtMost, Within};
use analysis::AnalysisError;
use analysis::fatigue::{REFERENCE_FREQUENCY, damage_equivalent_load};
use analysis::statistics::{change, mean, standard_deviation};
use basis::records::Statistic;
use flow::inflow::deterministic::RotatingDisk;

/// Where the expected values come from.
const SOURCE: &str = "van Veldhoven (2024), tables 4-4 and 4-6";

/// Blocks that intervals come from (s): two periods of the disk.
const BLOCK: f64 = 150.0;

/// What is kept of a run.
pub(super) struct Record {
    disk: RotatingDisk,
    /// Samples of [`MOMENTS`] (N m) and of power (W).
    samples: [Vec<f64>; 8],
    /// Tilt and yaw moment at the disk's frequency, block by block.
    fits: Vec<[Fit<3>; 2]>,
    /// Largest pitch off its mean on either axis (rad).
    pitch: f64,
}

impl Record {
    /// Nothing yet.
    pub(super) fn new(disk: RotatingDisk) -> Self {
        Self { disk, samples: Default::default(), fits: Vec::new(), pitch: 0.0 }
    }

    /// Takes in one instant.
    pub(super) fn take(&mut self, reading: &Reading) {
        if self.samples[0].len().is_multiple_of(block()) {
            self.fits.push(Default::default());
        }
        let values = reading.moments.iter().chain([&reading.power]);
        self.samples.iter_mut().zip(values).for_each(|(samples, value)| samples.push(*value));
        let (sine, cosine) = self.disk.phase(reading.time).sin_cos();
        if let Some([tilt, yaw]) = self.fits.last_mut() {
            tilt.add([1.0, sine, cosine], reading.loads.tilt);
            yaw.add([1.0, sine, cosine], reading.loads.yaw);
        }
        let pitch = larger(reading.pitch.tilt.abs(), reading.pitch.yaw.abs());
        self.pitch = larger(self.pitch, pitch);
    }

    /// Amplitudes of tilt and yaw (N m) at the disk's frequency, means over the blocks.
    fn amplitudes(&self) -> [f64; 2] {
        [0, 1].map(|axis| {
            let amplitude = |fits: &[Fit<3>; 2]| {
                let [_, sine, cosine] = fits[axis].parts();
                sine.hypot(cosine)
            };
            self.fits.iter().map(amplitude).sum::<f64>() / self.fits.len() as f64
        })
    }
}

fn block() -> usize {
    (BLOCK / INTERVAL).round() as usize
}

/// Change from `before` to `now` of what `of` makes of the samples number `index`.
fn changed(
    before: &Record,
    now: &Record,
    index: usize,
    of: impl Fn(&[f64]) -> Result<f64, AnalysisError>,
) -> Statistic {
    change(&now.samples[index], &before.samples[index], INTERVAL, BLOCK, of)
        .expect("loads are finite, none rests, and the records are equally long")
}

/// The change of `name` as measured beside the published one (%).
pub(super) fn beside(what: String, name: &str, change: &Statistic, expected: f64) -> Row {
    // Another wind, controller and code: five points or a third of the change; one point of power.
    let least = if name == "power" { 1.0 } else { 5.0 };
    Row {
        what,
        measured: 100.0 * change.mean,
        expected,
        tolerance: Within((expected.abs() / 3.0).max(least)),
        unit: "%",
        source: SOURCE,
    }
}

/// The amplitude on `axis` that was reached over the target, `factor` of the baseline's.
pub(super) fn reached(name: &str, factor: f64, axis: &str, measured: f64) -> Row {
    Row {
        what: format!("{name}, factor {factor}: amplitude reached in {axis}"),
        measured,
        expected: factor,
        // Three per cent of the factor, or one of the baseline where the target is near zero.
        tolerance: Within((0.03 * factor).max(0.01)),
        unit: "–",
        source: SOURCE,
    }
}

/// The change in per cent, with its interval where there is one.
pub(super) fn percent(change: &Statistic) -> String {
    let interval =
        change.half_width_95.map_or_else(String::new, |half| format!(" ± {:.1}", 100.0 * half));
    format!("{:+.1}{interval}", 100.0 * change.mean)
}

/// Prints a row of a table.
pub(super) fn print_line(name: &str, cells: &[String]) {
    tell!("| {name} | {} |", cells.join(" | "));
}

/// Runs beside the one without control.
pub(super) struct Table<'a> {
    /// What sets these runs apart.
    name: &'a str,
    baseline: &'a Record,
    runs: Vec<Run>,
}

/// A run beside the one without control.
struct Run {
    /// Target factor, and the one reached on both axes (–).
    factor: f64,
    reached: [f64; 2],
    /// Largest pitch on either axis (rad).
    pitch: f64,
    /// Of the deviations and of mean power.
    changes: [Statistic; 8],
    /// Of the equivalent loads.
    equivalents: [Statistic; 7],
}

impl<'a> Table<'a> {
    pub(super) fn new(name: &'a str, baseline: &'a Record) -> Self {
        Self { name, baseline, runs: Vec::new() }
    }

    /// Takes in a run with a target of `factor` times the baseline's amplitude; says what it reached.
    pub(super) fn add(&mut self, factor: f64, record: Record) -> Vec<Row> {
        let before = self.baseline;
        let changes = std::array::from_fn(|index| {
            let of = if index < MOMENTS.len() { standard_deviation } else { mean };
            changed(before, &record, index, |samples| Ok(of(samples)))
        });
        let equivalents = std::array::from_fn(|index| {
            let slope = MOMENTS[index].2;
            changed(before, &record, index, |samples| {
                damage_equivalent_load(samples, INTERVAL, slope, REFERENCE_FREQUENCY)
            })
        });
        let (now, then) = (record.amplitudes(), before.amplitudes());
        let shares = [0, 1].map(|axis| now[axis] / then[axis]);
        self.runs.push(Run { factor, reached: shares, pitch: record.pitch, changes, equivalents });
        ["tilt", "yaw"]
            .into_iter()
            .zip(shares)
            .map(|(axis, measured)| reached(self.name, factor, axis, measured))
            .collect()
    }

    /// Prints all changes with their intervals.
    pub(super) fn print(&self) {
        tell!("\n{}:\n", self.name);
        let line = |name: String, cells: Vec<String>| print_line(&name, &cells);
        let cells = |of: &dyn Fn(usize) -> String| (0..self.runs.len()).map(of).collect();
        line("target factor".into(), cells(&|run| format!("{}", self.runs[run].factor)));
        line("---".into(), cells(&|_| "---".into()));
        for (axis, name) in ["tilt", "yaw"].into_iter().enumerate() {
            line(
                format!("reached in {name}"),
                cells(&|run| format!("{:.3}", self.runs[run].reached[axis])),
            );
        }
        line(
            "largest pitch, deg".into(),
            cells(&|run| format!("{:.1}", self.runs[run].pitch.to_degrees())),
        );
        for (index, (name, _, _)) in MOMENTS.iter().enumerate() {
            let before = 1e-3 * standard_deviation(&self.baseline.samples[index]);
            let name = format!("{name}, deviation (baseline {before:.0} kN m), %");
            line(name, cells(&|run| percent(&self.runs[run].changes[index])));
        }
        let power = 1e-3 * mean(&self.baseline.samples[7]);
        let name = format!("power (baseline {power:.0} kW), %");
        line(name, cells(&|run| percent(&self.runs[run].changes[7])));
        for (index, (name, _, slope)) in MOMENTS.iter().enumerate() {
            let name = format!("{name}, equivalent load (m = {slope}), %");
            line(name, cells(&|run| percent(&self.runs[run].equivalents[index])));
        }
    }

    /// What is claimed of factor 0.75, and the changes that were published (%) beside ours.
    pub(super) fn claims(&self, published: &[(f64, [f64; 8])]) -> Vec<Row> {
        let mut rows = Vec::new();
        for Run { factor, changes, .. } in &self.runs {
            if *factor == 0.75 {
                // Where nothing is pitched nothing changes, which is no attenuation.
                let pitched = changes.iter().any(|change| change.mean != 0.0);
                let of = |change: f64| if pitched { change } else { f64::NAN };
                let largest = of(worst(changes[..7].iter().map(|change| change.mean)));
                // All seven fall.
                rows.push(Row {
                    what: format!("{}, factor 0.75: largest change of the deviations", self.name),
                    measured: largest,
                    expected: 0.0,
                    tolerance: AtMost,
                    unit: "–",
                    source: SOURCE,
                });
                rows.push(Row {
                    what: format!("{}, factor 0.75: change of power", self.name),
                    measured: of(changes[7].mean),
                    expected: -0.01,
                    tolerance: AtLeast,
                    unit: "–",
                    source: SOURCE,
                });
            }
            let Some((_, expected)) = published.iter().find(|(f, _)| f == factor) else { continue };
            let names = MOMENTS.iter().map(|(name, _, _)| *name).chain(["power"]);
            for ((name, change), expected) in names.zip(changes).zip(expected) {
                let what = format!("{}, factor {factor}: {name}, beside table 4-4", self.name);
                rows.push(beside(what, name, change, *expected));
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is claimed of a run at factor 0.75 in which everything changes by `change` (–).
    fn claims_of(change: f64) -> Vec<Row> {
        let baseline = Record::new(RotatingDisk::of_wake(240.0, 150.0, 16.0, true));
        let changed =
            Statistic { mean: change, standard_deviation: 0.0, half_width_95: None, n_blocks: 6 };
        let (changes, equivalents) = ([changed; 8], [changed; 7]);
        let run = Run { factor: 0.75, reached: [1.0; 2], pitch: 0.0, changes, equivalents };
        Table { name: "made up", baseline: &baseline, runs: vec![run] }.claims(&[])
    }

    #[test]
    fn a_loop_that_pitches_nothing_meets_no_claim() {
        assert_eq!(claims_of(0.0).len(), 2);
        assert!(claims_of(0.0).iter().all(|row| !row.passes()));
        assert!(claims_of(-0.001).iter().all(Row::passes));
        assert!(claims_of(f64::NAN).iter().all(|row| !row.passes()));
    }
}
