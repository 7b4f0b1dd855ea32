//! Sums of particles in cells that overlap, as particles come.

use super::Binned;
use super::result::CellSums;
use basis::records::Grid;
use thiserror::Error;

/// Length of the Gaussian weight's standard deviation over the edge of a cell (–): it has fallen to e⁻² at
/// the faces.
const DEVIATION: f64 = 0.25;

/// Why there are no cells.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ParticleError {
    /// A cell or an overlap that cannot be.
    #[error(
        "cells of {size} m that overlap by {overlap}: give a size above 0 m and an overlap from 0 to below 1"
    )]
    Cells {
        /// Edge (m).
        size: f64,
        /// Share of a cell that the next one shares (–).
        overlap: f64,
    },
    /// Bounds between which there is no cell.
    #[error(
        "from {low} m to {high} m along {axis} there is no room for cells; give bounds that grow"
    )]
    Bounds {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Lower bound (m).
        low: f64,
        /// Upper bound (m).
        high: f64,
    },
    /// More cells than can be summed.
    #[error(
        "{n_cells} cells take {memory} bytes, of which {most} are allowed; choose larger cells or less overlap"
    )]
    TooMany {
        /// Cells (–).
        n_cells: f64,
        /// Memory (bytes).
        memory: f64,
        /// Most (bytes).
        most: u64,
    },
}

/// Cells that overlap, as a grid of their middles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cells {
    /// Their middles.
    pub grid: Grid,
    /// Edge of a cell (m).
    pub size: f64,
}

impl Cells {
    /// Cells with edges of `size` (m), each of which shares `overlap` (–) of its length with the next, with
    /// middles from the lower to the upper of `bounds` (m) along each axis; where both are one, one cell. At
    /// most `most` bytes of sums.
    ///
    /// # Errors
    /// [`ParticleError`].
    pub fn new(
        bounds: [[f64; 2]; 3],
        size: f64,
        overlap: f64,
        most: u64,
    ) -> Result<Self, ParticleError> {
        if !(size > 0.0 && size.is_finite() && (0.0..1.0).contains(&overlap)) {
            return Err(ParticleError::Cells { size, overlap });
        }
        let spacing = size * (1.0 - overlap);
        let mut grid = Grid { origin: [0.0; 3], spacing: [spacing; 3], n_points: [1; 3] };
        let mut n_cells = 1.0;
        for (axis, [low, high]) in bounds.into_iter().enumerate() {
            if !(low <= high && low.is_finite() && high.is_finite()) {
                let axis = ["x", "y", "z"][axis];
                return Err(ParticleError::Bounds { axis, low, high });
            }
            let n = ((high - low) / spacing * (1.0 + 1e-12)).floor() + 1.0;
            n_cells *= n;
            grid.origin[axis] = low;
            grid.n_points[axis] = n as usize;
        }
        let memory = n_cells * size_of::<CellSums>() as f64;
        if memory > most as f64 {
            return Err(ParticleError::TooMany { n_cells, memory, most });
        }
        Ok(Self { grid, size })
    }

    /// Memory that sums take in the cells (bytes).
    pub fn memory(&self) -> u64 {
        self.grid.len() as u64 * size_of::<CellSums>() as u64
    }
}

/// What became of the particles so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// In a cell at least.
    pub kept: u64,
    /// In none.
    pub outside: u64,
    /// With a position or a velocity that is no number.
    pub not_finite: u64,
    /// Refused as outliers.
    pub outliers: u64,
}

/// Sums of particles in cells.
#[derive(Clone, Debug)]
pub struct Binner {
    cells: Cells,
    sums: Vec<CellSums>,
    taken: Taken,
}

impl Binner {
    /// Nothing taken in yet.
    pub fn new(cells: Cells) -> Self {
        Self { sums: vec![CellSums::default(); cells.grid.len()], cells, taken: Taken::default() }
    }

    /// What became of the particles so far.
    pub fn taken(&self) -> Taken {
        self.taken
    }

    /// The cells.
    pub fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Counts a particle that was found to be an outlier.
    pub fn refuse(&mut self) {
        self.taken.outliers += 1;
    }

    /// Takes in a particle at `position` (m) with `velocity` (m/s); allocates nothing.
    pub fn add(&mut self, position: [f64; 3], velocity: [f64; 3]) {
        if position.iter().chain(&velocity).any(|value| !value.is_finite()) {
            self.taken.not_finite += 1;
            return;
        }
        let Cells { grid, size } = self.cells;
        let half = 0.5 * size;
        let mut ranges = [[0_usize; 2]; 3];
        for axis in 0..3 {
            let from = (position[axis] - half - grid.origin[axis]) / grid.spacing[axis];
            let to = (position[axis] + half - grid.origin[axis]) / grid.spacing[axis];
            let last = grid.n_points[axis] as f64 - 1.0;
            let (from, to) = (from.ceil().max(0.0), to.floor().min(last));
            if from > to {
                self.taken.outside += 1;
                return;
            }
            ranges[axis] = [from as usize, to as usize];
        }
        let [x, y, z] = ranges;
        for k in z[0]..=z[1] {
            for j in y[0]..=y[1] {
                for i in x[0]..=x[1] {
                    let middle = grid.position([i, j, k]);
                    let away = std::array::from_fn(|a| (position[a] - middle[a]) / half);
                    self.sums[grid.index([i, j, k])].add(weight(away), away, velocity);
                }
            }
        }
        self.taken.kept += 1;
    }

    /// What the cells hold, those with fewer than `least` particles left out.
    pub fn binned(&self, least: u32) -> Binned {
        Binned::of(&self.cells, &self.sums, least)
    }
}

/// Weight of a particle that is `away` (half edges) from the middle of a cell.
fn weight(away: [f64; 3]) -> f64 {
    let square: f64 = away.iter().map(|part| part * part).sum();
    // Half an edge over the standard deviation.
    let scale = 0.5 / DEVIATION;
    (-0.5 * square * scale * scale).exp()
}
