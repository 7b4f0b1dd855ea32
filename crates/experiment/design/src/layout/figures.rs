//! Figures of a layout: over the direction, over the place in the wake, over an input; power against loads.

use super::{Layout, LayoutRow, POWER, Uncertain, change};
use crate::DesignError;
use formats::linear_model::Port;
use report::{CurveAt, CurveFigure, CurvePanel, Signals, Unit, Units};
use std::path::Path;
use surrogate::Prediction;

/// Draws `layout` into `folder`/figures; gives the figures' names.
///
/// # Errors
/// [`DesignError::Report`] where they cannot be drawn.
pub fn draw_layout(layout: &Layout, folder: &Path) -> Result<Vec<String>, DesignError> {
    let mut curves = Vec::new();
    for output in 0..layout.outputs.len() {
        curves.push(over(layout, output, Over::DIRECTION, &layout.directions));
        curves.push(over(layout, output, Over::DISPLACEMENT, &layout.displacements));
        if let Some((input, rows)) = &layout.along {
            let along = Over { name: "input", along: input, scale: 1.0, ..Over::DIRECTION };
            curves.push(over(layout, output, along, rows));
        }
    }
    if let Some(power) = layout.outputs.iter().position(|port| port.name == POWER) {
        let loads = (0..layout.outputs.len()).filter(|output| *output != power);
        curves.extend(loads.map(|load| against(layout, power, load)));
    }
    Ok(report::write_signals(&[Signals { curves, ..Signals::default() }], folder)?)
}

/// What a figure goes over.
#[derive(Clone, Copy)]
struct Over<'a> {
    /// Name in the files' names.
    name: &'a str,
    /// Label of the axis.
    along: &'a str,
    /// What the caption says.
    about: &'a str,
    /// What one on the axis is of the place, or 0 for a rotor diameter.
    scale: f64,
}

impl Over<'static> {
    const DIRECTION: Self = Self {
        name: "direction",
        along: "direction of the wind (°)",
        about: "Lines and bands: surrogates and where their curves lie with 95\u{a0}%, which is less than what ten minutes of wind scatter.",
        scale: 1.0,
    };
    const DISPLACEMENT: Self = Self {
        name: "displacement",
        along: "place to the left of the wake's middle (D)",
        scale: 0.0,
        ..Self::DIRECTION
    };
}

/// The port as it is drawn, and what one of its unit is of that in which `means` are given: a turbine's watts
/// have too many digits for an axis.
fn drawn(port: &Port, means: impl IntoIterator<Item = f64>) -> (Port, f64) {
    if port.unit != "W" {
        return (port.clone(), 1.0);
    }
    let Unit { name, size } = Units::of(means).power;
    (Port { unit: name.to_owned(), ..port.clone() }, size)
}

fn label(port: &Port) -> String {
    if port.unit.is_empty() { port.name.clone() } else { format!("{} ({})", port.name, port.unit) }
}

/// The name of a file of `port`.
fn file_name(over: &str, port: &Port) -> String {
    let word = |letter: char| if letter.is_alphanumeric() { letter } else { '-' };
    format!("layout-{over}-{}", port.name.chars().map(word).collect::<String>())
}

/// Output number `output` of `rows`, a panel for each turbine of each strategy.
fn over(layout: &Layout, output: usize, over: Over, rows: &[LayoutRow]) -> CurveFigure {
    let scale = if over.scale == 0.0 { layout.diameter } else { over.scale };
    let means = rows.iter().map(|row| row.predictions[output].mean);
    let (port, unit) = drawn(&layout.outputs[output], means);
    let mut panels: Vec<(usize, usize, CurvePanel)> = Vec::new();
    for row in rows {
        let mean = row.predictions[output].mean / unit;
        let band_95 = row.predictions[output].band_95().map(|end| end / unit);
        let at = CurveAt { at: row.at / scale, mean, band_95 };
        match panels.last_mut() {
            Some((strategy, turbine, panel))
                if [*strategy, *turbine] == [row.strategy, row.turbine] =>
            {
                panel.curve.push(at);
            }
            _ => {
                let title = format!(
                    "{}, {}",
                    layout.turbines[row.turbine], layout.strategies[row.strategy]
                );
                let panel = CurvePanel { title, curve: vec![at], ..CurvePanel::default() };
                panels.push((row.strategy, row.turbine, panel));
            }
        }
    }
    CurveFigure {
        name: file_name(over.name, &port),
        title: format!("{} over the {}", port.name, over.name),
        caption: over.about.to_owned(),
        along: over.along.to_owned(),
        label: label(&port),
        panels: panels.into_iter().map(|(.., panel)| panel).collect(),
    }
}

/// Gain of power against a load, a panel for each turbine: crosses for each direction of each strategy, the
/// line through the means over the directions.
fn against(layout: &Layout, power: usize, load: usize) -> CurveFigure {
    let panel = |turbine: usize| {
        let own: Vec<&LayoutRow> =
            layout.directions.iter().filter(|row| row.turbine == turbine).collect();
        let first = |row: &LayoutRow| {
            own.iter().find(|other| other.strategy == 0 && other.at == row.at).copied()
        };
        let uncertain = |found: &Prediction| Uncertain {
            mean: found.mean,
            deviation: found.standard_deviation,
        };
        let points = own.iter().filter_map(|row| {
            let (value, first) = (&row.predictions[power], &first(row)?.predictions[power]);
            let gain = change(uncertain(value), uncertain(first))?;
            Some([row.predictions[load].mean, 100.0 * gain.mean])
        });
        let averages = layout.averages.iter().filter(|one| one.turbine == Some(turbine));
        let mut curve: Vec<CurveAt> = averages
            .filter_map(|one| {
                let none = Uncertain { mean: 0.0, deviation: 0.0 };
                let gain = if one.strategy == 0 { none } else { one.changes[power]? };
                let ends = [-1.0, 1.0].map(|sign| gain.mean + sign * gain.half_width_95());
                Some(CurveAt {
                    at: one.values[load]?.mean,
                    mean: 100.0 * gain.mean,
                    band_95: ends.map(|end| 100.0 * end),
                })
            })
            .collect();
        curve.sort_by(|a, b| a.at.total_cmp(&b.at));
        CurvePanel {
            title: layout.turbines[turbine].clone(),
            points: points.collect(),
            curve,
            mark: None,
        }
    };
    let port = &layout.outputs[load];
    CurveFigure {
        name: file_name("gain-against", port),
        title: format!("Power against {}", port.name),
        caption: format!(
            "Crosses: each strategy in each direction, its power over that of {} in the same direction; line and band: means over the directions, from strategy to strategy.",
            layout.strategies[0]
        ),
        along: label(port),
        label: "gain of power (%)".to_owned(),
        panels: (0..layout.turbines.len()).map(panel).collect(),
    }
}
