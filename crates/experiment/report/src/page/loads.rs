//! The tables of loads, and what pitching cost, as rows of ready text.

use crate::RunRecords;
use crate::study::Study;
use crate::words::{self, number, three_figures};
use analysis::fatigue;
use basis::records::{Load, LoadKind, Statistic, TurbineSummary};
use minijinja::{Value, context};

/// What the loads of the study's turbines are, in words: of the equivalent loads, and of what pitching cost.
pub(crate) fn conventions(study: &Study) -> Vec<String> {
    let turbines = || study.runs().iter().flat_map(|run| &run.summary.turbines);
    let is_equivalent = |load: &Load| load.kind.is_damage_equivalent();
    let mut conventions = Vec::new();
    if turbines().any(|turbine| turbine.loads.iter().any(is_equivalent)) {
        conventions.push(fatigue::convention(None));
    }
    conventions.extend(turbines().find_map(|turbine| turbine.pitch_duty.as_ref()).map(|duty| {
        let n_positions = duty.bearing_loads.len();
        fatigue::duty_convention(duty.bearing_slope, n_positions, duty.sample_interval)
    }));
    conventions.into_iter().map(|convention| words::capitalised(&convention)).collect()
}

/// What a row of the table of loads tells of a turbine.
#[derive(Clone, PartialEq)]
enum Quantity {
    /// Pitch-bearing load at the position where it is greatest, with its slope.
    Bearing(f64),
    /// Pitch travel in ten minutes.
    Travel,
    /// Figure of a moment: channel, unit and kind.
    Moment(String, String, LoadKind),
}

impl Quantity {
    /// All that is reported of `turbine`.
    fn of(turbine: &TurbineSummary) -> Vec<Self> {
        let mut found = Vec::new();
        if let Some(duty) = &turbine.pitch_duty {
            if duty.worst_bearing_load().is_some() {
                found.push(Self::Bearing(duty.bearing_slope));
            }
            found.push(Self::Travel);
        }
        let moment = |load: &Load| Self::Moment(load.channel.clone(), load.unit.clone(), load.kind);
        found.extend(turbine.loads.iter().map(moment));
        found
    }

    /// Its value in `turbine`, and the change of it with an interval.
    fn value(&self, turbine: &TurbineSummary) -> Option<(f64, Option<Statistic>)> {
        match self {
            Self::Bearing(slope) => {
                let duty = turbine.pitch_duty.as_ref().filter(|duty| duty.bearing_slope == *slope);
                Some((duty?.worst_bearing_load()?.load_kn_m, None))
            }
            Self::Travel => Some((turbine.pitch_duty.as_ref()?.travel_in_ten_minutes_deg, None)),
            Self::Moment(channel, unit, kind) => turbine
                .loads
                .iter()
                .find(|load| load.channel == *channel && load.unit == *unit && load.kind == *kind)
                .map(|load| (load.value, load.change)),
        }
    }

    fn label(&self) -> String {
        match self {
            Self::Bearing(slope) => {
                format!("Pitch bearing 1, where it is greatest, m = {slope} (kN m)")
            }
            Self::Travel => "Pitch travel 1 (° in 10 min)".to_owned(),
            Self::Moment(channel, unit, LoadKind::DamageEquivalent { slope, .. }) => {
                format!("{channel}, m = {slope} ({unit})")
            }
            Self::Moment(channel, unit, LoadKind::Deviation) => {
                format!("{channel}, standard deviation ({unit})")
            }
        }
    }
}

/// Loads: a row for each turbine and quantity, in it a cell for each run with the load and its change.
pub(crate) fn loads(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for name in study.turbines() {
        let of_run = |run: &RunRecords| turbine(run, name).map(Quantity::of).unwrap_or_default();
        let mut quantities: Vec<Quantity> = Vec::new();
        for quantity in study.runs().iter().flat_map(of_run) {
            if !quantities.contains(&quantity) {
                quantities.push(quantity);
            }
        }
        quantities.sort_by_key(Quantity::label);
        for quantity in quantities {
            let cells: Vec<[String; 2]> =
                study.runs().iter().map(|run| cell(study, run, name, &quantity)).collect();
            rows.push(context! { turbine => name.to_owned(), channel => quantity.label(), cells });
        }
    }
    rows
}

/// The turbine called `name` in `run`.
fn turbine<'a>(run: &'a RunRecords, name: &str) -> Option<&'a TurbineSummary> {
    run.summary.turbines.iter().find(|turbine| turbine.name == name)
}

/// `quantity` of the turbine called `name` in `run`, and its change; empty where it has none.
fn cell(study: &Study, run: &RunRecords, name: &str, quantity: &Quantity) -> [String; 2] {
    let of = |run: &RunRecords| quantity.value(turbine(run, name)?);
    let Some((load, change)) = of(run) else { return [String::new(), String::new()] };
    let other = run.summary.compare_with.as_deref();
    let compared = study.runs().iter().find(|run| Some(run.summary.run.as_str()) == other);
    let change = match (change, compared.and_then(of)) {
        (Some(change), _) => words::gain(&change),
        // What pitching cost comes without an interval.
        (None, Some((compared, _))) if compared > 0.0 => {
            words::signed_percent(load / compared - 1.0)
        }
        _ => String::new(),
    };
    [number(load, three_figures(load)), change]
}

/// Pitch-bearing loads: a row for each turbine and position, in it a cell for each run.
pub(crate) fn bearings(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for name in study.turbines() {
        let of_run = |run: &RunRecords| {
            let turbine = run.summary.turbines.iter().find(|turbine| turbine.name == name)?;
            let positions = turbine.pitch_duty.as_ref()?.bearing_loads.iter();
            Some(positions.map(|position| position.load_kn_m).collect())
        };
        let loads: Vec<Vec<f64>> =
            study.runs().iter().map(|run| of_run(run).unwrap_or_default()).collect();
        let n_positions = loads.iter().map(Vec::len).max().unwrap_or(0);
        for index in 0..n_positions {
            let cell = |loads: &Vec<f64>| {
                loads.get(index).map_or(String::new(), |&load| number(load, three_figures(load)))
            };
            rows.push(context! {
                turbine => name.to_owned(),
                position => number(360.0 * index as f64 / n_positions as f64, 0),
                cells => loads.iter().map(cell).collect::<Vec<_>>(),
            });
        }
    }
    rows
}
