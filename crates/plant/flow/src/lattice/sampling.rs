//! The field as others see it: wind at points, rows, the mass of the air.

use super::cell_box::CellBox;
use super::probe::RowState;
use super::settings::{Ends, Ground, Sides};
use super::solver::Lattice;
use crate::WindField;
use basis::Vector3;

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
        self.totals(&[]).0
    }

    /// Momentum of the air in the box, forces of the last step not counted (kg m/s).
    pub fn momentum(&self) -> Vector3 {
        self.totals(&[]).1
    }

    /// Mass (kg) and momentum (kg m/s) of the air in all cells but those of `left_out`.
    pub(super) fn totals(&self, left_out: &[CellBox]) -> (f64, Vector3) {
        let [n_x, n_y, _] = self.n_cells();
        let mut row = RowState::new(n_x);
        let (mut n_cells, mut excess, mut momentum) = (0_usize, 0.0, Vector3::ZERO);
        for index in 0..self.n_rows() {
            self.engine.read_row(index, &mut row);
            let [y, z] = [index % n_y, index / n_y];
            for x in 0..n_x {
                if left_out.iter().any(|cells| cells.contains([x, y, z])) {
                    continue;
                }
                let velocity =
                    Vector3::from_array(std::array::from_fn(|c| f64::from(row.velocity[c][x])));
                n_cells += 1;
                excess += f64::from(row.density_excess[x]);
                momentum += velocity * (1.0 + f64::from(row.density_excess[x]));
            }
        }
        let settings = self.settings();
        let mass_unit = settings.air_density * settings.spacing.powi(3);
        ((n_cells as f64 + excess) * mass_unit, self.scaling().to_si_velocity(momentum) * mass_unit)
    }

    /// Potential temperature (K) at each of `positions` (m), trilinear between cell centres, outside the box
    /// the nearest cell's, into `temperatures`, of the same length; false, and nothing is written, where the
    /// air has none.
    pub fn sample_temperature(&self, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        let Some(atmosphere) = &self.settings().atmosphere else { return false };
        for (position, temperature) in positions.iter().zip(temperatures) {
            let (low, high, weight) = self.cell_cube(*position);
            let departures = corners(low, high).map(|cell| self.warmth(cell));
            *temperature = atmosphere.reference_temperature + interpolate(&departures, weight);
        }
        true
    }

    /// Temperature of a cell above the reference (K), not a number where the air has none.
    pub(super) fn warmth(&self, [x, y, z]: [usize; 3]) -> f32 {
        self.engine.temperature(self.row_at(y, z)).map_or(f32::NAN, |row| row[x])
    }

    /// Pressure above that of undisturbed air (Pa) at `position` (m), trilinear between cell centres.
    pub fn pressure(&self, position: Vector3) -> f64 {
        let (low, high, weight) = self.cell_cube(position);
        let [excess, ..] = self.engine.read_cells(&corners(low, high));
        self.scaling().to_si_pressure(interpolate(&excess, weight))
    }

    /// On return `state` holds the row at (`y`, `z`) in lattice units; velocities are the physical ones,
    /// half-way through the forces.
    pub(super) fn read_row(&self, y: usize, z: usize, state: &mut RowState) {
        self.engine.read_row(self.row_at(y, z), state);
        let n = self.n_cells()[0];
        let RowState { density_excess, velocity } = state;
        for (column, acceleration) in velocity.iter_mut().zip(self.acceleration) {
            if acceleration != 0.0 {
                for (value, excess) in column[..n].iter_mut().zip(&*density_excess) {
                    *value += 0.5 * acceleration / (1.0 + excess);
                }
            }
        }
        self.engine.see_forces(self.row_at(y, z), &mut |blocks| {
            for block in blocks {
                let Some(cells) = block.row(y, z) else { continue };
                let x = block.origin[0]..block.origin[0] + block.size[0];
                for (column, force) in velocity.iter_mut().zip(&block.force) {
                    let values = column[x.clone()].iter_mut().zip(&density_excess[x.clone()]);
                    for ((value, excess), force) in values.zip(&force[cells.clone()]) {
                        *value += 0.5 * force / (1.0 + excess);
                    }
                }
            }
        });
    }

    /// Number of the row at (`y`, `z`).
    fn row_at(&self, y: usize, z: usize) -> usize {
        z * self.n_cells()[1] + y
    }

    /// The cells around `position`: the lower ones, the upper ones, and how far it lies from the former to
    /// the latter (–).
    pub(super) fn cell_cube(&self, position: Vector3) -> ([usize; 3], [usize; 3], [f64; 3]) {
        let periodic = [
            self.settings().ends == Ends::Periodic,
            self.settings().sides == Sides::Periodic,
            self.settings().ground == Ground::Periodic,
        ];
        let coordinates = self.scaling().to_lattice_position(position).to_array();
        let (mut low, mut high, mut weight) = ([0; 3], [0; 3], [0.0; 3]);
        for axis in 0..3 {
            let n = self.n_cells()[axis];
            (low[axis], high[axis], weight[axis]) = bracket(coordinates[axis], n, periodic[axis]);
        }
        (low, high, weight)
    }

    fn cube_velocities(&self, low: [usize; 3], high: [usize; 3]) -> [[f32; 8]; 3] {
        self.cell_velocities(&corners(low, high))
    }

    /// Physical velocities of eight cells, component by component, in lattice units.
    pub(super) fn cell_velocities(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 3] {
        let [_, u, v, w] = self.cell_states(cells);
        [u, v, w]
    }

    /// Density less one and physical velocities of eight cells, component by component, in lattice units.
    pub(super) fn cell_states(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4] {
        let [excess, mut u, mut v, mut w] = self.engine.read_cells(cells);
        for (corner, [x, y, z]) in cells.iter().copied().enumerate() {
            let half = 0.5 / (1.0 + excess[corner]);
            let mut force = self.acceleration;
            self.engine.see_forces(self.row_at(y, z), &mut |blocks| {
                if let Some(block) = blocks.iter().find_map(|block| block.at(x, y, z)) {
                    for (total, value) in force.iter_mut().zip(block) {
                        *total += value;
                    }
                }
            });
            u[corner] += half * force[0];
            v[corner] += half * force[1];
            w[corner] += half * force[2];
        }
        [excess, u, v, w]
    }
}

/// The corners of the cube from `low` to `high`, x fastest.
pub(super) fn corners(low: [usize; 3], high: [usize; 3]) -> [[usize; 3]; 8] {
    std::array::from_fn(|corner| {
        std::array::from_fn(|axis| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] })
    })
}

/// Trilinear value `weight` of the way along each axis, of values at the corners of a cube.
pub(super) fn interpolate(corners: &[f32; 8], weight: [f64; 3]) -> f64 {
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
