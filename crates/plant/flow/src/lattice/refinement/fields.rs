//! The refined field as others see it: wind at points, on planes and in volumes.

use super::{Grid, Inner, Refined};
use crate::WindField;
use crate::fields::{FieldSource, Volume};
use crate::lattice::cell_box::CellBox;
use crate::lattice::sampling::{bracket, corners, interpolate};
use crate::lattice::settings::Sides;
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};

impl WindField for Refined {
    /// Trilinear between cell centres of the finest box that holds them all around a position; next to a box
    /// between those of the grid around and means over the box; outside all grids, the nearest cell's wind.
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.grid.sample(positions, velocities);
    }
}

impl FieldSource for Refined {
    /// At the cell centres of the [base](Refined::base); in a box, the mean over its cells in each.
    fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let mut plane = self.base().plane(name, axes, position);
        self.show_boxes(&mut plane);
        plane
    }

    fn refresh(&self, plane: &mut Plane) {
        self.base().refresh(plane);
        self.show_boxes(plane);
    }

    /// At cells of the [base](Refined::base), as planes.
    fn volume(&self, stride: usize) -> Volume {
        let mut volume = self.base().volume(stride);
        volume.time = self.time();
        let unit = self.base().scaling().si_velocity_unit() as f32;
        let unit_of_pressure = self.base().pressure_unit();
        let stride = stride.max(1);
        let [n_x, n_y, _] = volume.n_points;
        for one in &self.grid.boxes {
            let points = CellBox {
                low: one.covered.low.map(|low| low.div_ceil(stride)),
                high: one.covered.high.map(|high| high.div_ceil(stride)),
            };
            for point in points.cells() {
                let index = (point[2] * n_y + point[1]) * n_x + point[0];
                let [excess, velocity @ ..] = self.grid.state(point.map(|place| place * stride));
                for (column, value) in volume.velocity.iter_mut().zip(velocity) {
                    column[index] = unit * value;
                }
                if let Some(pressure) = &mut volume.pressure {
                    pressure[index] = unit_of_pressure * excess;
                }
            }
        }
        volume
    }
}

impl Refined {
    /// Potential temperature (K) at each of `positions` (m) into `temperatures`, of the same length:
    /// trilinear between cell centres of the finest box that holds them all around a position, next to a box
    /// as [wind](WindField::sample) is; false, and nothing is written, where the air has none.
    pub fn sample_temperature(&self, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        let mut one_by_one = positions.iter().zip(temperatures);
        one_by_one.all(|(position, temperature)| self.grid.temperature(*position, temperature))
    }

    /// On return `plane`, which the base has filled, shows the boxes and tells the time.
    fn show_boxes(&self, plane: &mut Plane) {
        self.grid.overlay(plane);
        plane.time = self.time();
    }
}

impl Inner {
    /// Whether the cells around `position` (m) are all cells of the box.
    fn holds(&self, position: Vector3) -> bool {
        let lattice = &self.grid.lattice;
        let place = lattice.scaling().to_lattice_position(position).to_array();
        (0..3).all(|axis| {
            let last = (lattice.n_cells()[axis] - 1) as f64;
            let [before, after] = self.beyond[axis];
            (before.is_some() || place[axis] >= 0.0) && (after.is_some() || place[axis] <= last)
        })
    }

    /// Its cells in `cell` of the grid around, which it covers.
    fn children(&self, cell: [usize; 3]) -> [[usize; 3]; 8] {
        let first = std::array::from_fn(|axis| 2 * (cell[axis] - self.covered.low[axis]));
        corners(first, first.map(|place| place + 1))
    }
}

impl Grid {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        let home = |position: &Vector3| self.boxes.iter().position(|one| one.holds(*position));
        let mut start = 0;
        // Neighbouring positions lie in one grid mostly, which then knows its cells from one to the next.
        while start < positions.len() {
            let here = home(&positions[start]);
            let n = positions[start..].iter().take_while(|next| home(next) == here).count();
            let (positions, velocities) =
                (&positions[start..start + n], &mut velocities[start..start + n]);
            match here {
                Some(number) => self.boxes[number].grid.sample(positions, velocities),
                None => self.sample_own(positions, velocities),
            }
            start += n;
        }
    }

    /// On return `temperature` is that at `position`, where the air has one; false where it has none.
    fn temperature(&self, position: Vector3, temperature: &mut f64) -> bool {
        if let Some(one) = self.boxes.iter().find(|one| one.holds(position)) {
            return one.grid.temperature(position, temperature);
        }
        let Some(atmosphere) = &self.lattice.settings().atmosphere else { return false };
        let (low, high, weight) = self.lattice.cell_cube(position);
        let departures = corners(low, high).map(|cell| self.warmth(cell));
        *temperature = atmosphere.reference_temperature + interpolate(&departures, weight);
        true
    }

    /// Temperature of `cell` above the reference (K), the mean over the cells in it where it is covered:
    /// those under a box follow that one's only when it has made its steps.
    fn warmth(&self, cell: [usize; 3]) -> f32 {
        match self.cover(cell) {
            None => self.lattice.warmth(cell),
            Some(one) => mean(&one.children(cell).map(|child| one.grid.warmth(child))),
        }
    }

    /// The wind at `positions` that no box holds.
    fn sample_own(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.lattice.sample(positions, velocities);
        for (position, velocity) in positions.iter().zip(velocities) {
            let (low, high, weight) = self.lattice.cell_cube(*position);
            let cells = corners(low, high);
            if cells.iter().any(|cell| self.cover(*cell).is_some()) {
                let corners = cells.map(|cell| self.velocity(cell));
                let result = std::array::from_fn(|component| {
                    interpolate(&corners.map(|corner| corner[component]), weight)
                });
                *velocity = self.lattice.scaling().to_si_velocity(Vector3::from_array(result));
            }
        }
    }

    /// The box over `cell`.
    fn cover(&self, cell: [usize; 3]) -> Option<&Inner> {
        self.boxes.iter().find(|one| one.covered.contains(cell))
    }

    /// Velocity of `cell` (cells a step), the mean over the cells in it where it is covered.
    fn velocity(&self, cell: [usize; 3]) -> [f32; 3] {
        let [_, velocity @ ..] = self.state(cell);
        velocity
    }

    /// Density less one and velocity of `cell`, in lattice units, which are the same in all grids: means over
    /// the cells in it where it is covered.
    fn state(&self, cell: [usize; 3]) -> [f32; 4] {
        match self.cover(cell) {
            None => self.lattice.cell_states(&[cell; 8]).map(|values| values[0]),
            Some(one) => {
                let children = one.children(cell);
                if one.grid.boxes.is_empty() {
                    one.grid.lattice.cell_states(&children).map(|values| mean(&values))
                } else {
                    let all = children.map(|child| one.grid.state(child));
                    std::array::from_fn(|part| mean(&all.map(|child| child[part])))
                }
            }
        }
    }

    /// On return `plane`, which the lattice has filled, shows the boxes.
    fn overlay(&self, plane: &mut Plane) {
        let lattice = &self.lattice;
        let (normal, along) = match plane.axes {
            PlaneAxes::Crosswind => (0, [1, 2]),
            PlaneAxes::Streamwise => (1, [0, 2]),
            PlaneAxes::Horizontal => (2, [0, 1]),
        };
        let place = lattice.scaling().to_lattice_position(plane.origin.into()).to_array();
        let periodic = normal == 1 && lattice.settings().sides == Sides::Periodic;
        let (low, high, weight) = bracket(place[normal], lattice.n_cells()[normal], periodic);
        let (unit, weight) = (lattice.scaling().si_velocity_unit() as f32, weight as f32);
        for CellBox { low: first, high: end } in self.boxes.iter().map(|one| one.covered) {
            if ![low, high].iter().any(|layer| (first[normal]..end[normal]).contains(layer)) {
                continue;
            }
            for b in first[along[1]]..end[along[1]] {
                for a in first[along[0]]..end[along[0]] {
                    let [low, high] = [low, high].map(|layer| {
                        let mut cell = [layer; 3];
                        (cell[along[0]], cell[along[1]]) = (a, b);
                        self.velocity(cell)
                    });
                    for (component, column) in plane.velocity.iter_mut().enumerate() {
                        let rise = weight * (high[component] - low[component]);
                        column[b * plane.n_points[0] + a] = unit * (low[component] + rise);
                    }
                }
            }
        }
    }
}

fn mean(values: &[f32; 8]) -> f32 {
    0.125 * values.iter().sum::<f32>()
}
