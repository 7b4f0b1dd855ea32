//! Recorded planes of wind that enter a domain larger than their grid.

use super::walk::walk;
use super::{InflowError, MeanColumn, MeanProfile, PlaneGrid, Planes};
use crate::Inflow;
use basis::Vector3;
use serde::{Deserialize, Serialize};

/// What blows where a domain is wider or higher than the grid of the planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Beyond {
    /// The fluctuations of the grid again: it repeats to the sides and upwards, as Mann's boxes do.
    Repeat,
    /// The fluctuations of the nearest edge.
    Hold,
    /// No fluctuations: those of the edge fade over [`FADING`] of the grid's width or height.
    Mean,
}

/// Bytes of the wind at a point.
const POINT_BYTES: u64 = size_of::<[f32; 3]>() as u64;

/// Width over which fluctuations fade beyond the edge with [`Beyond::Mean`], over that of the grid (–).
pub const FADING: f64 = 0.1;

/// Planes of wind as a domain takes them in.
///
/// Wind at x, y, z and time t is that of the planes at time t − (x − `origin_x`)/U, with U the speed of their
/// grid: linear in time, bilinear in y and z. On the grid it is the record's own. Its mean over time and
/// width goes on above the grid and below its lowest row in proportion to the profile, or above as the
/// [column](Self::with_column_aloft) of its atmosphere does; below, the fluctuations go with it; to the sides
/// and above, [`Beyond`] says what becomes of them. A record that does not repeat stands still before its
/// first plane and after its last. Planes with temperature bring it likewise; below the grid it is that of
/// the lowest row.
pub struct RecordedInflow {
    grid: PlaneGrid,
    profile: MeanProfile,
    beyond: Beyond,
    /// Where the first plane stands at time zero (m along x).
    origin_x: f64,
    /// Mean wind that blows in over the record's (–).
    mean_share: f64,
    /// Mean of each row of points over time and width (m/s), lowest first.
    means: Vec<[f32; 3]>,
    /// What the mean above the grid follows in place of the profile.
    aloft: Option<MeanColumn>,
    /// Count of the first plane held, and the planes held, each n_z × n_y.
    first: usize,
    held: Vec<[f32; 3]>,
    /// The temperature of the same planes, where they have one.
    warmth: Option<Warmth>,
}

/// Temperature of planes.
struct Warmth {
    /// Mean of each row of points over time and width (K), lowest first.
    means: Vec<f32>,
    /// Temperatures of the planes held (K).
    held: Vec<f32>,
}

/// Where planes are laid, and how much of them is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Where the first plane stands at time zero (m along x).
    pub origin_x: f64,
    /// Least and greatest x (m) at which the wind will be sampled.
    pub extent: [f64; 2],
    /// Time (s) until which it will be.
    pub duration: f64,
}

impl Entry {
    /// Counts of the first and the last plane of `grid` that are needed: all of them where it comes round.
    ///
    /// # Errors
    /// [`InflowError::Ended`] when a record that does not repeat is over before the end.
    pub fn planes(&self, grid: &PlaneGrid) -> Result<[usize; 2], InflowError> {
        let per_plane = 1.0 / (grid.speed * grid.interval);
        let [from, to] = self.extent.map(|x| (x - self.origin_x) * per_plane);
        let (first, newest) = (-to, self.duration / grid.interval - from);
        let last = grid.n_steps - 1;
        if grid.repeats {
            // A record that begins in the domain is needed from its end on, too.
            return Ok([0, last]);
        }
        // The last plane itself counts, and an interval's rounding is no end.
        if newest > last as f64 + 1e-6 {
            let length = grid.length();
            return Err(InflowError::Ended { length, time: newest * grid.interval });
        }
        // Casts stop at zero. One more, so that what is asked for a few steps after the end is there.
        let first = (first.floor() as usize).min(last);
        Ok([first, (newest.ceil() as usize + 1).clamp(first, last)])
    }

    /// Time (s) at which the air leaves that is alike all along the wind: at the start the first plane of
    /// `grid` stands at all places beyond `origin_x`, for no plane came before it. Zero for a record that
    /// repeats.
    pub fn blown_out(&self, grid: &PlaneGrid) -> f64 {
        let beyond = if grid.repeats { 0.0 } else { self.extent[1] - self.origin_x };
        beyond.max(0.0) / grid.speed
    }

    /// Memory that the wind of the planes takes (bytes); their temperature, where they have one, a third
    /// of it on top.
    ///
    /// # Errors
    /// As [`planes`](Self::planes).
    pub fn memory(&self, grid: &PlaneGrid) -> Result<u64, InflowError> {
        let [first, last] = self.planes(grid)?;
        let n_values = (last - first + 1).saturating_mul(grid.n_y.saturating_mul(grid.n_z));
        Ok(POINT_BYTES.saturating_mul(n_values as u64))
    }
}

impl RecordedInflow {
    /// `planes` as `entry` needs them, all of them read now; `progress` receives the share read, and gives
    /// false to break it off. What of the mean blows beyond the grid follows `profile`.
    ///
    /// # Errors
    /// [`InflowError`] when the grid makes no sense, the record ends too early, does not fit into memory or
    /// cannot be read, [`InflowError::BrokenOff`] after a break.
    pub fn read(
        mut planes: Box<dyn Planes>,
        entry: Entry,
        profile: MeanProfile,
        beyond: Beyond,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Self, InflowError> {
        let grid = planes.grid();
        grid.check()?;
        let [first, last] = entry.planes(&grid)?;
        let size = grid.n_y * grid.n_z;
        let n_held = last - first + 1;
        let refused = || InflowError::Memory {
            n_points: [n_held, grid.n_y, grid.n_z],
            memory: POINT_BYTES.saturating_mul(n_held.saturating_mul(size) as u64),
        };
        let mut held: Vec<[f32; 3]> = Vec::new();
        held.try_reserve_exact(n_held.saturating_mul(size)).map_err(|_| refused())?;
        let mut warm: Vec<f32> = Vec::new();
        let mut arriving = (vec![[0.0; 3]; size], vec![0.0; size]);
        let (mut sums, mut warm_sums) = (vec![[0.0_f64; 3]; grid.n_z], vec![0.0_f64; grid.n_z]);
        let mut has_temperature = true;
        // All of the record counts for its mean, so that a longer run has the same wind.
        for step in 0..grid.n_steps {
            if !progress(step as f64 / grid.n_steps as f64) {
                return Err(InflowError::BrokenOff);
            }
            let (wind, temperature) = &mut arriving;
            planes.read(step, wind)?;
            for (sum, row) in sums.iter_mut().zip(wind.chunks(grid.n_y)) {
                for wind in row {
                    (0..3).for_each(|axis| sum[axis] += f64::from(wind[axis]));
                }
            }
            has_temperature = has_temperature && planes.read_temperature(step, temperature)?;
            if has_temperature && step == 0 {
                warm.try_reserve_exact(n_held.saturating_mul(size)).map_err(|_| refused())?;
            }
            if has_temperature {
                for (sum, row) in warm_sums.iter_mut().zip(temperature.chunks(grid.n_y)) {
                    *sum += row.iter().copied().map(f64::from).sum::<f64>();
                }
            }
            if (first..=last).contains(&step) {
                held.extend_from_slice(wind);
                if has_temperature {
                    warm.extend_from_slice(temperature);
                }
            }
        }
        let per_value = 1.0 / (grid.n_steps * grid.n_y) as f64;
        let means = sums.iter().map(|sum| sum.map(|sum| (sum * per_value) as f32)).collect();
        let warm_means = warm_sums.iter().map(|sum| (sum * per_value) as f32).collect();
        let warmth = has_temperature.then_some(Warmth { means: warm_means, held: warm });
        let (origin_x, mean_share) = (entry.origin_x, 1.0);
        let aloft = None;
        Ok(Self { grid, profile, beyond, origin_x, mean_share, means, aloft, first, held, warmth })
    }

    /// The same; above the grid mean wind and temperature go on as `column` does, along x as the planes
    /// travel, from what they are at the highest row.
    pub fn with_column_aloft(self, column: MeanColumn) -> Self {
        Self { aloft: Some(column), ..self }
    }

    /// Whether its planes have temperature.
    pub fn has_temperature(&self) -> bool {
        self.warmth.is_some()
    }

    /// The same with `share` of the record's mean wind (–) and all of its fluctuations.
    pub fn with_share_of_mean(self, share: f64) -> Self {
        Self { mean_share: share, ..self }
    }

    /// Where the planes before and after the one that stands at `x` (m) at `time` (s) begin among the points
    /// held, and the share of the latter.
    fn planes(&self, x: f64, time: f64) -> ([usize; 2], f32) {
        let PlaneGrid { interval, speed, n_steps, repeats, .. } = self.grid;
        let place = (time - (x - self.origin_x) / speed) / interval;
        let count = place.floor();
        let held = |count: f64| {
            let step = if repeats {
                count.rem_euclid(n_steps as f64) as usize
            } else {
                // The cast stops at the first plane.
                (count as usize).min(n_steps - 1)
            };
            let size = self.grid.n_y * self.grid.n_z;
            step.saturating_sub(self.first).min(self.held.len() / size - 1) * size
        };
        ([held(count), held(count + 1.0)], (place - count) as f32)
    }

    /// What belongs to `height` (m).
    fn row(&self, height: f64) -> Row {
        let PlaneGrid { n_y, n_z, spacing, first, .. } = self.grid;
        let [low, high] = self.grid.up();
        let last = (n_z - 1) as f64;
        let place = (height - first[1]) / spacing[1];
        let inside = place.clamp(0.0, last);
        let below = inside.floor() as usize;
        let mut rows = [below, (below + 1).min(n_z - 1)];
        let mut weight = (inside - inside.floor()) as f32;
        let mean_of =
            |rows: [usize; 2], weight| between(self.means[rows[0]], self.means[rows[1]], weight);
        let edge = mean_of(rows, weight);
        let (mut factor, mut share, mut added) = (1.0, 1.0, [0.0; 3]);
        if place < 0.0 {
            factor = self.growth(low, height);
            share = factor;
        } else if place > last {
            match &self.aloft {
                Some(column) => {
                    let [edge, here] = [high, height].map(|height| column.at(height).wind);
                    (0..2).for_each(|axis| added[axis] = (here[axis] - edge[axis]) as f32);
                }
                None => factor = self.growth(high, height),
            }
            match self.beyond {
                Beyond::Hold => {}
                Beyond::Mean => share = fading(height - high, high - low, spacing[1]),
                Beyond::Repeat => {
                    let (below, above) = around(place, n_z);
                    (rows, weight) = ([below, (below + 1) % n_z], above);
                }
            }
        }
        let mean_share = self.mean_share as f32;
        Row {
            about: mean_of(rows, weight),
            mean: std::array::from_fn(|axis| mean_share * (factor * edge[axis] + added[axis])),
            share,
            starts: rows.map(|row| row * n_y),
            weight,
        }
    }

    /// Mean temperature of the row of `warmth` at `height` (m), that about which its points fluctuate, and
    /// the share of the fluctuations (–).
    fn warm_row(&self, warmth: &Warmth, height: f64) -> (Row, [f32; 3]) {
        let row = self.row(height);
        let [low, high] = self.grid.up();
        let n_y = self.grid.n_y;
        let [below, above] = row.starts.map(|start| warmth.means[start / n_y]);
        let about = below + row.weight * (above - below);
        let (edge, weight) = self.grid.rows_at(height);
        let [below, above] = edge.map(|row| warmth.means[row]);
        let mut mean = below + weight as f32 * (above - below);
        if height > high
            && let Some(column) = &self.aloft
        {
            mean += (column.at(height).temperature - column.at(high).temperature) as f32;
        }
        // Near the ground wind dies, and temperature does not.
        let share = if height < low { 1.0 } else { row.share };
        (row, [mean, about, share])
    }

    /// Mean wind at `height` over that at `edge` (m) as the profile has it (–).
    fn growth(&self, edge: f64, height: f64) -> f32 {
        let [there, here] = [edge, height].map(|height| self.profile.speed(height));
        if there > 0.0 { (here / there) as f32 } else { 1.0 }
    }

    /// Points to the right and the left of `y` (m), the share of the latter, and that of the fluctuations.
    fn columns(&self, y: f64) -> ([usize; 2], f32, f32) {
        let PlaneGrid { n_y, spacing, first, .. } = self.grid;
        let place = (y - first[0]) / spacing[0];
        let last = (n_y - 1) as f64;
        let outside = (-place).max(place - last).max(0.0) * spacing[0];
        if outside > 0.0 && self.beyond == Beyond::Repeat {
            let (right, weight) = around(place, n_y);
            return ([right, (right + 1) % n_y], weight, 1.0);
        }
        let inside = place.clamp(0.0, last);
        let right = inside.floor() as usize;
        let share = match self.beyond {
            Beyond::Mean => fading(outside, last * spacing[0], spacing[0]),
            Beyond::Hold | Beyond::Repeat => 1.0,
        };
        ([right, (right + 1).min(n_y - 1)], (inside - inside.floor()) as f32, share)
    }
}

/// What belongs to one height.
struct Row {
    /// Mean of the points that are read, about which they fluctuate (m/s).
    about: [f32; 3],
    /// Mean wind at this height (m/s).
    mean: [f32; 3],
    /// Share of the fluctuations (–).
    share: f32,
    /// First points of the rows below and above, with the share of the latter.
    starts: [usize; 2],
    weight: f32,
}

impl Row {
    /// What lies between the points `columns` of its rows, `left` of the way to the second, in the two of
    /// `planes`: `held` gives what a point holds, `mix` what lies between two of them.
    #[inline(always)]
    fn between<Value>(
        &self,
        ([before, after], late): &([usize; 2], f32),
        columns: [usize; 2],
        left: f32,
        held: impl Fn(usize) -> Value,
        mix: impl Fn(Value, Value, f32) -> Value,
    ) -> Value {
        let [before, after] = [before, after].map(|plane| {
            let [low, high] = self.starts.map(|row| {
                let [right, left_one] = columns.map(|column| held(plane + row + column));
                mix(right, left_one, left)
            });
            mix(low, high, self.weight)
        });
        mix(before, after, *late)
    }
}

/// Point at or before `place` (in spacings) on a grid that repeats after `n` points, and the share of the
/// next one.
fn around(place: f64, n: usize) -> (usize, f32) {
    let wrapped = place.rem_euclid(n as f64);
    let index = wrapped.floor();
    (index as usize % n, (wrapped - index) as f32)
}

/// Share of the fluctuations (–) that is left at `distance` (m) from the edge of a grid that is `wide` (m),
/// whose points stand `spacing` (m) apart.
fn fading(distance: f64, wide: f64, spacing: f64) -> f32 {
    (1.0 - distance.max(0.0) / (FADING * wide).max(spacing)).max(0.0) as f32
}

fn between(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]))
}

impl Inflow for RecordedInflow {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let wind = |planes: &([usize; 2], f32), row: &Row, y| {
            let (columns, left, share) = self.columns(y);
            let wind = row.between(planes, columns, left, |point| self.held[point], between);
            let share = share * row.share;
            let [u, v, w]: [f32; 3] =
                std::array::from_fn(|axis| row.mean[axis] + share * (wind[axis] - row.about[axis]));
            Vector3::new(f64::from(u), f64::from(v), f64::from(w))
        };
        walk(positions, velocities, |x| self.planes(x, time), |z| self.row(z), wind);
    }

    fn sample_temperature(
        &self,
        time: f64,
        positions: &[Vector3],
        temperatures: &mut [f64],
    ) -> bool {
        let Some(warmth) = &self.warmth else { return false };
        let single = |a: f32, b: f32, share: f32| a + share * (b - a);
        let warm = |planes: &([usize; 2], f32), row: &(Row, [f32; 3]), y| {
            let (columns, left, of_column) = self.columns(y);
            let (row, [mean, about, share]) = row;
            let found = row.between(planes, columns, left, |point| warmth.held[point], single);
            f64::from(mean + of_column * share * (found - about))
        };
        let row = |z| self.warm_row(warmth, z);
        walk(positions, temperatures, |x| self.planes(x, time), row, warm);
        true
    }
}

#[cfg(test)]
#[path = "recorded_tests.rs"]
mod tests;
