//! Planes through the air: at one instant, and averaged.

use basis::records::{Plane, PlaneAxes};
use basis::Vector3;
use flow::WindField;
use serde::{Deserialize, Serialize};

/// A plane of points at cell centres, with room for its velocities.
#[derive(Clone, Debug)]
pub struct Slice {
    name: String,
    axes: PlaneAxes,
    origin: Vector3,
    spacing: f64,
    n_points: [usize; 2],
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
}

impl Slice {
    /// The plane called `name` at `position` (m, on the axis that `axes` leaves out), through the cell centres of the
    /// box that starts at `corner` (m) with `n_cells` of edge `spacing` (m).
    pub fn new(
        name: &str,
        axes: PlaneAxes,
        position: f64,
        corner: Vector3,
        n_cells: [usize; 3],
        spacing: f64,
    ) -> Self {
        let (first, second, across) = match axes {
            PlaneAxes::Horizontal => (0, 1, 2),
            PlaneAxes::Streamwise => (0, 2, 1),
            PlaneAxes::Crosswind => (1, 2, 0),
        };
        let mut origin = corner + Vector3::splat(0.5 * spacing);
        origin[across] = position;
        let n_points = [n_cells[first], n_cells[second]];
        let mut positions = Vec::with_capacity(n_points[0] * n_points[1]);
        for j in 0..n_points[1] {
            for i in 0..n_points[0] {
                let mut point = origin;
                point[first] += i as f64 * spacing;
                point[second] += j as f64 * spacing;
                positions.push(point);
            }
        }
        let velocities = vec![Vector3::ZERO; positions.len()];
        Self { name: name.to_owned(), axes, origin, spacing, n_points, positions, velocities }
    }

    /// Reads the plane from `air` as it is now.
    pub fn read(&mut self, air: &impl WindField) {
        air.sample(&self.positions, &mut self.velocities);
    }

    /// The plane last read, at `time` (s).
    pub fn instant(&self, time: f64) -> Plane {
        self.plane(time, 0.0, [0, 1, 2].map(|axis| {
            self.velocities.iter().map(|velocity| velocity[axis] as f32).collect()
        }))
    }

    fn plane(&self, time: f64, averaged: f64, velocity: [Vec<f32>; 3]) -> Plane {
        Plane {
            name: self.name.clone(),
            axes: self.axes,
            origin: self.origin.to_array(),
            spacing: [self.spacing; 2],
            n_points: self.n_points,
            time,
            averaged,
            velocity,
        }
    }
}

/// Sums of a plane's velocities; restoring them continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneSum {
    sums: Vec<Vector3>,
    n_samples: u64,
}

impl PlaneSum {
    /// No samples of `slice` yet.
    pub fn new(slice: &Slice) -> Self {
        Self { sums: vec![Vector3::ZERO; slice.positions.len()], n_samples: 0 }
    }

    /// Adds the plane that `slice` read last.
    pub fn add(&mut self, slice: &Slice) {
        for (sum, velocity) in self.sums.iter_mut().zip(&slice.velocities) {
            *sum += *velocity;
        }
        self.n_samples += 1;
    }

    /// The mean of all samples of `slice`, which cover `averaged` seconds before `time` (s); none without samples.
    pub fn mean(&self, slice: &Slice, time: f64, averaged: f64) -> Option<Plane> {
        let share = (self.n_samples > 0).then(|| 1.0 / self.n_samples as f64)?;
        let component =
            |axis: usize| self.sums.iter().map(|sum| (sum[axis] * share) as f32).collect();
        Some(slice.plane(time, averaged, [component(0), component(1), component(2)]))
    }
}
