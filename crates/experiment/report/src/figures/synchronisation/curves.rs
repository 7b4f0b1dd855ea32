//! A quantity over another one: what was found, the curve through it and its band.

use super::marks::{named, upright};
use crate::draw::axes::{Frame, Scale};
use crate::draw::colour::Ink;
use crate::draw::{Figure, Look, Role, Shape, segment};
use crate::figures::WIDTH;
use crate::words::number;

const HEIGHT: f64 = 190.0;
const LEFT: f64 = 66.0;
const GAP: [f64; 2] = [34.0, 62.0];
/// Panels in a row at most.
const MOST: usize = 3;
const CURVE: Ink = Ink::Run(2);

/// A quantity over another one, a panel beside the other, all on one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// What it is over, with its unit.
    pub along: String,
    /// The quantity, with its unit.
    pub label: String,
    /// The panels.
    pub panels: Vec<CurvePanel>,
}

/// One curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurvePanel {
    /// Title.
    pub title: String,
    /// What was found: place and value (units of the axes).
    pub points: Vec<[f64; 2]>,
    /// The curve at ascending places.
    pub curve: Vec<CurveAt>,
    /// A place that is marked (unit of the horizontal axis).
    pub mark: Option<f64>,
}

/// The curve at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveAt {
    /// The place (unit of the horizontal axis).
    pub at: f64,
    /// Most probable value (unit of the vertical axis).
    pub mean: f64,
    /// Where it lies with 95 % (unit of the vertical axis).
    pub band_95: [f64; 2],
}

/// The panels in rows.
pub(super) fn curves(figure: &CurveFigure) -> Option<Figure> {
    let curves = || figure.panels.iter().flat_map(|panel| &panel.curve);
    let places = curves().map(|point| point.at);
    let [start, end] =
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    if start >= end {
        return None;
    }
    let found = || figure.panels.iter().flat_map(|panel| &panel.points);
    let values = curves().flat_map(|point| point.band_95);
    let values = values.chain(found().map(|point| point[1])).chain([0.0]);
    let [start, end] =
        found().fold([start, end], |[low, high], point| [low.min(point[0]), high.max(point[0])]);
    let (x, y) = (Scale::linear(start, end), Scale::around(values, 0.06));
    let n_columns = figure.panels.len().min(MOST);
    let width = (WIDTH - LEFT - 24.0 - GAP[0] * (n_columns - 1) as f64) / n_columns as f64;
    let mut shapes = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let (row, column) = (index / n_columns, index % n_columns);
        let left = LEFT + (width + GAP[0]) * column as f64;
        let top = 34.0 + (HEIGHT + GAP[1]) * row as f64;
        let frame = Frame { area: [left, top, width, HEIGHT], x, y };
        frame.rows(5, column == 0, &mut shapes);
        frame.columns(5, true, &mut shapes);
        frame.title(&panel.title, &mut shapes);
        if column == 0 {
            frame.y_label(&figure.label, 46.0, &mut shapes);
        }
        if index + n_columns >= figure.panels.len() {
            frame.x_label(&figure.along, &mut shapes);
        }
        shapes.push(frame.panel(drawn(panel, &frame), ["", ""]));
    }
    let n_rows = figure.panels.len().div_ceil(n_columns);
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: figure.caption.clone(),
        width: WIDTH,
        height: 34.0 + (HEIGHT + GAP[1]) * n_rows as f64 - GAP[1] + 50.0,
        shapes,
    })
}

/// Band, curve, crosses.
fn drawn(panel: &CurvePanel, frame: &Frame) -> Vec<Shape> {
    let along = |value: fn(&CurveAt) -> f64| -> Vec<[f64; 2]> {
        panel.curve.iter().map(|point| [point.at, value(point)]).collect()
    };
    let mut band = frame.points(&along(|point| point.band_95[0]));
    band.extend(frame.points(&along(|point| point.band_95[1])).into_iter().rev());
    let zero = [frame.point([frame.x.low, 0.0]), frame.point([frame.x.high, 0.0])];
    let mut shapes = vec![
        segment(zero[0], zero[1], Look::line(Ink::Axis, 1.0)),
        Shape::Path { points: band, closed: true, look: Look::fill(CURVE).opacity(0.16) },
        named("curve", vec![frame.line(&along(|point| point.mean), Look::line(CURVE, 2.0))]),
    ];
    if let Some(mark) = panel.mark {
        upright(frame, mark, &number(mark, 2), &mut shapes);
    }
    for point in &panel.points {
        let mut mark = Vec::new();
        cross(frame.point(*point), Look::line(Ink::Text, 1.4), &mut mark);
        let told = format!("{}: {}", number(point[0], 3), number(point[1], 2));
        shapes.push(Shape::Group { role: Role::Mark(told), clip: None, shapes: mark });
    }
    shapes
}

/// A slanted cross.
pub(super) fn cross([x, y]: [f64; 2], look: Look, shapes: &mut Vec<Shape>) {
    const ARM: f64 = 3.2;
    shapes.push(segment([x - ARM, y - ARM], [x + ARM, y + ARM], look));
    shapes.push(segment([x - ARM, y + ARM], [x + ARM, y - ARM], look));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_stand_in_rows_of_three_and_nothing_is_drawn_of_nothing() {
        let at = |at: f64| CurveAt { at, mean: at, band_95: [at - 1.0, at + 1.0] };
        let panel = CurvePanel {
            title: "T1".into(),
            points: vec![[0.5, 0.4]],
            curve: vec![at(0.0), at(1.0)],
            mark: Some(0.7),
        };
        let of = |panels| CurveFigure {
            name: "cut".into(),
            title: String::new(),
            caption: String::new(),
            along: "x (–)".into(),
            label: "y (%)".into(),
            panels,
        };
        let one = curves(&of(vec![panel.clone(); 3])).expect("a figure");
        let two = curves(&of(vec![panel; 4])).expect("a figure");
        assert_eq!(two.height - one.height, HEIGHT + GAP[1]);
        assert!(curves(&of(vec![CurvePanel::default()])).is_none());
    }
}
