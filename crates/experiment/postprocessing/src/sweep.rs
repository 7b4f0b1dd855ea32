//! What came of a sweep: a row for each run, all winds together that differ in their seed alone.

use crate::PostprocessingError;
use crate::error::InRecords;
use crate::seeds::{GainsQuestion, RunGains, gains_over_seeds};
use analysis::statistics::independent;
use basis::records::{
    Load, LoadKind, SWEEP_SCHEMA_VERSION, Setting, Statistic, Summary, Sweep, SweepLoad, SweepPart,
    SweepRow, SweepTable, SweptRun, SweptStudy, TurbineSummary, WindGain,
};
use formats::records::{self, RunFolder};
use std::path::{Path, PathBuf};

/// The key whose values are other winds of the same climate.
const SEED: &str = "wind.seed";
/// Winds below which Student's t makes intervals wide (–).
const FEW_WINDS: usize = 4;

/// Folder of `study` of the sweep in `directory`.
fn folder_of(directory: &Path, study: &SweptStudy) -> PathBuf {
    if study.folder.is_empty() { directory.to_owned() } else { directory.join(&study.folder) }
}

/// Folders of the studies of the sweep in `directory` that have a complete run.
pub(crate) fn studies_with_runs(directory: &Path, sweep: &Sweep) -> Vec<PathBuf> {
    let folders = sweep.studies.iter().map(|study| folder_of(directory, study));
    let has_run = |folder: &PathBuf| {
        sweep.runs.iter().any(|run| RunFolder::new(folder, &run.run).is_complete())
    };
    folders.filter(has_run).collect()
}

/// The table of the `sweep` in `directory`, of the runs that are complete.
///
/// # Errors
/// [`PostprocessingError::File`] for records that cannot be read, also where no run is complete;
/// [`PostprocessingError::Seeds`] for studies that do not belong together.
pub(crate) fn table(directory: &Path, sweep: &Sweep) -> Result<SweepTable, PostprocessingError> {
    let keys = sweep.keys.iter().filter(|key| key.key != SEED).cloned().collect();
    let mut table = SweepTable {
        schema_version: SWEEP_SCHEMA_VERSION,
        case: sweep.case.clone(),
        keys,
        seeds: Vec::new(),
        has_wakes: false,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let mut missing = Vec::new();
    for (settings, studies) in groups(sweep) {
        for run in &sweep.runs {
            let made = made(directory, &studies, run)?;
            let is_missing = |study: &&&SweptStudy| !made.iter().any(|made| made.study == **study);
            let lost = studies.iter().filter(is_missing);
            missing.extend(lost.map(|study| place(&study.folder, &run.run)));
            if let Some(row) = row(&settings, run, &made, &mut table)? {
                table.rows.push(row);
            }
        }
    }
    if table.rows.is_empty() {
        let problem = "no run of the sweep is complete".to_owned();
        let fix = "complete it with `wakemix run CASE --resume`";
        let error = formats::FileError::content("a sweep", directory, problem, fix);
        return Err(error.into());
    }
    remark(&mut table, &missing);
    Ok(table)
}

/// A run of the study in `folder`, in words.
fn place(folder: &str, run: &str) -> String {
    if folder.is_empty() { run.to_owned() } else { format!("{folder}/{run}") }
}

/// The studies of `sweep` that differ in the seed alone, under their other settings.
fn groups(sweep: &Sweep) -> Vec<(Vec<Setting>, Vec<&SweptStudy>)> {
    let mut groups: Vec<(Vec<Setting>, Vec<&SweptStudy>)> = Vec::new();
    for study in &sweep.studies {
        let settings: Vec<Setting> =
            study.settings.iter().filter(|setting| setting.key != SEED).cloned().collect();
        match groups.iter_mut().find(|(known, _)| *known == settings) {
            Some((_, studies)) => studies.push(study),
            None => groups.push((settings, vec![study])),
        }
    }
    groups
}

/// A complete run of one study.
struct Made<'s> {
    study: &'s SweptStudy,
    folder: PathBuf,
    summary: Summary,
}

/// What `run` has left in each of `studies` where it is complete.
fn made<'s>(
    directory: &Path,
    studies: &[&'s SweptStudy],
    run: &SweptRun,
) -> Result<Vec<Made<'s>>, PostprocessingError> {
    let mut made = Vec::new();
    for study in studies {
        let folder = folder_of(directory, study);
        let of_run = RunFolder::new(&folder, &run.run);
        if of_run.is_complete() {
            made.push(Made { study, folder, summary: records::read_summary(&of_run)? });
        }
    }
    Ok(made)
}

/// The row of `run`, with the `settings` of its studies, from what was `made`; none where nothing was. What
/// there is to know of it, and of the wind, goes into `table`.
fn row(
    settings: &[Setting],
    run: &SweptRun,
    made: &[Made],
    table: &mut SweepTable,
) -> Result<Option<SweepRow>, PostprocessingError> {
    let Some(first) = made.first().map(|made| &made.summary) else { return Ok(None) };
    table.has_wakes |= first.has_wakes();
    let seeds: Vec<u64> = made.iter().map(|made| made.summary.conditions.seed).collect();
    for seed in seeds.iter().filter(|_| made.len() > 1) {
        if !table.seeds.contains(seed) {
            table.seeds.push(*seed);
        }
    }
    let parts = match made {
        [_] => of_one_wind(first),
        _ => {
            let folder = RunFolder::new(&made[0].folder, &run.run);
            let gains = gains(run, made, &mut table.remarks)?;
            of_winds(made, gains.as_ref()).in_records(&folder.summary_path())?
        }
    };
    Ok(Some(SweepRow {
        run: run.run.clone(),
        base: run.base.clone(),
        compare_with: first.compare_with.clone(),
        settings: settings.iter().chain(&run.settings).cloned().collect(),
        studies: made.iter().map(|made| made.study.folder.clone()).collect(),
        seeds,
        parts,
    }))
}

/// The gains of `run` over the winds in which it was `made`; none where it compares with nothing in one.
fn gains(
    run: &SweptRun,
    made: &[Made],
    remarks: &mut Vec<String>,
) -> Result<Option<RunGains>, PostprocessingError> {
    if made.iter().any(|made| made.summary.compare_with.is_none()) {
        return Ok(None);
    }
    let studies = made.iter().map(|made| made.folder.clone()).collect();
    let question = GainsQuestion { studies, runs: vec![run.run.clone()] };
    let answer = gains_over_seeds(&question)?;
    remarks.extend(answer.undefined);
    Ok(answer.runs.into_iter().next())
}

/// The turbines of the run of `summary`, and all together where they feel one another.
fn of_one_wind(summary: &Summary) -> Vec<SweepPart> {
    let of_turbine = |turbine: &TurbineSummary| SweepPart {
        name: turbine.name.clone(),
        power: turbine.power,
        gain: turbine.power_gain,
        gains: Vec::new(),
        loads: turbine
            .loads
            .iter()
            .filter_map(|load| of_load(load, alone(load.value), load.change))
            .collect(),
    };
    let mut parts: Vec<SweepPart> = summary.turbines.iter().map(of_turbine).collect();
    if summary.has_wakes() && parts.len() > 1 {
        parts.push(SweepPart {
            name: "all".to_owned(),
            power: summary.array_power,
            gain: summary.array_power_gain,
            gains: Vec::new(),
            loads: Vec::new(),
        });
    }
    parts
}

/// A value of which no interval is known.
fn alone(value: f64) -> Statistic {
    Statistic { mean: value, standard_deviation: 0.0, half_width_95: None, n_blocks: 1 }
}

/// `load` with its `value` and `change`; none where it is no damage-equivalent one.
fn of_load(load: &Load, value: Statistic, change: Option<Statistic>) -> Option<SweepLoad> {
    let LoadKind::DamageEquivalent { slope, .. } = load.kind else { return None };
    let (channel, unit) = (load.channel.clone(), load.unit.clone());
    Some(SweepLoad { channel, unit, slope, value, change })
}

/// The damage-equivalent loads of the turbine called `name` over all `summaries`, those that it has in each.
fn loads_of_winds(
    name: &str,
    summaries: &[&Summary],
) -> Result<Vec<SweepLoad>, PostprocessingError> {
    let turbine = |summary: &'_ &Summary| -> Option<TurbineSummary> {
        summary.turbines.iter().find(|turbine| turbine.name == name).cloned()
    };
    let Some(turbines) = summaries.iter().map(turbine).collect::<Option<Vec<_>>>() else {
        return Ok(Vec::new());
    };
    let mut loads = Vec::new();
    for load in turbines[0].loads.iter().filter(|load| load.kind.is_damage_equivalent()) {
        let same = turbines.iter().map(|turbine| turbine.damage_equivalent(&load.channel));
        let Some(same) = same.collect::<Option<Vec<_>>>() else { continue };
        let values: Vec<f64> = same.iter().map(|load| load.value).collect();
        let changes = same.iter().map(|load| load.change.map(|change| change.mean));
        let changes: Option<Vec<f64>> = changes.collect();
        let change = changes.map(|changes| independent(&changes)).transpose()?;
        loads.extend(of_load(load, independent(&values)?, change));
    }
    Ok(loads)
}

/// The same of a run that was `made` in several winds, with its `gains` over them.
fn of_winds(
    made: &[Made],
    gains: Option<&RunGains>,
) -> Result<Vec<SweepPart>, PostprocessingError> {
    let summaries = || made.iter().map(|made| &made.summary);
    let first = &made[0].summary;
    let names = first.turbines.iter().map(|turbine| turbine.name.clone());
    let mut powers: Vec<(String, Vec<f64>)> = names
        .map(|name| {
            let power = |summary: &Summary| {
                let turbine = summary.turbines.iter().find(|turbine| turbine.name == name);
                turbine.map_or(0.0, |turbine| turbine.power.mean)
            };
            let powers = summaries().map(power).collect();
            (name, powers)
        })
        .collect();
    if first.has_wakes() && powers.len() > 1 {
        powers.push(("all".to_owned(), summaries().map(|s| s.array_power.mean).collect()));
    }
    let part = |(name, powers): (String, Vec<f64>)| {
        let part = gains.and_then(|gains| gains.parts.iter().find(|part| part.name == name));
        let loads = loads_of_winds(&name, &summaries().collect::<Vec<_>>())?;
        Ok(SweepPart {
            name,
            loads,
            power: independent(&powers)?,
            gain: part.map(|part| part.together),
            gains: part.map_or(Vec::new(), |part| in_each(made, &part.gains)),
        })
    };
    powers.into_iter().map(part).collect()
}

/// The `gains` (–) with the winds that each of them is of, in which a run was `made`.
fn in_each(made: &[Made], gains: &[f64]) -> Vec<WindGain> {
    let gain = |(made, gain): (&Made, &f64)| WindGain {
        study: made.study.folder.clone(),
        seed: made.summary.conditions.seed,
        gain: *gain,
    };
    made.iter().zip(gains).map(gain).collect()
}

/// Adds to `table` what a reader must know; `missing` are the runs that are not complete.
fn remark(table: &mut SweepTable, missing: &[String]) {
    const MOST: usize = 6;
    let fewest = table.rows.iter().map(|row| row.seeds.len()).filter(|n| *n > 1).min();
    if let Some(n_winds) = fewest.filter(|n_winds| *n_winds < FEW_WINDS) {
        table.remarks.push(format!(
            "{n_winds} winds are few: what is left of chance shows in the width of the intervals, and that itself is a rough estimate; five or more are better"
        ));
    }
    if !missing.is_empty() {
        let mut names = missing[..missing.len().min(MOST)].join(", ");
        if missing.len() > MOST {
            names += &format!(" and {} more", missing.len() - MOST);
        }
        let [is, it, they] =
            if missing.len() == 1 { ["is", "it", "it is"] } else { ["are", "them", "they are"] };
        table.remarks.push(format!(
            "{names} {is} not complete: unless {they} under way, make {it} with --resume"
        ));
    }
}
