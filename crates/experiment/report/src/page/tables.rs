//! The tables of the page, as rows of ready text.

use crate::RunRecords;
use crate::draw::colour::Ink;
use crate::sentence;
use crate::study::{Kind, Study};
use crate::words::{self, SPACE, number, percent, three_figures};
use analysis::fatigue;
use basis::records::{Conditions, MeanderingAxis, PitchResponse, Statistic, TurbineSummary};
use minijinja::{Value, context};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// How well each run found the phases of the helix, a row for each axis.
pub(crate) fn phases(study: &Study) -> Vec<Value> {
    let degrees = |angle: f64| number(angle.to_degrees(), 1);
    let found = study.records.synchronisation.iter();
    let rows = found.flat_map(|found| found.phases.iter().map(move |row| (&found.name, row)));
    let axes = rows.flat_map(|(turbine, row)| {
        [(turbine, row, "tilt", &row.tilt), (turbine, row, "yaw", &row.yaw)]
    });
    axes.map(|(turbine, row, axis, numbers)| {
        context! {
            run => row.run.clone(),
            turbine => turbine.clone(),
            offset => row.offset.map_or("watches".to_owned(), |offset| number(offset.to_degrees(), 0)),
            axis,
            rmse => degrees(numbers.rmse),
            bias => degrees(numbers.bias),
            spread => degrees(numbers.spread),
            locking => number(numbers.locking, 2),
            coherence => numbers.coherence.map_or("–".to_owned(), |found| number(found, 2)),
            error => numbers.phase_error.map_or("–".to_owned(), |[error, _]| degrees(error)),
            error_interval => numbers
                .phase_error
                .map_or(String::new(), |[_, half]| format!("±{SPACE}{}", degrees(half))),
            amplitude => number(numbers.amplitude, 2),
            true_amplitude => number(numbers.true_amplitude, 2),
        }
    })
    .collect()
}

/// How the mean wind of `conditions` grows with height.
fn mean_profile(conditions: &Conditions) -> String {
    match (conditions.roughness_length, conditions.shear_exponent) {
        (Some(length), _) => format!("logarithmic, z₀ = {length}{SPACE}m"),
        (None, Some(exponent)) => format!("power law, exponent {}", number(exponent, 2)),
        (None, None) => "–".to_owned(),
    }
}

/// The conditions that all runs share.
pub(crate) fn conditions(study: &Study) -> Vec<Value> {
    let summary = &study.runs()[0].summary;
    let conditions = &summary.conditions;
    let analysed = conditions.duration - conditions.spin_up;
    let fact = |label: &str, value: String, remark: String| context! { label, value, remark };
    let mut facts = vec![
        fact(
            "Wind speed at hub height",
            format!("{}{SPACE}m/s", number(conditions.wind_speed, 1)),
            format!("{}{SPACE}m/s arrived", number(conditions.arriving_wind_speed, 2)),
        ),
        fact(
            "Turbulence intensity",
            percent(conditions.turbulence_intensity),
            format!(
                "{} arrived upstream of {}",
                percent(conditions.arriving_turbulence_intensity),
                summary.turbines.first().map_or("the row", |turbine| turbine.name.as_str())
            ),
        ),
        fact(
            "Mean profile",
            mean_profile(conditions),
            format!("turbulence seed {}", conditions.seed),
        ),
    ];
    // A run may leave turbines out.
    let turbines = |run: &&RunRecords| run.summary.turbines.len();
    let fullest = study.runs().iter().max_by_key(turbines).map_or(summary, |run| &run.summary);
    let mut models: Vec<String> = fullest.turbines.iter().map(|t| t.model.clone()).collect();
    models.dedup();
    facts.push(fact(
        "Turbines",
        format!("{} × {}", fullest.turbines.len(), models.join(", ")),
        format!("rotor diameter D = {}{SPACE}m", number(conditions.rotor_diameter, 1)),
    ));
    if let Some(spacing) = sentence::spacing(study) {
        let meters: Vec<String> = study
            .spacings()
            .iter()
            .map(|spacing| number(spacing * conditions.rotor_diameter, 0))
            .collect();
        facts.push(fact("Spacing", spacing, format!("{}{SPACE}m", meters.join(", "))));
    }
    let blocks = sentence::length(&summary.array_power, analysed);
    facts.push(fact(
        "Length",
        format!("{}{SPACE}s", number(conditions.duration, 0)),
        format!("{}{SPACE}s spin-up, {blocks}", number(conditions.spin_up, 0)),
    ));
    if let Some(run) = study.best().or_else(|| study.runs().last())
        && let Some(excitation) = study.excitations(run).first()
    {
        let value = sentence::words_of(excitation);
        facts.push(fact(
            if study.best().is_some() { "Excitation, best run" } else { "Excitation" },
            words::capitalised(value.trim_start_matches("a ")),
            format!(
                "on {}, {}° delivered, St{SPACE}{}",
                excitation.turbine.name,
                number(excitation.pitch.delivered_amplitude_deg, 1),
                number(excitation.strouhal, 2)
            ),
        ));
    }
    facts.push(match conditions.cells_per_diameter {
        Some(cells) => fact(
            "Grid",
            format!("{} cells per D", number(cells, 0)),
            format!(
                "{}{SPACE}m cells, {}{SPACE}s flow step",
                number(conditions.rotor_diameter / cells, 1),
                number(conditions.interval, 3)
            ),
        ),
        None => fact(
            "Wind",
            "prescribed".to_owned(),
            format!("no wakes, {}{SPACE}s step", number(conditions.interval, 3)),
        ),
    });
    facts
}

/// Every excited turbine.
pub(crate) fn excitations(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        for excitation in study.excitations(run) {
            let pitch = &excitation.pitch;
            let kind = match excitation.kind {
                Kind::CounterClockwise => "helix, counter-clockwise".to_owned(),
                Kind::Clockwise => "helix, clockwise".to_owned(),
                Kind::Pulse => "pulse".to_owned(),
                Kind::Other => excitation.turbine.control.clone(),
            };
            rows.push(context! {
                run => run.summary.run.clone(),
                colour,
                turbine => excitation.turbine.name.clone(),
                kind,
                strouhal => number(excitation.strouhal, 3),
                asked => number(pitch.commanded_amplitude_deg, 2),
                delivered => number(pitch.delivered_amplitude_deg, 2),
                frequency => number(pitch.frequency_hz, 4),
                excitation_period => number(1.0 / pitch.excitation_frequency_hz.abs(), 1),
                clipped => percent(pitch.clipped_share),
            });
        }
    }
    rows
}

/// How pitch acts where a controller was told, as it was told: a row for each thing that it acts on.
pub(crate) fn responses(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        for turbine in &run.summary.turbines {
            let mut add = |on: &str, gain: String, offset: f64, delay: String, remark: String| {
                rows.push(context! {
                    run => run.summary.run.clone(),
                    colour,
                    turbine => turbine.name.clone(),
                    on,
                    gain,
                    offset => number(offset.to_degrees(), 1),
                    delay,
                    remark,
                });
            };
            if let Some(offset) = turbine.individual_pitch_offset {
                let on = "blades, under individual pitch control";
                add(on, String::new(), offset, String::new(), String::new());
            }
            let transformation = match turbine.pitch_response {
                Some(PitchResponse::Estimator { transformation_offset, .. }) => {
                    transformation_offset
                }
                Some(PitchResponse::Transformation { azimuth_offset }) => Some(azimuth_offset),
                Some(PitchResponse::IndividualPitch { .. } | PitchResponse::Loads { .. })
                | None => None,
            };
            if let Some(offset) = transformation {
                let on = "blades, by the inverse multi-blade transformation";
                add(on, String::new(), offset, String::new(), String::new());
            }
            match turbine.pitch_response {
                Some(PitchResponse::Estimator { gain, azimuth_offset, before, after, .. }) => {
                    let remark = format!(
                        "helix found without one: {}{SPACE}m/s before, {}{SPACE}m/s after",
                        number(before, 2),
                        number(after, 2)
                    );
                    let gain = format!("× {}", number(gain, 3));
                    let on = "belief of the phase estimator";
                    add(on, gain, azimuth_offset, String::new(), remark);
                }
                Some(PitchResponse::Loads { azimuth_offset, delay, gain }) => {
                    let gain = number(1e-6 * gain * 1f64.to_radians(), 3);
                    let gain = format!("−{gain}{SPACE}MN{SPACE}m/°");
                    let on = "tilt and yaw moment of the blades";
                    add(on, gain, azimuth_offset, number(delay, 2), String::new());
                }
                Some(
                    PitchResponse::Transformation { .. } | PitchResponse::IndividualPitch { .. },
                )
                | None => {}
            }
        }
    }
    rows
}

/// What turbines found of meandering and made of it, a row for each axis.
pub(crate) fn meanderings(study: &Study) -> Vec<Value> {
    let told = |value: Option<f64>, decimals: fn(f64) -> usize| {
        value.map_or("–".to_owned(), |value| number(value, decimals(value)))
    };
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let conditions = &run.summary.conditions;
        let strouhal =
            |frequency: f64| frequency * conditions.rotor_diameter / conditions.wind_speed;
        for turbine in &run.summary.turbines {
            let Some(found) = turbine.meandering else { continue };
            for (axis, moment) in [("tilt", found.tilt), ("yaw", found.yaw)] {
                let mega = |of: fn(MeanderingAxis) -> Option<f64>| {
                    moment.and_then(of).map(|newton_metres| 1e-6 * newton_metres)
                };
                rows.push(context! {
                    run => run.summary.run.clone(),
                    colour,
                    turbine => turbine.name.clone(),
                    control => turbine.control.clone(),
                    locked => percent(found.locked_share),
                    frequency => told(found.frequency_hz, |_| 4),
                    strouhal => told(found.frequency_hz.map(strouhal), |_| 3),
                    axis,
                    amplitude => told(mega(|moment| Some(moment.amplitude)), three_figures),
                    reference => told(mega(|moment| moment.reference), three_figures),
                    factor => told(moment.and_then(|moment| moment.factor), |_| 2),
                });
            }
        }
    }
    rows
}

/// One row for each turbine of each run, and one for all together.
pub(crate) fn results(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let summary = &run.summary;
        let has_total = summary.turbines.len() > 1;
        let span = summary.turbines.len() + usize::from(has_total);
        for (index, turbine) in summary.turbines.iter().enumerate() {
            let excited = turbine.delivered_pitch.filter(|p| p.commanded_amplitude_deg > 0.0);
            let pitch = excited.map_or_else(String::new, |pitch| {
                format!(
                    "{}° at {}{SPACE}Hz",
                    number(pitch.delivered_amplitude_deg, 2),
                    number(pitch.frequency_hz, 3)
                )
            });
            rows.push(context! {
                run => summary.run.clone(),
                colour,
                ink => Ink::Run(colour).name(),
                span => if index == 0 { span } else { 0 },
                turbine => turbine.name.clone(),
                control => turbine.control.clone(),
                is_total => false,
                power => quantity(&turbine.power, 1e6),
                gain => gain(turbine.power_gain.as_ref()),
                thrust => quantity(&turbine.thrust, 1e3),
                rotor_speed => quantity(&turbine.rotor_speed, TAU / 60.0),
                pitch,
            });
        }
        if has_total {
            rows.push(context! {
                run => summary.run.clone(),
                colour,
                ink => Ink::Run(colour).name(),
                span => if summary.turbines.is_empty() { 1 } else { 0 },
                turbine => "All".to_owned(),
                control => String::new(),
                is_total => true,
                power => quantity(&summary.array_power, 1e6),
                gain => gain(summary.array_power_gain.as_ref()),
                thrust => Vec::<String>::new(),
                rotor_speed => Vec::<String>::new(),
                pitch => String::new(),
            });
        }
    }
    rows
}

/// Mean and "± half width" in units of `scale`.
fn quantity(statistic: &Statistic, scale: f64) -> Vec<String> {
    let decimals = three_figures(statistic.mean / scale);
    let interval = match statistic.half_width_95 {
        Some(_) => words::interval(statistic, scale, decimals),
        None => String::new(),
    };
    vec![number(statistic.mean / scale, decimals), interval]
}

fn gain(statistic: Option<&Statistic>) -> Vec<String> {
    let Some(statistic) = statistic else { return Vec::new() };
    let interval = match statistic.half_width_95 {
        Some(_) => words::interval(statistic, 0.01, 1),
        None => "no interval".to_owned(),
    };
    vec![words::signed(100.0 * statistic.mean, 1), interval]
}

/// What the loads of the study's turbines are, in words: of the equivalent loads, and of what pitching cost.
pub(crate) fn load_conventions(study: &Study) -> Vec<String> {
    let turbines = || study.runs().iter().flat_map(|run| &run.summary.turbines);
    let mut conventions = Vec::new();
    if turbines().any(|turbine| !turbine.damage_equivalent_loads.is_empty()) {
        conventions.push(fatigue::convention(None));
    }
    conventions.extend(
        turbines()
            .find_map(|turbine| turbine.pitch_duty.as_ref())
            .map(|duty| duty.convention.clone()),
    );
    conventions.into_iter().map(|convention| words::capitalised(&convention)).collect()
}

/// Loads of a turbine by channel: damage-equivalent ones, standard deviations, and what its pitching cost.
fn channels_of(turbine: &TurbineSummary) -> BTreeMap<String, f64> {
    let mut loads = turbine.damage_equivalent_loads.clone();
    loads.extend(turbine.load_deviations.clone());
    if let Some(duty) = &turbine.pitch_duty {
        if let Some((load, _)) = duty.worst_bearing_load() {
            let slope = duty.bearing_slope;
            loads
                .insert(format!("Pitch bearing 1, where it is greatest, m = {slope} (kN m)"), load);
        }
        let travel = duty.travel_in_ten_minutes_deg;
        loads.insert("Pitch travel 1 (° in 10 min)".to_owned(), travel);
    }
    loads
}

/// Pitch-bearing loads: a row for each turbine and position, in it a cell for each run.
pub(crate) fn bearings(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for name in study.turbines() {
        let of_run = |run: &RunRecords| {
            let turbine = run.summary.turbines.iter().find(|turbine| turbine.name == name)?;
            Some(turbine.pitch_duty.as_ref()?.bearing_loads_kn_m.clone())
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

/// Loads: a row for each turbine and channel, in it a cell for each run with the load and its change.
pub(crate) fn loads(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for name in study.turbines() {
        let of_run = |run: &RunRecords| {
            let turbine = run.summary.turbines.iter().find(|turbine| turbine.name == name)?;
            Some(channels_of(turbine))
        };
        let loads: Vec<_> = study.runs().iter().map(of_run).collect();
        let channels: BTreeSet<&String> = loads.iter().flatten().flat_map(BTreeMap::keys).collect();
        for channel in channels {
            let at = |index: usize| loads[index].as_ref().and_then(|loads| loads.get(channel));
            let cells: Vec<[String; 2]> = study
                .runs()
                .iter()
                .enumerate()
                .map(|(index, run)| {
                    let Some(&load) = at(index) else { return [String::new(), String::new()] };
                    let other = run.summary.compare_with.as_deref();
                    let compared = study
                        .runs()
                        .iter()
                        .position(|run| Some(run.summary.run.as_str()) == other)
                        .and_then(at);
                    let change = match (change_of(run, name, channel), compared) {
                        (Some(change), _) => words::gain(change),
                        // What pitching cost comes without an interval.
                        (None, Some(&compared)) if compared > 0.0 => {
                            words::signed_percent(load / compared - 1.0)
                        }
                        _ => String::new(),
                    };
                    [number(load, three_figures(load)), change]
                })
                .collect();
            rows.push(context! { turbine => name.to_owned(), channel => channel.clone(), cells });
        }
    }
    rows
}

/// Change of the load `channel` of `turbine` in `run`, where its summary tells.
fn change_of<'a>(run: &'a RunRecords, turbine: &str, channel: &str) -> Option<&'a Statistic> {
    let turbine = run.summary.turbines.iter().find(|found| found.name == turbine)?;
    turbine.load_changes.get(channel)
}

/// What every run cost.
pub(crate) fn costs(study: &Study) -> Vec<Value> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .map(|(run, &colour)| {
            let cost = &run.summary.cost;
            let ratio = cost.wall_time / run.summary.conditions.duration;
            context! {
                run => run.summary.run.clone(),
                colour,
                wall_time => words::duration(cost.wall_time),
                ratio => number(ratio, three_figures(ratio).min(2)),
                cells => words::count(cost.n_cells),
                steps => words::count(cost.n_steps),
                updates => number(cost.updates_per_second / 1e6, three_figures(cost.updates_per_second / 1e6)),
                threads => cost.n_threads,
                memory => words::memory(cost.memory),
                peak_memory => cost.peak_memory.map_or_else(|| "–".to_owned(), words::memory),
            }
        })
        .collect()
}
