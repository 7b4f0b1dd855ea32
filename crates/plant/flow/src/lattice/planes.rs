//! Slices and volumes of the wind, at an instant or averaged.

use super::probe::RowState;
use super::sampling::bracket;
use super::settings::Sides;
use super::solver::Lattice;
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};

/// Wind at every so many cells of the box, at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Position of its first point, farm frame (m).
    pub origin: Vector3,
    /// Distance of neighbouring points (m).
    pub spacing: f64,
    /// Points along x, y, z (–).
    pub n_points: [usize; 3],
    /// Instant (s).
    pub time: f64,
    /// Velocity components u, v, w (m/s), x fastest.
    pub velocity: [Vec<f32>; 3],
}

/// A plane's mean over instants, without allocation once it is made.
#[derive(Clone, Debug)]
pub struct PlaneAverage {
    latest: Plane,
    sums: [Vec<f64>; 3],
    n_instants: u64,
    start: f64,
    rows: [RowState; 2],
}

impl PlaneAverage {
    /// The mean of `lattice`'s planes as [`Lattice::plane`] gives them; none taken in yet.
    pub fn new(lattice: &Lattice, name: &str, axes: PlaneAxes, position: f64) -> Self {
        let latest = lattice.empty_plane(name, axes, position);
        let sums = std::array::from_fn(|_| vec![0.0; latest.velocity[0].len()]);
        Self { sums, n_instants: 0, start: lattice.time(), rows: lattice.row_pair(), latest }
    }

    /// Takes the present instant in.
    pub fn add(&mut self, lattice: &Lattice) {
        lattice.write_plane(&mut self.latest, &mut self.rows);
        for (sums, values) in self.sums.iter_mut().zip(&self.latest.velocity) {
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += f64::from(*value);
            }
        }
        if self.n_instants == 0 {
            self.start = self.latest.time;
        }
        self.n_instants += 1;
    }

    /// Instants taken in so far (–).
    pub fn n_instants(&self) -> u64 {
        self.n_instants
    }

    /// The mean so far; air at rest before the first instant.
    pub fn mean(&self) -> Plane {
        let share = 1.0 / self.n_instants.max(1) as f64;
        Plane {
            averaged: self.latest.time - self.start,
            velocity: std::array::from_fn(|component| {
                self.sums[component].iter().map(|sum| (sum * share) as f32).collect()
            }),
            ..self.latest.clone()
        }
    }

    /// Sums and times, to be carried over a restart.
    pub fn state(&self) -> PlaneAverageState {
        PlaneAverageState {
            sums: self.sums.clone(),
            n_instants: self.n_instants,
            start: self.start,
            time: self.latest.time,
        }
    }

    /// Goes on from `state`, which an average of the same plane gave.
    ///
    /// # Errors
    /// [`PlaneSizeError`] when it was a plane of another size; nothing is changed then.
    pub fn restore(&mut self, state: PlaneAverageState) -> Result<(), PlaneSizeError> {
        let (expected, found) = (self.sums[0].len(), state.sums[0].len());
        if state.sums.iter().any(|sums| sums.len() != expected) {
            return Err(PlaneSizeError { expected, found });
        }
        (self.sums, self.n_instants, self.start) = (state.sums, state.n_instants, state.start);
        self.latest.time = state.time;
        Ok(())
    }
}

/// What a [`PlaneAverage`] has gathered.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PlaneAverageState {
    sums: [Vec<f64>; 3],
    n_instants: u64,
    start: f64,
    time: f64,
}

/// An average was restored from a plane of another size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the stored average has {found} points, the plane {expected}")]
pub struct PlaneSizeError {
    /// Points of the plane (–).
    pub expected: usize,
    /// Points of the stored sums (–).
    pub found: usize,
}

impl Lattice {
    /// The wind now on the plane that `axes` span at `position` (m) along the third axis, at the cells' centres.
    ///
    /// A position between two layers of cells is interpolated; beyond the outermost centres it is that layer's wind.
    pub fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let mut plane = self.empty_plane(name, axes, position);
        self.write_plane(&mut plane, &mut self.row_pair());
        plane
    }

    /// The wind now at every `stride`-th cell along each axis.
    pub fn volume(&self, stride: usize) -> Volume {
        let stride = stride.max(1);
        let [n_x, n_y, n_z] = self.layout.n_cells;
        let n_points = self.layout.n_cells.map(|n| n.div_ceil(stride));
        let mut velocity: [Vec<f32>; 3] =
            std::array::from_fn(|_| Vec::with_capacity(n_points.iter().product()));
        let unit = self.scaling().si_velocity_unit() as f32;
        let [mut row, _] = self.row_pair();
        for z in (0..n_z).step_by(stride) {
            for y in (0..n_y).step_by(stride) {
                self.read_row(y, z, &mut row);
                for (target, column) in velocity.iter_mut().zip(&row.velocity) {
                    target.extend(column[..n_x].iter().step_by(stride).map(|value| value * unit));
                }
            }
        }
        Volume {
            origin: self.scaling().to_si_position(Vector3::ZERO),
            spacing: self.scaling().spacing() * stride as f64,
            n_points,
            time: self.time(),
            velocity,
        }
    }

    fn row_pair(&self) -> [RowState; 2] {
        std::array::from_fn(|_| RowState::new(self.layout.n_cells[0]))
    }

    fn empty_plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let (normal, along) = match axes {
            PlaneAxes::Crosswind => (0, [1, 2]),
            PlaneAxes::Streamwise => (1, [0, 2]),
            PlaneAxes::Horizontal => (2, [0, 1]),
        };
        let n_points = along.map(|axis| self.layout.n_cells[axis]);
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
        let [_, n_y, n_z] = self.layout.n_cells;
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
        let n = self.layout.n_cells[0];
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
        let [n_x, n_y, n_z] = self.layout.n_cells;
        let (low, high, weight) = bracket(x, n_x, false);
        let unit = self.scaling().si_velocity_unit() as f32;
        let weight = weight as f32;
        let n = n_y * n_z;
        let mut first = 0;
        while first < n {
            // Four points at a time: eight cells, the last point repeated where there are fewer.
            let cells: [[usize; 3]; 8] = std::array::from_fn(|lane| {
                let [y, z] = self.layout.place((first + lane / 2).min(n - 1));
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
