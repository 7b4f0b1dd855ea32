//! The scans that a question about a hub vortex is put to, as a controller would have seen them.

use super::{HubVortexQuestion, VortexFilter};
use crate::PostprocessingError;
use crate::error::case_of;
use crate::phase::query::folder_of;
use basis::scan::Scan;
use control::Control;
use farm::case::Case;
use formats::records::{self, RunFolder, StoredScans};
use std::ops::Range;
use std::path::PathBuf;

/// Share of an interval by which rounding may be early (–).
const EARLY: f64 = 1e-6;
/// Range that is looked at of several when none is asked for (rotor diameters).
const USUAL_RANGE: f64 = 1.0;

/// Scans of one lidar, sampled as its turbine's controller would.
pub(crate) struct Sampled {
    /// All that the file holds.
    pub(crate) stored: StoredScans,
    /// The points that are looked at.
    pub(super) points: Range<usize>,
    /// Time between samples (s).
    pub(super) interval: f64,
    /// Time of each sample (s), with the number of the latest scan then.
    pub(super) samples: Vec<(f64, usize)>,
    /// What the hub vortex's circle is taken to be about (m), where the controller was told.
    pub(super) centre: Option<[f64; 2]>,
    /// How the controller found the hub vortex, where it looked for one.
    pub(super) filter: Option<VortexFilter>,
    /// Where the analysed time begins (s).
    pub(crate) spin_up: f64,
    /// The file.
    path: PathBuf,
}

/// The scans that `question` is about.
///
/// # Errors
/// [`PostprocessingError::Scans`] where the run kept none, with the key to add.
pub(crate) fn scans_of(question: &HubVortexQuestion) -> Result<Sampled, PostprocessingError> {
    let folder = folder_of(&question.run);
    let manifest = records::read_manifest(&folder)?;
    let case = case_of(&folder, &manifest)?;
    let control = &case.runs[manifest.run_index].control;
    let is_asked = |wanted: &Option<String>, name: &str| wanted.as_ref().is_none_or(|w| w == name);
    let turbines = case.turbines.iter().zip(control);
    let found = turbines
        .filter(|(turbine, control)| {
            control.is_there() && is_asked(&question.turbine, &turbine.name)
        })
        .flat_map(|(turbine, control)| turbine.sensors.iter().map(move |s| (turbine, control, s)))
        .filter(|(_, _, sensor)| is_asked(&question.lidar, &sensor.name))
        .map(|(turbine, control, sensor)| (folder.scans_path(&turbine.name, &sensor.name), control))
        .find(|(path, _)| path.is_file());
    let (path, control) = found.ok_or_else(|| without(&folder, &case, question))?;
    Sampled::read(path, control, case.time.spin_up, question)
}

/// Why there are no scans to answer `question` with, and what to add to the case.
fn without(folder: &RunFolder, case: &Case, question: &HubVortexQuestion) -> PostprocessingError {
    let turbine = question.turbine.as_deref().unwrap_or("a turbine");
    let sensor = question.lidar.as_deref().unwrap_or("lidar");
    let run = folder.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    let kept = records::scan_paths(folder).unwrap_or_default();
    let names = kept.iter().filter_map(|path| path.file_name()?.to_str().map(str::to_owned));
    let names: Vec<String> = names.collect();
    let fix = if !case.output.keeps_scans {
        format!(
            "take output.scans = \"none\" out of the case, and make the run again with `wakemix run CASE --run {run} --overwrite`"
        )
    } else if names.is_empty() {
        format!(
            "give {turbine} of the case a lidar, sensors.{sensor} = {{ kind = \"lidar\" }}, and make the run again with `wakemix run CASE --run {run} --overwrite`; runs of earlier versions kept no scans"
        )
    } else {
        format!("it has {}: name turbine and lidar with --turbine and --lidar", names.join(", "))
    };
    let problem = format!("holds no scans of a lidar of {turbine}");
    PostprocessingError::Scans { path: folder.path().to_owned(), problem, fix }
}

impl Sampled {
    /// The scans at `path` of a turbine under `control`, whose analysed time begins at `spin_up` (s).
    ///
    /// # Errors
    /// [`PostprocessingError`] for a file that cannot be read, or holds too few scans.
    pub(crate) fn read(
        path: PathBuf,
        control: &Control,
        spin_up: f64,
        question: &HubVortexQuestion,
    ) -> Result<Self, PostprocessingError> {
        let stored = records::read_scans(&path)?;
        let values = control.values();
        let centre = match values.numbers("vortex_centre") {
            [left, up] => Some([*left, *up]),
            _ => None,
        };
        let named = values.word("vortex_filter");
        let filter = VortexFilter::ALL.into_iter().find(|filter| filter.name() == named);
        let (first, last) = (stored.times.first(), stored.times.last());
        let spacing = first
            .zip(last)
            .map(|(first, last)| (last - first) / stored.n_scans().saturating_sub(1).max(1) as f64);
        let interval = question.interval.or(values.optional_number("vortex_interval"));
        let interval = interval.or(spacing).unwrap_or(0.0);
        let wanted = question.range.unwrap_or(USUAL_RANGE) * stored.rotor_diameter;
        let off = |index: &usize| (mean_range(&stored, *index) - wanted).abs();
        let nearest = (0..stored.n_ranges).min_by(|a, b| off(a).total_cmp(&off(b)));
        let points = stored.points_at(nearest.unwrap_or(0));
        let samples = sampled(&stored.times, interval);
        let sampled = Self { stored, points, interval, samples, centre, filter, spin_up, path };
        if sampled.samples.len() < 2 {
            let fix = "make a longer run (time.duration), or ask for a shorter --interval";
            return Err(sampled.refused("which are too few to follow anything", fix));
        }
        Ok(sampled)
    }

    /// Times of the samples (s).
    pub(super) fn times(&self) -> Vec<f64> {
        self.samples.iter().map(|(time, _)| *time).collect()
    }

    /// The mean distance of the points that are looked at (m).
    pub(super) fn range(&self) -> f64 {
        self.stored.ranges[self.points.clone()].iter().sum::<f64>() / self.points.len() as f64
    }

    /// Whether the points that were measured lie downwind of the rotor.
    pub(super) fn is_downwind(&self) -> bool {
        let mut sum = 0.0;
        self.each(|_, scan| sum += scan.downwind().iter().filter(|x| x.is_finite()).sum::<f64>());
        sum > 0.0
    }

    /// Gives `take` each sample's time (s) and scan, of the points that are looked at.
    pub(super) fn each(&self, mut take: impl FnMut(f64, Scan)) {
        let mut reading = Vec::new();
        for (time, index) in &self.samples {
            self.stored.reading(*index, self.points.clone(), &mut reading);
            if let Some(scan) = Scan::of(&reading) {
                take(*time, scan);
            }
        }
    }

    /// Share of the points of all samples that have no speed (–).
    pub(super) fn missing(&self) -> f64 {
        let (mut n_valid, mut n) = (0, 0);
        self.each(|_, scan| {
            n_valid += scan.n_valid();
            n += scan.n_points();
        });
        1.0 - n_valid as f64 / n.max(1) as f64
    }

    /// These scans have no answer: the `problem` follows on "holds scans", `fix` says what to do.
    pub(super) fn refused(&self, problem: &str, fix: &str) -> PostprocessingError {
        let problem = format!("holds scans {problem}");
        PostprocessingError::Scans { path: self.path.clone(), problem, fix: fix.to_owned() }
    }

    /// Too few of them are settled after `from` (s).
    pub(super) fn too_short(&self, from: f64) -> PostprocessingError {
        let problem = format!(
            "that are too short: after {from} s the filter, or the mean over a period of the helix, has not settled before they end"
        );
        self.refused(
            &problem,
            "count from an earlier time with --from, or make a longer run (time.duration)",
        )
    }
}

/// The mean distance at range number `index` (m).
fn mean_range(stored: &StoredScans, index: usize) -> f64 {
    let points = stored.points_at(index);
    stored.ranges[points.clone()].iter().sum::<f64>() / points.len() as f64
}

/// Samples `interval` (s) apart as a controller takes them: each at the first of `times` (s) that is not
/// before it is due, with the scan of that time. Of scans that are further apart the latest is seen again
/// when due.
fn sampled(times: &[f64], interval: f64) -> Vec<(f64, usize)> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    if interval.is_nan() || interval <= 0.0 {
        return Vec::new();
    }
    let early = EARLY * interval;
    let n = ((last - first) / interval + EARLY).floor() as usize;
    let sample = |number: usize| {
        let due = first + number as f64 * interval;
        let next = times.partition_point(|time| *time < due - early);
        // A control instant lies between two scans where they are no further apart than samples.
        let at_next = |next: usize| times[next] - due < interval - early;
        if next < times.len() && at_next(next) {
            (times[next], next)
        } else {
            (due, next.max(1) - 1)
        }
    };
    (0..=n).map(sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_the_latest_scan_then() {
        let times: Vec<f64> = (0..40).map(|step| 0.1 * f64::from(step)).collect();
        let own = sampled(&times, 0.1);
        assert!(own.iter().enumerate().all(|(k, (time, index))| *index == k && *time == times[k]));
        let indices = |interval| sampled(&times, interval).into_iter().map(|(_, index)| index);
        assert_eq!(indices(1.0).collect::<Vec<_>>(), [0, 10, 20, 30]);
        // Due between control instants: the next one takes it.
        let coarse: Vec<f64> = (0..20).map(|step| 0.2 * f64::from(step)).collect();
        let taken: Vec<f64> = sampled(&coarse, 0.5).into_iter().map(|(time, _)| time).collect();
        for (time, expected) in taken.iter().zip([0.0, 0.6, 1.0, 1.6, 2.0]) {
            assert!((time - expected).abs() < 1e-12, "{taken:?}");
        }
        // Between scans that are further apart the one before is seen again.
        assert_eq!(indices(0.05).take(5).collect::<Vec<_>>(), [0, 0, 1, 1, 2]);
        assert!(sampled(&times, 0.0).is_empty() && sampled(&[], 0.1).is_empty());
    }
}
