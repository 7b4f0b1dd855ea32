//! Signals of studies and their spectra, made into the data of figures.

pub(crate) mod blade_moments;
mod helix_frame;
pub(crate) mod meandering;
mod scans;
pub(crate) mod spectra;

use crate::PostprocessingError;
use crate::error::case_in;
use analysis::AnalysisError;
use analysis::spectra::{Spectrum, power_density};
use basis::channels::TIME;
use basis::records::Series;
use farm::case::{Case, Control, Sense, helix_upstream};
use formats::records::{RunRecords, StudyRecords};
use report::{Signals, SpectrumLine};
use std::path::Path;

/// Periods of the slow frequency in a segment of a density (–): so many values lie below that frequency.
const SEGMENT_PERIODS: f64 = 8.0;

/// All signals that the report of the study in `directory` shows; `records` are its own. What the rows are
/// too few or too far apart for is no reason to withhold the rest of a report.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be analysed.
pub(crate) fn of_study(
    records: &StudyRecords,
    directory: &Path,
) -> Result<Vec<Signals>, PostprocessingError> {
    let case = case_in(directory, &records.case_text)?;
    let mut signals = Vec::new();
    for answer in unless_coarse(spectra::of_study(&case, records))? {
        signals.push(answer.signals());
    }
    for found in unless_coarse(meandering::of_study(&case, records))? {
        signals.push(found.signals());
    }
    signals.extend(helix_frame::of_study(&case, records)?);
    signals.extend(scans::of_study(&case, records)?);
    Ok(signals)
}

/// `found`, or nothing where rows are too few or too far apart.
fn unless_coarse<T: Default>(
    found: Result<T, PostprocessingError>,
) -> Result<T, PostprocessingError> {
    use AnalysisError::{AboveNyquist, TooShort};
    match found {
        Err(PostprocessingError::Analysis {
            source: AboveNyquist { .. } | TooShort { .. },
            ..
        }) => Ok(T::default()),
        found => found,
    }
}

/// What controls the turbines of `case` in `run`; nothing where that is of another version of the case.
fn control_of<'c>(case: &'c Case, run: &RunRecords) -> &'c [Control] {
    let found = case.runs.get(run.manifest.run_index);
    found.map(|run| run.control.as_slice()).unwrap_or_default()
}

/// Sense and Strouhal number of the helix from upstream that meets turbine `index` of `case` in `run`.
fn helix_in(case: &Case, run: &RunRecords, index: usize) -> Option<(Sense, f64)> {
    let control = control_of(case, run);
    let is_whole = control.len() == case.turbines.len();
    is_whole.then(|| helix_upstream(index, &case.places(), control)).flatten()
}

/// First row of `series` from `from` (s) on, the times from there, and their distance (s); nothing where
/// there are fewer than two.
pub(crate) fn analysed(series: &Series, from: f64) -> Option<(usize, &[f64], f64)> {
    let times = series.column(&TIME.name)?;
    let first = times.iter().position(|time| *time >= from)?;
    let rest = &times[first..];
    let (begin, end) = (rest.first()?, rest.last()?);
    (rest.len() > 1).then(|| (first, rest, (end - begin) / (rest.len() - 1) as f64))
}

/// Density of `samples`, one each `interval` (s), in segments of eight periods of `frequency` (Hz), or of as
/// many as half of the record holds, so that one of its values lies at that frequency; nothing where that is
/// none.
///
/// # Errors
/// [`PostprocessingError::Analysis`] for another reason.
fn density(
    samples: &[f64],
    interval: f64,
    frequency: f64,
) -> Result<Option<Spectrum>, PostprocessingError> {
    let held = (0.5 * samples.len() as f64 * interval * frequency).floor();
    let n_segment = (held.min(SEGMENT_PERIODS) / (frequency * interval)).round() as usize;
    match power_density(samples, interval, n_segment) {
        Ok(found) => Ok(Some(found)),
        Err(AnalysisError::TooShort { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// `found` as the line of a run called `name`, in the colour of index `colour`.
fn line(name: &str, colour: usize, found: Spectrum) -> SpectrumLine {
    let Spectrum { frequency_step, values } = found;
    SpectrumLine { name: name.to_owned(), colour, frequency_step, values }
}

/// `line` for programs: frequencies from zero, a step apart.
pub(crate) fn line_json(line: &SpectrumLine) -> serde_json::Value {
    serde_json::json!({
        "run": line.name,
        "frequency_step_hz": line.frequency_step,
        "density": line.values,
    })
}
