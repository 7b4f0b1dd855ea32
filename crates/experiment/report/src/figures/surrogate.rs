//! A surrogate: predicted over true values, cuts along each input with bands, and a map over two inputs.

use super::WIDTH;
use super::sheet::colour_bar;
use crate::draw::axes::{FieldValues, Frame, Readout, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Shape, segment};

/// What is drawn of a surrogate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurrogateFigures {
    /// Output with its unit.
    pub output: String,
    /// True and predicted value of each point (unit of the output); may be empty.
    pub pairs: Vec<[f64; 2]>,
    /// How well they agree, in words; may be empty.
    pub fit: String,
    /// A cut along each input.
    pub cuts: Vec<SurrogateCut>,
    /// The mean over two inputs, and the half width of its 95 % band; may be absent.
    pub maps: Option<[SurrogateMap; 2]>,
    /// What stays the same in cuts and map, in words.
    pub held: String,
}

/// The curve along one input.
#[derive(Clone, Debug, PartialEq)]
pub struct SurrogateCut {
    /// Input with its unit.
    pub label: String,
    /// Places, ascending (unit of the input).
    pub places: Vec<f64>,
    /// Mean at each (unit of the output).
    pub means: Vec<f64>,
    /// Half width of the 95 % band of the curve (unit of the output).
    pub half_widths: Vec<f64>,
}

/// A value over two inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct SurrogateMap {
    /// What it is, with its unit.
    pub title: String,
    /// Both inputs with their units.
    pub labels: [String; 2],
    /// Ends of both inputs (units of the inputs).
    pub ends: [[f64; 2]; 2],
    /// Numbers of places along both inputs (–).
    pub n: [usize; 2],
    /// Values, those along the first input together (unit of the output).
    pub values: Vec<f64>,
}

const HEIGHT: f64 = 230.0;
const LEFT: f64 = 74.0;
const GAP: f64 = 74.0;
const RIGHT: f64 = 24.0;
/// Points of the scatter that are drawn at most (–).
const MOST_POINTS: usize = 3000;
/// Lines of equal value in a map (–).
const N_LINES: usize = 8;

/// All figures of a surrogate.
pub(crate) fn surrogate(figures: &SurrogateFigures) -> Vec<Figure> {
    let all = [scatter(figures), cuts(figures), maps(figures)];
    all.into_iter().flatten().collect()
}

fn figure(name: &str, title: &str, caption: String, height: f64, shapes: Vec<Shape>) -> Figure {
    let (name, title) = (name.to_owned(), title.to_owned());
    Figure { name, title, caption, width: WIDTH, height, shapes }
}

fn scatter(of: &SurrogateFigures) -> Option<Figure> {
    if of.pairs.is_empty() {
        return None;
    }
    let side = 420.0;
    let scale = Scale::around(of.pairs.iter().flatten().copied(), 0.05);
    let area = [0.5 * (WIDTH - side), 24.0, side, side];
    let frame = Frame { area, x: scale, y: scale };
    let mut shapes = Vec::new();
    frame.rows(6, true, &mut shapes);
    frame.columns(6, true, &mut shapes);
    frame.x_label(&format!("true {}", of.output), &mut shapes);
    frame.y_label(&format!("predicted {}", of.output), 58.0, &mut shapes);
    let ends = [scale.low, scale.high].map(|value| frame.point([value, value]));
    let mut inner = vec![segment(ends[0], ends[1], Look::line(Ink::Axis, 1.0))];
    let stride = of.pairs.len().div_ceil(MOST_POINTS);
    let look = Look::fill(Ink::Run(1)).opacity(0.5);
    for center in frame.points(&of.pairs).into_iter().step_by(stride) {
        inner.push(Shape::Circle { center, radius: 2.2, look });
    }
    shapes.push(frame.panel(inner, ["", ""]));
    let fit = if of.fit.is_empty() { String::new() } else { format!(" {}.", of.fit) };
    let caption =
        format!("Predicted over true values; a point on the line is predicted exactly.{fit}");
    Some(figure("surrogate-scatter", "Predicted and true", caption, side + 76.0, shapes))
}

fn cuts(of: &SurrogateFigures) -> Option<Figure> {
    let n_rows = of.cuts.len().div_ceil(2);
    let edges = of.cuts.iter().flat_map(|cut| {
        let both = cut.means.iter().zip(&cut.half_widths);
        both.flat_map(|(mean, half)| [mean - half, mean + half])
    });
    if n_rows == 0 {
        return None;
    }
    let scale = Scale::around(edges, 0.06);
    let width = (WIDTH - LEFT - RIGHT - GAP) / 2.0;
    let mut shapes = Vec::new();
    for (index, cut) in of.cuts.iter().enumerate() {
        let (row, column) = (index / 2, index % 2);
        let left = LEFT + (width + GAP) * column as f64;
        let area = [left, 16.0 + (HEIGHT + 56.0) * row as f64, width, HEIGHT];
        let (first, last) = (cut.places.first()?, cut.places.last()?);
        let frame = Frame { area, x: Scale::linear(*first, *last), y: scale };
        frame.rows(5, true, &mut shapes);
        frame.columns(6, true, &mut shapes);
        frame.x_label(&cut.label, &mut shapes);
        if column == 0 {
            frame.y_label(&of.output, 56.0, &mut shapes);
        }
        let edge = |sign: f64| -> Vec<[f64; 2]> {
            let both = cut.means.iter().zip(&cut.half_widths);
            cut.places.iter().zip(both).map(|(x, (mean, half))| [*x, mean + sign * half]).collect()
        };
        let mut outline = edge(1.0);
        outline.extend(edge(-1.0).into_iter().rev());
        let look = Look::fill(Ink::Run(1)).opacity(0.2);
        let band = Shape::Path { points: frame.points(&outline), closed: true, look };
        let curve = frame.line(&edge(0.0), Look::line(Ink::Run(1), 1.8));
        shapes.push(frame.panel(vec![band, curve], ["", ""]));
    }
    let caption = format!("Mean and 95\u{a0}% band of the curve along each input; {}.", of.held);
    let height = 16.0 + (HEIGHT + 56.0) * n_rows as f64;
    Some(figure("surrogate-cuts", "Along each input", caption, height, shapes))
}

fn maps(of: &SurrogateFigures) -> Option<Figure> {
    let maps = of.maps.as_ref()?;
    let width = (WIDTH - LEFT - 2.0 * GAP - 50.0) / 2.0;
    let mut shapes = Vec::new();
    for (index, map) in maps.iter().enumerate() {
        let area = [LEFT + (width + GAP + 30.0) * index as f64, 40.0, width, 300.0];
        draw_map(map, index, area, &mut shapes);
    }
    let caption = format!(
        "Mean of the curve and half of its 95\u{a0}% band, with lines of equal value; {}.",
        of.held
    );
    Some(figure("surrogate-map", "Over two inputs", caption, 400.0, shapes))
}

fn draw_map(map: &SurrogateMap, index: usize, area: [f64; 4], shapes: &mut Vec<Shape>) {
    let [left, top, width, height] = area;
    let [[x_low, x_high], [y_low, y_high]] = map.ends;
    let (x, y) = (Scale::linear(x_low, x_high), Scale::linear(y_low, y_high));
    let frame = Frame { area, x, y };
    let scale = Scale::around(map.values.iter().copied(), 0.0);
    let range = [scale.low, scale.high];
    let size = [width.round() as usize, height.round() as usize];
    let picture = Picture::new(size, Map::Sequential, range, |column, row| {
        let share = [(column as f64 + 0.5) / width, 1.0 - (row as f64 + 0.5) / height];
        between(map, share)
    });
    let mut inner = vec![Shape::Field { area, picture }];
    for line in 1..=N_LINES {
        let level = range[0] + (range[1] - range[0]) * line as f64 / (N_LINES + 1) as f64;
        for [from, to] in level_pieces(map, level) {
            let look = Look::line(Ink::FieldHalo, 1.0).opacity(0.8);
            inner.push(segment(frame.point(from), frame.point(to), look));
        }
    }
    frame.title(&map.title, shapes);
    frame.heights(5, shapes);
    frame.columns(5, true, shapes);
    frame.x_label(&map.labels[0], shapes);
    if index == 0 {
        frame.y_label(&map.labels[1], 52.0, shapes);
    }
    let bar = [left + width + 12.0, top + 6.0, 12.0, height - 6.0];
    colour_bar(bar, range, Map::Sequential, 5, "", shapes);
    let field = FieldValues { name: map.title.clone(), run: 0, range, unit: String::new() };
    let readout = Readout { field: Some(field), ..frame.readout(["", ""]) };
    shapes.push(readout.group(0.0, inner));
}

/// The value at shares of the way along both inputs, linear between places.
fn between(map: &SurrogateMap, share: [f64; 2]) -> f64 {
    let cell = |axis: usize| {
        let place = share[axis].clamp(0.0, 1.0) * (map.n[axis] - 1) as f64;
        let first = (place.floor() as usize).min(map.n[axis].saturating_sub(2));
        (first, place - first as f64)
    };
    let ((i, s), (j, t)) = (cell(0), cell(1));
    let at = |i: usize, j: usize| map.values[j * map.n[0] + i];
    let along = |j: usize| at(i, j) + s * (at(i + 1, j) - at(i, j));
    along(j) + t * (along(j + 1) - along(j))
}

/// Straight pieces of the line on which the map has `level`: each cell of places is cut in two triangles,
/// in each of which the value is linear.
fn level_pieces(map: &SurrogateMap, level: f64) -> Vec<[[f64; 2]; 2]> {
    let [nx, ny] = map.n;
    let corner = |i: usize, j: usize| {
        let of = |axis: usize, index: usize| {
            let [low, high] = map.ends[axis];
            low + (high - low) * index as f64 / (map.n[axis] - 1) as f64
        };
        ([of(0, i), of(1, j)], map.values[j * nx + i] - level)
    };
    let mut pieces = Vec::new();
    for j in 0..ny - 1 {
        for i in 0..nx - 1 {
            let [a, b, c, d] =
                [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                let sides = [[0, 1], [1, 2], [2, 0]];
                let crossings: Vec<[f64; 2]> = sides
                    .into_iter()
                    .filter_map(|[from, to]| {
                        let ((p, u), (q, v)) = (triangle[from], triangle[to]);
                        let share = u / (u - v);
                        let on = |axis: usize| p[axis] + share * (q[axis] - p[axis]);
                        ((u < 0.0) != (v < 0.0)).then(|| [on(0), on(1)])
                    })
                    .collect();
                if let [from, to] = crossings[..] {
                    pieces.push([from, to]);
                }
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a plane the lines of equal value are straight, and the value between places is exact.
    #[test]
    fn a_plane_has_straight_lines() {
        let n = [5, 4];
        let law = |x: f64, y: f64| 2.0 * x - 3.0 * y;
        let place = |k: usize, n: usize| k as f64 / (n - 1) as f64;
        let values = (0..20).map(|k| law(place(k % 5, 5), place(k / 5, 4))).collect();
        let labels = ["x".to_owned(), "y".to_owned()];
        let ends = [[0.0, 1.0], [0.0, 1.0]];
        let map = SurrogateMap { title: String::new(), labels, ends, n, values };
        assert!((between(&map, [0.3, 0.77]) - law(0.3, 0.77)).abs() < 1e-12);
        let pieces = level_pieces(&map, -0.45);
        assert!(pieces.len() > 4);
        assert!(pieces.iter().flatten().all(|[x, y]| (law(*x, *y) + 0.45).abs() < 1e-12));
        let figures = SurrogateFigures { maps: Some([map.clone(), map]), ..Default::default() };
        assert_eq!(surrogate(&figures).len(), 1);
    }
}
