//! Velocity on planes, run by run, with the rotors drawn in.

use super::WIDTH;
use crate::RunRecords;
use crate::draw::axes::{Frame, LARGE, MEDIUM, SMALL, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Setting, Shape, rectangle, segment, text};
use crate::sentence;
use crate::study::{Study, is_whole, plane, sample};
use crate::words::{SPACE, number};
use basis::records::{Plane, PlaneAxes};

const LEFT: f64 = 58.0;
const RIGHT: f64 = 84.0;
/// Above so many runs the slices stand in two columns.
const MOST_STACKED: usize = 3;

/// A window onto a plane: lowest and highest first and second coordinate (m).
type Window = [f64; 4];

/// One field to draw.
struct Panel<'a> {
    /// Colour of the run, when the title belongs to one.
    colour: Option<usize>,
    title: String,
    plane: &'a Plane,
    /// What is taken off first.
    minus: Option<&'a Plane>,
}

/// Everything that the panels of a figure share.
struct Sheet<'a> {
    study: &'a Study<'a>,
    window: Window,
    map: Map,
    range: [f64; 2],
    n_columns: usize,
    labels: [&'static str; 2],
    bar: &'static str,
}

/// Mean velocity at hub height in each run.
pub(crate) fn mean(study: &Study) -> Option<Figure> {
    let panels = per_run(study, |run| plane(&run.mean_planes, "hub-height"), |_| String::new());
    let caption =
        "Mean streamwise velocity at hub height, seen from above; black lines are rotors.";
    along(study, "mean-hub-height", "Mean wake at hub height", caption, &panels)
}

/// Velocity at hub height at the last stored instant of each run.
pub(crate) fn instants(study: &Study) -> Option<Figure> {
    let panels = per_run(
        study,
        |run| {
            let planes = run.instant_planes.iter();
            planes
                .filter(|plane| plane.name == "hub-height" && is_whole(plane))
                .max_by(|a, b| a.time.total_cmp(&b.time))
        },
        |plane| format!(", at {}{SPACE}s", number(plane.time, 0)),
    );
    let caption = "Streamwise velocity at hub height at one instant; the inflow is the same in every \
                   run.";
    along(study, "instant-hub-height", "Wake at one instant", caption, &panels)
}

/// Mean velocity on the vertical plane through the rotors.
pub(crate) fn streamwise(study: &Study) -> Option<Figure> {
    let panels = per_run(study, |run| plane(&run.mean_planes, "streamwise"), |_| String::new());
    let caption = "Mean streamwise velocity on the vertical plane through the rotors.";
    along(study, "mean-streamwise", "Mean wake from the side", caption, &panels)
}

/// What each run changes in the mean velocity of the run that it compares with.
pub(crate) fn difference(study: &Study) -> Option<Figure> {
    let mut panels = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let Some(name) = run.summary.compare_with.as_deref() else { continue };
        let reference = study.runs().iter().find(|other| other.summary.run == name)?;
        let planes =
            (plane(&run.mean_planes, "hub-height"), plane(&reference.mean_planes, "hub-height"));
        let (Some(plane), Some(minus)) = planes else { continue };
        if plane.n_points == minus.n_points && name != run.summary.run {
            let title = format!("{} minus {name}", run.summary.run);
            panels.push(Panel { colour: Some(colour), title, plane, minus: Some(minus) });
        }
    }
    let window = window(study, panels.first()?.plane);
    let limit = values(study, &panels, window).map(f64::abs).fold(0.0, f64::max);
    let limit = (20.0 * 0.9 * limit).ceil().max(1.0) / 20.0;
    let sheet = Sheet {
        study,
        window,
        map: Map::Diverging,
        range: [-limit, limit],
        n_columns: if panels.len() > MOST_STACKED { 2 } else { 1 },
        labels: ["x/D", "y/D"],
        bar: "Δu/U∞",
    };
    let caption = "Change of the mean velocity at hub height: red is faster air than in the compared \
                   run, blue slower.";
    Some(sheet.draw("difference-hub-height", "What the excitation changes", caption, &panels))
}

/// Mean velocity on the planes across the wind: a row for each run, a column for each distance.
pub(crate) fn crosswind(study: &Study) -> Option<Figure> {
    const MOST_COLUMNS: usize = 6;
    let across = |run: &'_ RunRecords| -> Vec<usize> {
        let mut found: Vec<usize> = (0..run.mean_planes.len())
            .filter(|&index| {
                let plane = &run.mean_planes[index];
                plane.axes == PlaneAxes::Crosswind && is_whole(plane)
            })
            .collect();
        found.sort_by(|&a, &b| {
            run.mean_planes[a].origin[0].total_cmp(&run.mean_planes[b].origin[0])
        });
        found.truncate(MOST_COLUMNS);
        found
    };
    let n_columns = study.runs().iter().map(|run| across(run).len()).max().unwrap_or(0);
    let mut panels = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let found = across(run);
        if found.len() < n_columns || n_columns == 0 {
            continue;
        }
        for index in found {
            let plane = &run.mean_planes[index];
            let distance = number(plane.origin[0] / study.diameter(), 1);
            let distance = distance.strip_suffix(".0").unwrap_or(&distance);
            let title = format!("{}, {distance}{SPACE}D", run.summary.run);
            panels.push(Panel { colour: Some(colour), title, plane, minus: None });
        }
    }
    let (diameter, hub) = (study.diameter(), study.hub_height().unwrap_or(study.diameter()));
    let extent = extent(panels.first()?.plane);
    let center = study.layout.first().map_or(0.0, |position| position[1] * diameter);
    let window = [
        extent[0].max(center - 1.3 * diameter),
        extent[1].min(center + 1.3 * diameter),
        extent[2].max(0.0),
        extent[3].min(hub + 1.2 * diameter),
    ];
    if window[0] >= window[1] || window[2] >= window[3] {
        return None;
    }
    let range = range(values(study, &panels, window));
    let sheet = Sheet {
        study,
        window,
        map: Map::Sequential,
        range,
        n_columns,
        labels: ["y/D", "z/D"],
        bar: "u/U∞",
    };
    let caption = "Mean streamwise velocity across the wake, looking downwind; the circle is the first \
                   turbine's rotor.";
    Some(sheet.draw("mean-crosswind", "Across the wake", caption, &panels))
}

/// One panel for each run that has the plane.
fn per_run<'a>(
    study: &'a Study<'a>,
    find: impl Fn(&'a RunRecords) -> Option<&'a Plane>,
    remark: impl Fn(&Plane) -> String,
) -> Vec<Panel<'a>> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .filter_map(|(run, &colour)| {
            let plane = find(run)?;
            let title = format!("{}{}", run.summary.run, remark(plane));
            Some(Panel { colour: Some(colour), title, plane, minus: None })
        })
        .collect()
}

/// A figure of planes that run along the wind.
fn along(
    study: &Study,
    name: &str,
    title: &str,
    caption: &str,
    panels: &[Panel],
) -> Option<Figure> {
    let first = panels.first()?.plane;
    let window = window(study, first);
    let sheet = Sheet {
        study,
        window,
        map: Map::Sequential,
        range: range(values(study, panels, window)),
        n_columns: if panels.len() > MOST_STACKED { 2 } else { 1 },
        labels: ["x/D", if first.axes == PlaneAxes::Horizontal { "y/D" } else { "z/D" }],
        bar: "u/U∞",
    };
    Some(sheet.draw(name, title, caption, panels))
}

impl Sheet<'_> {
    fn draw(&self, name: &str, title: &str, caption: &str, panels: &[Panel]) -> Figure {
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
            frame.columns(if n_columns > 2 { 4 } else { 12 }, is_last_row, &mut shapes);
            if column == 0 {
                rows(&frame, &mut shapes);
                frame.y_label(self.labels[1], 38.0, &mut shapes);
            }
            if is_last_row {
                frame.x_label(self.labels[0], &mut shapes);
            }
        }
        let base = 34.0 + step * (n_rows - 1) as f64 + height;
        self.colour_bar([WIDTH - RIGHT + 22.0, 34.0, 14.0, (base - 34.0).min(300.0)], &mut shapes);
        let conditions = sentence::conditions_line(self.study, None);
        let free_stream = number(self.study.free_stream(), 1);
        Figure {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: format!("{caption} U∞ = {free_stream}{SPACE}m/s. {conditions}."),
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
        let mut title_left = left;
        if let Some(colour) = panel.colour {
            let look = Look::fill(Ink::Run(colour));
            let center = [left + 5.0, top - 13.5];
            shapes.push(Shape::Circle { center, radius: 4.5, look });
            title_left += 16.0;
        }
        let size = if self.n_columns > 2 { MEDIUM } else { LARGE };
        let setting = Setting::plain(Ink::Text, size).bold();
        shapes.push(text([title_left, top - 9.0], panel.title.as_str(), setting));
        let clip = Some(frame.area);
        let shapes_on_field = self.rotors(panel.plane, frame);
        shapes.push(Shape::Group { role: crate::draw::Role::Plain, clip, shapes: shapes_on_field });
    }

    /// Rotors as lines from above or from the side, as a circle from upwind.
    fn rotors(&self, plane: &Plane, frame: &Frame) -> Vec<Shape> {
        let hub = self.study.hub_height().unwrap_or(plane.origin[2]) / self.study.diameter();
        let halo = Look::line(Ink::FieldHalo, 5.0).opacity(0.75);
        let core = Look::line(Ink::OnField, 2.4);
        let mut shapes = Vec::new();
        if plane.axes == PlaneAxes::Crosswind {
            let y = self.study.layout.first().map_or(0.0, |position| position[1]);
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
        for [x, y] in &self.study.layout {
            let middle = if plane.axes == PlaneAxes::Horizontal { *y } else { hub };
            let ends = [frame.point([*x, middle - 0.5]), frame.point([*x, middle + 0.5])];
            shapes.extend([halo, core].map(|look| segment(ends[0], ends[1], look)));
        }
        shapes
    }

    fn colour_bar(&self, area: [f64; 4], shapes: &mut Vec<Shape>) {
        let [low, high] = self.range;
        let frame = Frame { area, x: Scale::linear(0.0, 1.0), y: Scale::linear(low, high) };
        let picture = Picture::new([1, 256], self.map, [255.0, 0.0], |_, row| row as f64);
        shapes.push(Shape::Field { area, picture });
        shapes.push(rectangle(area, Look::line(Ink::Axis, 0.8)));
        let (ticks, decimals) = frame.y.ticks(6);
        let right = area[0] + area[2];
        for tick in ticks {
            let [_, y] = frame.point([1.0, tick]);
            shapes.push(segment([right, y], [right + 4.0, y], Look::line(Ink::Axis, 1.0)));
            let setting = Setting::plain(Ink::Muted, SMALL);
            shapes.push(text([right + 7.0, y + 4.0], number(tick, decimals), setting));
        }
        let setting = Setting::plain(Ink::Muted, MEDIUM);
        shapes.push(text([area[0] - 4.0, area[1] - 10.0], self.bar, setting));
    }
}

/// Tick labels left of a field, without grid lines across it.
fn rows(frame: &Frame, shapes: &mut Vec<Shape>) {
    let [left, ..] = frame.area;
    let (ticks, decimals) = frame.y.ticks(4);
    for tick in ticks {
        let [_, y] = frame.point([frame.x.low, tick]);
        shapes.push(segment([left - 4.0, y], [left, y], Look::line(Ink::Axis, 1.0)));
        let setting = Setting::plain(Ink::Muted, SMALL).anchored(1.0);
        shapes.push(text([left - 7.0, y + 4.0], number(tick, decimals), setting));
    }
}

/// Lowest and highest coordinates of a plane's own axes (m).
fn extent(plane: &Plane) -> Window {
    let [first, second] = match plane.axes {
        PlaneAxes::Horizontal => [plane.origin[0], plane.origin[1]],
        PlaneAxes::Streamwise => [plane.origin[0], plane.origin[2]],
        PlaneAxes::Crosswind => [plane.origin[1], plane.origin[2]],
    };
    let length = |axis: usize| plane.spacing[axis] * (plane.n_points[axis] - 1) as f64;
    [first, first + length(0), second, second + length(1)]
}

/// What to show of a plane along the wind: all of its length, two diameters beside the row.
fn window(study: &Study, plane: &Plane) -> Window {
    let [left, right, low, high] = extent(plane);
    let diameter = study.diameter();
    let (lowest, highest) = if plane.axes == PlaneAxes::Horizontal {
        let sides = study.layout.iter().map(|position| position[1]);
        let (least, most) = sides.fold((0.0_f64, 0.0_f64), |(a, b), y| (a.min(y), b.max(y)));
        ((least - 1.75) * diameter, (most + 1.75) * diameter)
    } else {
        (0.0, study.hub_height().unwrap_or(diameter) + 1.5 * diameter)
    };
    let (low_shown, high_shown) = (low.max(lowest), high.min(highest));
    if low_shown < high_shown {
        [left, right, low_shown, high_shown]
    } else {
        [left, right, low, high]
    }
}

fn value(panel: &Panel, first: f64, second: f64) -> Option<f64> {
    let value = sample(panel.plane, first, second)?;
    let minus = match panel.minus {
        Some(plane) => sample(plane, first, second)?,
        None => 0.0,
    };
    Some(value - minus)
}

/// Values of all panels (relative to the free stream) on a coarse net over the window.
fn values<'a>(
    study: &'a Study,
    panels: &'a [Panel],
    [low, high, bottom, top]: Window,
) -> impl Iterator<Item = f64> + 'a {
    const N: usize = 60;
    panels.iter().flat_map(move |panel| {
        (0..N * N).filter_map(move |index| {
            let share = [index % N, index / N].map(|i| (i as f64 + 0.5) / N as f64);
            let point = [low + share[0] * (high - low), bottom + share[1] * (top - bottom)];
            Some(value(panel, point[0], point[1])? / study.free_stream())
        })
    })
}

/// Round ends of a colour bar that leave out the outermost values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
        sorted.get(index).copied()
    };
    match (at(0.003), at(0.997)) {
        (Some(low), Some(high)) => {
            let low = (10.0 * low).floor() / 10.0;
            [low, ((10.0 * high).ceil() / 10.0).max(low + 0.1)]
        }
        _ => [0.0, 1.0],
    }
}
