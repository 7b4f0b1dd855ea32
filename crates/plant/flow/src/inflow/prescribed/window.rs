//! The planes of wind around the farm at one time, out of a record of any length.

use super::Placement;
use crate::inflow::{InflowError, PlaneGrid, Planes};
use basis::Vector3;

/// Planes beyond the farm's extent that are kept, so that interpolation always has both neighbours.
const MARGIN: i64 = 2;

/// A ring of planes, of which the newest replaces the oldest.
pub(super) struct Window {
    planes: Box<dyn Planes>,
    grid: PlaneGrid,
    placement: Placement,
    /// Planes held, each n_z × n_y, with a fourth value that keeps points aligned.
    ring: Vec<[f32; 4]>,
    /// One plane as its source gives it.
    arriving: Vec<[f32; 3]>,
    /// Planes that fit into the ring.
    capacity: usize,
    /// Count of the oldest plane held, where that of the record's first is zero and the record, where it
    /// repeats, goes on in both directions; and how many are held.
    oldest: i64,
    n_held: usize,
    /// Place in the ring of the oldest.
    oldest_slot: usize,
    /// Planes that have passed `origin_x` (–).
    passed: f64,
}

impl Window {
    pub(super) fn new(planes: Box<dyn Planes>, placement: Placement) -> Result<Self, InflowError> {
        let mut grid = planes.grid();
        grid.check()?;
        grid.first[0] += placement.shift_y;
        let [from, to] = placement.extent;
        let numbers = [from, to, placement.origin_x, placement.shift_y];
        if !numbers.iter().all(|number| number.is_finite()) || to < from {
            let (name, expected) =
                ("extent of the wind along x (m)", "two numbers, the lesser first");
            return Err(InflowError::Setting { name, value: to - from, expected });
        }
        let extent = ((to - from) / (grid.speed * grid.interval)).ceil();
        let size = grid.n_y.saturating_mul(grid.n_z);
        let capacity = (extent as usize).saturating_add(2 * MARGIN as usize + 2);
        let n_values = capacity.saturating_mul(size);
        let mut ring: Vec<[f32; 4]> = Vec::new();
        ring.try_reserve_exact(n_values).map_err(|_| InflowError::Memory {
            n_points: [capacity, grid.n_y, grid.n_z],
            memory: 16_u64.saturating_mul(n_values as u64),
        })?;
        ring.resize(n_values, [0.0; 4]);
        let arriving = vec![[0.0; 3]; size];
        let mut window = Self {
            planes,
            grid,
            placement,
            ring,
            arriving,
            capacity,
            oldest: 0,
            n_held: 0,
            oldest_slot: 0,
            passed: 0.0,
        };
        window.load(0.0)?;
        Ok(window)
    }

    pub(super) fn grid(&self) -> PlaneGrid {
        self.grid
    }

    /// Planes (–) that pass between `origin_x` and `x` (m).
    fn ahead(&self, x: f64) -> f64 {
        (x - self.placement.origin_x) / (self.grid.speed * self.grid.interval)
    }

    pub(super) fn covers(
        &self,
        lowest: Vector3,
        highest: Vector3,
        duration: f64,
    ) -> Result<(), InflowError> {
        let (across, up) = (self.grid.across(), self.grid.up());
        // Rounding of a grid stored in single precision is no gap.
        let slack = 1e-3 * self.grid.spacing[0].min(self.grid.spacing[1]);
        for position in [lowest, highest] {
            let within = position.y >= across[0] - slack
                && position.y <= across[1] + slack
                && position.z <= up[1] + slack;
            if !within {
                return Err(InflowError::Outside { position, across, up });
            }
        }
        let newest = duration / self.grid.interval - self.ahead(self.placement.extent[0]);
        self.ended(newest)
    }

    fn ended(&self, newest: f64) -> Result<(), InflowError> {
        // The last plane itself counts, and an interval's rounding is no end.
        if self.grid.repeats || newest <= (self.grid.n_steps - 1) as f64 + 1e-6 {
            return Ok(());
        }
        let length = self.grid.length();
        Err(InflowError::Ended { length, time: newest * self.grid.interval })
    }

    /// On return the window stands at `time` (s): planes that were not held have been read.
    pub(super) fn load(&mut self, time: f64) -> Result<(), InflowError> {
        let passed = time / self.grid.interval;
        let [from, to] = self.placement.extent;
        self.ended(passed - self.ahead(from))?;
        let first = (passed - self.ahead(to)).floor() as i64 - MARGIN + 1;
        let last = (passed - self.ahead(from)).floor() as i64 + MARGIN;
        let newest = self.oldest + self.n_held as i64 - 1;
        if self.n_held == 0 || first < self.oldest || first > newest {
            (self.oldest, self.oldest_slot, self.n_held) = (first, 0, 0);
        }
        // Planes that have gone by make room.
        let gone = (first - self.oldest) as usize;
        self.oldest = first;
        self.oldest_slot = (self.oldest_slot + gone) % self.capacity;
        self.n_held -= gone.min(self.n_held);
        while self.oldest + (self.n_held as i64) <= last && self.n_held < self.capacity {
            self.read_next()?;
        }
        self.passed = passed;
        Ok(())
    }

    /// On return one more plane is held.
    fn read_next(&mut self) -> Result<(), InflowError> {
        let count = self.oldest + self.n_held as i64;
        let n_steps = self.grid.n_steps as i64;
        let step = if self.grid.repeats {
            count.rem_euclid(n_steps)
        } else {
            // Before the record's first and behind its last plane these stand still.
            count.clamp(0, n_steps - 1)
        };
        self.planes.read(step as usize, &mut self.arriving)?;
        let size = self.arriving.len();
        let slot = (self.oldest_slot + self.n_held) % self.capacity;
        let held = &mut self.ring[slot * size..(slot + 1) * size];
        for (value, [u, v, w]) in held.iter_mut().zip(&self.arriving) {
            *value = [*u, *v, *w, 0.0];
        }
        self.n_held += 1;
        Ok(())
    }

    pub(super) fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        let PlaneGrid { n_y, n_z, spacing, first, .. } = self.grid;
        let size = n_y * n_z;
        let per_plane = 1.0 / (self.grid.speed * self.grid.interval);
        let per_point = spacing.map(|spacing| 1.0 / spacing);
        let start = self.passed + self.placement.origin_x * per_plane - self.oldest as f64;
        for (position, velocity) in positions.iter().zip(velocities) {
            let (plane, late) = place(start - position.x * per_plane, self.n_held);
            let (y, left) = place((position.y - first[0]) * per_point[0], n_y);
            let (z, above) = place((position.z - first[1]) * per_point[1], n_z);
            let mut slot = self.oldest_slot + plane;
            slot -= if slot >= self.capacity { self.capacity } else { 0 };
            let next = if slot + 1 == self.capacity { 0 } else { slot + 1 };
            let corner = z * n_y + y;
            let beside = usize::from(n_y > 1);
            let upper = if n_z > 1 { n_y } else { 0 };
            let now = &self.ring[slot * size..(slot + 1) * size];
            let then = &self.ring[next * size..(next + 1) * size];
            let [now, then] = [now, then].map(|plane| {
                let low = between(plane[corner], plane[corner + beside], left);
                let high = between(plane[corner + upper], plane[corner + upper + beside], left);
                between(low, high, above)
            });
            let [u, v, w, _] = between(now, then, late);
            *velocity = Vector3::new(f64::from(u), f64::from(v), f64::from(w));
        }
    }
}

/// Point at or before `place` (in spacings), at most the last but one of `n`, and how far behind it (–), 0 to
/// 1.
#[inline(always)]
fn place(place: f64, n: usize) -> (usize, f32) {
    let last = n.saturating_sub(2);
    // What is not a number lands on the first point.
    let index = (place.max(0.0) as usize).min(last);
    (index, ((place - index as f64) as f32).clamp(0.0, 1.0))
}

#[inline(always)]
fn between(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|index| a[index] + share * (b[index] - a[index]))
}
