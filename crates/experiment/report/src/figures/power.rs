//! Power and rotor speed over time.

use super::WIDTH;
use crate::draw::axes::{Frame, Readout, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::whisker::{Style, whisker};
use crate::draw::{Axis, Figure, Look, Role, Shape, TextStyle, text};
use crate::study::Study;
use crate::trace::{envelope, moving_mean, thinned};
use crate::units::Unit;
use crate::words;
use basis::Channel;
use basis::channels::{GEN_PWR, ROT_SPEED, TIME};
use basis::records::Statistic;
use std::f64::consts::TAU;

/// Averaging of the thick lines (s),
const SMOOTHING: f64 = 30.0;
/// less on models: so many times as long as the wind takes past the first rotor (–).
const SMOOTHING_PASSES: f64 = 20.0;
/// Above so many runs the unsmoothed lines would hide everything.
const MOST_RAW_RUNS: usize = 4;
const PANEL_HEIGHT: f64 = 165.0;

/// Whether the channel `channel` of a turbine is shown.
pub(crate) fn draws(channel: &str) -> bool {
    [GEN_PWR, ROT_SPEED].iter().any(|shown| shown.name == channel)
}

/// A quantity of every turbine over time.
struct Quantity {
    name: &'static str,
    title: &'static str,
    channel: Channel,
    label: String,
    unit: &'static str,
    /// SI value of one unit of the axis.
    scale: f64,
    statistic: fn(&basis::records::TurbineSummary) -> Statistic,
}

/// Electrical power over time, a panel for each turbine, runs overlaid.
pub(crate) fn power(study: &Study) -> Option<Figure> {
    let Unit { name, size } = study.units().power;
    over_time(
        study,
        &Quantity {
            name: "power",
            title: "Power over time",
            channel: GEN_PWR,
            label: format!("power ({name})"),
            unit: name,
            scale: size,
            statistic: |turbine| turbine.power,
        },
    )
}

/// Rotor speed over time.
pub(crate) fn rotor_speed(study: &Study) -> Option<Figure> {
    over_time(
        study,
        &Quantity {
            name: "rotor-speed",
            title: "Rotor speed over time",
            channel: ROT_SPEED,
            label: "rotor speed (rpm)".to_owned(),
            unit: "rpm",
            scale: TAU / 60.0,
            statistic: |turbine| turbine.rotor_speed,
        },
    )
}

fn over_time(study: &Study, quantity: &Quantity) -> Option<Figure> {
    let names: Vec<&str> = study
        .turbines()
        .into_iter()
        .filter(|name| study.runs().iter().any(|run| channel(run, name, quantity).is_some()))
        .collect();
    let end = study
        .runs()
        .iter()
        .filter_map(|run| run.series.column(&TIME.name)?.last().copied())
        .fold(0.0, f64::max);
    if names.is_empty() || end <= 0.0 {
        return None;
    }
    let mut shapes = Vec::new();
    let top = 22.0 + legend([64.0, 22.0], WIDTH - 90.0, Role::Run, &study.names(), &mut shapes);
    let mut frame_top = top + 16.0;
    for (index, name) in names.iter().enumerate() {
        let area = [64.0, frame_top, WIDTH - 64.0 - 62.0, PANEL_HEIGHT];
        let is_last = index + 1 == names.len();
        panel(study, quantity, name, area, end, is_last, &mut shapes);
        frame_top += PANEL_HEIGHT + 40.0;
    }
    let raw =
        if study.runs().len() <= MOST_RAW_RUNS { ", over the thin unsmoothed one" } else { "" };
    Some(Figure {
        name: quantity.name.to_owned(),
        title: quantity.title.to_owned(),
        caption: format!(
            "Thick: {} s moving mean{raw}. Grey: spin-up, not analysed. Marks at the \
             right: mean over the analysed time with its 95\u{a0}% interval; an arrow has the number of \
             an end beyond the axis.",
            words::number(smoothing(study), usize::from(smoothing(study) < 10.0))
        ),
        width: WIDTH,
        height: frame_top + 14.0,
        shapes,
    })
}

/// Averaging of the thick lines of `study` (s).
fn smoothing(study: &Study) -> f64 {
    let conditions = &study.runs()[0].summary.conditions;
    let pass = conditions.rotor_diameter / conditions.target_wind_speed;
    SMOOTHING.min(SMOOTHING_PASSES * pass)
}

fn channel<'r>(
    run: &'r crate::RunRecords,
    turbine: &str,
    quantity: &Quantity,
) -> Option<(&'r [f64], &'r [f64])> {
    let times = run.series.column(&TIME.name)?;
    let values = run.series.column(&quantity.channel.at(turbine))?;
    (times.len() > 1 && values.len() == times.len()).then_some((times, values))
}

fn panel(
    study: &Study,
    quantity: &Quantity,
    turbine: &str,
    area: [f64; 4],
    end: f64,
    is_last: bool,
    shapes: &mut Vec<Shape>,
) {
    let conditions = &study.runs()[0].summary.conditions;
    let with_raw = study.runs().len() <= MOST_RAW_RUNS;
    let mut raw_lines = Vec::new();
    let mut lines = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let Some((times, values)) = channel(run, turbine, quantity) else { continue };
        let values: Vec<f64> = values.iter().map(|value| value / quantity.scale).collect();
        let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        let window = (smoothing(study) / interval).round().max(1.0) as usize;
        lines.push((colour, thinned(times, &moving_mean(&values, window), 480)));
        if with_raw {
            raw_lines.push((colour, envelope(times, &values, 420)));
        }
    }
    let shown = raw_lines.iter().chain(&lines).flat_map(|(_, line)| line);
    // The start of the spin-up may overshoot far beyond what matters.
    let settled = shown.filter(|point| point[0] > 0.5 * conditions.spin_up).map(|point| point[1]);
    let y = scale(settled.collect(), &statistics(study, quantity, turbine));
    let frame = Frame { area, x: Scale::linear(0.0, end), y };
    if conditions.spin_up > 0.0 {
        shapes.push(spin_up(&frame, conditions.spin_up.min(end), is_last));
    }
    frame.rows(4, true, shapes);
    frame.columns(10, is_last, shapes);
    frame.title(turbine, shapes);
    frame.y_label(&quantity.label, 46.0, shapes);
    if is_last {
        frame.x_label("time (s)", shapes);
    }
    let groups = raw_lines
        .iter()
        .map(|(colour, line)| {
            let look = Look::line(Ink::Run(*colour), 1.0).opacity(0.28);
            run_group(*colour, vec![crate::draw::polyline(frame.points(line), look)])
        })
        .chain(lines.iter().map(|(colour, line)| {
            let look = Look::line(Ink::Run(*colour), 2.2).dashed(run_dash(*colour));
            run_group(*colour, vec![frame.line(line, look)])
        }))
        .collect();
    shapes.push(Readout { both: false, ..frame.readout(["s", quantity.unit]) }.group(0.0, groups));
    means(study, quantity, turbine, &frame, shapes);
}

/// The axis of the values `settled` and of `means` with their intervals, which may be many times as long as
/// the signal is wide: as far as that at most.
fn scale(settled: Vec<f64>, means: &[Mean]) -> Scale {
    let signal = Scale::around(settled.iter().copied(), 0.0);
    let whiskers: Vec<(f64, f64)> =
        means.iter().map(|(.., mean, half)| (*mean, half.unwrap_or(0.0))).collect();
    Scale::around_whiskers(settled, &whiskers, signal.high - signal.low, 0.08)
}

/// The time up to `end` (s), which is not analysed; called so where it is `named`.
fn spin_up(frame: &Frame, end: f64, named: bool) -> Shape {
    let [_, top, _, height] = frame.area;
    let mut behind = Vec::new();
    frame.band(0.0, end, &mut behind);
    if named {
        let [x, _] = frame.point([0.5 * end, frame.y.low]);
        let setting = TextStyle::plain(Ink::Muted, 11.5).anchored(0.5);
        behind.push(text([x, top + height - 8.0], "spin-up", setting));
    }
    frame.behind(behind)
}

/// Colour and name of a run, a mean and half the width of its interval (units of the axis).
type Mean<'a> = (usize, &'a str, f64, Option<f64>);

/// Those of `turbine` in each run.
fn statistics<'a>(study: &'a Study, quantity: &Quantity, turbine: &str) -> Vec<Mean<'a>> {
    let runs = study.runs().iter().zip(&study.colours);
    let found = runs.filter_map(|(run, &colour)| {
        let summary = run.summary.turbines.iter().find(|summary| summary.name == turbine)?;
        let statistic = (quantity.statistic)(summary);
        let half = statistic.half_width_95.map(|half| half / quantity.scale);
        Some((colour, run.summary.run.as_str(), statistic.mean / quantity.scale, half))
    });
    found.filter(|found| found.2.is_finite()).collect()
}

/// Means of the runs with their intervals, right of the frame.
fn means(
    study: &Study,
    quantity: &Quantity,
    turbine: &str,
    frame: &Frame,
    shapes: &mut Vec<Shape>,
) {
    let [left, _, width, _] = frame.area;
    let step = (44.0 / study.runs().len() as f64).min(13.0);
    let found = statistics(study, quantity, turbine);
    for (index, (colour, name, mean, half)) in found.into_iter().enumerate() {
        let x = left + width + 12.0 + step * index as f64;
        let ink = Ink::Run(colour);
        let style = Style { ink, width: 1.6, cap: 0.0, radius: 3.4, numbered: true };
        let mark = whisker(frame, Axis::Y, x, mean, half, style);
        let decimals = words::three_figures(mean);
        let interval =
            half.map_or(String::new(), |half| format!(" ± {}", words::number(half, decimals)));
        let unit = quantity.unit;
        let words = format!("{name}, mean: {}{interval} {unit}", words::number(mean, decimals));
        let mark = Shape::Group { role: Role::Mark(words), clip: None, shapes: mark };
        shapes.push(run_group(colour, vec![mark]));
    }
}

/// Shapes that vanish with their run.
fn run_group(colour: usize, shapes: Vec<Shape>) -> Shape {
    Shape::Group { role: Role::Run(colour), clip: None, shapes }
}
