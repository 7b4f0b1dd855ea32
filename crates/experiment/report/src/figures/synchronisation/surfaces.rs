//! Surfaces in space, seen along parallel rays, lit from the side.

use crate::draw::axes::SMALL;
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Shape, TextStyle, segment, text};
use crate::figures::WIDTH;
use crate::words::number;

const MARGIN: f64 = 40.0;
const GAP: f64 = 58.0;
/// Panels in a row at most, and height of one.
const MOST: usize = 2;
const HEIGHT: f64 = 260.0;
/// How far the view is turned about the vertical, and tipped down (rad).
const TURN: f64 = 0.42;
const TIP: f64 = 0.32;
/// Pixels for each unit of the sheet.
const FINE: f64 = 2.0;
/// Shares of the palette: of what is lit least, of what is lit most, and of the ground.
const SHADES: [f64; 3] = [0.12, 0.78, 1.0];

/// Surfaces in space, a panel beside the other, all in one box.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// Names of x, y and z with their units.
    pub along: [String; 3],
    /// The box: least and greatest x, y, z.
    pub bounds: [[f64; 2]; 3],
    /// The panels.
    pub panels: Vec<SurfacePanel>,
}

/// One surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfacePanel {
    /// Title.
    pub title: String,
    /// Corners (units of the axes).
    pub points: Vec<[f64; 3]>,
    /// Corners of each triangle by their numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// How space is put on the sheet.
struct View {
    /// Directions to the right, up and away.
    axes: [[f64; 3]; 3],
    scale: f64,
    /// Place of the axes' origin on the sheet.
    origin: [f64; 2],
}

impl View {
    /// The box `bounds` as large as it goes into `area`.
    fn new(bounds: &[[f64; 2]; 3], [left, top, width, height]: [f64; 4]) -> Self {
        let ((turn, ahead), (tip, level)) = (TURN.sin_cos(), TIP.sin_cos());
        let axes = [
            [ahead, turn, 0.0],
            [-turn * tip, ahead * tip, level],
            [-turn * level, ahead * level, -tip],
        ];
        let flat = corners(bounds).map(|corner| [dot(axes[0], corner), dot(axes[1], corner)]);
        let ends = [0, 1].map(|axis| {
            flat.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
                [low.min(place[axis]), high.max(place[axis])]
            })
        });
        let [across, up] = ends.map(|[low, high]| high - low);
        let scale = (width / across).min(height / up);
        let middle = ends.map(|[low, high]| 0.5 * (low + high));
        let origin =
            [left + 0.5 * width - scale * middle[0], top + 0.5 * height + scale * middle[1]];
        Self { axes, scale, origin }
    }

    /// Place on the sheet, and distance from the eye.
    fn of(&self, point: [f64; 3]) -> [f64; 3] {
        let [right, up, away] = self.axes.map(|axis| dot(axis, point));
        [self.origin[0] + self.scale * right, self.origin[1] - self.scale * up, away]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn corners(bounds: &[[f64; 2]; 3]) -> [[f64; 3]; 8] {
    std::array::from_fn(|corner| std::array::from_fn(|axis| bounds[axis][corner >> axis & 1]))
}

/// The panels in rows; none without one, or without a box.
pub(super) fn surfaces(figure: &SurfaceFigure) -> Option<Figure> {
    if figure.panels.is_empty() || !figure.bounds.iter().all(|[low, high]| low < high) {
        return None;
    }
    let n_columns = figure.panels.len().min(MOST);
    let width = (WIDTH - 2.0 * MARGIN - GAP * (n_columns - 1) as f64) / n_columns as f64;
    let mut shapes = Vec::new();
    for (index, panel) in figure.panels.iter().enumerate() {
        let (row, column) = (index / n_columns, index % n_columns);
        let left = MARGIN + (width + GAP) * column as f64;
        let top = 34.0 + (HEIGHT + GAP) * row as f64;
        let area = [left, top, width, HEIGHT];
        let view = View::new(&figure.bounds, area);
        shapes.push(Shape::Field { area, picture: lit(panel, &view, area) });
        edges(figure, &view, &mut shapes);
        let setting = TextStyle::plain(Ink::Text, SMALL).bold();
        shapes.push(text([left, top - 10.0], panel.title.clone(), setting));
    }
    let n_rows = figure.panels.len().div_ceil(n_columns);
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: figure.caption.clone(),
        width: WIDTH,
        height: 34.0 + (HEIGHT + GAP) * n_rows as f64,
        shapes,
    })
}

/// Edges of the box, with the ends of the axes along three of them.
fn edges(figure: &SurfaceFigure, view: &View, shapes: &mut Vec<Shape>) {
    let corners = corners(&figure.bounds);
    for from in 0..8_usize {
        for axis in (0..3).filter(|axis| from >> axis & 1 == 0) {
            let [a, b] = [corners[from], corners[from | 1 << axis]].map(|corner| view.of(corner));
            let look = Look::line(Ink::OnField, 0.8).opacity(0.35);
            shapes.push(segment([a[0], a[1]], [b[0], b[1]], look));
        }
    }
    // x along the near lower edge, y along the right one, z along the left one.
    for (axis, from, shift) in
        [(0, 0_usize, [0.0, 14.0]), (1, 1, [14.0, 12.0]), (2, 0, [-6.0, 4.0])]
    {
        let ends = [from, from | 1 << axis].map(|corner| view.of(corners[corner]));
        let anchor = [0.5, 0.0, 1.0][axis];
        let mut tell = |place: [f64; 2], what: String| {
            let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(anchor);
            shapes.push(text([place[0] + shift[0], place[1] + shift[1]], what, setting));
        };
        for (end, value) in ends.iter().zip(figure.bounds[axis]) {
            tell([end[0], end[1]], number(value, 2));
        }
        let middle = [0, 1].map(|place| 0.5 * (ends[0][place] + ends[1][place]));
        tell(middle, figure.along[axis].clone());
    }
}

/// The surface of `panel` as it is lit, the nearest part in front.
fn lit(panel: &SurfacePanel, view: &View, [left, top, width, height]: [f64; 4]) -> Picture {
    let size = [(FINE * width).round() as usize, (FINE * height).round() as usize];
    let mut nearest = vec![f64::INFINITY; size[0] * size[1]];
    let mut shades = vec![SHADES[2]; size[0] * size[1]];
    for triangle in &panel.triangles {
        let [p, q, r] = triangle.map(|corner| {
            let [x, y, away] = view.of(panel.points[corner as usize]);
            [FINE * (x - left), FINE * (y - top), away]
        });
        let twice = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
        if twice == 0.0 || !twice.is_finite() {
            continue;
        }
        let shade = shade(triangle.map(|corner| panel.points[corner as usize]), view);
        let range = |axis: usize| {
            let (a, b, c) = (p[axis], q[axis], r[axis]);
            let last = size[axis] as f64 - 1.0;
            let low = a.min(b).min(c).floor().clamp(0.0, last) as usize;
            low..=(a.max(b).max(c).ceil().clamp(0.0, last) as usize)
        };
        for row in range(1) {
            for column in range(0) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let b = ((x - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (y - p[1])) / twice;
                let c = ((q[0] - p[0]) * (y - p[1]) - (x - p[0]) * (q[1] - p[1])) / twice;
                let away = p[2] + b * (q[2] - p[2]) + c * (r[2] - p[2]);
                let place = row * size[0] + column;
                if b >= 0.0 && c >= 0.0 && b + c <= 1.0 && away < nearest[place] {
                    (nearest[place], shades[place]) = (away, shade);
                }
            }
        }
    }
    Picture::new(size, Map::Sequential, [0.0, 1.0], |column, row| shades[row * size[0] + column])
}

/// Share of the palette of a triangle, lit from the eye's upper left; both of its sides alike.
fn shade([p, q, r]: [[f64; 3]; 3], view: &View) -> f64 {
    let less = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| a[i] - b[i]) };
    let (u, v) = (less(q, p), less(r, p));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let [right, up, away] = view.axes.map(|axis| dot(axis, normal));
    let length = right.hypot(up).hypot(away);
    let light = [-0.4, 0.6, -0.7_f64];
    let size = light[0].hypot(light[1]).hypot(light[2]);
    // What faces away is the inner side, seen through an opening.
    let way = if away > 0.0 { -1.0 } else { 1.0 };
    let falls = way * (right * light[0] + up * light[1] + away * light[2]) / (length * size);
    SHADES[0] + (SHADES[1] - SHADES[0]) * (0.25 + 0.75 * falls.max(0.0)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sheets across the view: the nearer one hides the other, and both are lit.
    #[test]
    fn what_is_nearer_hides_what_is_behind() {
        let sheet = |y: f64, size: f64| {
            [[-size, y, -size], [size, y, -size], [size, y, size], [-size, y, size]]
        };
        let bounds = [[-1.0, 1.0]; 3];
        let area = [0.0, 0.0, 200.0, 200.0];
        let view = View::new(&bounds, area);
        let panel = |points: Vec<[f64; 3]>| {
            let triangles = (0..points.len() as u32 / 4)
                .flat_map(|n| [[4 * n, 4 * n + 1, 4 * n + 2], [4 * n, 4 * n + 2, 4 * n + 3]])
                .collect();
            SurfacePanel { title: String::new(), points, triangles }
        };
        let count =
            |picture: &Picture| picture.indices.iter().filter(|index| **index < 255).count();
        let near = lit(&panel(sheet(-0.9, 0.5).to_vec()), &view, area);
        // The small sheet straight behind the larger one along the view.
        let behind: Vec<[f64; 3]> = sheet(-0.9, 0.3)
            .into_iter()
            .map(|p| std::array::from_fn(|i| p[i] + 1.2 * view.axes[2][i]))
            .collect();
        let alone = lit(&panel(behind.clone()), &view, area);
        let both = lit(&panel([sheet(-0.9, 0.5).to_vec(), behind].concat()), &view, area);
        assert!(count(&alone) > 0 && count(&near) > count(&alone));
        assert_eq!(near, both);
    }

    #[test]
    fn a_figure_has_a_panel_for_each_surface_and_none_without() {
        let panel = SurfacePanel {
            title: "one".to_owned(),
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 1, 2]],
        };
        let figure = SurfaceFigure {
            name: "surface".to_owned(),
            title: String::new(),
            caption: String::new(),
            along: ["x", "y", "z"].map(str::to_owned),
            bounds: [[0.0, 4.0], [-0.5, 0.5], [-0.5, 0.5]],
            panels: vec![panel; 3],
        };
        let drawn = surfaces(&figure).unwrap();
        let n_fields = drawn.shapes.iter().filter(|shape| matches!(shape, Shape::Field { .. }));
        assert_eq!(n_fields.count(), 3);
        assert!(surfaces(&SurfaceFigure { panels: Vec::new(), ..figure.clone() }).is_none());
        assert!(surfaces(&SurfaceFigure { bounds: [[0.0, 0.0]; 3], ..figure }).is_none());
    }
}
