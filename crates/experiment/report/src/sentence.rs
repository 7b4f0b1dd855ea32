//! What the numbers say, in plain sentences, and the conditions under which they hold.

use crate::RunRecords;
use crate::study::{Excitation, ExcitationKind, Study, gain_of};
use crate::words::{self, SPACE, number, percent};
use basis::records::{Statistic, TurbineSummary};

/// Changes of power below this (–) are not stated: they print as zero.
const LEAST_STATED: f64 = 5e-4;

/// The result in one sentence: what was done, what each turbine lost or won, and all together.
pub(crate) fn headline(study: &Study) -> String {
    match study.best() {
        Some(run) => gain_sentence(study, run),
        None => power_sentence(&study.runs()[0]),
    }
}

/// A remark on how firm the headline is; empty when there is nothing to add.
pub(crate) fn confidence(study: &Study) -> String {
    let Some(gain) = study.best().and_then(|run| run.summary.array_power_gain) else {
        return String::new();
    };
    match gain.half_width_95 {
        Some(width) if width >= gain.mean.abs() => {
            "The interval includes zero: a study of this length does not show whether there is a \
             gain."
                .to_owned()
        }
        Some(_) => String::new(),
        None => {
            "There is no interval: the analysed time is too short for two blocks, so the figure may \
             be chance."
                .to_owned()
        }
    }
}

/// The gain of one run: "A counter-clockwise helix of 4.0° on T1 cost T1 2.1 % …".
pub(crate) fn gain_sentence(study: &Study, run: &RunRecords) -> String {
    let excitations = study.changed_excitations(run);
    let subject = if excitations.is_empty() {
        format!("The run “{}”", run.summary.run)
    } else {
        let parts: Vec<String> = excitations
            .iter()
            .map(|excitation| format!("{} on {}", words_of(excitation), excitation.turbine.name))
            .collect();
        words::capitalised(&words::list(&parts))
    };
    let gains: Vec<(&TurbineSummary, f64)> = run
        .summary
        .turbines
        .iter()
        .filter_map(|turbine| Some((turbine, turbine.power_gain?.mean)))
        .collect();
    let stated = |gain: &f64| gain.abs() >= LEAST_STATED;
    let says = |(turbine, gain): &(&TurbineSummary, f64)| {
        format!("{} {}", turbine.name, percent(gain.abs()))
    };
    let losses: Vec<String> =
        gains.iter().filter(|gain| stated(&gain.1) && gain.1 < 0.0).map(says).collect();
    let wins: Vec<String> =
        gains.iter().filter(|gain| stated(&gain.1) && gain.1 > 0.0).map(says).collect();
    let mut clauses = Vec::new();
    if !losses.is_empty() {
        clauses.push(format!("cost {} of its power", words::list(&losses)));
        if losses.len() > 1 {
            clauses[0] = format!("cost {} of their power", words::list(&losses));
        }
    }
    if !wins.is_empty() {
        clauses.push(format!("gave {} more", words::list(&wins)));
    }
    if clauses.is_empty() {
        clauses.push("left the power as it was".to_owned());
    }
    let total = run.summary.array_power_gain.map(|gain| words::gain(&gain)).unwrap_or_default();
    let whole = match gains.len() {
        0 | 1 => String::new(),
        n => format!(" for the {} together", words::small_count(n)),
    };
    format!("{subject} {}: {total}{whole}.", clauses.join(" and "))
}

/// One run against the others in a few words, for the list under the headline.
pub(crate) fn short_gain(study: &Study, run: &RunRecords) -> Option<String> {
    gain_of(run)?;
    let gain = run.summary.array_power_gain?;
    let done: Vec<String> = study
        .changed_excitations(run)
        .iter()
        .map(|excitation| format!("{} on {}", words_of(excitation), excitation.turbine.name))
        .collect();
    let done = if done.is_empty() { String::new() } else { format!(", {}", words::list(&done)) };
    Some(format!("{} for the array{done}", words::gain(&gain)))
}

fn power_sentence(run: &RunRecords) -> String {
    let names: Vec<String> = run.summary.turbines.iter().map(|t| t.name.clone()).collect();
    let power = &run.summary.array_power;
    let decimals = words::three_figures(power.mean / 1e6);
    let uncertain = match power.half_width_95 {
        Some(_) => format!(" {}", words::interval(power, 1e6, decimals)),
        None => String::new(),
    };
    let together = if names.len() > 1 { " together" } else { "" };
    format!(
        "{} made {}{uncertain}{SPACE}MW{together} in the run “{}”.",
        words::list(&names),
        number(power.mean / 1e6, decimals),
        run.summary.run
    )
}

/// "a counter-clockwise helix of 4.0°".
pub(crate) fn words_of(excitation: &Excitation) -> String {
    let amplitude = number(excitation.pitch.commanded_amplitude_deg, 1);
    if let Some(offset) = excitation.synchronised_at() {
        return format!("a synchronised helix of {amplitude}° at {offset}");
    }
    match excitation.kind {
        ExcitationKind::CounterClockwise => format!("a counter-clockwise helix of {amplitude}°"),
        ExcitationKind::Clockwise => format!("a clockwise helix of {amplitude}°"),
        ExcitationKind::Pulse => format!("a pulse of {amplitude}°"),
        ExcitationKind::Other => format!("“{}”", excitation.turbine.control.description),
    }
}

/// The conditions that all runs share, one item each.
pub(crate) fn shared_conditions(study: &Study) -> Vec<String> {
    let summary = &study.runs()[0].summary;
    let conditions = &summary.conditions;
    let mut items = vec![
        format!("{}{SPACE}m/s", number(conditions.target_wind_speed, 1)),
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
    items.push(match conditions.cells_per_diameter {
        Some(cells) => format!("{} cells per diameter", number(cells, 0)),
        None => "prescribed wind, no wakes".to_owned(),
    });
    items
}

/// Excitations of a run: "ccw helix on T1, 4.0° target, 3.9° delivered, St 0.25".
pub(crate) fn excitation_conditions(study: &Study, run: &RunRecords) -> Vec<String> {
    study
        .excitations(run)
        .iter()
        .map(|excitation| {
            let kind = match excitation.kind {
                ExcitationKind::CounterClockwise => "ccw helix",
                ExcitationKind::Clockwise => "cw helix",
                ExcitationKind::Pulse => "pulse",
                ExcitationKind::Other => excitation.turbine.control.description.as_str(),
            };
            let synchronised =
                excitation.synchronised_at().map(|offset| format!(" synchronised at {offset}"));
            format!(
                "{kind}{} on {}, {}° target, {}° delivered, St{SPACE}{}",
                synchronised.unwrap_or_default(),
                excitation.turbine.name,
                number(excitation.pitch.commanded_amplitude_deg, 1),
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

/// The conditions of all runs in one line: each excitation where there are few, their span where
/// there are many.
pub(crate) fn study_line(study: &Study) -> String {
    const MOST: usize = 3;
    let mut items = shared_conditions(study);
    let runs = study.runs();
    let each: Vec<String> = runs.iter().flat_map(|run| excitation_conditions(study, run)).collect();
    if each.len() <= MOST {
        items.extend(each);
        return items.join(" · ");
    }
    let all: Vec<Excitation> = runs.iter().flat_map(|run| study.excitations(run)).collect();
    items.push(span("St", all.iter().map(|excitation| excitation.strouhal), 2, ""));
    let delivered = all.iter().map(|excitation| excitation.pitch.delivered_amplitude_deg);
    items.push(span("delivered", delivered, 1, "°"));
    items.join(" · ")
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

/// Distance of neighbours in words: "5.0 D", or "5.0 D, 6.0 D".
pub(crate) fn spacing(study: &Study) -> Option<String> {
    let mut spacings: Vec<String> =
        study.spacings().iter().map(|spacing| format!("{}{SPACE}D", number(*spacing, 1))).collect();
    spacings.dedup();
    if spacings.is_empty() { None } else { Some(spacings.join(", ")) }
}

/// "2100 s analysed in 3 ten-minute blocks".
pub(crate) fn length(power: &Statistic, analysed: f64) -> String {
    let seconds = format!("{}{SPACE}s analysed", number(analysed, 0));
    match power.n_blocks {
        0 => seconds,
        1 => format!("{seconds} in one block"),
        n if (600.0 * n as f64..600.0 * (n + 1) as f64).contains(&analysed) => {
            format!("{seconds} in {n} ten-minute blocks")
        }
        n => format!("{seconds} in {n} blocks of {}{SPACE}s", number(analysed / n as f64, 0)),
    }
}
