//! Gain over one swept number, a line for each combination of the other keys.

use super::super::WIDTH;
use super::{axis_name, key_name, number, numeric, parts, series_name, title};
use crate::draw::axes::{Frame, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::whisker::{self, Style, whisker};
use crate::draw::{Axis, Figure, Look, Role, Shape, polyline, segment};
use crate::words;
use basis::records::{Statistic, SweepRow, SweepTable, SweptKey};

/// Panels at most.
const MOST_PANELS: usize = 3;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 64.0;

/// One line, with its rows from the least number on.
struct Line<'a> {
    name: String,
    rows: Vec<(f64, &'a SweepRow)>,
}

/// Gain over the swept number that is an amplitude, or else has most values.
pub(super) fn lines(table: &SweepTable) -> Option<Figure> {
    let numeric = numeric(table);
    let rank =
        |(key, values): &(&SweptKey, Vec<f64>)| (key.label.contains("amplitude"), values.len());
    // The first of equals.
    let (key, values) = numeric.iter().rev().max_by_key(|entry| rank(entry))?;
    let lines = lines_over(table, key);
    let names: Vec<&str> = parts(table).into_iter().take(MOST_PANELS).collect();
    if names.is_empty() || lines.iter().all(|line| line.rows.len() < 2) {
        return None;
    }
    let mut shapes = Vec::new();
    let entries: Vec<(usize, &str)> =
        lines.iter().enumerate().map(|(place, line)| (place + 1, line.name.as_str())).collect();
    let used = legend([LEFT, 22.0], WIDTH - 90.0, |_| Role::Plain, &entries, &mut shapes);
    let top = 22.0 + used + 18.0;
    let step = (WIDTH - LEFT - 12.0) / names.len() as f64;
    let x = Scale::around(values.iter().copied(), 0.06);
    for (place, name) in names.iter().enumerate() {
        let gains = lines.iter().flat_map(|line| &line.rows).filter_map(|(_, row)| gain(row, name));
        let frame = Frame {
            area: [LEFT + step * place as f64, top, step - 52.0, HEIGHT],
            x,
            y: scale(gains),
        };
        panel(&frame, (place == 0, title(name), &axis_name(key)), &mut shapes);
        let inner = lines.iter().enumerate();
        let inner = inner.map(|(place, line)| drawn(line, place + 1, name, &frame)).collect();
        shapes.push(frame.readout(["", "%"]).group(6.0, inner));
    }
    Some(Figure {
        name: "sweep-lines".to_owned(),
        title: format!("Power gain over {}", key_name(key)),
        caption: "Gain of the mean power over the compared run in the same wind, with its 95\u{a0}% interval."
            .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

/// Rows of `table` over the numbers of `key`, line by line.
fn lines_over<'a>(table: &'a SweepTable, key: &SweptKey) -> Vec<Line<'a>> {
    let mut lines: Vec<Line> = Vec::new();
    let is_compared = |row: &&SweepRow| row.parts.iter().any(|part| part.gain.is_some());
    for row in table.rows.iter().filter(is_compared) {
        let Some(x) = number(row, key) else { continue };
        let name = series_name(table, row, &[key]);
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.rows.push((x, row)),
            None => lines.push(Line { name, rows: vec![(x, row)] }),
        }
    }
    for line in &mut lines {
        line.rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    lines
}

fn gain(row: &SweepRow, part: &str) -> Option<Statistic> {
    row.part(part)?.gain.filter(|gain| gain.mean.is_finite())
}

/// The axis (%) of `gains`: zero, every mean, and the intervals that are not far beyond the usual.
pub(super) fn scale(gains: impl Iterator<Item = Statistic>) -> Scale {
    let whisker = |gain: Statistic| (100.0 * gain.mean, 100.0 * gain.half_width_95.unwrap_or(0.0));
    let whiskers: Vec<(f64, f64)> = gains.map(whisker).collect();
    let halves = whiskers.iter().map(|whisker| whisker.1).filter(|half| *half > 0.0);
    Scale::around_whiskers([0.0], &whiskers, whisker::reach(halves), 0.08)
}

/// Axes with a line at zero.
fn panel(frame: &Frame, (is_first, title, x): (bool, &str, &str), shapes: &mut Vec<Shape>) {
    frame.rows(5, true, shapes);
    frame.columns(6, true, shapes);
    frame.title(title, shapes);
    frame.x_label(x, shapes);
    if is_first {
        frame.y_label("power gain (%)", 46.0, shapes);
    }
    let ends = [frame.x.low, frame.x.high].map(|x| frame.point([x, 0.0]));
    let zero = segment(ends[0], ends[1], Look::line(Ink::Axis, 1.0));
    shapes.push(frame.behind(vec![zero]));
}

/// The line of number `colour` with the gains of the part called `name`.
fn drawn(line: &Line, colour: usize, name: &str, frame: &Frame) -> Shape {
    let ink = Ink::Run(colour);
    let gains: Vec<(f64, Statistic)> =
        line.rows.iter().filter_map(|(x, row)| Some((*x, gain(row, name)?))).collect();
    let through: Vec<[f64; 2]> = gains.iter().map(|(x, gain)| [*x, 100.0 * gain.mean]).collect();
    let look = Look::line(ink, 1.8).dashed(run_dash(colour));
    let mut shapes = vec![polyline(frame.points(&through), look)];
    let style = Style { ink, width: 1.6, cap: 0.0, radius: 4.5, numbered: true };
    for (x, gain) in gains {
        let half = gain.half_width_95.map(|half| 100.0 * half);
        let [across, _] = frame.point([x, 0.0]);
        let mark = whisker(frame, Axis::Y, across, 100.0 * gain.mean, half, style);
        let told = format!("{} at {x}: {}", line.name, words::gain(&gain));
        shapes.push(Shape::Group { role: Role::Mark(told), clip: None, shapes: mark });
    }
    Shape::Group { role: Role::Plain, clip: None, shapes }
}
