//! A sheet of velocity slices: panels on one scale with their rotors, and the bar of its colours.

use super::WIDTH;
use crate::RunRecords;
use crate::draw::axes::{Frame, LARGE, MEDIUM, SMALL, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Shape, TextStyle, rectangle, segment, text};
use crate::study::{Study, sample};
use crate::words::{SPACE, number};
use basis::records::{Plane, PlaneAxes};

const LEFT: f64 = 58.0;
const RIGHT: f64 = 84.0;
/// A window onto a plane: lowest and highest first and second coordinate (m).
pub(super) type Window = [f64; 4];

/// One field to draw.
pub(super) struct Panel<'a> {
    pub(super) run: &'a RunRecords,
    pub(super) colour: usize,
    pub(super) title: String,
    pub(super) plane: &'a Plane,
    /// What is taken off first.
    pub(super) minus: Option<&'a Plane>,
}

/// Everything that the panels of a figure share.
pub(super) struct Sheet<'a> {
    pub(super) study: &'a Study<'a>,
    pub(super) window: Window,
    pub(super) map: Map,
    pub(super) range: [f64; 2],
    pub(super) n_columns: usize,
    pub(super) labels: [&'static str; 2],
    pub(super) bar: &'static str,
}

impl Sheet<'_> {
    /// The figure with all `panels`.
    pub(super) fn draw(&self, name: &str, title: &str, caption: &str, panels: &[Panel]) -> Figure {
        const GAP: f64 = 46.0;
        let diameter = self.study.diameter();
        let [low, high, bottom, top] = self.window;
        let n_columns = self.n_columns.min(panels.len());
        let gap = if n_columns > 2 { 18.0 } else { GAP };
        let room = WIDTH - LEFT - RIGHT - gap * (n_columns - 1) as f64;
        let width = room / n_columns as f64;
        let height = (width * (top - bottom) / (high - low)).clamp(60.0, 460.0);
        let n_rows = panels.len().div_ceil(n_columns);
        let step = height + if n_columns > 2 { 42.0 } else { 44.0 };
        let mut shapes = Vec::new();
        for (index, panel) in panels.iter().enumerate() {
            let (row, column) = (index / n_columns, index % n_columns);
            let left = LEFT + (width + gap) * column as f64;
            let area = [left, 34.0 + step * row as f64, width, height];
            // Looking downwind, y grows to the left.
            let mirrored = panel.plane.axes == PlaneAxes::Crosswind;
            let (from, to) = if mirrored { (high, low) } else { (low, high) };
            let frame = Frame {
                area,
                x: Scale::linear(from / diameter, to / diameter),
                y: Scale::linear(bottom / diameter, top / diameter),
            };
            self.panel(panel, &frame, &mut shapes);
            let is_last_row = index + n_columns >= panels.len();
            frame.columns(if n_columns > 2 { 3 } else { 12 }, is_last_row, &mut shapes);
            if column == 0 {
                rows(&frame, &mut shapes);
                frame.y_label(self.labels[1], 38.0, &mut shapes);
            }
            if is_last_row {
                frame.x_label(self.labels[0], &mut shapes);
            }
        }
        let base = 34.0 + step * (n_rows - 1) as f64 + height;
        let bar = [WIDTH - RIGHT + 22.0, 34.0, 14.0, (base - 34.0).min(300.0)];
        colour_bar(bar, self.range, self.map, 6, self.bar, &mut shapes);
        let free_stream = number(self.study.free_stream(), 1);
        Figure {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: format!("{caption} U∞ = {free_stream}{SPACE}m/s, the target at hub height."),
            width: WIDTH,
            height: base + 48.0,
            shapes,
        }
    }

    fn panel(&self, panel: &Panel, frame: &Frame, shapes: &mut Vec<Shape>) {
        let [left, top, width, height] = frame.area;
        let diameter = self.study.diameter();
        let size = [width.round().max(2.0) as usize, height.round().max(2.0) as usize];
        let picture = Picture::new(size, self.map, self.range, |column, row| {
            let share =
                [(column as f64 + 0.5) / size[0] as f64, (row as f64 + 0.5) / size[1] as f64];
            let first = frame.x.low + share[0] * (frame.x.high - frame.x.low);
            let second = frame.y.high + share[1] * (frame.y.low - frame.y.high);
            let value = value(panel, first * diameter, second * diameter);
            value.map_or(f64::NAN, |value| value / self.study.free_stream())
        });
        shapes.push(Shape::Field { area: frame.area, picture });
        let look = Look::fill(Ink::Run(panel.colour));
        shapes.push(Shape::Circle { center: [left + 5.0, top - 13.5], radius: 4.5, look });
        let size = if self.n_columns > 2 { MEDIUM } else { LARGE };
        let setting = TextStyle::plain(Ink::Text, size).bold();
        shapes.push(text([left + 16.0, top - 9.0], panel.title.as_str(), setting));
        let clip = Some(frame.area);
        let shapes_on_field = self.rotors(panel, frame);
        shapes.push(Shape::Group { role: crate::draw::Role::Plain, clip, shapes: shapes_on_field });
    }

    /// Rotors as lines from above or from the side, as a circle from upwind.
    fn rotors(&self, panel: &Panel, frame: &Frame) -> Vec<Shape> {
        let plane = panel.plane;
        let hub = self.study.hub_height().unwrap_or(plane.origin[2]) / self.study.diameter();
        let halo = Look::line(Ink::FieldHalo, 5.0).opacity(0.75);
        let core = Look::line(Ink::OnField, 2.4);
        let mut shapes = Vec::new();
        if plane.axes == PlaneAxes::Crosswind {
            let y = self.study.side();
            let center = frame.point([y, hub]);
            let radius = 0.5 * (frame.point([y, hub])[1] - frame.point([y, hub + 1.0])[1]).abs();
            for look in [
                Look::line(Ink::FieldHalo, 3.0).opacity(0.6),
                Look { dash: Some([5.0, 4.0]), ..Look::line(Ink::OnField, 1.4) },
            ] {
                shapes.push(Shape::Circle { center, radius, look });
            }
            return shapes;
        }
        let turbines = &panel.run.summary.turbines;
        let is_there = |name: &str| turbines.iter().any(|turbine| turbine.name == name);
        for place in self.study.layout.iter().filter(|place| is_there(&place.name)) {
            let [x, y] = place.position;
            let middle = if plane.axes == PlaneAxes::Horizontal { y } else { hub };
            let ends = [frame.point([x, middle - 0.5]), frame.point([x, middle + 0.5])];
            shapes.extend([halo, core].map(|look| segment(ends[0], ends[1], look)));
        }
        shapes
    }
}

/// A bar of the colours of `map` over `range` in `area`, with about `n_ticks` ticks on its right and `title`
/// above.
pub(super) fn colour_bar(
    area: [f64; 4],
    [low, high]: [f64; 2],
    map: Map,
    n_ticks: usize,
    title: &str,
    shapes: &mut Vec<Shape>,
) {
    let frame = Frame { area, x: Scale::linear(0.0, 1.0), y: Scale::linear(low, high) };
    let picture = Picture::new([1, 256], map, [255.0, 0.0], |_, row| row as f64);
    shapes.push(Shape::Field { area, picture });
    shapes.push(rectangle(area, Look::line(Ink::Axis, 0.8)));
    let (ticks, decimals) = frame.y.ticks(n_ticks);
    let right = area[0] + area[2];
    for tick in ticks {
        let [_, y] = frame.point([1.0, tick]);
        shapes.push(segment([right, y], [right + 4.0, y], Look::line(Ink::Axis, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL);
        shapes.push(text([right + 7.0, y + 4.0], number(tick, decimals), setting));
    }
    shapes.push(text([area[0] - 4.0, area[1] - 10.0], title, TextStyle::plain(Ink::Muted, MEDIUM)));
}

/// Tick labels left of a field, without grid lines across it.
fn rows(frame: &Frame, shapes: &mut Vec<Shape>) {
    let [left, ..] = frame.area;
    let (ticks, decimals) = frame.y.ticks(4);
    for tick in ticks {
        let [_, y] = frame.point([frame.x.low, tick]);
        shapes.push(segment([left - 4.0, y], [left, y], Look::line(Ink::Axis, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(1.0);
        shapes.push(text([left - 7.0, y + 4.0], number(tick, decimals), setting));
    }
}

/// Lowest and highest coordinates of a plane's own axes (m).
pub(super) fn extent(plane: &Plane) -> Window {
    let [first, second] = match plane.axes {
        PlaneAxes::Horizontal => [plane.origin[0], plane.origin[1]],
        PlaneAxes::Streamwise => [plane.origin[0], plane.origin[2]],
        PlaneAxes::Crosswind => [plane.origin[1], plane.origin[2]],
    };
    let length = |axis: usize| plane.spacing[axis] * (plane.n_points[axis] - 1) as f64;
    [first, first + length(0), second, second + length(1)]
}

fn value(panel: &Panel, first: f64, second: f64) -> Option<f64> {
    let value = sample(panel.plane, first, second)?;
    let minus = match panel.minus {
        Some(plane) => sample(plane, first, second)?,
        None => 0.0,
    };
    Some(value - minus)
}

/// Values of a panel (relative to the free stream) on a coarse net over the window.
pub(super) fn values<'a>(
    study: &'a Study,
    panel: &'a Panel,
    [low, high, bottom, top]: Window,
) -> impl Iterator<Item = f64> + 'a {
    const N: usize = 60;
    (0..N * N).filter_map(move |index| {
        let share = [index % N, index / N].map(|i| (i as f64 + 0.5) / N as f64);
        let point = [low + share[0] * (high - low), bottom + share[1] * (top - bottom)];
        Some(value(panel, point[0], point[1])? / study.free_stream())
    })
}

/// Round ends of a colour bar that leave out the outermost values of each panel.
pub(super) fn range(study: &Study, panels: &[Panel], window: Window) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for panel in panels {
        let mut sorted: Vec<f64> =
            values(study, panel, window).filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
            sorted.get(index).copied()
        };
        low = low.min(at(0.003).unwrap_or(low));
        high = high.max(at(0.997).unwrap_or(high));
    }
    if low > high {
        return [0.0, 1.0];
    }
    let low = (10.0 * low).floor() / 10.0;
    [low, ((10.0 * high).ceil() / 10.0).max(low + 0.1)]
}
