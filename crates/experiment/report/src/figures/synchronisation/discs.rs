//! What is seen over the rotor's disc, looking downwind: points with speeds, paths, and what stands out.

use super::marks::{case_line, named, names};
use crate::draw::axes::{FieldValues, Frame, MEDIUM, Readout, SMALL, Scale, legend};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Role, Shape, TextStyle, segment, text};
use crate::figures::WIDTH;
use crate::figures::sheet::colour_bar;
use std::f64::consts::{PI, TAU};

/// What is seen over a rotor's disc, a panel beside the other.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// Rotor radius (m).
    pub radius: f64,
    /// Whether it shows no more of the disc than paths and the hub.
    pub is_close: bool,
    /// The panels, on one scale.
    pub panels: Vec<DiscPanel>,
}

/// One look at the disc. Places are to the left, looking downwind, and up from the rotor's centre (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiscPanel {
    /// Title.
    pub title: String,
    /// Where something is measured; colours tell the speeds, where there are some.
    pub points: Vec<DiscPoint>,
    /// Paths of what moves.
    pub paths: Vec<DiscPath>,
    /// Place that is marked (m).
    pub mark: Option<[f64; 2]>,
}

/// One point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscPoint {
    /// Its place (m).
    pub place: [f64; 2],
    /// Speed there (m/s): none where none is shown, not a number where it is missing.
    pub speed: Option<f64>,
}

/// One path.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscPath {
    /// Name in the legend.
    pub name: String,
    /// Its colour: 0 is that of the run which others compare with.
    pub colour: usize,
    /// Its places (m).
    pub points: Vec<[f64; 2]>,
}

const LEFT: f64 = 62.0;
const RIGHT: f64 = 84.0;
/// Sides of a panel at most.
const MOST: f64 = 400.0;
/// Room between panels, for titles and axes.
const GAP: f64 = 46.0;
/// What is shown of a panel beyond the rotor's rim and all points (–).
const MARGIN: f64 = 1.03;
/// Least that a close look shows on each side of the hub, over the rotor's radius (–).
const CLOSEST: f64 = 0.15;
/// Pieces of a circle (–).
const N_ARCS: usize = 96;
/// Distance within which a point alone decides the colour, over that between points (–).
const SOFT: f64 = 0.3;

/// The panels in rows, with a bar of the speeds where any are shown.
pub(super) fn discs(figure: &DiscFigure) -> Option<Figure> {
    let range = range(figure);
    let n_columns = if figure.panels.len() > 2 { 4 } else { 2 };
    let gap = if n_columns > 2 { 18.0 } else { 66.0 };
    let room = WIDTH - LEFT - RIGHT - gap * (n_columns - 1) as f64;
    let side = (room / n_columns as f64).min(MOST);
    let reach = reach(figure)?;
    // Looking downwind, y grows to the left.
    let (x, y) = (Scale::linear(reach, -reach), Scale::linear(-reach, reach));
    let mut shapes = Vec::new();
    let lines = figure.panels.iter().flat_map(|panel| &panel.paths);
    let in_legend = names(lines.map(|path| (path.colour, path.name.as_str())));
    let mut top = 26.0;
    if !in_legend.is_empty() {
        top += 12.0 + legend([LEFT, 22.0], WIDTH - 100.0, |_| Role::Plain, &in_legend, &mut shapes);
    }
    let n_rows = figure.panels.len().div_ceil(n_columns);
    for (index, panel) in figure.panels.iter().enumerate() {
        let (row, column) = (index / n_columns, index % n_columns);
        let at = [LEFT + (side + gap) * column as f64, top + (side + GAP) * row as f64];
        let frame = Frame { area: [at[0], at[1], side, side], x, y };
        let setting = TextStyle::plain(Ink::Text, MEDIUM).bold();
        shapes.push(text([at[0], at[1] - 9.0], panel.title.as_str(), setting));
        shapes.push(drawn(figure, panel, range, &frame));
        let is_last = index + n_columns >= figure.panels.len();
        frame.columns(if n_columns > 2 { 3 } else { 6 }, is_last, &mut shapes);
        if column == 0 {
            frame.heights(4, &mut shapes);
            frame.y_label("z from the hub (m)", 46.0, &mut shapes);
        }
        if is_last {
            frame.x_label("y from the hub, to the left (m)", &mut shapes);
        }
    }
    let base = top + (side + GAP) * (n_rows - 1) as f64 + side;
    if let Some(range) = range {
        let bar = [WIDTH - RIGHT + 22.0, top + 8.0, 14.0, (base - top - 8.0).min(300.0)];
        colour_bar(bar, range, Map::Sequential, 5, "m/s", &mut shapes);
    }
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: figure.caption.clone(),
        width: WIDTH,
        height: base + 50.0,
        shapes,
    })
}

/// How far the panels reach from the hub (m); none where there is nothing to draw.
fn reach(figure: &DiscFigure) -> Option<f64> {
    let discs = figure.panels.iter().map(|panel| filled(panel)[0]);
    let paths = figure.panels.iter().flat_map(|panel| &panel.paths);
    let places = paths.flat_map(|path| &path.points).map(|[left, up]| left.abs().max(up.abs()));
    let furthest = discs.chain(places).filter(|length| length.is_finite()).reduce(f64::max);
    let least = if figure.is_close { CLOSEST * figure.radius } else { figure.radius };
    furthest.map(|furthest| MARGIN * furthest.max(least))
}

/// Radius of the disc that the points of `panel` fill, half of their distance beyond the outermost, and that
/// distance (m).
fn filled(panel: &DiscPanel) -> [f64; 2] {
    let places = panel.points.iter().map(|point| point.place).filter(|p| p[0].is_finite());
    let (furthest, n) =
        places.fold((0.0_f64, 0.0), |(most, n), [y, z]| (most.max(y.hypot(z)), n + 1.0));
    let spacing = furthest * (PI / f64::max(n, 1.0)).sqrt();
    [furthest + 0.5 * spacing, spacing]
}

/// Ends of the colours: halves of a metre per second around all speeds but the outermost hundredths.
fn range(figure: &DiscFigure) -> Option<[f64; 2]> {
    let points = figure.panels.iter().flat_map(|panel| &panel.points);
    let mut speeds: Vec<f64> =
        points.filter_map(|point| point.speed).filter(|speed| speed.is_finite()).collect();
    speeds.sort_by(f64::total_cmp);
    let last = speeds.len().checked_sub(1)?;
    let at = |share: f64| 2.0 * speeds[(share * last as f64).round() as usize];
    let low = 0.5 * at(0.01).floor();
    Some([low, (0.5 * at(0.99).ceil()).max(low + 0.5)])
}

/// One panel: field, points, paths, mark.
fn drawn(figure: &DiscFigure, panel: &DiscPanel, range: Option<[f64; 2]>, frame: &Frame) -> Shape {
    let mut inner = Vec::new();
    let seen: Vec<([f64; 2], f64)> = panel
        .points
        .iter()
        .filter_map(|point| Some((point.place, point.speed.filter(|speed| speed.is_finite())?)))
        .collect();
    let field = range.filter(|_| !seen.is_empty());
    if let Some(range) = field {
        inner.extend(coloured(panel, &seen, range, frame));
    }
    let circle = frame.points(&circle(figure.radius, 1.0));
    let look = Look::line(Ink::Axis, 1.2).dashed(Some([5.0, 3.0]));
    inner.push(Shape::Path { points: circle, closed: true, look });
    for point in &panel.points {
        inner.extend(dot(frame.point(point.place), point.speed, field.is_some()));
    }
    for path in &panel.paths {
        let line = frame.line(&path.points, case_line(path.colour, 1.4));
        inner.push(named(&path.name, vec![line]));
    }
    if panel.points.is_empty() {
        cross(frame.point([0.0; 2]), 5.0, Look::line(Ink::Axis, 1.2), &mut inner);
        let [x, y] = frame.point([0.0; 2]);
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(1.0);
        inner.push(text([x - 6.0, y + 14.0], "hub", setting));
    }
    if let Some(place) = panel.mark {
        let center = frame.point(place);
        for look in [Look::line(Ink::FieldHalo, 5.0).opacity(0.8), Look::line(Ink::OnField, 2.0)] {
            inner.push(Shape::Circle { center, radius: 8.0, look });
            cross(center, 4.0, look, &mut inner);
        }
    }
    let values = field.map(|range| FieldValues {
        name: panel.title.clone(),
        run: 0,
        range,
        unit: "m/s".to_owned(),
    });
    Readout { field: values, both: true, ..frame.readout(["m", "m"]) }.group(0.0, inner)
}

/// The speeds at the points `seen` spread over the disc that they fill; paper beyond it.
///
/// Shepard's weights, 1 over the fourth power of the distance: at a point the colour is its own, and none is
/// outside of theirs.
fn coloured(
    panel: &DiscPanel,
    seen: &[([f64; 2], f64)],
    range: [f64; 2],
    frame: &Frame,
) -> [Shape; 2] {
    let [radius, spacing] = filled(panel);
    let soft = (SOFT * spacing).powi(2).max(1e-9);
    let size = [frame.area[2].round() as usize, frame.area[3].round() as usize];
    let picture = Picture::new(size, Map::Sequential, range, |column, row| {
        let share = [(column as f64 + 0.5) / size[0] as f64, (row as f64 + 0.5) / size[1] as f64];
        let y = frame.x.low + share[0] * (frame.x.high - frame.x.low);
        let z = frame.y.high + share[1] * (frame.y.low - frame.y.high);
        let (mut sum, mut total) = (0.0, 0.0);
        for (place, speed) in seen {
            let weight = ((y - place[0]).powi(2) + (z - place[1]).powi(2) + soft).powi(-2);
            sum += weight * speed;
            total += weight;
        }
        sum / total
    });
    // The frame's outline one way round and the disc's the other: what lies between is paper.
    let (wide, high) = ([1.02 * frame.x.low, 1.02 * frame.x.high], 1.02 * frame.y.high);
    let mut outline: Vec<[f64; 2]> =
        [[wide[0], 0.0], [wide[0], high], [wide[1], high], [wide[1], -high], [wide[0], -high]]
            .into();
    outline.push([wide[0], 0.0]);
    outline.extend(circle(radius, -1.0));
    let look = Look::fill(Ink::Paper);
    let paper = Shape::Path { points: frame.points(&outline), closed: true, look };
    [Shape::Field { area: frame.area, picture }, paper]
}

/// A circle of `radius` (m) about the hub that begins and ends at the left: over the top where `way` is 1.
fn circle(radius: f64, way: f64) -> Vec<[f64; 2]> {
    let angle = |step: usize| way * TAU * step as f64 / N_ARCS as f64;
    (0..=N_ARCS).map(|step| [radius * angle(step).cos(), radius * angle(step).sin()]).collect()
}

/// A point at `center`: a dot, open on a sheet without speeds, a cross where its speed is missing.
fn dot(center: [f64; 2], speed: Option<f64>, is_on_field: bool) -> Vec<Shape> {
    if center.iter().any(|length| !length.is_finite()) {
        return Vec::new();
    }
    let mut shapes = Vec::new();
    match speed {
        None => {
            let look = Look::fill(Ink::Run(2));
            shapes.push(Shape::Circle { center, radius: 3.2, look });
        }
        Some(speed) if speed.is_finite() => {
            let look = Look::fill(if is_on_field { Ink::OnField } else { Ink::Axis });
            shapes.push(Shape::Circle { center, radius: 1.1, look: look.opacity(0.55) });
        }
        Some(_) => {
            cross(center, 2.6, Look::line(Ink::FieldHalo, 3.0), &mut shapes);
            cross(center, 2.6, Look::line(Ink::OnField, 1.3), &mut shapes);
        }
    }
    shapes
}

/// A cross of four arms of `size`.
fn cross([x, y]: [f64; 2], size: f64, look: Look, shapes: &mut Vec<Shape>) {
    shapes.push(segment([x - size, y - size], [x + size, y + size], look));
    shapes.push(segment([x - size, y + size], [x + size, y - size], look));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(speed: impl Fn(usize) -> f64) -> DiscFigure {
        let point = |index: usize| DiscPoint {
            place: [20.0 * (index as f64 - 2.0), 10.0],
            speed: Some(speed(index)),
        };
        let panel = DiscPanel { points: (0..5).map(point).collect(), ..DiscPanel::default() };
        let (name, title, caption) = ("scan".into(), "Scan".into(), String::new());
        DiscFigure { name, title, caption, radius: 63.0, is_close: false, panels: vec![panel] }
    }

    /// The darkest and the lightest pixel of the field in `shapes`.
    fn ends(shapes: &[Shape]) -> Option<[u8; 2]> {
        shapes.iter().find_map(|shape| match shape {
            Shape::Group { role: Role::Panel(_), shapes, .. } => ends(shapes),
            Shape::Field { picture, .. } => {
                Some([*picture.indices.iter().min()?, *picture.indices.iter().max()?])
            }
            _ => None,
        })
    }

    #[test]
    fn colours_stay_within_the_speeds_and_a_lost_point_has_none() {
        // 6 to 8 m/s over a bar of just that.
        let whole = discs(&figure(|index| 6.0 + 0.5 * index as f64)).expect("a figure");
        let [low, high] = ends(&whole.shapes).expect("a field");
        assert!(low < 10 && high > 245, "{low} {high}");
        let without = discs(&figure(|index| if index == 4 { f64::NAN } else { 7.0 }));
        let [low, high] = ends(&without.expect("a figure").shapes).expect("a field");
        // A lost point that were zero would be the darkest of all.
        assert_eq!(low, high);
        assert!(ends(&discs(&figure(|_| f64::NAN)).expect("points alone").shapes).is_none());
    }

    #[test]
    fn what_is_to_the_left_stands_at_the_left() {
        let x = Scale::linear(70.0, -70.0);
        let frame = Frame { area: [0.0, 0.0, 100.0, 100.0], x, y: Scale::linear(-70.0, 70.0) };
        assert!(frame.point([60.0, 0.0])[0] < frame.point([-60.0, 0.0])[0]);
        assert!(discs(&DiscFigure { panels: Vec::new(), ..figure(|_| 1.0) }).is_none());
    }
}
