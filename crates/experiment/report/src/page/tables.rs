//! The tables of the page, as rows of ready text.

use crate::RunRecords;
use crate::draw::colour::Ink;
use crate::sentence;
use crate::study::Study;
use crate::words::{self, SPACE, number, percent, three_figures};
use basis::records::{Conditions, Statistic};
use minijinja::{Value, context};
use std::f64::consts::TAU;

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
    let mut facts = vec![
        fact(
            "Wind speed at hub height",
            format!("{}{SPACE}m/s", number(conditions.target_wind_speed, 1)),
            format!("{}{SPACE}m/s realised", number(conditions.realised_wind_speed, 2)),
        ),
        fact(
            "Turbulence intensity",
            percent(conditions.target_turbulence_intensity),
            format!(
                "{} realised upstream of {}",
                percent(conditions.realised_turbulence_intensity),
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
    facts.extend(excitation(study));
    facts.push(grid(conditions));
    facts
}

/// The first excitation of the run with the largest gain, or of the last one.
fn excitation(study: &Study) -> Option<Value> {
    let run = study.best().or_else(|| study.runs().last())?;
    let excitations = study.excitations(run);
    let excitation = excitations.first()?;
    let value = sentence::words_of(excitation);
    Some(fact(
        if study.best().is_some() { "Excitation, best run" } else { "Excitation" },
        words::capitalised(value.trim_start_matches("a ")),
        format!(
            "on {}, {}° delivered, St{SPACE}{}",
            excitation.turbine.name,
            number(excitation.pitch.delivered_amplitude_deg, 1),
            number(excitation.strouhal, 2)
        ),
    ))
}

fn grid(conditions: &Conditions) -> Value {
    match conditions.cells_per_diameter {
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
    }
}

fn fact(label: &str, value: String, remark: String) -> Value {
    context! { label, value, remark }
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
                control => turbine.control.description.clone(),
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

/// What every run cost.
pub(crate) fn costs(study: &Study) -> Vec<Value> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .map(|(run, &colour)| {
            let cost = &run.summary.cost;
            let ratio = cost.wall_time / run.summary.conditions.duration;
            let millions = cost.updates_per_second / 1e6;
            context! {
                run => run.summary.run.clone(),
                colour,
                wall_time => words::duration(cost.wall_time),
                ratio => number(ratio, three_figures(ratio).min(2)),
                cells => words::count(cost.n_cells),
                steps => words::count(cost.n_steps),
                updates => number(millions, three_figures(millions)),
                threads => cost.n_threads,
                memory => words::memory(cost.memory),
                peak_memory => cost.peak_memory.map_or_else(|| "–".to_owned(), words::memory),
            }
        })
        .collect()
}
