//! Velocity on regular grids of points: instants, and averages by phase.

use super::{Plane, PlaneAxes};
use serde::{Deserialize, Serialize};

/// A regular grid of points, x fastest, then y, then z; an axis with one point is that of a plane or a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Position of its first point, farm frame (m).
    pub origin: [f64; 3],
    /// Distance of neighbouring points along x, y, z (m).
    pub spacing: [f64; 3],
    /// Points along x, y, z (–).
    pub n_points: [usize; 3],
}

impl Grid {
    /// The points of `plane`, in its order.
    pub fn of_plane(plane: &Plane) -> Self {
        let along = match plane.axes {
            PlaneAxes::Horizontal => [0, 1],
            PlaneAxes::Streamwise => [0, 2],
            PlaneAxes::Crosswind => [1, 2],
        };
        let (mut spacing, mut n_points) = ([1.0; 3], [1; 3]);
        for (place, axis) in along.into_iter().enumerate() {
            spacing[axis] = plane.spacing[place];
            n_points[axis] = plane.n_points[place];
        }
        Self { origin: plane.origin, spacing, n_points }
    }

    /// Points in all (–).
    pub fn len(&self) -> usize {
        self.n_points.iter().product()
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of the point at `place`, steps along x, y, z from the first.
    pub fn index(&self, place: [usize; 3]) -> usize {
        let [n_x, n_y, _] = self.n_points;
        place[0] + n_x * (place[1] + n_y * place[2])
    }

    /// Steps along x, y, z from the first point to the point number `index`.
    pub fn place(&self, index: usize) -> [usize; 3] {
        let [n_x, n_y, _] = self.n_points;
        [index % n_x, index / n_x % n_y, index / (n_x * n_y)]
    }

    /// Position of the point at `place`, farm frame (m).
    pub fn position(&self, place: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.coordinate(axis, place[axis]))
    }

    /// Coordinate along `axis` (0 to 2) of the points that are `step` steps from the first (m).
    pub fn coordinate(&self, axis: usize, step: usize) -> f64 {
        self.origin[axis] + step as f64 * self.spacing[axis]
    }

    /// The axes along which it has more than one point.
    pub fn spanned(&self) -> Vec<usize> {
        (0..3).filter(|axis| self.n_points[*axis] > 1).collect()
    }

    /// Distance from the first point along `axis` of `coordinate` (m), in steps; none beyond the grid.
    pub fn steps_to(&self, axis: usize, coordinate: f64) -> Option<f64> {
        let last = (self.n_points[axis].checked_sub(1)?) as f64;
        let steps = (coordinate - self.origin[axis]) / self.spacing[axis];
        // A point on the edge is on the grid, whatever rounding says.
        let slack = 1e-9 * last.max(1.0);
        (-slack <= steps && steps <= last + slack).then_some(steps.clamp(0.0, last))
    }
}

/// Velocity on a grid at one instant; what is not a number is a hole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Its points.
    pub grid: Grid,
    /// Instant (s).
    pub time: f64,
    /// Velocity components u, v, w (m/s), in the order of the grid.
    pub velocity: [Vec<f32>; 3],
}

/// Stresses among u, v, w, in the order of [`Moments::stress`]: the two components of each.
pub const STRESSES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Place of the stress of components `first` and `second` (0 to 2 each) among [`STRESSES`].
pub fn stress_of(first: usize, second: usize) -> usize {
    match (first.min(second), first.max(second)) {
        (a, b) if a == b => a,
        (0, 1) => 3,
        (0, _) => 4,
        _ => 5,
    }
}

/// Means and second moments of velocity on a grid; not a number where there is no sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// Samples at each point (–); holes are none.
    pub n_samples: Vec<u32>,
    /// Means of u, v, w (m/s).
    pub mean: [Vec<f32>; 3],
    /// Means of the products of deviations from the means (m²/s²), as [`STRESSES`] orders them.
    pub stress: [Vec<f32>; 6],
}

/// A bin of phase, and what fell into it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseBin {
    /// Rotor azimuth at its middle (rad).
    pub rotor: f64,
    /// Helix azimuth at its middle (rad); none where the helix plays no part.
    pub helix: Option<f64>,
    /// Instants in it (–).
    pub n_instants: u64,
    /// Times that it was entered (–): instants that follow one another in a bin are not independent.
    pub n_visits: u64,
}

/// Velocity averaged by phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseAverages {
    /// The points.
    pub grid: Grid,
    /// Width of a bin in rotor azimuth (rad).
    pub rotor_width: f64,
    /// Width of a bin in helix azimuth (rad); none where the helix plays no part. Windows may overlap.
    pub helix_width: Option<f64>,
    /// First and last instant (s).
    pub span: [f64; 2],
    /// The bins, in the order in which they follow one another in time.
    pub bins: Vec<PhaseBin>,
    /// All instants, whatever their phase.
    pub all: Moments,
    /// Mean pressure of all instants over density (m²/s²), but for a constant; none where it is not recorded.
    pub pressure: Option<Vec<f32>>,
    /// One for each bin.
    pub each: Vec<Moments>,
}

/// What fields were taken of, or measured on: that by which lengths and speeds are divided.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldSetting {
    /// What is said of the case and the run, such as `quickstart, helix`.
    pub name: String,
    /// Free-stream speed (m/s).
    pub wind_speed: f64,
    /// Turbulence intensity of the free stream (–); none where it is not known.
    pub turbulence_intensity: Option<f64>,
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Middle of the rotor, farm frame (m).
    pub hub: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_counted_x_fastest_and_come_back() {
        let grid = Grid { origin: [1.0, 2.0, 3.0], spacing: [0.5, 1.0, 2.0], n_points: [4, 3, 2] };
        for index in 0..grid.len() {
            assert_eq!(grid.index(grid.place(index)), index);
        }
        assert_eq!(grid.place(1), [1, 0, 0]);
        assert_eq!(grid.position([3, 2, 1]), [2.5, 4.0, 5.0]);
        assert_eq!(grid.steps_to(0, 2.0), Some(2.0));
        assert_eq!(grid.steps_to(0, 2.6), None);
    }

    #[test]
    fn each_pair_of_components_has_its_place() {
        for (place, [first, second]) in STRESSES.into_iter().enumerate() {
            assert_eq!(stress_of(first, second), place);
            assert_eq!(stress_of(second, first), place);
        }
    }

    #[test]
    fn the_points_of_a_plane_keep_their_order() {
        let plane = Plane {
            name: "2D".to_owned(),
            axes: PlaneAxes::Crosswind,
            origin: [10.0, -5.0, 0.0],
            spacing: [2.0, 3.0],
            n_points: [4, 5],
            time: 0.0,
            averaged: 0.0,
            velocity: Default::default(),
        };
        let grid = Grid::of_plane(&plane);
        // The second row of the plane is one step up.
        assert_eq!(grid.position(grid.place(5)), [10.0, -3.0, 3.0]);
        assert_eq!(grid.spanned(), [1, 2]);
    }
}
