//! Surfaces on which a field has one value.

use basis::records::Grid;
use std::collections::BTreeMap;

/// The six tetrahedra of a cell about its diagonal; bit 0 of a corner is a step along x, bit 1 along y, bit 2
/// along z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// A surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Isosurface {
    /// Corners (m).
    pub points: Vec<[f64; 3]>,
    /// Corners of each triangle by their numbers; counter-clockwise as seen from where the field is less.
    pub triangles: Vec<[u32; 3]>,
    /// Of each corner the two points of the grid between which it lies, and how far from the first (–).
    between: Vec<([usize; 2], f64)>,
}

impl Isosurface {
    /// Another field of the same grid at the corners, straight between its points.
    pub fn values(&self, field: &[f64]) -> Vec<f64> {
        let value =
            |([a, b], share): &([usize; 2], f64)| field[*a] + share * (field[*b] - field[*a]);
        self.between.iter().map(value).collect()
    }
}

/// The surface on which `field` on `grid`, which must fill a volume, is `level`; without the cells that have
/// a corner without a number.
///
/// Marching tetrahedra: closed wherever the field is whole, straight between neighbouring points.
/// Source: Doi and Koide (1991), IEICE Transactions E74, 214.
pub fn isosurface(grid: &Grid, field: &[f64], level: f64) -> Isosurface {
    let mut surface = Isosurface::default();
    let mut known: BTreeMap<[usize; 2], u32> = BTreeMap::new();
    let cells = grid.n_points.map(|n| n.saturating_sub(1));
    for z in 0..cells[2] {
        for y in 0..cells[1] {
            for x in 0..cells[0] {
                let corner = |corner: usize| {
                    grid.index([x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)])
                };
                let corners: [usize; 8] = std::array::from_fn(corner);
                if corners.iter().all(|index| field[*index].is_finite()) {
                    for tetrahedron in TETRAHEDRA {
                        let of = tetrahedron.map(|corner| corners[corner]);
                        cut(grid, field, level, of, &mut surface, &mut known);
                    }
                }
            }
        }
    }
    surface
}

/// Adds what of the surface lies within the tetrahedron of the points `corners`.
fn cut(
    grid: &Grid,
    field: &[f64],
    level: f64,
    corners: [usize; 4],
    surface: &mut Isosurface,
    known: &mut BTreeMap<[usize; 2], u32>,
) {
    let (within, without): (Vec<usize>, Vec<usize>) =
        corners.into_iter().partition(|index| field[*index] >= level);
    // Triangles by the edges of the tetrahedron on which their corners lie.
    let triangles = match (&within[..], &without[..]) {
        ([a], [b, c, d]) | ([b, c, d], [a]) => vec![[[*a, *b], [*a, *c], [*a, *d]]],
        ([a, b], [c, d]) => {
            let ring = [[*a, *c], [*a, *d], [*b, *d], [*b, *c]];
            vec![[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
        }
        _ => return,
    };
    let position = |index: usize| grid.position(grid.place(index));
    let middle = |of: &[usize]| -> [f64; 3] {
        let sum = |axis: usize| of.iter().map(|index| position(*index)[axis]).sum::<f64>();
        std::array::from_fn(|axis| sum(axis) / of.len() as f64)
    };
    let out = less(middle(&without), middle(&within));
    let mut point = |[a, b]: [usize; 2]| {
        let ends = [a.min(b), a.max(b)];
        *known.entry(ends).or_insert_with(|| {
            let share = (level - field[ends[0]]) / (field[ends[1]] - field[ends[0]]);
            let [from, to] = ends.map(position);
            let place = |axis: usize| from[axis] + share * (to[axis] - from[axis]);
            surface.points.push(std::array::from_fn(place));
            surface.between.push((ends, share));
            (surface.points.len() - 1) as u32
        })
    };
    for edges in triangles {
        // Which way it faces, as its corners were in the middles of the edges: there it has an area.
        let [p, q, r] = edges.map(|edge| middle(&edge));
        let normal = cross(less(q, p), less(r, p));
        let faces: f64 = normal.iter().zip(out).map(|(n, out)| n * out).sum();
        let [a, b, c] = edges.map(&mut point);
        surface.triangles.push(if faces > 0.0 { [a, b, c] } else { [a, c, b] });
    }
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn ball(spacing: f64) -> (Grid, Vec<f64>) {
        let n = (2.6 / spacing) as usize + 1;
        let grid = Grid { origin: [-1.3, -1.2, -1.25], spacing: [spacing; 3], n_points: [n; 3] };
        let value = |index: usize| {
            let [x, y, z] = grid.position(grid.place(index));
            1.0 - (x * x + y * y + z * z).sqrt()
        };
        (grid, (0..grid.len()).map(value).collect())
    }

    /// Volume by the divergence theorem, area, and how often edges belong to other than two triangles.
    fn measured(surface: &Isosurface) -> (f64, f64, usize) {
        let (mut volume, mut area) = (0.0, 0.0);
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for corners in &surface.triangles {
            let [p, q, r] = corners.map(|corner| surface.points[corner as usize]);
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            volume += dot(p, cross(q, r)) / 6.0;
            let normal = cross(less(q, p), less(r, p));
            area += 0.5 * dot(normal, normal).sqrt();
            for [a, b] in [[0, 1], [1, 2], [2, 0]] {
                let (a, b) = (corners[a], corners[b]);
                // Neighbours pass an edge in opposite ways.
                *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
        (volume, area, edges.values().filter(|sum| **sum != 0).count())
    }

    #[test]
    fn the_surface_of_a_ball_is_closed_and_has_its_volume_and_area() {
        let (grid, field) = ball(0.05);
        let surface = isosurface(&grid, &field, 0.0);
        let (volume, area, n_open) = measured(&surface);
        assert_eq!(n_open, 0);
        assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 0.005, "{volume}");
        assert!((area / (4.0 * PI) - 1.0).abs() < 0.005, "{area}");
        for value in surface.values(&field) {
            assert!(value.abs() < 1e-12);
        }
        let x: Vec<f64> = (0..grid.len()).map(|i| grid.position(grid.place(i))[0]).collect();
        for (value, point) in surface.values(&x).iter().zip(&surface.points) {
            assert!((value - point[0]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_opens_the_surface_and_nothing_is_made_up() {
        let (grid, mut field) = ball(0.1);
        let whole = isosurface(&grid, &field, 0.0);
        let near = (0..grid.len()).min_by(|a, b| field[*a].abs().total_cmp(&field[*b].abs()));
        field[near.unwrap()] = f64::NAN;
        let holed = isosurface(&grid, &field, 0.0);
        assert!(holed.triangles.len() < whole.triangles.len() && measured(&holed).2 > 0);
        assert!(holed.points.iter().flatten().all(|x| x.is_finite()));
        assert_eq!(isosurface(&grid, &field, 5.0), Isosurface::default());
        let plane = Grid { n_points: [grid.n_points[0], grid.n_points[1], 1], ..grid };
        assert_eq!(isosurface(&plane, &field, 0.0), Isosurface::default());
    }
}
