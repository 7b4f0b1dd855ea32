//! Gains of a run over the run that it compares with, whenever that was made.

use crate::loads;
use crate::prepare::Setup;
use crate::summarise::Analysed;
use crate::{StudyError, Watcher, check_same};
use analysis::statistics::{BLOCK_LENGTH, gain};
use basis::records::{Series, Summary};
use farm::case::Run;
use formats::records::{self, RunFolder};

/// What a run can be compared with.
pub(crate) enum Comparison<'a> {
    /// With nothing: the case asks for none.
    None,
    /// With a run that is not made yet.
    Missing(&'a Run),
    /// With a run that was made of another case or other turbines: no comparison.
    Other(&'a Run),
    /// With this run.
    Made(&'a Run, Series),
}

/// Number of the run that run number `index` compares with.
pub(crate) fn compared(setup: &Setup, index: usize) -> Option<usize> {
    let runs = &setup.case.runs;
    let other = match &runs[index].compare_with {
        Some(name) => runs.iter().position(|run| run.name == *name),
        None => (index > 0).then_some(0),
    };
    other.filter(|&other| other != index)
}

/// What run number `index` can be compared with now.
///
/// # Errors
/// [`StudyError::File`] for records that cannot be read.
pub(crate) fn comparison<'a>(
    setup: &'a Setup,
    index: usize,
    folders: &[RunFolder],
) -> Result<Comparison<'a>, StudyError> {
    let Some(other) = compared(setup, index) else { return Ok(Comparison::None) };
    let (run, folder) = (&setup.case.runs[other], &folders[other]);
    if !folder.is_complete() {
        return Ok(Comparison::Missing(run));
    }
    match check_same(setup, run, folder) {
        Ok(()) => Ok(Comparison::Made(run, records::read_series(&folder.series_path())?)),
        Err(StudyError::OtherCase { .. }) => Ok(Comparison::Other(run)),
        Err(error) => Err(error),
    }
}

/// On return `summary`, which is that of `run`, holds its gains over the run `other`; each run comes with its series.
pub(crate) fn add(
    setup: &Setup,
    summary: &mut Summary,
    (run, series): (&Run, &Series),
    (other, other_series): (&Run, &Series),
) -> Result<(), StudyError> {
    let [own, there] = [series, other_series].map(|series| Analysed::new(series, setup));
    for (turbine, index) in summary.turbines.iter_mut().zip(run.present()) {
        if other.present().any(|there| there == index) {
            let channel = format!("{}.power_w", turbine.name);
            let [own_power, power] = [own.column(&channel)?, there.column(&channel)?];
            turbine.power_gain = Some(gain(own_power, power, own.interval, BLOCK_LENGTH)?);
            turbine.load_changes = loads::changes(&turbine.name, &own, &there)?;
        }
    }
    if other.present().eq(run.present()) {
        let names: Vec<&str> = summary.turbines.iter().map(|t| t.name.as_str()).collect();
        let [own_power, power] = [own.sum(&names, "power_w")?, there.sum(&names, "power_w")?];
        summary.array_power_gain = Some(gain(&own_power, &power, own.interval, BLOCK_LENGTH)?);
    }
    summary.compare_with = Some(other.name.clone());
    Ok(())
}

/// On return the summary of run number `index` holds its gains where the run that it compares with was made after it.
///
/// # Errors
/// [`StudyError::File`] for records that cannot be read or written.
pub(crate) fn catch_up(
    setup: &Setup,
    index: usize,
    folders: &[RunFolder],
    watcher: &mut dyn Watcher,
) -> Result<(), StudyError> {
    let (run, folder) = (&setup.case.runs[index], &folders[index]);
    let mut summary = records::read_summary(folder)?;
    if summary.compare_with.is_some() {
        return Ok(());
    }
    match comparison(setup, index, folders)? {
        Comparison::None => {}
        Comparison::Missing(Run { name, .. }) => watcher.warned(&format!(
            "{} has no gains: the run {name} that it compares with is not made yet; make it with --run {name} --resume",
            run.name
        )),
        Comparison::Other(Run { name, .. }) => watcher.warned(&format!(
            "{} has no gains: the run {name} was made with another version of the case or of a turbine",
            run.name
        )),
        Comparison::Made(other, other_series) => {
            let series = records::read_series(&folder.series_path())?;
            add(setup, &mut summary, (run, &series), (other, &other_series))?;
            records::write_summary(folder, &summary)?;
        }
    }
    Ok(())
}
