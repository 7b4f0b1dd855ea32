//! Planes of 16-bit integers, as TurbSim and Bladed write them, read one at a time.

use super::blocks::Blocks;
use super::source::{Outline, Source, each_plane};
use crate::FileError;
use flow::inflow::{InflowError, PlaneGrid, Planes};
use std::fs::File;
use std::path::Path;

/// Where the integers are in a file, and what they mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    /// Grid in the farm frame.
    pub grid: PlaneGrid,
    /// Byte of the first plane's first value.
    pub start: u64,
    /// Bytes from one plane to the next: points of a tower may follow those of the grid.
    pub bytes_per_step: usize,
    /// Speed of the integer zero, for u, v, w (m/s).
    pub offsets: [f64; 3],
    /// Speed per integer, for u, v, w (m/s).
    pub scales: [f64; 3],
    /// Whether a row starts at the left end, looking downwind, instead of the right.
    pub from_left: bool,
}

/// Planes of 16-bit integers in a file; a block of them is in memory.
#[derive(Debug)]
pub(super) struct PackedPlanes {
    planes: Blocks,
    packing: Packing,
}

impl PackedPlanes {
    /// Planes in `file`, which stands at `path` and holds `what`.
    pub(super) fn new(file: File, path: &Path, what: &'static str, packing: Packing) -> Self {
        let Packing { grid, start, bytes_per_step, .. } = packing;
        let planes = Blocks::new(file, path, what, start, bytes_per_step, grid.n_steps);
        Self { planes, packing }
    }

    fn decode(
        &mut self,
        step: usize,
        mut put: impl FnMut(usize, [f32; 3]),
    ) -> Result<(), FileError> {
        let Packing { grid, offsets, scales, from_left, .. } = self.packing;
        let bytes = self.planes.plane(step)?;
        for (index, six) in bytes.chunks_exact(6).take(grid.n_y * grid.n_z).enumerate() {
            let value = |component: usize| {
                let two = [six[2 * component], six[2 * component + 1]];
                (offsets[component] + scales[component] * f64::from(i16::from_le_bytes(two))) as f32
            };
            let (row, column) = (index / grid.n_y, index % grid.n_y);
            let y = if from_left { grid.n_y - 1 - column } else { column };
            put(row * grid.n_y + y, [value(0), value(1), value(2)]);
        }
        Ok(())
    }

    /// The planes as those of a box; the mean of u over time and width at each height, for which all of them
    /// are read once, goes to the mean speeds, so that the fluctuations have none; v and w keep theirs.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be read any more.
    pub(super) fn into_source(
        self,
        hub_height: f64,
        description: String,
    ) -> Result<PackedSource, FileError> {
        let grid = self.packing.grid;
        let mut means = vec![0.0; grid.n_z];
        let outline = Outline {
            n_points: [grid.n_steps, grid.n_y, grid.n_z],
            spacing: [grid.speed * grid.interval, grid.spacing[0], grid.spacing[1]],
            hub_speed: grid.speed,
            hub_height,
            lowest_height: grid.first[1],
            mean_speeds: means.clone(),
            description,
            // Whoever asks for a box takes what the file holds for one.
            repeats: true,
        };
        let velocity = std::array::from_fn(|_| vec![0.0; grid.n_y * grid.n_z]);
        let mut source = PackedSource { planes: self, outline, velocity };
        // As long as the mean speeds are zero, u is the wind itself.
        each_plane(&mut source, |[u, ..]| {
            for (mean, row) in means.iter_mut().zip(u.chunks(grid.n_y)) {
                *mean += row.iter().map(|value| f64::from(*value)).sum::<f64>();
            }
        })?;
        let points = (grid.n_steps * grid.n_y) as f64;
        means.iter_mut().for_each(|mean| *mean /= points);
        source.outline.mean_speeds = means;
        Ok(source)
    }
}

impl Planes for PackedPlanes {
    fn grid(&self) -> PlaneGrid {
        self.packing.grid
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        self.decode(step, |point, wind| values[point] = wind)
            .map_err(|error| super::plane_error(step, &error))
    }
}

/// The box that planes of 16-bit integers are.
pub(super) struct PackedSource {
    planes: PackedPlanes,
    outline: Outline,
    /// Fluctuations u, v, w (m/s) on the plane that was asked for.
    velocity: [Vec<f32>; 3],
}

impl Source for PackedSource {
    fn outline(&self) -> Outline {
        self.outline.clone()
    }

    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError> {
        let Self { planes, outline, velocity } = self;
        let [n_x, n_y, _] = outline.n_points;
        planes.decode(super::in_order_of_arrival(x, n_x), |point, wind| {
            for (values, value) in velocity.iter_mut().zip(wind) {
                values[point] = value;
            }
        })?;
        for (row, mean) in velocity[0].chunks_mut(n_y).zip(&outline.mean_speeds) {
            for value in row {
                *value = (f64::from(*value) - mean) as f32;
            }
        }
        Ok(velocity.each_ref().map(Vec::as_slice))
    }
}
