//! What a controller changes: power and damage-equivalent loads of runs over those that they compare with, in
//! every wind of one or several studies.

mod winds;

use crate::PostprocessingError;
use crate::error::{InRecords, case_in};
use crate::seeds::{Pair, SeedsError, Study, gain, pairs, seeds, turbine_names};
use crate::signals::analysed;
use crate::sweep::studies_with_runs;
use analysis::fatigue::damage_equivalent_load;
use analysis::statistics::{change_together, independent};
use basis::channels::TIME;
use basis::records::{LoadKind, Series, Statistic, Summary};
use formats::records::{self, RunFolder, read_series};
use std::collections::BTreeSet;
use std::path::PathBuf;
pub(crate) use winds::names_of_runs;
use winds::{Group, groups};

/// A question to studies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChangesQuestion {
    /// Folders of studies, or of sweeps of them.
    pub studies: Vec<PathBuf>,
    /// Runs that are asked for; all that compare with another when empty.
    pub runs: Vec<String>,
    /// Channels whose damage-equivalent loads are asked for, such as `RootMyb1`.
    pub channels: Vec<String>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangesAnswer {
    /// Name of the case.
    pub case: String,
    /// The winds, each of one climate.
    pub winds: Vec<ChangesWind>,
    /// Run by run, quantity by quantity, turbine by turbine.
    pub rows: Vec<ChangesRow>,
    /// What is left out, and why, in sentences.
    pub remarks: Vec<String>,
}

/// A wind, in one study or in several that differ in its seed alone.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangesWind {
    /// What it is, in words.
    pub name: String,
    /// Speed at hub height (m/s).
    pub speed: f64,
    /// Turbulence intensity (–).
    pub turbulence_intensity: f64,
    /// Exponent of shear (–); none of a logarithmic profile.
    pub shear_exponent: Option<f64>,
    /// Folders of its studies, with their seeds.
    pub studies: Vec<(PathBuf, u64)>,
}

/// What changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// Electrical power.
    Power,
    /// Damage-equivalent load of a channel.
    Load {
        /// The channel.
        channel: String,
        /// Slope of the Wöhler line (–).
        slope: f64,
        /// How often the equivalent load repeats (Hz).
        reference_frequency: f64,
    },
}

/// One quantity of one turbine, or of all, over all winds.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangesRow {
    /// Name of the run.
    pub run: String,
    /// Run that it compares with.
    pub compare_with: String,
    /// What changes.
    pub quantity: Quantity,
    /// Name of the turbine; `all` of all together: their power, or the sum of their loads.
    pub part: String,
    /// The change in each of the answer's winds; none where it is not known.
    pub changes: Vec<Option<Change>>,
}

/// A change relative to the compared run in the same wind, minus one (–).
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// With one wind that of the whole record, with the interval of its blocks; with several their mean, with
    /// its 95 % interval by Student's t over them.
    pub together: Statistic,
    /// The change in each wind of the same climate (–).
    pub each: Vec<f64>,
}

/// What the studies that `question` names tell of changes of power and loads.
///
/// # Errors
/// [`PostprocessingError::Seeds`] for studies that do not belong together, or without a run that compares
/// with another; [`PostprocessingError`] for records that cannot be read, and for series without a turbine's
/// load beside others' where these have blocks.
pub fn changes(question: &ChangesQuestion) -> Result<ChangesAnswer, PostprocessingError> {
    let mut folders = Vec::new();
    for folder in &question.studies {
        match records::read_sweep(folder)? {
            Some(sweep) => folders.extend(studies_with_runs(folder, &sweep)),
            None => folders.push(folder.clone()),
        }
    }
    let mut studies = Vec::with_capacity(folders.len());
    for folder in &folders {
        studies.push(Study { folder, runs: records::read_summaries(folder)? });
    }
    let Some(first) = studies.first() else {
        let folder = question.studies.first().cloned().unwrap_or_default();
        return Err(SeedsError::NoGains { folder }.into());
    };
    let case = first.runs[0].1.case.clone();
    let groups = groups(&studies);
    let mut answer = ChangesAnswer {
        case,
        winds: groups.iter().map(|group| group.wind.clone()).collect(),
        rows: Vec::new(),
        remarks: untold(question, &studies),
    };
    for run in wanted(question, &studies)? {
        let mut columns = Vec::with_capacity(groups.len());
        for group in &groups {
            columns.push(of_run(question, group, &run, &mut answer.remarks)?);
        }
        answer.rows.extend(rows(columns));
    }
    Ok(answer)
}

/// Which channels of `question` have a damage-equivalent load in none of the `studies`, in sentences.
fn untold(question: &ChangesQuestion, studies: &[Study<'_>]) -> Vec<String> {
    let summaries = studies.iter().flat_map(|study| study.runs.iter().map(|(_, summary)| summary));
    let loads = summaries.flat_map(|summary| &summary.turbines).flat_map(|turbine| &turbine.loads);
    let told = loads.filter(|load| matches!(load.kind, LoadKind::DamageEquivalent { .. }));
    let told: BTreeSet<&str> = told.map(|load| load.channel.as_str()).collect();
    let list = told.iter().copied().collect::<Vec<_>>().join(", ");
    let remark = |channel: &String| {
        let list = if list.is_empty() { "no channel" } else { &list };
        format!("no run tells the damage-equivalent load of `{channel}`: they tell those of {list}")
    };
    let channels = question.channels.iter();
    channels.filter(|channel| !told.contains(channel.as_str())).map(remark).collect()
}

/// The runs that `question` is about.
fn wanted(
    question: &ChangesQuestion,
    studies: &[Study<'_>],
) -> Result<Vec<String>, PostprocessingError> {
    let mut all: Vec<String> = Vec::new();
    for run in studies.iter().flat_map(Study::compared) {
        if !all.contains(&run) {
            all.push(run);
        }
    }
    let folder = studies[0].folder.to_owned();
    if all.is_empty() {
        return Err(SeedsError::NoGains { folder }.into());
    }
    let missing: Vec<String> =
        question.runs.iter().filter(|run| !all.contains(run)).cloned().collect();
    if !missing.is_empty() {
        return Err(SeedsError::Runs { folder, missing, common: all }.into());
    }
    Ok(if question.runs.is_empty() { all } else { question.runs.clone() })
}

/// A row in one wind.
struct Cell {
    run: [String; 2],
    quantity: Quantity,
    part: String,
    change: Option<Change>,
}

/// What `run` changes in the wind of `group`; nothing where it is not there.
fn of_run(
    question: &ChangesQuestion,
    group: &Group<'_>,
    run: &str,
    remarks: &mut Vec<String>,
) -> Result<Vec<Cell>, PostprocessingError> {
    let (here, lacking): (Vec<&Study>, Vec<&Study>) =
        group.studies.iter().partition(|study| study.compared().iter().any(|own| own == run));
    if here.is_empty() {
        return Ok(Vec::new());
    }
    for study in lacking {
        remarks.push(format!("{} has no changes of {run}", study.folder.display()));
    }
    let mut pairs = pairs(&here, run)?;
    seeds(&pairs)?;
    if pairs.len() > 1 && is_one_wind(&pairs) {
        remarks.push(format!(
            "{}: {run} is the same in {} studies, for the wind has no turbulence that a seed could change: it counts once",
            group.wind.name,
            pairs.len()
        ));
        pairs.truncate(1);
    }
    let names = [pairs[0].run, pairs[0].other].map(|(_, summary)| turbine_names(summary));
    let mut parts: Vec<(String, Vec<String>)> = names[0]
        .iter()
        .filter(|name| names[1].contains(name))
        .map(|name| (name.clone(), vec![name.clone()]))
        .collect();
    // Without wakes no turbine feels another, so that a sum means nothing.
    if names[0] == names[1] && parts.len() > 1 && pairs.iter().all(|pair| pair.run.1.has_wakes()) {
        parts.push(("all".to_owned(), names[0].clone()));
    }
    let run = [pairs[0].run, pairs[0].other].map(|(manifest, _)| manifest.run.clone());
    let loads = question.channels.iter().filter_map(|channel| quantity(channel, &pairs[0].run.1));
    let mut cells = Vec::new();
    for quantity in std::iter::once(Quantity::Power).chain(loads) {
        for (part, turbines) in &parts {
            let path = RunFolder::new(pairs[0].folder, &run[0]).summary_path();
            let change = change(&pairs, &quantity, turbines).in_records(&path)?;
            let (run, quantity, part) = (run.clone(), quantity.clone(), part.clone());
            cells.push(Cell { run, quantity, part, change });
        }
    }
    Ok(cells)
}

/// Whether winds of several seeds are one: none has turbulence, and all have moved the turbines alike.
fn is_one_wind(pairs: &[Pair<'_>]) -> bool {
    let power = |pair: &Pair| [pair.run, pair.other].map(|(_, summary)| summary.array_power.mean);
    pairs.iter().all(|pair| {
        pair.run.1.conditions.target_turbulence_intensity == 0.0 && power(pair) == power(&pairs[0])
    })
}

/// The damage-equivalent load of `channel` that `summary` tells; none where it tells none.
fn quantity(channel: &str, summary: &Summary) -> Option<Quantity> {
    let mut loads = summary.turbines.iter().filter_map(|t| t.damage_equivalent(channel));
    let LoadKind::DamageEquivalent { slope, reference_frequency_hz } = loads.next()?.kind else {
        return None;
    };
    let channel = channel.to_owned();
    Some(Quantity::Load { channel, slope, reference_frequency: reference_frequency_hz })
}

/// The change of `quantity` of `turbines` together in all winds of `pairs`; none where a run does not tell of
/// it, or has none to compare with.
fn change(
    pairs: &[Pair<'_>],
    quantity: &Quantity,
    turbines: &[String],
) -> Result<Option<Change>, PostprocessingError> {
    if let [pair] = pairs {
        let together = in_one_wind(pair, quantity, turbines)?;
        return Ok(together.map(|together| Change { together, each: vec![together.mean] }));
    }
    let each: Option<Vec<f64>> = pairs.iter().map(|pair| ratio(pair, quantity, turbines)).collect();
    let Some(each) = each else { return Ok(None) };
    Ok(Some(Change { together: independent(&each)?, each }))
}

/// The same in the wind of `pair` (–), without an interval.
fn ratio(pair: &Pair<'_>, quantity: &Quantity, turbines: &[String]) -> Option<f64> {
    let Quantity::Load { channel, .. } = quantity else {
        return gain(&pair.run.1, &pair.other.1, turbines);
    };
    let sum = |summary: &Summary| -> Option<f64> {
        let of = |name: &String| {
            let turbine = summary.turbines.iter().find(|turbine| turbine.name == *name)?;
            Some(turbine.damage_equivalent(channel)?.value)
        };
        turbines.iter().map(of).sum()
    };
    let (now, before) = (sum(&pair.run.1)?, sum(&pair.other.1)?);
    (before != 0.0).then(|| now / before - 1.0)
}

/// The same, with the interval that its blocks tell where there are two or more.
fn in_one_wind(
    pair: &Pair<'_>,
    quantity: &Quantity,
    turbines: &[String],
) -> Result<Option<Statistic>, PostprocessingError> {
    let summary = &pair.run.1;
    let own = |name: &String| summary.turbines.iter().find(|turbine| turbine.name == *name);
    match (quantity, turbines) {
        (Quantity::Power, [name]) => Ok(own(name).and_then(|turbine| turbine.power_gain)),
        (Quantity::Power, _) => Ok(summary.array_power_gain),
        (Quantity::Load { channel, .. }, [name]) => Ok(own(name)
            .and_then(|turbine| turbine.damage_equivalent(channel))
            .and_then(|load| load.change)),
        (Quantity::Load { channel, slope, reference_frequency }, _) => {
            let Some(mean) = ratio(pair, quantity, turbines) else { return Ok(None) };
            let has_blocks = turbines.iter().all(|name| {
                let load = own(name).and_then(|turbine| turbine.damage_equivalent(channel));
                load.and_then(|load| load.change).is_some_and(|change| change.n_blocks > 1)
            });
            if has_blocks {
                let load = (channel.as_str(), *slope, *reference_frequency);
                return of_blocks(pair, load, turbines).map(Some);
            }
            let (standard_deviation, half_width_95, n_blocks) = (0.0, None, 1);
            Ok(Some(Statistic { mean, standard_deviation, half_width_95, n_blocks }))
        }
    }
}

/// The change of the sum of the loads of `turbines` from the series of both runs of `pair`.
fn of_blocks(
    pair: &Pair<'_>,
    (channel, slope, frequency): (&str, f64, f64),
    turbines: &[String],
) -> Result<Statistic, PostprocessingError> {
    let channels: Vec<String> = turbines.iter().map(|name| format!("{name}.{channel}")).collect();
    let read = |run: &str| -> Result<Series, PostprocessingError> {
        let path = RunFolder::new(pair.folder, run).series_path();
        Ok(read_series(&path, |name| name == TIME.name || channels.iter().any(|own| own == name))?)
    };
    let series = [read(&pair.run.0.run)?, read(&pair.other.0.run)?];
    let from = pair.run.1.conditions.spin_up;
    let mut columns = Vec::with_capacity(channels.len());
    for name in &channels {
        let part = |series: &Series, run: &str| -> Result<Vec<f64>, PostprocessingError> {
            let missing = || PostprocessingError::MissingChannel {
                path: Some(RunFolder::new(pair.folder, run).series_path()),
                channel: name.clone(),
            };
            let samples = series.column(name).ok_or_else(missing)?;
            let first = analysed(series, from).map_or(samples.len(), |(first, _, _)| first);
            Ok(samples[first..].to_vec())
        };
        let [now, before] = &series;
        columns.push((part(now, &pair.run.0.run)?, part(before, &pair.other.0.run)?));
    }
    let interval = analysed(&series[0], from).map_or(0.0, |(_, _, interval)| interval);
    let pairs: Vec<[&[f64]; 2]> = columns.iter().map(|(now, before)| [&now[..], before]).collect();
    let load = |samples: &[f64]| damage_equivalent_load(samples, interval, slope, frequency);
    let block = case_in(pair.folder, &pair.run.0.case_text)?.time.block;
    Ok(change_together(&pairs, interval, block, load)?)
}

/// The rows of one run, whose cells in each wind are `columns`.
fn rows(columns: Vec<Vec<Cell>>) -> Vec<ChangesRow> {
    let n_winds = columns.len();
    let mut rows: Vec<ChangesRow> = Vec::new();
    for (wind, cells) in columns.into_iter().enumerate() {
        for Cell { run: [run, compare_with], quantity, part, change } in cells {
            let known = rows.iter_mut().find(|row| {
                row.quantity == quantity && row.part == part && row.compare_with == compare_with
            });
            if let Some(row) = known {
                row.changes[wind] = change;
                continue;
            }
            let mut changes = vec![None; n_winds];
            changes[wind] = change;
            rows.push(ChangesRow { run, compare_with, quantity, part, changes });
        }
    }
    rows
}

#[cfg(test)]
mod tests;
