//! Gains of a run over the run that it compares with, whenever that was made.

use crate::columns::{Analysed, Columns, add_to};
use crate::loads;
use crate::prepared::Prepared;
use crate::same_case::{WindDigests, check_same};
use crate::{Observer, StudyError};
use analysis::AnalysisError;
use analysis::statistics::gain;
use basis::channels::GEN_PWR;
use basis::records::{Statistic, Summary, TurbineSummary, Warning, WarningKind};
use farm::case::Run;
use formats::records::{self, RunFolder};

/// What a run can be compared with.
pub(crate) enum Comparison<'a> {
    /// With nothing: the case asks for none.
    None,
    /// With a run that is not made yet.
    Missing(&'a Run),
    /// With a run that was made of another case or other turbines, or by another program: no comparison.
    Other(&'a Run),
    /// With this run.
    Made(&'a Run, Columns),
}

/// Number of the run that run number `index` compares with.
pub(crate) fn compared(setup: &Prepared, index: usize) -> Option<usize> {
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
    setup: &'a Prepared,
    wind: &WindDigests,
    index: usize,
    folders: &[RunFolder],
) -> Result<Comparison<'a>, StudyError> {
    let Some(other) = compared(setup, index) else { return Ok(Comparison::None) };
    let (run, folder) = (&setup.case.runs[other], &folders[other]);
    if !folder.is_complete() {
        return Ok(Comparison::Missing(run));
    }
    let [own, there] = [&folders[index], folder].map(records::read_manifest);
    if own?.version != there?.version {
        return Ok(Comparison::Other(run));
    }
    match check_same(setup, wind, run, folder) {
        Ok(()) => Ok(Comparison::Made(run, Columns::open(folder, setup)?)),
        Err(
            StudyError::OtherCase { .. }
            | StudyError::OtherFile { .. }
            | StudyError::UntoldWind { .. },
        ) => Ok(Comparison::Other(run)),
        Err(error) => Err(error),
    }
}

/// On return `summary`, which is that of `run`, holds its gains over the run `other`, and warnings of those
/// that are not defined; each run comes with its columns.
pub(crate) fn add(
    summary: &mut Summary,
    (run, own): (&Run, &mut Columns),
    (other, there): (&Run, &mut Columns),
) -> Result<(), StudyError> {
    for columns in [&mut *own, &mut *there] {
        let expected = parts(summary, columns.names());
        columns.expect(expected);
    }
    let is_alike = other.present().eq(run.present());
    let (mut own_array, mut array, mut undefined) = (Vec::new(), Vec::new(), Vec::new());
    for (turbine, index) in summary.turbines.iter_mut().zip(run.present()) {
        if !other.present().any(|there| there == index) {
            continue;
        }
        let channel = power(&turbine.name);
        let (now, before) = (own.of(&channel)?, there.of(&channel)?);
        let (own_power, power) = (now.column(&channel[0])?, before.column(&channel[0])?);
        turbine.power_gain = defined(gain(own_power, power, now.interval, now.block))?;
        if turbine.power_gain.is_none() {
            undefined.push(not_defined(run, other, Some(&turbine.name)));
        }
        if is_alike {
            add_to(&mut own_array, own_power);
            add_to(&mut array, power);
        }
        for moment in loads::moments(own.names(), &turbine.name) {
            let part = moment.part();
            loads::compare(&mut turbine.loads, &moment, &own.of(&part)?, &there.of(&part)?)?;
        }
    }
    if is_alike {
        let Analysed { interval, block, .. } = own.of(&[])?;
        summary.array_power_gain = defined(gain(&own_array, &array, interval, block))?;
        // Where no turbine feels another nobody is shown a gain of all.
        if summary.array_power_gain.is_none() && summary.has_wakes() {
            undefined.push(not_defined(run, other, None));
        }
    }
    summary.warnings.append(&mut undefined);
    summary.compare_with = Some(other.name.clone());
    Ok(())
}

/// A gain that was `found`; none over a power of zero.
fn defined(found: Result<Statistic, AnalysisError>) -> Result<Option<Statistic>, AnalysisError> {
    match found {
        Err(AnalysisError::ZeroMean) => Ok(None),
        found => found.map(Some),
    }
}

/// What a reader of `run` must know of the gain of `turbine`, or of the array, over the run `other`.
fn not_defined(run: &Run, other: &Run, turbine: Option<&str>) -> Warning {
    let whose = turbine.unwrap_or("the array");
    Warning {
        kind: WarningKind::GainUndefined,
        turbine: turbine.map(str::to_owned),
        message: format!(
            "{}: the gain of {whose} is not defined: its mean power in {} is zero; compare with a run in which it makes power (compare_with)",
            run.name, other.name
        ),
    }
}

/// Channels that [`add`] asks for together, in its order; the columns of the run are called `names`.
fn parts(summary: &Summary, names: &[String]) -> Vec<Vec<String>> {
    let of_turbine = |turbine: &TurbineSummary| {
        let moments = loads::moments(names, &turbine.name);
        let moments = moments.into_iter().map(|moment| moment.part());
        std::iter::once(power(&turbine.name).to_vec()).chain(moments)
    };
    summary.turbines.iter().flat_map(of_turbine).collect()
}

/// The channel of the power of `turbine`.
fn power(turbine: &str) -> [String; 1] {
    [GEN_PWR.at(turbine)]
}

/// On return the summary of run number `index` holds its gains where the run that it compares with was made
/// after it.
///
/// # Errors
/// [`StudyError::File`] for records that cannot be read or written.
pub(crate) fn catch_up(
    setup: &Prepared,
    wind: &WindDigests,
    index: usize,
    folders: &[RunFolder],
    observer: &mut dyn Observer,
) -> Result<(), StudyError> {
    let (run, folder) = (&setup.case.runs[index], &folders[index]);
    let mut summary = records::read_summary(folder)?;
    if summary.compare_with.is_some() {
        return Ok(());
    }
    match comparison(setup, wind, index, folders)? {
        Comparison::None => {}
        Comparison::Missing(Run { name, .. }) => observer.warned(&format!(
            "{} has no gains: the run {name} that it compares with is not made yet; make it with --run {name} --resume",
            run.name
        )),
        Comparison::Other(Run { name, .. }) => observer.warned(&format!(
            "{} has no gains: the run {name} was made with another version of the case, of a turbine, of a file of wind or of the program",
            run.name
        )),
        Comparison::Made(other, mut there) => {
            let mut own = Columns::open(folder, setup)?;
            let n_known = summary.warnings.len();
            add(&mut summary, (run, &mut own), (other, &mut there))?;
            for warning in &summary.warnings[n_known..] {
                observer.warned(&warning.message);
            }
            records::write_summary(folder, &summary)?;
        }
    }
    Ok(())
}
