//! Figures of modes: energy over frequency, and what the strongest modes look like.

use super::found::Found;
use crate::wake_fields::{axes, panel};
use report::{DensityFigure, DensityRow, MapColours, MapFigure, MapPanel, Signals, SpectrumLine};

/// Modes that a figure of densities draws (–).
const N_DRAWN: usize = 3;
/// Panels of a figure of shapes at most (–).
const MOST_PANELS: usize = 6;
/// Excitation frequencies that a figure shows (–).
const SHOWN: f64 = 6.0;
/// Names of the components.
const NAMES: [&str; 3] = ["u", "v", "w"];

/// The figures of an `answer`.
pub(super) fn signals(answer: &Found) -> Signals {
    let shapes = (0..3).find(|component| answer.components[*component]);
    let maps = shapes.map(|component| [spectral(answer, component), by_energy(answer, component)]);
    Signals {
        title: format!("Modes, {}", answer.conditions),
        lead: format!("Energies are means over the area. {}.", answer.samples()),
        maps: maps.into_iter().flatten().flatten().collect(),
        densities: vec![densities(answer)],
        ..Signals::default()
    }
}

/// Energy over frequency: all, and of each mode.
fn densities(answer: &Found) -> DensityFigure {
    let spod = &answer.spod;
    let n = spod.densities.len();
    let line = |name: String, colour: usize, of: &dyn Fn(usize) -> f64| SpectrumLine {
        name,
        colour,
        frequency_step: spod.frequency_step,
        values: (0..n).map(of).collect(),
    };
    let mut lines = vec![line("all modes".to_owned(), 0, &|index| spod.density(index))];
    for mode in 0..N_DRAWN.min(spod.n_blocks) {
        let of = |index: usize| spod.densities[index].get(mode).copied().unwrap_or(0.0);
        lines.push(line(format!("mode {}", mode + 1), mode + 1, &of));
    }
    let last = spod.frequency(n - 1);
    let first = answer.names.all.first().map_or(last, |first| SHOWN * first.frequency);
    let [low, high] = spod.interval_95;
    let marks = answer.names.all.iter().filter(|one| one.frequency <= first.min(last));
    DensityFigure {
        name: "modes-energy".to_owned(),
        title: "Energy of modes over frequency".to_owned(),
        caption: format!(
            "Mean over the area of |u'|², one-sided. {}. {}. A density lies with 95 % between {low:.2} and {high:.2} of what is drawn.",
            answer.conditions,
            answer.samples()
        ),
        lowest_frequency: None,
        highest_frequency: first.min(last),
        marks: marks.map(|one| (one.frequency, one.name.clone())).collect(),
        band: None,
        rows: vec![DensityRow { label: "density ((m/s)²/Hz)".to_owned(), lines }],
    }
}

/// Real part of the first mode at each frequency that is kept.
fn spectral(answer: &Found, component: usize) -> Option<MapFigure> {
    let panels = answer.spod.modes.iter().take(MOST_PANELS).filter_map(|one| {
        let mode = one.modes.first()?;
        let values: Vec<f64> = mode[component].iter().map(|value| f64::from(value[0])).collect();
        let name = answer.name_of(one.index).map_or(String::new(), |name| format!("{name}: "));
        panel(&answer.grid, &answer.setting, format!("{name}{:.4} Hz", one.frequency), &values)
    });
    let title = format!("Real part of {} of the first mode at a frequency", NAMES[component]);
    figure(answer, "modes-shapes", title, panels.collect())
}

/// The strongest modes over all frequencies.
fn by_energy(answer: &Found, component: usize) -> Option<MapFigure> {
    let panels =
        answer.pod.modes.iter().enumerate().take(MOST_PANELS).filter_map(|(index, mode)| {
            let values: Vec<f64> = mode[component].iter().map(|value| f64::from(*value)).collect();
            let share = 100.0 * answer.pod.energies[index] / answer.pod.total;
            let name = answer.pod_name(index).map_or(String::new(), |name| format!(", {name}"));
            panel(
                &answer.grid,
                &answer.setting,
                format!("mode {}: {share:.1} %{name}", index + 1),
                &values,
            )
        });
    let title = format!("{} of the modes with most energy", NAMES[component]);
    figure(answer, "modes-pod", title, panels.collect())
}

fn figure(answer: &Found, name: &str, title: String, panels: Vec<MapPanel>) -> Option<MapFigure> {
    (!panels.is_empty()).then(|| MapFigure {
        colours: MapColours::AboutZero,
        is_to_scale: true,
        has_lines: false,
        name: name.to_owned(),
        title,
        caption: format!(
            "The mean square over the area, of all components together, is 1. {}. {}.",
            answer.conditions,
            answer.samples()
        ),
        along: axes(&answer.grid),
        unit: "–".to_owned(),
        panels,
    })
}
