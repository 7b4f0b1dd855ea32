//! The tables of the page, as rows of ready text.

use crate::RunRecords;
use crate::draw::colour::Ink;
use crate::sentence;
use crate::study::Study;
use crate::units::Unit;
use crate::words::{self, SPACE, number, percent, three_figures};
use basis::records::{Conditions, GridSummary, Statistic, Summary, TurbineSummary};
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

/// Length scale of the turbulence, to be put behind its intensity; empty where it has none.
fn length_scale(conditions: &Conditions) -> String {
    conditions
        .turbulence_length_scale
        .map_or(String::new(), |length| format!(", length scale {}{SPACE}m", number(length, 0)))
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
                "{} realised upstream of {}{}",
                percent(conditions.realised_turbulence_intensity),
                summary.turbines.first().map_or("the row", |turbine| turbine.name.as_str()),
                length_scale(conditions)
            ),
        ),
        fact(
            "Mean profile",
            mean_profile(conditions),
            format!("turbulence seed {}", conditions.seed),
        ),
    ];
    if let Some(degrees) = sentence::direction(conditions) {
        facts.push(fact("Wind direction", degrees, "x is downwind".to_owned()));
    }
    // A run may leave turbines out.
    let turbines = |run: &&RunRecords| run.summary.turbines.len();
    let fullest = study.runs().iter().max_by_key(turbines).map_or(summary, |run| &run.summary);
    facts.push(fact("Turbines", machines(fullest), diameters(study)));
    if let Some(spacing) = sentence::spacing(study) {
        let metres = sentence::spacing_in_metres(study).unwrap_or_default();
        facts.push(fact("Spacing", spacing, metres));
    }
    let blocks = sentence::length(&summary.array_power, analysed);
    facts.push(fact(
        "Length",
        format!("{}{SPACE}s", number(conditions.duration, 0)),
        format!("{}{SPACE}s spin-up, {blocks}", number(conditions.spin_up, 0)),
    ));
    facts.extend(excitation(study));
    facts.push(grid(summary));
    facts
}

/// How many there are of each model: "2 × iea-15mw, 1 × nrel-5mw".
fn machines(summary: &Summary) -> String {
    let mut models: Vec<(&str, usize)> = Vec::new();
    for turbine in &summary.turbines {
        match models.iter_mut().find(|(model, _)| *model == turbine.model) {
            Some((_, count)) => *count += 1,
            None => models.push((&turbine.model, 1)),
        }
    }
    let each = models.iter().map(|(model, count)| format!("{count}{SPACE}×{SPACE}{model}"));
    each.collect::<Vec<_>>().join(", ")
}

/// The first turbine's rotor diameter, which is the unit of lengths, and those of others that differ.
fn diameters(study: &Study) -> String {
    let first = number(study.diameter(), 1);
    let mut others: Vec<String> = Vec::new();
    for rotor in &study.rotors {
        let diameter = number(rotor.diameter, 1);
        if diameter != first && !others.contains(&diameter) {
            others.push(diameter);
        }
    }
    let whose = study.rotors.first().map_or("the first turbine", |rotor| rotor.name.as_str());
    match others.is_empty() {
        true => format!("rotor diameter D = {first}{SPACE}m"),
        false => format!("D = {first}{SPACE}m of {whose}, others {}{SPACE}m", others.join(", ")),
    }
}

/// The first excitation of the run with the largest gain, or of the last one.
fn excitation(study: &Study) -> Option<Value> {
    let run = study.best().or_else(|| study.runs().last())?;
    let excitations = study.excitations(run);
    let excitation = excitations.first()?;
    Some(fact(
        if study.best().is_some() { "Excitation, best run" } else { "Excitation" },
        words::capitalised(&sentence::name_of(excitation)),
        format!(
            "on {}, {}° delivered, St{SPACE}{}",
            excitation.turbine.name,
            number(excitation.pitch.delivered_amplitude_deg, 1),
            number(excitation.strouhal, 2)
        ),
    ))
}

fn grid(summary: &Summary) -> Value {
    let conditions = &summary.conditions;
    let solver = summary.flow.as_ref().map(|flow| flow.solver.clone());
    let wakes = if summary.has_wakes() { "with wakes" } else { "no wakes" };
    match conditions.cells_per_diameter {
        Some(cells) => fact(
            "Grid",
            format!("{} cells per D", number(cells, 0)),
            format!(
                "{}{}{SPACE}m cells{}, {}{SPACE}s flow step",
                solver.map_or(String::new(), |solver| format!("{solver}, ")),
                number(conditions.rotor_diameter / cells, 1),
                around_boxes(summary),
                number(conditions.interval, 3)
            ),
        ),
        None => fact(
            "Flow solver",
            solver.unwrap_or_else(|| "prescribed wind".to_owned()),
            format!("{wakes}, {}{SPACE}s step", number(conditions.interval, 3)),
        ),
    }
}

/// Which cells are where, in a few words: " (5.0 m in 1200 × 480 × 240 m; 10.0 m elsewhere)".
fn around_boxes(summary: &Summary) -> String {
    let grids = summary.flow.as_ref().map_or(&[][..], |flow| flow.grids.as_slice());
    let Some((domain, boxes)) = grids.split_first() else { return String::new() };
    let of_box = |grid: &GridSummary| {
        let [length, width, height] = grid.size.map(|length| number(length, 0));
        let cells = number(grid.spacing, 1);
        format!("{cells}{SPACE}m in {length} × {width} × {height}{SPACE}m")
    };
    let boxes: Vec<String> = boxes.iter().map(of_box).collect();
    format!(" ({}; {}{SPACE}m elsewhere)", boxes.join(", "), number(domain.spacing, 1))
}

fn fact(label: &str, value: String, remark: String) -> Value {
    context! { label, value, remark }
}

/// One row for each turbine of each run, and one for all together.
pub(crate) fn results(study: &Study) -> Vec<Value> {
    let (units, mut rows) = (study.units(), Vec::new());
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let summary = &run.summary;
        let has_total = summary.turbines.len() > 1 && sentence::is_summed(run);
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
                power => quantity(&turbine.power, units.power.size),
                gain => gain(turbine.power_gain.as_ref()),
                thrust => quantity(&turbine.thrust, units.thrust.size),
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
                power => quantity(&summary.array_power, units.power.size),
                gain => gain(summary.array_power_gain.as_ref()),
                thrust => Vec::<String>::new(),
                rotor_speed => Vec::<String>::new(),
                pitch => String::new(),
            });
        }
    }
    rows
}

/// The short table: its columns, and a row for each run with power and gain of each turbine and of all.
pub(crate) fn glance(study: &Study) -> (Vec<String>, Vec<Value>) {
    const MOST_TURBINES: usize = 6;
    let names = study.turbines();
    let sums = names.len() > 1 && study.runs().iter().all(sentence::is_summed);
    let shown = if sums && names.len() > MOST_TURBINES { &[][..] } else { &names[..] };
    let mut heads: Vec<String> = shown.iter().map(|name| (*name).to_owned()).collect();
    heads.extend(sums.then(|| "All".to_owned()));
    let cell = |power: &Statistic, gain: Option<&Statistic>| {
        let Unit { name, size } = study.units().power;
        let mean = power.mean / size;
        let power = format!("{}{SPACE}{name}", number(mean, three_figures(mean)));
        let change = gain.map_or(String::new(), words::gain);
        let is_gain = gain.map(|gain| gain.mean > 0.0);
        context! { power, change, is_gain }
    };
    let rows = study.runs().iter().zip(&study.colours).map(|(run, &colour)| {
        let summary = &run.summary;
        let of = |name: &&str| {
            let found = summary.turbines.iter().find(|turbine| turbine.name == *name);
            found.map(|turbine: &TurbineSummary| cell(&turbine.power, turbine.power_gain.as_ref()))
        };
        let mut cells: Vec<Option<Value>> = shown.iter().map(of).collect();
        if sums {
            cells.push(Some(cell(&summary.array_power, summary.array_power_gain.as_ref())));
        }
        context! { run => summary.run.clone(), colour, ink => Ink::Run(colour).name(), cells }
    });
    (heads, rows.collect())
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
