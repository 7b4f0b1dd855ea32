//! A sheet of velocity slices: panels on one scale with their rotors, and the bar of its colours.

use super::{WIDTH, rotors};
use crate::RunRecords;
use crate::draw::axes::{FieldValues, Frame, LARGE, MEDIUM, Readout, SMALL, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::font::{Face, wrapped};
use crate::draw::{Figure, Look, Role, Shape, TextStyle, rectangle, segment, text};
use crate::layout::Rotor;
use crate::sentence::direction;
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

/// Height of a line of a panel's title.
const TITLE: f64 = 16.0;

impl Sheet<'_> {
    /// The figure with all `panels`.
    pub(super) fn draw(&self, name: &str, title: &str, caption: &str, panels: &[Panel]) -> Figure {
        let diameter = self.study.diameter();
        let [low, high, bottom, top] = self.window;
        let n_columns = self.n_columns.min(panels.len());
        let gap = if n_columns > 2 { 18.0 } else { 46.0 };
        let width = (WIDTH - LEFT - RIGHT - gap * (n_columns - 1) as f64) / n_columns as f64;
        let true_height = width * (top - bottom) / (high - low);
        let height = true_height.clamp(84.0, 560.0);
        let titles: Vec<Vec<String>> =
            panels.iter().map(|panel| self.title(panel, width)).collect();
        let above = TITLE * titles.iter().map(Vec::len).max().unwrap_or(1) as f64;
        let n_rows = panels.len().div_ceil(n_columns);
        let (first, step) = (18.0 + above, height + above + 26.0);
        let mut shapes = Vec::new();
        for (index, (panel, title)) in panels.iter().zip(&titles).enumerate() {
            let (row, column) = (index / n_columns, index % n_columns);
            let left = LEFT + (width + gap) * column as f64;
            let area = [left, first + step * row as f64, width, height];
            // Looking downwind, y grows to the left.
            let mirrored = panel.plane.axes == PlaneAxes::Crosswind;
            let (from, to) = if mirrored { (high, low) } else { (low, high) };
            let frame = Frame {
                area,
                x: Scale::linear(from / diameter, to / diameter),
                y: Scale::linear(bottom / diameter, top / diameter),
            };
            self.headed(panel, title, &frame, &mut shapes);
            self.panel(panel, &frame, &mut shapes);
            let is_last_row = index + n_columns >= panels.len();
            frame.columns(if n_columns > 2 { 3 } else { 12 }, is_last_row, &mut shapes);
            if column == 0 {
                frame.heights(4, &mut shapes);
                frame.y_label(self.labels[1], 38.0, &mut shapes);
            }
            if is_last_row {
                frame.x_label(self.labels[0], &mut shapes);
            }
        }
        let base = first + step * (n_rows - 1) as f64 + height;
        let bar = [WIDTH - RIGHT + 22.0, first, 14.0, (base - first).min(300.0)];
        colour_bar(bar, self.range, self.map, 6, self.bar, &mut shapes);
        let free_stream = number(self.study.free_stream(), 1);
        let stretched = stretched(height / true_height);
        let from = direction(&self.study.runs()[0].summary.conditions)
            .map_or(String::new(), |degrees| format!(" The wind comes from {degrees}, along x."));
        Figure {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: format!(
                "{caption}{stretched} U∞ = {free_stream}{SPACE}m/s, the target at hub height.{from}"
            ),
            width: WIDTH,
            height: base + 48.0,
            shapes,
        }
    }

    /// Size of the letters of a panel's title.
    fn title_size(&self) -> f64 {
        if self.n_columns > 2 { MEDIUM } else { LARGE }
    }

    /// Lines of a panel's title.
    fn title(&self, panel: &Panel, width: f64) -> Vec<String> {
        let title = std::slice::from_ref(&panel.title);
        wrapped(title, "", &Face::new(true), self.title_size(), width - 16.0)
    }

    /// The title of a panel with the colour of its run, above `frame`.
    fn headed(&self, panel: &Panel, title: &[String], frame: &Frame, shapes: &mut Vec<Shape>) {
        let [left, top, ..] = frame.area;
        let start = top - 9.0 - TITLE * title.len().saturating_sub(1) as f64;
        let look = Look::fill(Ink::Run(panel.colour));
        shapes.push(Shape::Circle { center: [left + 5.0, start - 4.5], radius: 4.5, look });
        let setting = TextStyle::plain(Ink::Text, self.title_size()).bold();
        for (index, line) in title.iter().enumerate() {
            let base = start + TITLE * index as f64;
            shapes.push(text([left + 16.0, base], line.as_str(), setting));
        }
    }

    fn panel(&self, panel: &Panel, frame: &Frame, shapes: &mut Vec<Shape>) {
        let [_, _, width, height] = frame.area;
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
        let mut inner = vec![Shape::Field { area: frame.area, picture }];
        let there: Vec<Rotor> = self.study.rotors_of(panel.run).collect();
        inner.extend(rotors::on_plane(there.iter(), panel.plane, frame, diameter));
        let field = FieldValues {
            name: panel.title.clone(),
            run: panel.colour,
            range: self.range,
            unit: "U∞".to_owned(),
        };
        let readout = Readout { field: Some(field), ..frame.readout(["D", "D"]) };
        shapes.push(readout.group(0.0, inner));
    }
}

/// What a caption says of a field that is drawn `factor` times as high as it is.
pub(super) fn stretched(factor: f64) -> String {
    match factor {
        factor if factor > 1.05 => {
            format!(" Heights on the sheet are stretched {} times.", number(factor, 1))
        }
        factor if factor < 0.95 => {
            format!(" Heights on the sheet are shortened {} times.", number(1.0 / factor, 1))
        }
        _ => String::new(),
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
    let bar = vec![Shape::Field { area, picture }];
    shapes.push(Shape::Group { role: Role::Bar, clip: None, shapes: bar });
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
