//! Power and loads over the phase offset, with the curve that a Gaussian process puts through them.

use super::curve::{CURVES, offset_panel};
use super::{Joined, Synchronised};
use crate::PostprocessingError;
use analysis::statistics::gain;
use basis::channels::{GEN_PWR, TIME};
use basis::records::{Series, Statistic, TurbineSummary};
use formats::records::RunRecords;
use report::{OffsetFigure, OffsetPanel, OffsetPoint};

/// Channels whose damage-equivalent loads are shown, and their titles.
const LOADS: [(&str, &str); 4] = [
    ("RootMyc1", "blade root flapwise"),
    ("RootMxc1", "blade root edgewise"),
    ("TwrBsMyt", "tower base fore-aft"),
    ("TwrBsMxt", "tower base side-side"),
];

/// The figures.
pub(super) fn offsets(study: &Synchronised) -> Result<Vec<OffsetFigure>, PostprocessingError> {
    let joined: Vec<&Joined> = study
        .runs
        .iter()
        .filter(|run| run.offset().is_some() && compared(study, run).is_some())
        .collect();
    if joined.is_empty() {
        return Ok(Vec::new());
    }
    let against =
        compared(study, joined[0]).map(|run| run.manifest.run.clone()).unwrap_or_default();
    let in_wind = study.case.places();
    let x = |index: usize| in_wind[index][0];
    let own = x(study.turbine);
    let mut places: Vec<usize> =
        (0..study.case.turbines.len()).filter(|&index| x(index) >= own).collect();
    places.sort_by(|a, b| x(*a).total_cmp(&x(*b)));
    let names: Vec<&str> =
        places.iter().map(|&index| study.case.turbines[index].name.as_str()).collect();
    let joining = &study.case.turbines[study.turbine].name;
    let without = if CURVES { "" } else { "; built without the curve" };
    let mut figures = vec![OffsetFigure {
        name: "power-over-offset".into(),
        title: format!("Power over the phase offset of {joining}"),
        label: format!("power against the run {against} (%){without}"),
        panels: power(study, &joined, &names)?,
    }];
    for (channel, title) in LOADS {
        let panels: Vec<OffsetPanel> =
            names.iter().map(|name| fatigue(study, &joined, name, channel)).collect();
        if panels.iter().all(|panel| panel.points.is_empty()) {
            continue;
        }
        figures.push(OffsetFigure {
            name: format!("load-over-offset-{channel}"),
            title: format!("Fatigue over the phase offset of {joining}: {title}"),
            label: format!("equivalent load against {against} (%){without}"),
            panels,
        });
    }
    Ok(figures)
}

/// Power of each of the turbines called `names` in the runs `joined`, then of all of them together.
fn power(
    study: &Synchronised,
    joined: &[&Joined],
    names: &[&str],
) -> Result<Vec<OffsetPanel>, PostprocessingError> {
    let mut panels: Vec<OffsetPanel> = Vec::new();
    for name in names {
        let points = joined.iter().filter_map(|run| {
            let change = turbine(study, run, name)?.power_gain?;
            Some(OffsetPoint { offset: run.offset()?, change })
        });
        panels.push(offset_panel((*name).to_owned(), points.collect()));
    }
    if names.len() > 1 {
        let mut points = Vec::new();
        for run in joined {
            let (Some(offset), Some(change)) = (run.offset(), together(study, run, names)?) else {
                continue;
            };
            points.push(OffsetPoint { offset, change });
        }
        panels.push(offset_panel(names.join(" + "), points));
    }
    Ok(panels)
}

/// Equivalent load of `channel` of the turbine called `name` in the runs `joined`.
fn fatigue(study: &Synchronised, joined: &[&Joined], name: &str, channel: &str) -> OffsetPanel {
    let points = joined.iter().filter_map(|run| {
        let own = load(turbine(study, run, name)?, channel)?;
        let mut others = compared(study, run)?.summary.turbines.iter();
        let other = others.find(|turbine| turbine.name == name)?;
        let mean = own / load(other, channel)? - 1.0;
        let change = Statistic { mean, standard_deviation: 0.0, half_width_95: None, n_blocks: 1 };
        Some(OffsetPoint { offset: run.offset()?, change })
    });
    offset_panel(name.to_owned(), points.collect())
}

/// The run that `run`'s gains compare with.
fn compared<'a>(study: &'a Synchronised, run: &Joined) -> Option<&'a RunRecords> {
    let name = study.records.runs[run.run].summary.compare_with.as_deref()?;
    study.records.runs.iter().find(|other| other.manifest.run == name)
}

fn turbine<'a>(study: &'a Synchronised, run: &Joined, name: &str) -> Option<&'a TurbineSummary> {
    study.records.runs[run.run].summary.turbines.iter().find(|turbine| turbine.name == name)
}

fn load(turbine: &TurbineSummary, channel: &str) -> Option<f64> {
    turbine.damage_equivalent(channel).map(|load| load.value)
}

/// Change of the power of the turbines called `names` together.
fn together(
    study: &Synchronised,
    run: &Joined,
    names: &[&str],
) -> Result<Option<Statistic>, PostprocessingError> {
    let Some(other) = compared(study, run) else { return Ok(None) };
    let powers: Vec<String> = names.iter().map(|name| GEN_PWR.at(name)).collect();
    let read = |run: &RunRecords| {
        run.series.read(|channel| channel == TIME.name || powers.iter().any(|name| name == channel))
    };
    let sum = |series: Series| -> Option<(Vec<f64>, f64)> {
        let times = series.column(&TIME.name)?;
        let first = times.iter().position(|time| *time >= study.case.time.spin_up)?;
        let mut total = vec![0.0; times.len() - first];
        for name in &powers {
            let power = series.column(name)?;
            total.iter_mut().zip(&power[first..]).for_each(|(sum, power)| *sum += power);
        }
        Some((total, times.get(1)? - times.first()?))
    };
    match (sum(read(&study.records.runs[run.run])?), sum(read(other)?)) {
        (Some((own, interval)), Some((other, _))) => {
            Ok(Some(gain(&own, &other, interval, study.case.time.block)?))
        }
        _ => Ok(None),
    }
}
