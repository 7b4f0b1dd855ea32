//! Changes over the phase offset with the curve through them and its band.

use super::marks::{DEGREE, degree_columns, degrees, named, upright};
use super::{CurveEnd, CurvePoint, OffsetFigure, OffsetPanel, OffsetPoint};
use crate::draw::axes::{Frame, Scale};
use crate::draw::colour::Ink;
use crate::draw::whisker::{self, Style, whisker};
use crate::draw::{Axis, Figure, Look, Role, Shape, segment};
use crate::figures::WIDTH;
use crate::words::{self, number};

const HEIGHT: f64 = 270.0;
const LEFT: f64 = 66.0;
const GAP: f64 = 40.0;
/// Colours of the points' marks and of the curve.
const POINT: Ink = Ink::Text;
const CURVE: Ink = Ink::Run(2);

/// A panel for each turbine, all on one scale.
pub(super) fn offsets(figure: &OffsetFigure) -> Option<Figure> {
    let panels: Vec<&OffsetPanel> =
        figure.panels.iter().filter(|panel| !panel.points.is_empty()).collect();
    let n_panels = panels.len();
    if n_panels == 0 {
        return None;
    }
    let scale = scale(&panels);
    let width = (WIDTH - LEFT - 24.0 - GAP * (n_panels - 1) as f64) / n_panels as f64;
    let mut shapes = Vec::new();
    for (index, panel) in panels.iter().enumerate() {
        let left = LEFT + (width + GAP) * index as f64;
        let frame =
            Frame { area: [left, 40.0, width, HEIGHT], x: Scale::linear(0.0, 360.0), y: scale };
        frame.rows(6, index == 0, &mut shapes);
        degree_columns(&frame, if n_panels > 2 { 90.0 } else { 60.0 }, &mut shapes);
        frame.title(&panel.title, &mut shapes);
        frame.x_label("phase offset (°)", &mut shapes);
        if index == 0 {
            frame.y_label(&figure.label, 44.0, &mut shapes);
        }
        let zero = [frame.point([0.0, 0.0]), frame.point([360.0, 0.0])];
        shapes.push(frame.behind(vec![segment(zero[0], zero[1], Look::line(Ink::Axis, 1.0))]));
        let mut inner = Vec::new();
        if let Some(best) = &panel.highest {
            inner.extend(interval(best, &frame));
        }
        inner.extend(curve(panel, &frame));
        if let Some(best) = &panel.highest {
            upright(&frame, best.offset.to_degrees(), &with_interval(best), &mut inner);
        }
        inner.extend(panel.points.iter().map(|point| mark(point, &frame)));
        // Beyond the frame's edges, which would cut the marks at zero and at a whole turn.
        shapes.push(frame.readout(["°", "%"]).group(6.0, inner));
    }
    let has_curve = panels.iter().any(|panel| !panel.curve.is_empty());
    let of_curve = "; line and band: Gaussian process through them and where it lies with 95\u{a0}%, \
                    dashed, with its own 95\u{a0}% interval shaded: its highest place";
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: format!(
            "Dots: simulated, whiskers: their 95\u{a0}% intervals, with an arrow and its end's number where one goes on \
             beyond the axis{}.",
            if has_curve { of_curve } else { "" }
        ),
        width: WIDTH,
        height: 40.0 + HEIGHT + 50.0,
        shapes,
    })
}

/// The axis (%): zero, the curves, every mean, and the intervals that are not far beyond the usual.
fn scale(panels: &[&OffsetPanel]) -> Scale {
    let points = panels.iter().flat_map(|panel| &panel.points);
    let whisker = |point: &OffsetPoint| {
        let half = point.change.half_width_95.unwrap_or(0.0);
        (100.0 * point.change.mean, 100.0 * half)
    };
    let whiskers: Vec<(f64, f64)> = points.map(whisker).collect();
    let halves = whiskers.iter().map(|whisker| whisker.1).filter(|half| *half > 0.0);
    let curves = panels.iter().flat_map(|panel| &panel.curve);
    let curves = curves.flat_map(|point| point.band_95).map(|share| 100.0 * share);
    Scale::around_whiskers(curves.chain([0.0]), &whiskers, whisker::reach(halves), 0.06)
}

fn curve(panel: &OffsetPanel, frame: &Frame) -> Vec<Shape> {
    let along = |value: fn(&CurvePoint) -> f64| -> Vec<[f64; 2]> {
        panel.curve.iter().map(|p| [p.offset.to_degrees(), 100.0 * value(p)]).collect()
    };
    if panel.curve.is_empty() {
        return Vec::new();
    }
    let mut band = frame.points(&along(|point| point.band_95[0]));
    band.extend(frame.points(&along(|point| point.band_95[1])).into_iter().rev());
    let look = Look::fill(CURVE).opacity(0.16);
    vec![
        Shape::Path { points: band, closed: true, look },
        named("curve", vec![frame.line(&along(|point| point.mean), Look::line(CURVE, 2.0))]),
    ]
}

/// Offset of `best` with its interval, such as "105° (62 to 148°)".
fn with_interval(best: &CurveEnd) -> String {
    let [low, high] = best.offset_95.map(|end| number(end.to_degrees(), 0));
    format!("{} ({low} to {high}{DEGREE})", degrees(best.offset))
}

/// Where `best` lies with 95 %, over the height of `frame`: in two parts where that passes a whole turn.
fn interval(best: &CurveEnd, frame: &Frame) -> Vec<Shape> {
    let [low, high] = best.offset_95.map(f64::to_degrees);
    let parts = [-360.0, 0.0, 360.0].map(|turn| [(low + turn).max(0.0), (high + turn).min(360.0)]);
    let strip = |[low, high]: [f64; 2]| {
        let (bottom, top) = (frame.y.low, frame.y.high);
        let corners = [[low, bottom], [high, bottom], [high, top], [low, top]];
        let look = Look::fill(Ink::Axis).opacity(0.12);
        Shape::Path { points: frame.points(&corners), closed: true, look }
    };
    parts.into_iter().filter(|[low, high]| low < high).map(strip).collect()
}

/// A dot with its whiskers; an offset of zero stands at both ends.
fn mark(point: &OffsetPoint, frame: &Frame) -> Shape {
    let style = Style { ink: POINT, width: 1.4, cap: 4.0, radius: 4.0, numbered: true };
    let half = point.change.half_width_95.map(|half| 100.0 * half);
    let offset = point.offset.to_degrees();
    let places = if offset == 0.0 { vec![0.0, 360.0] } else { vec![offset] };
    let mut shapes = Vec::new();
    for place in places {
        let [x, _] = frame.point([place, 0.0]);
        shapes.extend(whisker(frame, Axis::Y, x, 100.0 * point.change.mean, half, style));
    }
    let words = format!("{}: {}", degrees(point.offset), words::gain(&point.change));
    Shape::Group { role: Role::Mark(words), clip: None, shapes }
}
