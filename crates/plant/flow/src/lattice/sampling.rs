//! The field as others see it: wind at points, rows, the mass of the air.

use super::probe::RowState;
use super::settings::{Ends, Ground, Sides};
use super::solver::{Lattice, Worker, own};
use crate::WindField;
use basis::Vector3;
use std::sync::Mutex;

impl WindField for Lattice {
    /// Trilinear between cell centres; outside the box, the nearest cell's wind.
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        // Neighbouring stations of a blade often lie between the same eight cells.
        let mut known: Option<([usize; 3], [[f32; 8]; 3])> = None;
        for (position, velocity) in positions.iter().zip(velocities) {
            let (low, high, weight) = self.cell_cube(*position);
            let corners = match known {
                Some((at, corners)) if at == low => corners,
                _ => {
                    let corners = self.cube_velocities(low, high);
                    known = Some((low, corners));
                    corners
                }
            };
            let result = corners.each_ref().map(|corners| interpolate(corners, weight));
            *velocity = self.scaling().to_si_velocity(Vector3::from_array(result));
        }
    }
}

impl Lattice {
    /// Mass of the air in the box (kg).
    pub fn mass(&self) -> f64 {
        let mut row = RowState::new(self.layout.n_cells[0]);
        let mut excess = 0.0;
        for index in 0..self.layout.n_rows() {
            self.kernel.read_row(&self.view(), index, &mut row);
            excess += row.density_excess[..self.layout.n_cells[0]]
                .iter()
                .copied()
                .map(f64::from)
                .sum::<f64>();
        }
        let settings = self.settings();
        (settings.cells() as f64 + excess) * settings.air_density * settings.spacing.powi(3)
    }

    /// Momentum of the air in the box, forces of the last step not counted (kg m/s).
    pub fn momentum(&self) -> Vector3 {
        let n = self.layout.n_cells[0];
        let mut row = RowState::new(n);
        let mut total = Vector3::ZERO;
        for index in 0..self.layout.n_rows() {
            self.kernel.read_row(&self.view(), index, &mut row);
            for x in 0..n {
                let velocity =
                    Vector3::from_array(std::array::from_fn(|c| f64::from(row.velocity[c][x])));
                total += velocity * (1.0 + f64::from(row.density_excess[x]));
            }
        }
        let settings = self.settings();
        self.scaling().to_si_velocity(total) * settings.air_density * settings.spacing.powi(3)
    }

    /// Pressure above that of undisturbed air (Pa) at `position` (m), trilinear between cell centres.
    pub fn pressure(&self, position: Vector3) -> f64 {
        let (low, high, weight) = self.cell_cube(position);
        let [excess, ..] = self.kernel.read_cells(&self.view(), &corners(low, high));
        self.scaling().to_si_pressure(interpolate(&excess, weight))
    }

    /// On return `state` holds the row at (`y`, `z`) in lattice units; velocities are the physical ones, half-way
    /// through the forces.
    pub(super) fn read_row(&self, y: usize, z: usize, state: &mut RowState) {
        self.kernel.read_row(&self.view(), z * self.layout.n_cells[1] + y, state);
        let n = self.layout.n_cells[0];
        let RowState { density_excess, velocity } = state;
        for (column, acceleration) in velocity.iter_mut().zip(self.acceleration) {
            if acceleration != 0.0 {
                for (value, excess) in column[..n].iter_mut().zip(&*density_excess) {
                    *value += 0.5 * acceleration / (1.0 + excess);
                }
            }
        }
        let worker = own(self.worker_of(y, z));
        for block in worker.spreader.blocks() {
            if let Some(cells) = block.row(y, z) {
                let x = block.origin[0]..block.origin[0] + block.size[0];
                for (column, force) in velocity.iter_mut().zip(&block.force) {
                    let values = column[x.clone()].iter_mut().zip(&density_excess[x.clone()]);
                    for ((value, excess), force) in values.zip(&force[cells.clone()]) {
                        *value += 0.5 * force / (1.0 + excess);
                    }
                }
            }
        }
    }

    /// The cells around `position`: the lower ones, the upper ones, and how far it lies from the former to the latter (–).
    fn cell_cube(&self, position: Vector3) -> ([usize; 3], [usize; 3], [f64; 3]) {
        let periodic = [
            self.settings().ends == Ends::Periodic,
            self.settings().sides == Sides::Periodic,
            self.settings().ground == Ground::Periodic,
        ];
        let coordinates = self.scaling().to_lattice_position(position).to_array();
        let (mut low, mut high, mut weight) = ([0; 3], [0; 3], [0.0; 3]);
        for axis in 0..3 {
            let n = self.layout.n_cells[axis];
            (low[axis], high[axis], weight[axis]) = bracket(coordinates[axis], n, periodic[axis]);
        }
        (low, high, weight)
    }

    fn cube_velocities(&self, low: [usize; 3], high: [usize; 3]) -> [[f32; 8]; 3] {
        self.cell_velocities(&corners(low, high))
    }

    /// The worker that the row at (`y`, `z`) belongs to.
    fn worker_of(&self, y: usize, z: usize) -> &Mutex<Worker> {
        let row = z * self.layout.n_cells[1] + y;
        // Workers' rows start at worker · n_rows / n_workers, rounded down.
        let n_workers = self.workers.len();
        &self.workers[((row + 1) * n_workers - 1) / self.layout.n_rows()]
    }

    /// Physical velocities of eight cells, component by component, in lattice units.
    pub(super) fn cell_velocities(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 3] {
        let [excess, mut u, mut v, mut w] = self.kernel.read_cells(&self.view(), cells);
        for (corner, [x, y, z]) in cells.iter().copied().enumerate() {
            let half = 0.5 / (1.0 + excess[corner]);
            let mut force = self.acceleration;
            let worker = own(self.worker_of(y, z));
            let block = worker.spreader.blocks().iter().find_map(|block| block.at(x, y, z));
            if let Some(block) = block {
                for (total, value) in force.iter_mut().zip(block) {
                    *total += value;
                }
            }
            u[corner] += half * force[0];
            v[corner] += half * force[1];
            w[corner] += half * force[2];
        }
        [u, v, w]
    }
}

/// The corners of the cube from `low` to `high`, x fastest.
fn corners(low: [usize; 3], high: [usize; 3]) -> [[usize; 3]; 8] {
    std::array::from_fn(|corner| {
        std::array::from_fn(|axis| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] })
    })
}

/// Trilinear value `weight` of the way along each axis, of values at the corners of a cube.
fn interpolate(corners: &[f32; 8], weight: [f64; 3]) -> f64 {
    let mut result = 0.0;
    for (corner, value) in corners.iter().enumerate() {
        let mut share = f64::from(*value);
        for (axis, weight) in weight.iter().enumerate() {
            share *= if corner >> axis & 1 == 1 { *weight } else { 1.0 - weight };
        }
        result += share;
    }
    result
}

/// Cells below and above `coordinate` on an axis of `n` cells, and the share of the way between them (–).
pub(super) fn bracket(coordinate: f64, n: usize, periodic: bool) -> (usize, usize, f64) {
    let inside = if periodic {
        coordinate.rem_euclid(n as f64)
    } else {
        coordinate.clamp(0.0, (n - 1) as f64)
    };
    // Saturating: a coordinate that is not a number gives the first cell.
    let below = (inside.floor() as usize).min(n - 1);
    let above = match below + 1 < n {
        true => below + 1,
        false if periodic => 0,
        false => below,
    };
    (below, above, inside - below as f64)
}
