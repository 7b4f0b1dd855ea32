//! Planes of 16-bit integers, as TurbSim and Bladed write them, read one at a time.

use super::StoredBox;
use crate::FileError;
use flow::inflow::{InflowError, PlaneGrid, Planes, TurbulenceBox};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Where the integers are in a file, and what they mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    /// Grid in the farm frame.
    pub grid: PlaneGrid,
    /// Byte of the first plane's first value.
    pub start: u64,
    /// Bytes from one plane to the next: points of a tower may follow those of the grid.
    pub bytes_per_step: u64,
    /// Speed of the integer zero, for u, v, w (m/s).
    pub offsets: [f64; 3],
    /// Speed per integer, for u, v, w (m/s).
    pub scales: [f64; 3],
    /// Whether a row starts at the left end, looking downwind, instead of the right.
    pub from_left: bool,
}

/// Planes of 16-bit integers in a file; one of them is in memory.
#[derive(Debug)]
pub(super) struct PackedPlanes {
    file: File,
    path: PathBuf,
    what: &'static str,
    packing: Packing,
    bytes: Vec<u8>,
}

impl PackedPlanes {
    /// Planes in `file`, which stands at `path` and holds `what`.
    pub(super) fn new(file: File, path: &Path, what: &'static str, packing: Packing) -> Self {
        let bytes = vec![0; 6 * packing.grid.n_y * packing.grid.n_z];
        Self { file, path: path.to_owned(), what, packing, bytes }
    }

    fn decode(
        &mut self,
        step: usize,
        mut put: impl FnMut(usize, [f32; 3]),
    ) -> Result<(), FileError> {
        let Packing { grid, start, bytes_per_step, offsets, scales, from_left } = self.packing;
        let byte = start + step as u64 * bytes_per_step;
        self.file
            .seek(SeekFrom::Start(byte))
            .and_then(|_| self.file.read_exact(&mut self.bytes))
            .map_err(|source| FileError::system("read", self.what, &self.path, source))?;
        for (index, six) in self.bytes.chunks_exact(6).enumerate() {
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

    /// All planes as a box; the mean of u over time and width at each height goes to the mean speeds, so that the
    /// fluctuations have none; v and w keep theirs.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be read any more.
    pub(super) fn into_box(
        mut self,
        hub_height: f64,
        description: String,
    ) -> Result<StoredBox, FileError> {
        let grid = self.packing.grid;
        let (n_x, size) = (grid.n_steps, grid.n_y * grid.n_z);
        let mut velocity: [Vec<f32>; 3] = Default::default();
        for values in &mut velocity {
            values.try_reserve_exact(n_x * size).map_err(|_| {
                let problem =
                    format!("its {} bytes of wind do not fit into memory", 12 * n_x * size);
                FileError::content(self.what, &self.path, problem, "take a shorter record")
            })?;
            values.resize(n_x * size, 0.0);
        }
        for step in 0..n_x {
            let start = super::in_order_of_arrival(step, n_x) * size;
            self.decode(step, |point, wind| {
                for (values, value) in velocity.iter_mut().zip(wind) {
                    values[start + point] = value;
                }
            })?;
        }
        let mean_speeds = take_means(&mut velocity[0], grid.n_y, grid.n_z);
        let n_points = [n_x, grid.n_y, grid.n_z];
        let spacing = [grid.speed * grid.interval, grid.spacing[0], grid.spacing[1]];
        let turbulence = TurbulenceBox::new(n_points, spacing, velocity).map_err(|error| {
            FileError::content(self.what, &self.path, error.to_string(), "make the file again")
        })?;
        let (hub_speed, lowest_height) = (grid.speed, grid.first[1]);
        Ok(StoredBox { turbulence, hub_speed, hub_height, lowest_height, mean_speeds, description })
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

/// Takes the mean of each row off `values` (n_x × n_z × n_y) and gives it, lowest row first.
fn take_means(values: &mut [f32], n_y: usize, n_z: usize) -> Vec<f64> {
    let n_rows = values.len() / n_y;
    let mut means = vec![0.0; n_z];
    for (row, values) in values.chunks(n_y).enumerate() {
        means[row % n_z] += values.iter().map(|value| f64::from(*value)).sum::<f64>();
    }
    let points = (n_rows / n_z * n_y) as f64;
    means.iter_mut().for_each(|mean| *mean /= points);
    for (row, values) in values.chunks_mut(n_y).enumerate() {
        for value in values {
            *value = (f64::from(*value) - means[row % n_z]) as f32;
        }
    }
    means
}
