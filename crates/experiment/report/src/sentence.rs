//! What the numbers say, in plain sentences, and the conditions under which they hold.

use crate::RunRecords;
use crate::study::{Excitation, ExcitationKind, Study, gain_of};
use crate::units::{Unit, Units};
use crate::words::{self, SPACE, number, percent};
use basis::Sense;
use basis::records::{Conditions, Statistic, Summary, TurbineSummary};

/// Changes of power below this (–) are not stated: they print as zero.
const LEAST_STATED: f64 = 5e-4;

/// The result in one sentence: what was done, what each turbine lost or won, and all together.
pub(crate) fn headline(study: &Study) -> String {
    match study.best() {
        Some(run) => gain_sentence(study, run),
        None => power_sentence(&study.runs()[0]),
    }
}

/// That runs of the case are missing, and which; empty where none is.
pub(crate) fn incomplete(study: &Study) -> String {
    /// Runs that are named at most (–).
    const MOST: usize = 6;
    let missing = &study.records.incomplete;
    if missing.is_empty() {
        return String::new();
    }
    let mut names = missing.clone();
    if missing.len() > MOST {
        names.truncate(MOST - 1);
        names.push(format!("{} more", missing.len() - names.len()));
    }
    let n = study.runs().len();
    let is = if n == 1 { "is" } else { "are" };
    format!(
        "Of {} runs {n} {is} complete, and on this page; not yet complete: {}.",
        n + missing.len(),
        words::list(&names)
    )
}

/// A remark on how firm the headline is; empty when there is nothing to add.
pub(crate) fn confidence(study: &Study) -> String {
    let Some(run) = study.best() else { return String::new() };
    let gains: Vec<Statistic> = if is_summed(run) {
        run.summary.array_power_gain.into_iter().collect()
    } else {
        stated_gains(run).into_iter().map(|(_, gain)| gain).collect()
    };
    let includes_zero =
        |gain: &Statistic| gain.half_width_95.is_some_and(|width| width >= gain.mean.abs());
    if gains.iter().any(|gain| gain.half_width_95.is_none()) {
        "There is no interval: the analysed time is too short for two blocks, so the figure may \
         be chance."
            .to_owned()
    } else if gains.iter().any(includes_zero) {
        "The interval includes zero: a study of this length does not show whether there is a \
         gain."
            .to_owned()
    } else {
        String::new()
    }
}

/// Whether the sum over the turbines of `run` means something: not in wind without wakes, in which no turbine
/// feels another.
pub(crate) fn is_summed(run: &RunRecords) -> bool {
    run.summary.has_wakes()
}

/// Gains of single turbines that do not print as zero.
fn stated_gains(run: &RunRecords) -> Vec<(&TurbineSummary, Statistic)> {
    let gains = run.summary.turbines.iter().filter_map(|t| Some((t, t.power_gain?)));
    gains.filter(|(_, gain)| gain.mean.abs() >= LEAST_STATED).collect()
}

/// The gain of one run: "A counter-clockwise helix of 4.0° on T1 cost T1 2.1 % …".
pub(crate) fn gain_sentence(study: &Study, run: &RunRecords) -> String {
    let done = done(study, run);
    let subject = match done.is_empty() {
        true => format!("The run “{}”", run.summary.run),
        false => words::capitalised(&words::list(&done)),
    };
    let gains = stated_gains(run);
    let (losses, wins): (Vec<_>, Vec<_>) = gains.iter().partition(|(_, gain)| gain.mean < 0.0);
    let mut clauses = Vec::new();
    if !losses.is_empty() {
        let whose = if losses.len() > 1 { "their" } else { "its" };
        clauses.push(format!("cost {} of {whose} power", changes(run, &losses)));
    }
    if !wins.is_empty() {
        clauses.push(format!("gave {} more", changes(run, &wins)));
    }
    if clauses.is_empty() {
        clauses.push("left the power as it was".to_owned());
    }
    let clauses = clauses.join(" and ");
    if !is_summed(run) {
        return format!("{subject} {clauses}.");
    }
    let total = run.summary.array_power_gain.map(|gain| words::gain(&gain)).unwrap_or_default();
    let n_gains =
        run.summary.turbines.iter().filter(|turbine| turbine.power_gain.is_some()).count();
    let whole = match n_gains {
        0 | 1 => String::new(),
        n => format!(" for the {} together", words::small_count(n)),
    };
    format!("{subject} {clauses}: {total}{whole}.")
}

/// "T1 2.1 %", with its interval where no sum follows that has one; how many there are and the span of their
/// changes where they are too many to name.
fn changes(run: &RunRecords, gains: &[&(&TurbineSummary, Statistic)]) -> String {
    const MOST_NAMED: usize = 4;
    if gains.len() > MOST_NAMED {
        let sizes = || gains.iter().map(|(_, gain)| gain.mean.abs());
        let (least, most) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        let count = words::small_count(gains.len());
        return format!("{count} turbines {} to {}", percent(least), percent(most));
    }
    let says = |(turbine, gain): &&(&TurbineSummary, Statistic)| {
        let size = Statistic { mean: gain.mean.abs(), ..*gain };
        let change = if is_summed(run) { percent(size.mean) } else { words::size(&size) };
        format!("{} {change}", turbine.name)
    };
    words::list(&gains.iter().map(says).collect::<Vec<_>>())
}

/// What was done in `run` and not in the one that it compares with, an item each.
fn done(study: &Study, run: &RunRecords) -> Vec<String> {
    let says = |excitation: &Excitation| {
        format!("a {} on {}", name_of(excitation), excitation.turbine.name)
    };
    study.changed_excitations(run).iter().map(says).collect()
}

/// One run against the others in a few words, for the list under the headline.
pub(crate) fn short_gain(study: &Study, run: &RunRecords) -> Option<String> {
    gain_of(run)?;
    let mut items = Vec::new();
    if is_summed(run) {
        let gain = run.summary.array_power_gain?;
        items.push(format!("{} for the array", words::gain(&gain)));
    } else {
        let gains = stated_gains(run);
        items.extend(gains.iter().map(|(t, gain)| format!("{} {}", t.name, words::gain(gain))));
        if items.is_empty() {
            items.push("power as it was".to_owned());
        }
    }
    let done = done(study, run);
    if !done.is_empty() {
        items.push(words::list(&done));
    }
    Some(items.join(", "))
}

fn power_sentence(run: &RunRecords) -> String {
    const MOST_NAMED: usize = 6;
    let turbines = &run.summary.turbines;
    let power = |power: &Statistic| {
        let Unit { name, size } = Units::of_all([&run.summary]).power;
        let decimals = words::three_figures(power.mean / size);
        let uncertain = match power.half_width_95 {
            Some(_) => format!(" {}", words::interval(power, size, decimals)),
            None => String::new(),
        };
        format!("{}{uncertain}{SPACE}{name}", number(power.mean / size, decimals))
    };
    let name = &run.summary.run;
    if is_summed(run) {
        let names: Vec<String> = turbines.iter().map(|turbine| turbine.name.clone()).collect();
        let who = match names.len() {
            n if n > MOST_NAMED => format!("The {} turbines", words::small_count(n)),
            _ => words::list(&names),
        };
        let together = if names.len() > 1 { " together" } else { "" };
        return format!(
            "{who} made {}{together} in the run “{name}”.",
            power(&run.summary.array_power)
        );
    }
    let each =
        turbines.iter().map(|turbine| format!("{} made {}", turbine.name, power(&turbine.power)));
    format!("{} in the run “{name}”.", words::list(&each.collect::<Vec<_>>()))
}

/// "counter-clockwise helix of 4.0°".
pub(crate) fn name_of(excitation: &Excitation) -> String {
    let amplitude = amplitude(excitation.pitch.commanded_amplitude_deg);
    match (excitation.kind, excitation.synchronised_at()) {
        (ExcitationKind::Synchronised(_), Some(offset)) => {
            format!("synchronised helix of {amplitude}° at {offset}")
        }
        (ExcitationKind::Synchronised(_), None) => format!("synchronised helix of {amplitude}°"),
        (ExcitationKind::Helix(Sense::CounterClockwise), _) => {
            format!("counter-clockwise helix of {amplitude}°")
        }
        (ExcitationKind::Helix(Sense::Clockwise), _) => format!("clockwise helix of {amplitude}°"),
        (ExcitationKind::Pulse, _) => format!("pulse of {amplitude}°"),
        (ExcitationKind::Named(name), _) => {
            format!("periodic pitch of {amplitude}° under “{name}”")
        }
    }
}

/// An amplitude (deg) with one decimal, with a second one where it has one.
fn amplitude(degrees: f64) -> String {
    let text = number(degrees, 2);
    text.strip_suffix('0').map_or(text.clone(), str::to_owned)
}

/// The conditions that all runs share, one item each.
pub(crate) fn shared_conditions(study: &Study) -> Vec<String> {
    let summary = &study.runs()[0].summary;
    let conditions = &summary.conditions;
    let from = direction(conditions).map_or(String::new(), |degrees| format!(" from {degrees}"));
    let mut items = vec![
        format!("{}{SPACE}m/s{from}", number(conditions.target_wind_speed, 1)),
        format!(
            "TI {} target, {} realised",
            percent(conditions.target_turbulence_intensity),
            percent(conditions.realised_turbulence_intensity)
        ),
    ];
    if let Some(spacing) = spacing(study) {
        items.push(format!("spacing {spacing}"));
    }
    items.push(length(&summary.array_power, conditions.duration - conditions.spin_up));
    items.push(air(summary));
    items
}

/// Where the wind comes from, "241.5°"; none from the west, where wind comes from unless a case says so.
pub(crate) fn direction(conditions: &Conditions) -> Option<String> {
    let degrees = conditions.direction_deg;
    (degrees != 270.0).then(|| {
        let text = number(degrees, 1);
        format!("{}°", text.strip_suffix(".0").unwrap_or(&text))
    })
}

/// What moves the air: "lattice, 16 cells per diameter", or "uniform wind, no wakes".
fn air(summary: &Summary) -> String {
    let solver = summary.flow.as_ref().map(|flow| flow.solver.as_str());
    let mut items = Vec::new();
    match (summary.conditions.cells_per_diameter, solver) {
        (Some(cells), solver) => {
            items.extend(solver.map(str::to_owned));
            let boxed = summary.flow.as_ref().is_some_and(|flow| !flow.grids.is_empty());
            let place = if boxed { " at the first turbine" } else { "" };
            items.push(format!("{} cells per diameter{place}", number(cells, 0)));
        }
        (None, Some(solver)) => items.push(format!("flow solver {solver}")),
        (None, None) => items.push("prescribed wind".to_owned()),
    }
    if !summary.has_wakes() {
        items.push("no wakes".to_owned());
    }
    items.join(", ")
}

/// Excitations of a run: "ccw helix on T1, 4.0° target, 3.9° delivered, St 0.25".
pub(crate) fn excitation_conditions(study: &Study, run: &RunRecords) -> Vec<String> {
    study
        .excitations(run)
        .iter()
        .map(|excitation| {
            let kind = match excitation.kind {
                ExcitationKind::Helix(sense) | ExcitationKind::Synchronised(sense) => {
                    format!("{sense} helix")
                }
                ExcitationKind::Pulse => "pulse".to_owned(),
                ExcitationKind::Named(name) => name.to_owned(),
            };
            let synchronised =
                excitation.synchronised_at().map(|offset| format!(" synchronised at {offset}"));
            format!(
                "{kind}{} on {}, {}° target, {}° delivered, St{SPACE}{}",
                synchronised.unwrap_or_default(),
                excitation.turbine.name,
                amplitude(excitation.pitch.commanded_amplitude_deg),
                number(excitation.pitch.delivered_amplitude_deg, 1),
                number(excitation.strouhal, 2)
            )
        })
        .collect()
}

/// All conditions of one run in one line; no percentage goes without it.
pub(crate) fn conditions_line(study: &Study, run: Option<&RunRecords>) -> String {
    let mut items = shared_conditions(study);
    if let Some(run) = run {
        items.extend(excitation_conditions(study, run));
    }
    items.join(" · ")
}

/// The conditions of all runs, an item each: each excitation where there are few, their span where there are
/// many.
pub(crate) fn study_conditions(study: &Study) -> Vec<String> {
    const MOST: usize = 3;
    let mut items = shared_conditions(study);
    let runs = study.runs();
    let each: Vec<String> = runs.iter().flat_map(|run| excitation_conditions(study, run)).collect();
    if each.len() <= MOST {
        items.extend(each);
        return items;
    }
    let all: Vec<Excitation> = runs.iter().flat_map(|run| study.excitations(run)).collect();
    items.push(span("St", all.iter().map(|excitation| excitation.strouhal), 2, ""));
    let delivered = all.iter().map(|excitation| excitation.pitch.delivered_amplitude_deg);
    items.push(span("delivered", delivered, 1, "°"));
    items
}

/// "St 0.25" or "St 0.20 to 0.30".
fn span(name: &str, values: impl Iterator<Item = f64>, decimals: usize, unit: &str) -> String {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = (number(low, decimals), number(high, decimals));
    if low == high {
        format!("{name}{SPACE}{low}{unit}")
    } else {
        format!("{name}{SPACE}{low}{unit} to {high}{unit}")
    }
}

/// Distance of neighbours in words: "5.0 D", "5.0 D, 6.0 D", or "4.0 D to 7.0 D" where there are many.
pub(crate) fn spacing(study: &Study) -> Option<String> {
    let spacing = spread(&study.spacings(), 1, "D")?;
    let staggered = if study.lanes.len() > 1 { " along the wind, staggered" } else { "" };
    Some(format!("{spacing}{staggered}"))
}

/// The same in metres.
pub(crate) fn spacing_in_metres(study: &Study) -> Option<String> {
    let diameter = study.diameter();
    let metres: Vec<f64> = study.spacings().iter().map(|spacing| spacing * diameter).collect();
    spread(&metres, 0, "m")
}

/// Each of `values` once where they are few, their span where they are many; none of none.
fn spread(values: &[f64], decimals: usize, unit: &str) -> Option<String> {
    const MOST: usize = 3;
    let mut stated: Vec<String> = Vec::new();
    for value in values {
        let text = format!("{}{SPACE}{unit}", number(*value, decimals));
        if !stated.contains(&text) {
            stated.push(text);
        }
    }
    if stated.len() <= MOST {
        return (!stated.is_empty()).then(|| stated.join(", "));
    }
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let [least, most] =
        [least, most].map(|value| format!("{}{SPACE}{unit}", number(value, decimals)));
    Some(format!("{least} to {most}"))
}

/// "2100 s analysed in 3 ten-minute blocks".
pub(crate) fn length(power: &Statistic, analysed: f64) -> String {
    let decimals = if analysed < 10.0 { 1 } else { 0 };
    let seconds = format!("{}{SPACE}s analysed", number(analysed, decimals));
    match power.n_blocks {
        0 => seconds,
        1 => format!("{seconds} in one block"),
        n if (600.0 * n as f64..600.0 * (n + 1) as f64).contains(&analysed) => {
            format!("{seconds} in {n} ten-minute blocks")
        }
        n => {
            let each = analysed / n as f64;
            let decimals = if each < 10.0 { 1 } else { 0 };
            format!("{seconds} in {n} blocks of {}{SPACE}s", number(each, decimals))
        }
    }
}
