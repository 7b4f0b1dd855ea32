//! Means with their intervals: a dot with whiskers, and an arrow with the number where one leaves its axes.

use super::axes::Frame;
use super::colour::Ink;
use super::{Axis, Look, Shape, TextStyle, polyline, segment, text};
use crate::words;

/// How a mean with its interval is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// Its colour.
    pub(crate) ink: Ink,
    /// Width of the whiskers.
    pub(crate) width: f64,
    /// Half length of the lines across their ends.
    pub(crate) cap: f64,
    /// Radius of the dot.
    pub(crate) radius: f64,
    /// Whether an arrow has the number of the end that it stands for.
    pub(crate) numbered: bool,
}

/// The mean `mean` with the interval `half` to both sides, along `axis` of `frame`; `across` is its place on
/// the sheet along the other axis. Nothing where the mean is not a number.
pub(crate) fn whisker(
    frame: &Frame,
    axis: Axis,
    across: f64,
    mean: f64,
    half: Option<f64>,
    style: Style,
) -> Vec<Shape> {
    let place = |value: f64| match axis {
        Axis::X => frame.point([value, frame.y.low])[0],
        Axis::Y => frame.point([frame.x.low, value])[1],
    };
    let point = |along: f64, across: f64| match axis {
        Axis::X => [along, across],
        Axis::Y => [across, along],
    };
    let [left, top, width, height] = frame.area;
    let (start, end) = if axis == Axis::X { (left, left + width) } else { (top, top + height) };
    if !mean.is_finite() {
        return Vec::new();
    }
    let look = Look::line(style.ink, style.width);
    let mut shapes = Vec::new();
    for value in half.iter().flat_map(|half| [mean - half, mean + half]) {
        let whole = place(value);
        let cut = whole.clamp(start, end);
        shapes.push(segment(point(place(mean), across), point(cut, across), look));
        if (whole - cut).abs() < 0.5 {
            if style.cap > 0.0 {
                let ends = [across - style.cap, across + style.cap].map(|at| point(cut, at));
                shapes.push(segment(ends[0], ends[1], look));
            }
            continue;
        }
        let back = if whole > cut { cut - 7.0 } else { cut + 7.0 };
        let corners =
            vec![point(back, across - 4.0), point(cut, across), point(back, across + 4.0)];
        shapes.push(polyline(corners, look));
        if style.numbered {
            shapes.push(number(value, axis, point(cut, across), whole > cut));
        }
    }
    let center = point(place(mean).clamp(start, end), across);
    shapes.push(Shape::Circle { center, radius: style.radius, look: Look::fill(style.ink) });
    shapes
}

/// The number of an end that lies outside, beside the tip of its arrow at (`x`, `y`), which points to larger
/// places on the sheet where it is `onwards`.
fn number(value: f64, axis: Axis, [x, y]: [f64; 2], onwards: bool) -> Shape {
    let content = words::number(value, words::three_figures(value).min(2));
    let setting = TextStyle::plain(Ink::Muted, 10.0);
    match axis {
        Axis::X if onwards => text([x, y - 6.0], content, setting.anchored(1.0)),
        Axis::X => text([x, y - 6.0], content, setting),
        Axis::Y if onwards => text([x - 6.0, y], content, setting.upwards()),
        Axis::Y => text([x - 6.0, y], content, setting.upwards().anchored(1.0)),
    }
}

/// Half lengths that are far beyond the usual: four times the middle one of `halves`.
pub(crate) fn reach(halves: impl IntoIterator<Item = f64>) -> f64 {
    let mut halves: Vec<f64> = halves.into_iter().filter(|half| half.is_finite()).collect();
    halves.sort_by(f64::total_cmp);
    halves.get(halves.len() / 2).map_or(f64::INFINITY, |middle| 4.0 * middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::axes::Scale;

    const STYLE: Style =
        Style { ink: Ink::Text, width: 1.0, cap: 3.0, radius: 4.0, numbered: true };

    fn texts(shapes: &[Shape]) -> Vec<&str> {
        let mut found = Vec::new();
        for shape in shapes {
            if let Shape::Text { content, .. } = shape {
                found.push(content.as_str());
            }
        }
        found
    }

    #[test]
    fn an_end_outside_has_an_arrow_with_its_number_and_one_inside_its_cap() {
        let frame = Frame {
            area: [0.0, 0.0, 100.0, 100.0],
            x: Scale::linear(0.0, 1.0),
            y: Scale::linear(0.0, 10.0),
        };
        let inside = whisker(&frame, Axis::Y, 50.0, 5.0, Some(2.0), STYLE);
        assert!(texts(&inside).is_empty());
        let outside = whisker(&frame, Axis::Y, 50.0, 5.0, Some(7.5), STYLE);
        assert_eq!(texts(&outside), ["−2.50", "12.5"]);
        let reached = outside.iter().filter_map(|shape| match shape {
            Shape::Path { points, .. } => Some(points.iter().map(|point| point[1])),
            _ => None,
        });
        assert!(reached.flatten().all(|y| (0.0..=100.0).contains(&y)));
        assert!(whisker(&frame, Axis::Y, 50.0, f64::NAN, Some(1.0), STYLE).is_empty());
    }

    #[test]
    fn the_axis_grows_for_intervals_of_usual_length() {
        let halves = [0.1, 0.2, 0.2, 30.0];
        let whiskers: Vec<(f64, f64)> = halves.iter().map(|half| (1.0, *half)).collect();
        let scale = Scale::around_whiskers([0.0], &whiskers, reach(halves), 0.0);
        assert!((scale.low - 0.0).abs() < 0.3 && (scale.high - 1.8).abs() < 0.3, "{scale:?}");
        assert_eq!(reach([]), f64::INFINITY);
    }
}
