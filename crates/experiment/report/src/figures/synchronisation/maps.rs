//! A quantity over two others: colours, contour lines, and where something was found.

use super::curves::cross;
use crate::draw::axes::{FieldValues, Frame, Readout, SMALL, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Role, Shape, TextStyle, polyline, segment, text};
use crate::figures::WIDTH;
use crate::figures::sheet::colour_bar;
use crate::words::number;
use std::collections::BTreeMap;

const LEFT: f64 = 66.0;
const RIGHT: f64 = 84.0;
const GAP: [f64; 2] = [46.0, 66.0];
const HEIGHT: f64 = 230.0;
/// Panels in a row at most.
const MOST: usize = 3;
/// Length over height from which panels that are to scale stand in rows of two (–), and such with points.
const WIDE: f64 = 3.0;
const WIDE_WITH_POINTS: f64 = 1.5;
/// Height of such a panel at most, and of the bar of colours at least.
const MOST_HEIGHT: f64 = 420.0;
const LEAST_BAR: f64 = 120.0;
/// Room of a number beside the bar of colours, and how many there are at most (–).
const TICK: f64 = 30.0;
const MOST_TICKS: usize = 6;
/// Contour lines, about.
const N_LEVELS: usize = 10;

/// A quantity over two others, a panel beside the other, all on one scale of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// What it is over, horizontally and vertically, with units.
    pub along: [String; 2],
    /// Unit of the quantity.
    pub unit: String,
    /// How values become colours.
    pub colours: MapColours,
    /// Whether a unit of length is as long along both axes.
    pub is_to_scale: bool,
    /// Whether lines of equal value are drawn, with their values: those of a noisy quantity would hide it.
    pub has_lines: bool,
    /// The panels.
    pub panels: Vec<MapPanel>,
}

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapColours {
    /// Zero is in the middle: below and above it differ.
    AboutZero,
    /// From the least value to the greatest.
    FromLeast,
}

/// One map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapPanel {
    /// Title.
    pub title: String,
    /// Ascending places along both axes (units of the axes), two or more.
    pub places: [Vec<f64>; 2],
    /// The quantity, row by row upwards (its unit).
    pub values: Vec<f64>,
    /// Places of samples (units of the axes).
    pub points: Vec<[f64; 2]>,
    /// A place that is marked with dashed lines (units of the axes).
    pub mark: Option<[f64; 2]>,
}

/// The panels in rows, with a bar of the colours.
pub(super) fn maps(figure: &MapFigure) -> Option<Figure> {
    let is_whole = |panel: &MapPanel| {
        let [columns, rows] = &panel.places;
        columns.len() > 1 && rows.len() > 1 && panel.values.len() == columns.len() * rows.len()
    };
    if figure.panels.is_empty() || !figure.panels.iter().all(is_whole) {
        return None;
    }
    let range = range(figure);
    let (mut levels, decimals) = Scale::linear(range[0], range[1]).ticks(2 * N_LEVELS);
    if !figure.has_lines {
        levels.clear();
    }
    let (n_columns, [width, panel_height]) = layout(figure);
    let mut shapes = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let (row, column) = (index / n_columns, index % n_columns);
        let [left, top] =
            [LEFT + (width + GAP[0]) * column as f64, 34.0 + (panel_height + GAP[1]) * row as f64];
        let [x, y] = panel.places.each_ref().map(|p| Scale::linear(p[0], p[p.len() - 1]));
        let frame = Frame { area: [left, top, width, panel_height], x, y };
        shapes.push(drawn(figure, panel, range, (&levels, decimals), &frame));
        frame.title(&panel.title, &mut shapes);
        frame.columns(5, true, &mut shapes);
        frame.x_label(&figure.along[0], &mut shapes);
        frame.heights(5, &mut shapes);
        if column == 0 {
            frame.y_label(&figure.along[1], 46.0, &mut shapes);
        }
    }
    let bar_height = panel_height.max(LEAST_BAR) - 8.0;
    let n_ticks = ((bar_height / TICK) as usize).min(MOST_TICKS);
    let bar = [WIDTH - RIGHT + 22.0, 42.0, 14.0, bar_height];
    colour_bar(bar, range, figure.colours.map(), n_ticks, &figure.unit, &mut shapes);
    let n_rows = figure.panels.len().div_ceil(n_columns);
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: figure.caption.clone(),
        width: WIDTH,
        height: 34.0 + (panel_height + GAP[1]) * n_rows as f64 - GAP[1] + 50.0,
        shapes,
    })
}

/// Colours, contour lines with their values, samples, and the mark.
fn drawn(
    figure: &MapFigure,
    panel: &MapPanel,
    range: [f64; 2],
    (levels, decimals): (&[f64], usize),
    frame: &Frame,
) -> Shape {
    let size = [frame.area[2].round() as usize, frame.area[3].round() as usize];
    let picture = Picture::new(size, figure.colours.map(), range, |column, row| {
        let share =
            [(column as f64 + 0.5) / size[0] as f64, 1.0 - (row as f64 + 0.5) / size[1] as f64];
        let at = |scale: Scale, share: f64| scale.low + share * (scale.high - scale.low);
        panel.at([at(frame.x, share[0]), at(frame.y, share[1])])
    });
    let mut inner = vec![Shape::Field { area: frame.area, picture }];
    let mut told: Vec<[f64; 2]> = Vec::new();
    for level in levels {
        for line in contours(panel, *level) {
            let middle = frame.point(line[line.len() / 2]);
            let is_long = line.len() > panel.places[0].len() / 3;
            let look = Look::line(Ink::OnField, 0.9).opacity(0.7);
            inner.push(polyline(frame.points(&line), look));
            let is_clear = told.iter().all(|other| {
                (other[0] - middle[0]).abs() > 36.0 || (other[1] - middle[1]).abs() > 16.0
            });
            if is_long && is_clear {
                told.push(middle);
                let setting = TextStyle::plain(Ink::OnField, SMALL).anchored(0.5).on_field();
                inner.push(text([middle[0], middle[1] + 4.0], number(*level, decimals), setting));
            }
        }
    }
    if let Some(mark) = panel.mark {
        let [x, y] = frame.point(mark);
        let [left, top, width, height] = frame.area;
        let look = Look::line(Ink::OnField, 1.2).dashed(Some([5.0, 3.0]));
        inner.push(segment([x, top], [x, top + height], look));
        inner.push(segment([left, y], [left + width, y], look));
    }
    for point in &panel.points {
        let mut mark = Vec::new();
        cross(frame.point(*point), Look::line(Ink::FieldHalo, 3.2), &mut mark);
        cross(frame.point(*point), Look::line(Ink::OnField, 1.4), &mut mark);
        let told = format!("{}, {}", number(point[0], 3), number(point[1], 3));
        inner.push(Shape::Group { role: Role::Mark(told), clip: None, shapes: mark });
    }
    let (name, unit) = (panel.title.clone(), figure.unit.clone());
    let field = Some(FieldValues { name, run: 0, range, unit });
    Readout { field, both: true, ..frame.readout(["", ""]) }.group(3.0, inner)
}

impl MapColours {
    fn map(self) -> Map {
        match self {
            Self::AboutZero => Map::Diverging,
            Self::FromLeast => Map::Sequential,
        }
    }
}

/// Values of the first and the last colour of `figure`.
fn range(figure: &MapFigure) -> [f64; 2] {
    let values = || figure.panels.iter().flat_map(|panel| panel.values.iter().copied());
    let most = values().map(f64::abs).fold(0.0, f64::max);
    let (low, high) = match figure.colours {
        MapColours::AboutZero => (-most, most),
        MapColours::FromLeast => {
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        }
    };
    if low < high { [low, high] } else { [low - 1.0, low + 1.0] }
}

/// Panels in a row, with their width and height.
fn layout(figure: &MapFigure) -> (usize, [f64; 2]) {
    let width = |n_columns: usize| {
        (WIDTH - LEFT - RIGHT - GAP[0] * (n_columns - 1) as f64) / n_columns as f64
    };
    let n = figure.panels.len();
    if !figure.is_to_scale {
        let n_columns = n.min(MOST);
        return (n_columns, [width(n_columns), HEIGHT]);
    }
    let length = |places: &Vec<f64>| places[places.len() - 1] - places[0];
    let [along, up] = figure.panels[0].places.each_ref().map(length);
    // Wide panels in rows of three would be too low to see anything, and marks would hide what is in them.
    let has_points = figure.panels.iter().any(|panel| !panel.points.is_empty());
    let most = if along > if has_points { WIDE_WITH_POINTS } else { WIDE } * up { 2 } else { MOST };
    let n_columns = n.min(most);
    let width = width(n_columns).min(MOST_HEIGHT * along / up);
    (n_columns, [width, width * up / along])
}

impl MapPanel {
    /// The value at a column and a row.
    fn of(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.places[0].len() + column]
    }

    /// The value at a place between those that are given: straight along both axes.
    fn at(&self, place: [f64; 2]) -> f64 {
        let within = |places: &[f64], value: f64| {
            let last = places.len() - 2;
            let low = places.partition_point(|other| *other <= value).saturating_sub(1).min(last);
            (low, ((value - places[low]) / (places[low + 1] - places[low])).clamp(0.0, 1.0))
        };
        let (column, x) = within(&self.places[0], place[0]);
        let (row, y) = within(&self.places[1], place[1]);
        let along = |row| (1.0 - x) * self.of(column, row) + x * self.of(column + 1, row);
        (1.0 - y) * along(row) + y * along(row + 1)
    }
}

/// An edge of the lattice: its lower left end, and whether it goes up.
type Edge = (usize, usize, bool);

/// Lines along which the value is `level`: marching squares, pieces joined at the edges that they share.
fn contours(panel: &MapPanel, level: f64) -> Vec<Vec<[f64; 2]>> {
    let [columns, rows] = &panel.places;
    let crossing = |(column, row, is_up): Edge| {
        let (a, b) = (
            panel.of(column, row),
            panel.of(column + usize::from(!is_up), row + usize::from(is_up)),
        );
        ((a < level) != (b < level)).then(|| {
            let share = (level - a) / (b - a);
            let along =
                |places: &[f64], at: usize| places[at] + share * (places[at + 1] - places[at]);
            if is_up {
                [columns[column], along(rows, row)]
            } else {
                [along(columns, column), rows[row]]
            }
        })
    };
    let mut neighbours: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    for row in 0..rows.len() - 1 {
        for column in 0..columns.len() - 1 {
            // Below, right, above, left.
            let edges = [
                (column, row, false),
                (column + 1, row, true),
                (column, row + 1, false),
                (column, row, true),
            ];
            let cut: Vec<Edge> =
                edges.into_iter().filter(|edge| crossing(*edge).is_some()).collect();
            for pair in cut.chunks_exact(2) {
                neighbours.entry(pair[0]).or_default().push(pair[1]);
                neighbours.entry(pair[1]).or_default().push(pair[0]);
            }
        }
    }
    let mut lines = Vec::new();
    // Open lines begin at their ends; what is left are rings.
    for most in [1, 2] {
        while let Some(start) =
            neighbours.iter().find(|(_, to)| to.len() == most).map(|(edge, _)| *edge)
        {
            let (mut line, mut edge) = (Vec::new(), start);
            line.extend(crossing(edge));
            while let Some(next) = neighbours.get_mut(&edge).and_then(Vec::pop) {
                if let Some(back) = neighbours.get_mut(&next) {
                    back.retain(|other| *other != edge);
                }
                edge = next;
                line.extend(crossing(edge));
            }
            neighbours.retain(|_, to| !to.is_empty());
            lines.push(line);
        }
    }
    lines.retain(|line| line.len() > 1);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x² + y² over −1 to 1 in both.
    fn bowl() -> MapPanel {
        let places: Vec<f64> = (0..=40).map(|i| -1.0 + 0.05 * f64::from(i)).collect();
        let values =
            places.iter().flat_map(|y| places.iter().map(move |x| x * x + y * y)).collect();
        MapPanel { places: [places.clone(), places], values, ..MapPanel::default() }
    }

    /// A straight line between lattice points h = 0.05 apart lies at most h²/8 times the second derivative
    /// 2 off, twice over: 1.25e-3 in the square of the radius.
    #[test]
    fn contours_of_a_bowl_are_one_ring_inside_and_four_arcs_at_the_corners() {
        let ring = contours(&bowl(), 0.5);
        assert_eq!(ring.len(), 1);
        assert_eq!(ring[0].first(), ring[0].last());
        for [x, y] in &ring[0] {
            assert!((x * x + y * y - 0.5).abs() < 1.3e-3, "{x} {y}");
        }
        let arcs = contours(&bowl(), 1.5);
        assert_eq!(arcs.len(), 4);
        assert!(contours(&bowl(), 3.0).is_empty());
    }

    /// 4 along and 2 up: three beside each other, or two with points, none of them stretched.
    #[test]
    fn maps_to_scale_are_not_stretched_and_leave_room_for_points() {
        let places = [vec![0.0, 4.0], vec![-1.0, 1.0]];
        let panel = MapPanel { places, values: vec![2.0, 3.0, 4.0, 5.0], ..MapPanel::default() };
        let figure = |points: Vec<[f64; 2]>| MapFigure {
            colours: MapColours::FromLeast,
            is_to_scale: true,
            has_lines: false,
            name: "map".into(),
            title: String::new(),
            caption: String::new(),
            along: ["x".into(), "y".into()],
            unit: "U".into(),
            panels: vec![MapPanel { points, ..panel.clone() }; 3],
        };
        assert_eq!(range(&figure(Vec::new())), [2.0, 5.0]);
        for (points, expected) in [(Vec::new(), 3), (vec![[1.0, 0.0]], 2)] {
            let (n_columns, [width, height]) = layout(&figure(points));
            assert_eq!(n_columns, expected);
            assert!((width / height - 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_map_reads_its_own_values_and_holds_no_broken_panel() {
        let panel = bowl();
        assert!((panel.at([0.5, -0.25]) - 0.3125).abs() < 1e-12);
        assert!((panel.at([2.0, 2.0]) - 2.0).abs() < 1e-12);
        let figure = |panel| MapFigure {
            colours: MapColours::AboutZero,
            is_to_scale: false,
            has_lines: true,
            name: "map".into(),
            title: String::new(),
            caption: String::new(),
            along: ["x".into(), "y".into()],
            unit: "%".into(),
            panels: vec![panel],
        };
        assert!(maps(&figure(MapPanel { mark: Some([0.0, 0.0]), ..panel })).is_some());
        assert!(maps(&figure(MapPanel::default())).is_none());
    }
}
