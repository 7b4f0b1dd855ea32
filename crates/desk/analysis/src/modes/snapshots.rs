//! Where instants come from, and what share of the area a point stands for.

use super::ModesError;
use basis::records::Grid;
use std::ops::Range;

/// Velocity on a grid at many instants, read in strips.
pub trait Snapshots {
    /// What can go wrong.
    type Error: From<ModesError>;

    /// The points.
    fn grid(&self) -> &Grid;

    /// The instants (s), ascending.
    fn times(&self) -> &[f64];

    /// Velocity u, v, w (m/s; not a number where there is a hole) at all instants, one after the other, at
    /// the points that lie `steps` steps along the [`slowest_axis`] from the first, in the order of the grid.
    ///
    /// # Errors
    /// Of whatever holds them.
    fn read(&mut self, steps: Range<usize>) -> Result<[Vec<f32>; 3], Self::Error>;
}

/// Instants in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldSnapshots {
    /// The points.
    pub grid: Grid,
    /// The instants (s), ascending.
    pub times: Vec<f64>,
    /// Velocity u, v, w (m/s) at each instant, one after the other, in the order of the grid.
    pub velocity: [Vec<f32>; 3],
}

impl Snapshots for HeldSnapshots {
    type Error = ModesError;

    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn times(&self) -> &[f64] {
        &self.times
    }

    fn read(&mut self, steps: Range<usize>) -> Result<[Vec<f32>; 3], ModesError> {
        let (n_points, row) = (self.grid.len(), row_points(&self.grid));
        let of = |values: &Vec<f32>| {
            let instants = values.chunks_exact(n_points);
            instants.flat_map(|one| &one[steps.start * row..steps.end * row]).copied().collect()
        };
        Ok(self.velocity.each_ref().map(of))
    }
}

/// The last of x, y, z along which `grid` has more than one point; x where it has one point.
pub(super) fn slowest_axis(grid: &Grid) -> usize {
    (0..3).rev().find(|axis| grid.n_points[*axis] > 1).unwrap_or(0)
}

/// Points of `grid` for each step along the slowest axis (–).
pub(super) fn row_points(grid: &Grid) -> usize {
    grid.len() / grid.n_points[slowest_axis(grid)].max(1)
}

/// Area or volume that the point number `index` of `grid` stands for (m, m² or m³): half of it at an edge, by
/// the trapezoidal rule.
pub fn area_share(grid: &Grid, index: usize) -> f64 {
    let place = grid.place(index);
    let along = |axis: usize| match grid.n_points[axis] {
        0 | 1 => 1.0,
        n if place[axis] == 0 || place[axis] + 1 == n => 0.5 * grid.spacing[axis],
        _ => grid.spacing[axis],
    };
    (0..3).map(along).product()
}
