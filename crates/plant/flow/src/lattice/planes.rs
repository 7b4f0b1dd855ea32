//! Slices and volumes of the wind at an instant.

use super::probe::RowState;
use super::sampling::bracket;
use super::settings::Sides;
use super::solver::Lattice;
use crate::fields::{FieldSource, Volume};
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};
use std::sync::{MutexGuard, PoisonError};

impl FieldSource for Lattice {
    fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        Self::plane(self, name, axes, position)
    }

    fn refresh(&self, plane: &mut Plane) {
        self.write_plane(plane, &mut self.room());
    }

    fn volume(&self, stride: usize) -> Volume {
        Self::volume(self, stride)
    }
}

impl Lattice {
    /// The wind now on the plane that `axes` span at `position` (m) along the third axis, at the cells'
    /// centres.
    ///
    /// A position between two layers of cells is interpolated; beyond the outermost centres it is that
    /// layer's wind.
    pub fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let mut plane = self.empty_plane(name, axes, position);
        self.refresh(&mut plane);
        plane
    }

    /// The wind now at every `stride`-th cell along each axis.
    pub fn volume(&self, stride: usize) -> Volume {
        let stride = stride.max(1);
        let [n_x, n_y, n_z] = self.n_cells();
        let n_points = self.n_cells().map(|n| n.div_ceil(stride));
        let mut velocity: [Vec<f32>; 3] =
            std::array::from_fn(|_| Vec::with_capacity(n_points.iter().product()));
        let mut pressure = Vec::with_capacity(n_points.iter().product());
        let unit = self.scaling().si_velocity_unit() as f32;
        let unit_of_pressure = self.pressure_unit();
        let [row, _] = &mut *self.room();
        for z in (0..n_z).step_by(stride) {
            for y in (0..n_y).step_by(stride) {
                self.read_row(y, z, row);
                for (target, column) in velocity.iter_mut().zip(&row.velocity) {
                    target.extend(column[..n_x].iter().step_by(stride).map(|value| value * unit));
                }
                let excess = row.density_excess[..n_x].iter().step_by(stride);
                pressure.extend(excess.map(|excess| excess * unit_of_pressure));
            }
        }
        Volume {
            origin: self.scaling().to_si_position(Vector3::ZERO),
            spacing: self.scaling().spacing() * stride as f64,
            n_points,
            time: self.time(),
            velocity,
            pressure: Some(pressure),
        }
    }

    /// Pressure over density (m²/s²) of an excess of density of one.
    pub(super) fn pressure_unit(&self) -> f32 {
        (self.scaling().to_si_pressure(1.0) / self.settings().air_density) as f32
    }

    /// Room for two rows.
    fn room(&self) -> MutexGuard<'_, [RowState; 2]> {
        self.room.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn empty_plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let (normal, along) = match axes {
            PlaneAxes::Crosswind => (0, [1, 2]),
            PlaneAxes::Streamwise => (1, [0, 2]),
            PlaneAxes::Horizontal => (2, [0, 1]),
        };
        let n_points = along.map(|axis| self.n_cells()[axis]);
        let mut origin = self.scaling().to_si_position(Vector3::ZERO).to_array();
        origin[normal] = position;
        Plane {
            name: name.to_owned(),
            axes,
            origin,
            spacing: [self.scaling().spacing(); 2],
            n_points,
            time: self.time(),
            averaged: 0.0,
            velocity: std::array::from_fn(|_| vec![0.0; n_points[0] * n_points[1]]),
        }
    }

    /// On return `plane` holds the wind of this instant; `rows` is room to work in.
    fn write_plane(&self, plane: &mut Plane, rows: &mut [RowState; 2]) {
        plane.time = self.time();
        let [_, n_y, n_z] = self.n_cells();
        let [x, y, z] = self.scaling().to_lattice_position(plane.origin.into()).to_array();
        match plane.axes {
            PlaneAxes::Horizontal => {
                let (low, high, weight) = bracket(z, n_z, false);
                for y in 0..n_y {
                    self.write_line(plane, y, rows, [(y, low), (y, high)], weight);
                }
            }
            PlaneAxes::Streamwise => {
                let (low, high, weight) = bracket(y, n_y, self.settings().sides == Sides::Periodic);
                for z in 0..n_z {
                    self.write_line(plane, z, rows, [(low, z), (high, z)], weight);
                }
            }
            PlaneAxes::Crosswind => self.write_crosswind(plane, x),
        }
    }

    /// On return line number `line` of `plane` lies `weight` of the way between the rows at `places` (y, z).
    fn write_line(
        &self,
        plane: &mut Plane,
        line: usize,
        rows: &mut [RowState; 2],
        places: [(usize, usize); 2],
        weight: f64,
    ) {
        let n = self.n_cells()[0];
        let unit = self.scaling().si_velocity_unit() as f32;
        let weight = weight as f32;
        for (row, (y, z)) in rows.iter_mut().zip(places) {
            self.read_row(y, z, row);
        }
        for (component, target) in plane.velocity.iter_mut().enumerate() {
            let (low, high) = (&rows[0].velocity[component], &rows[1].velocity[component]);
            let target = &mut target[line * n..(line + 1) * n];
            for ((value, low), high) in target.iter_mut().zip(low).zip(high) {
                *value = unit * (low + weight * (high - low));
            }
        }
    }

    fn write_crosswind(&self, plane: &mut Plane, x: f64) {
        let [n_x, n_y, n_z] = self.n_cells();
        let (low, high, weight) = bracket(x, n_x, false);
        let unit = self.scaling().si_velocity_unit() as f32;
        let weight = weight as f32;
        let n = n_y * n_z;
        let mut first = 0;
        while first < n {
            // Four points at a time: eight cells, the last point repeated where there are fewer.
            let cells: [[usize; 3]; 8] = std::array::from_fn(|lane| {
                let row = (first + lane / 2).min(n - 1);
                let [y, z] = [row % n_y, row / n_y];
                [if lane % 2 == 0 { low } else { high }, y, z]
            });
            let velocities = self.cell_velocities(&cells);
            for (target, lanes) in plane.velocity.iter_mut().zip(&velocities) {
                for (value, pair) in target[first..].iter_mut().zip(lanes.chunks_exact(2)) {
                    *value = unit * (pair[0] + weight * (pair[1] - pair[0]));
                }
            }
            first += 4;
        }
    }
}
