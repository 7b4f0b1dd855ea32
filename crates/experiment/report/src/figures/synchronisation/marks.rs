//! Small parts that these figures share.

use crate::draw::axes::{Frame, SMALL};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::{Axis, Look, Role, Shape, TextStyle, segment, text};
use crate::words::{SPACE, number};

/// A degree as a reader sees it.
pub(super) const DEGREE: char = '°';

/// Ticks every `step` degrees below a frame whose horizontal values are degrees.
pub(super) fn degree_columns(frame: &Frame, step: f64, shapes: &mut Vec<Shape>) {
    let [left, top, width, height] = frame.area;
    let base = top + height;
    shapes.push(segment([left, base], [left + width, base], Look::line(Ink::Axis, 1.0)));
    let mut ticks = Vec::new();
    for degrees in multiples(step, frame.x.low, frame.x.high) {
        let [x, _] = frame.point([degrees, frame.y.low]);
        ticks.push(segment([x, base], [x, base + 4.0], Look::line(Ink::Axis, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(0.5);
        ticks.push(text([x, base + 17.0], number(degrees, 0), setting));
    }
    frame.ticks(Axis::X, ticks, shapes);
}

/// Grid lines every `step` degrees across a frame whose vertical values are degrees.
pub(super) fn degree_rows(frame: &Frame, step: f64, shapes: &mut Vec<Shape>) {
    let [left, _, width, _] = frame.area;
    let mut ticks = Vec::new();
    for degrees in multiples(step, frame.y.low, frame.y.high) {
        let [_, y] = frame.point([frame.x.low, degrees]);
        ticks.push(segment([left, y], [left + width, y], Look::line(Ink::Grid, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(1.0);
        ticks.push(text([left - 7.0, y + 4.0], number(degrees, 0), setting));
    }
    frame.ticks(Axis::Y, ticks, shapes);
}

fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step - 1e-6).ceil() as i64, (high / step + 1e-6).floor() as i64);
    (first..=last).map(move |index| index as f64 * step)
}

/// A dashed line over the height of a frame at `value`, with `label` at its top when there is one.
pub(super) fn upright(frame: &Frame, value: f64, label: &str, shapes: &mut Vec<Shape>) {
    let [left, top, width, height] = frame.area;
    let [x, _] = frame.point([value, frame.y.low]);
    if !(left..=left + width).contains(&x) {
        return;
    }
    let look = Look::line(Ink::Axis, 1.0).dashed(Some([4.0, 3.0]));
    shapes.push(segment([x, top], [x, top + height], look));
    if !label.is_empty() {
        // On the side where there is room.
        let right = x < left + 0.75 * width;
        let (place, anchor) = if right { (x + 5.0, 0.0) } else { (x - 5.0, 1.0) };
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(anchor);
        shapes.push(text([place, top + 13.0], label, setting));
    }
}

/// A case's line, or the pieces of it, under its `name`.
pub(super) fn named(name: &str, shapes: Vec<Shape>) -> Shape {
    Shape::Group { role: Role::Line(name.to_owned()), clip: None, shapes }
}

/// The look of a case's line.
pub(super) fn case_line(colour: usize, width: f64) -> Look {
    Look::line(Ink::Run(colour), width).dashed(run_dash(colour))
}

/// Names with their colours, each once, in the order in which they first come.
pub(super) fn names<'a>(
    lines: impl IntoIterator<Item = (usize, &'a str)>,
) -> Vec<(usize, &'a str)> {
    let mut names: Vec<(usize, &str)> = Vec::new();
    for name in lines {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// An angle in whole degrees with its sign: "150°".
pub(super) fn degrees(angle: f64) -> String {
    format!("{}{DEGREE}", number(angle.to_degrees(), 0))
}

/// "U∞ = 10.5 m/s".
pub(super) fn free_stream(speed: f64) -> String {
    format!("U∞ = {}{SPACE}m/s", number(speed, 1))
}
