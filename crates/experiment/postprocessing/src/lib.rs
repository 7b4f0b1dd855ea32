//! What records of runs tell afterwards: the phase of a helix, gains over several winds, what a loop would
//! lock to; the wake by phases, its energy, vortices and modes; and the report.
//!
//! Records in, numbers out: nothing is simulated here. [`ANALYSES`] lists what `wakemix analyse` offers.

pub mod analyses;
mod changes;
mod error;
mod hub_vortex;
mod lock;
mod over_offset;
mod phase;
mod precursor;
mod request;
mod seeds;
mod signals;
mod sweep;
mod synchronisation;
mod wake_fields;
mod wakes_in_report;
mod winds;

pub use analyses::{ANALYSES, Analysis};
pub use changes::{
    Change, ChangesAnswer, ChangesQuestion, ChangesRow, ChangesWind, Quantity, changes,
};
pub use error::PostprocessingError;
pub use hub_vortex::{
    HubVortexAnswer, HubVortexNumbers, HubVortexQuestion, HubVortexTrack, VortexFilter, hub_vortex,
};
pub use lock::{LockAnswer, LockQuestion, lock};
pub use over_offset::over_offset;
pub use phase::{
    PhaseAnswer, PhaseAnswers, PhaseAxis, PhaseQuestion, PreviewUse, Replayed, phase, phases, tune,
};
pub use precursor::report_of_precursor;
pub use seeds::{GainsAnswer, GainsQuestion, PartGains, RunGains, SeedsError, gains_over_seeds};
pub use signals::blade_moments::{MomentsAnswer, MomentsLine, MomentsQuestion, moments};
pub use signals::meandering::{MeanderingAxisNumbers, MeanderingNumbers, meandering};
pub use signals::spectra::{SpectraAnswer, SpectraLine, spectra};
pub use synchronisation::curve::offset_panel;
pub use winds::{WindNumbers, wind_numbers};

use basis::records::{Summary, SweepTable};
use error::InRecords;
use formats::{leftovers, records};
use std::path::{Path, PathBuf};

/// What a report is made of, and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportMade {
    /// The runs' numbers, of all studies.
    pub summaries: Vec<Summary>,
    /// What came of the sweep, where it is one.
    pub sweep: Option<SweepTable>,
    /// The page.
    pub page: PathBuf,
}

/// Makes the report of the study in `directory` from its records; of a sweep that of each of its studies,
/// `sweep.html` over all of them, and its table; of a precursor its page.
///
/// Where several processes do so at once, each waits for the one before: the last report tells of all runs
/// that were complete when it began.
///
/// # Errors
/// [`PostprocessingError::File`] for records that cannot be read, [`PostprocessingError::Report`] for a
/// report that cannot be written.
pub fn report(directory: &Path) -> Result<ReportMade, PostprocessingError> {
    if precursor::is_precursor(directory) {
        let page = report_of_precursor(directory)?;
        return Ok(ReportMade { summaries: Vec::new(), sweep: None, page });
    }
    let Some(swept) = records::read_sweep(directory)? else {
        let (summaries, page) = report_of_study(directory, report::write)?;
        return Ok(ReportMade { summaries, sweep: None, page });
    };
    let mut summaries = Vec::new();
    for study in sweep::studies_with_runs(directory, &swept) {
        summaries.extend(report_of_study(&study, report::write)?.0);
    }
    let _lock = records::lock_shared(directory, "sweep")?;
    let table = sweep::table(directory, &swept)?;
    records::write_table(directory, &table)?;
    let page = report::write_sweep(&table, env!("CARGO_PKG_VERSION"), directory)?;
    Ok(ReportMade { summaries, sweep: Some(table), page })
}

/// Makes the page of the study in `study` while further runs of it are to come, without figures beside it;
/// where `directory`, in which it is, is that of a sweep, `sweep.html` too. Gives the page over all.
///
/// # Errors
/// Those of [`report()`].
pub fn report_so_far(directory: &Path, study: &Path) -> Result<PathBuf, PostprocessingError> {
    let (_, page) = report_of_study(study, report::write_page)?;
    let Some(swept) = records::read_sweep(directory)? else { return Ok(page) };
    let _lock = records::lock_shared(directory, "sweep")?;
    let table = sweep::table(directory, &swept)?;
    Ok(report::write_sweep_page(&table, env!("CARGO_PKG_VERSION"), directory)?)
}

/// Writes what is of a report into a folder.
type Write = fn(&report::StudyRecords, &Path) -> Result<(), report::ReportError>;

/// Has `write` make the report of the one study in `directory`; gives the summaries and the report's path.
fn report_of_study(
    directory: &Path,
    write: Write,
) -> Result<(Vec<Summary>, PathBuf), PostprocessingError> {
    if !directory.is_dir() {
        // The reader says what is wrong; a lock would make the folder.
        records::read_study(directory)?;
    }
    let _lock = records::lock_shared(directory, "report")?;
    for folder in [directory.to_owned(), directory.join("figures")] {
        if folder.is_dir() {
            leftovers::remove_abandoned(&folder, None)?;
        }
    }
    let study = records::read_study(directory)?;
    let synchronisation =
        synchronisation::synchronisation(&study, directory).in_records(directory)?;
    let mut signals = signals::of_study(&study, directory).in_records(directory)?;
    signals.extend(wakes_in_report::of_study(&study, directory)?);
    let mut runs = Vec::with_capacity(study.runs.len());
    let mut summaries = Vec::with_capacity(study.runs.len());
    for run in study.runs {
        let mut summary = run.summary;
        let series = run.series.read(|channel| report::draws(&summary, channel))?;
        summaries.push(summary.clone());
        summary.warnings.extend(study.warnings.iter().cloned());
        runs.push(report::RunRecords {
            summary,
            series,
            mean_planes: run.mean_planes,
            instant_planes: run.last_planes,
            filaments: run.last_filaments,
        });
    }
    let study = report::StudyRecords {
        case_name: study.case_name,
        description: study.description,
        case_text: study.case_text,
        runs,
        incomplete: study.incomplete,
        synchronisation,
        signals,
        version: study.version,
    };
    write(&study, directory)?;
    Ok((summaries, directory.join("report.html")))
}
