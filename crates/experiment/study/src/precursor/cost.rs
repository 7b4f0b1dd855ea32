//! What a precursor will cost, known before it starts.

use super::error::PrecursorError;
use super::levels::OF_LEVELS;
use farm::precursor::{Precursor, PrecursorPlan};
use flow::FlowSolver;
use flow::lattice::Lattice;
use formats::machine;
use formats::records::PrecursorFolder;
use std::time::{Duration, Instant};

/// Bytes of a cell with its temperature, boundaries included.
const CELL_BYTES: u64 = 146;
/// What the viscosity of eddies takes besides, where it follows from the wind of neighbours.
const EDDY_BYTES: u64 = 4;
/// Bytes of a point of a plane: three components as they come, which stay for a longer record, three of the
/// full field, and a temperature.
const POINT_BYTES: u64 = (3 * (size_of::<f32>() + size_of::<i16>()) + size_of::<f32>()) as u64;
/// Bytes that a level takes in a record of statistics, in the file and in each checkpoint.
const LEVEL_BYTES: u64 = (OF_LEVELS.len() * size_of::<f64>()) as u64;
/// Most cells of a trial along x and y (–), and how long it takes.
const TRIAL_CELLS: usize = 64;
const TRIAL: Duration = Duration::from_millis(300);
/// Bytes of what is told as a GB, and as a GiB.
const GB: f64 = 1e9;
const GIB: f64 = 1024.0 * 1024.0 * 1024.0;

/// What a precursor will cost.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecursorEstimate {
    /// Cells, steps and planes.
    pub plan: PrecursorPlan,
    /// Memory (bytes).
    pub memory: u64,
    /// Disk that it takes at most at any time (bytes).
    pub disk: u64,
    /// How much of that are the planes in `planes.bts` (bytes).
    pub planes: u64,
    /// Cell updates a second (1/s), measured on this machine in a small box of the same air.
    pub updates_per_second: f64,
}

impl PrecursorEstimate {
    /// That of `precursor`, laid out as `plan`.
    ///
    /// # Errors
    /// [`PrecursorError`] for air that cannot be set up, or that breaks down at once.
    pub(super) fn new(precursor: &Precursor, plan: &PrecursorPlan) -> Result<Self, PrecursorError> {
        let memory = memory(precursor, plan);
        let points = (plan.grid.n_y * plan.grid.n_z) as u64;
        let recorded = points.saturating_mul(plan.grid.n_steps as u64);
        let statistics = (plan.n_statistics() * plan.n_cells[2] as u64).saturating_mul(LEVEL_BYTES);
        // A new checkpoint stands beside the old one until it is whole.
        let checkpoints = 2 * memory.saturating_add(statistics);
        Ok(Self {
            plan: *plan,
            memory,
            disk: recorded.saturating_mul(POINT_BYTES) + checkpoints + statistics,
            planes: recorded.saturating_mul(3 * size_of::<i16>() as u64),
            updates_per_second: updates_per_second(precursor, plan)?,
        })
    }

    /// Wall time of all of it (s).
    pub fn wall_time(&self) -> f64 {
        self.plan.updates() / self.updates_per_second
    }

    /// Whether memory and disk of this machine carry it, with what stands in `folder` already; passes where
    /// the system does not tell.
    ///
    /// # Errors
    /// [`PrecursorError::Memory`], [`PrecursorError::Disk`].
    pub(super) fn check(&self, folder: &PrecursorFolder) -> Result<(), PrecursorError> {
        if let Some(free) = machine::free_memory().filter(|free| *free < self.memory) {
            let [needed, available] = [self.memory, free].map(|bytes| bytes as f64 / GIB);
            return Err(PrecursorError::Memory { needed, available });
        }
        let own = machine::size_of_folder(folder.path());
        let free = machine::free_disk(folder.path()).map(|free| free.saturating_add(own));
        match free.filter(|free| *free < self.disk) {
            None => Ok(()),
            Some(free) => {
                let [needed, available] = [self.disk, free].map(|bytes| bytes as f64 / GB);
                let directory = folder.path().to_owned();
                Err(PrecursorError::Disk { needed, available, directory })
            }
        }
    }
}

/// Memory of the box of `precursor`, laid out as `plan` (bytes).
pub(crate) fn memory(precursor: &Precursor, plan: &PrecursorPlan) -> u64 {
    let of_eddies = if precursor.domain.subgrid.needs_neighbours() { EDDY_BYTES } else { 0 };
    plan.cells() as u64 * (CELL_BYTES + of_eddies)
}

/// Cell updates a second (1/s) in a part of the box.
fn updates_per_second(precursor: &Precursor, plan: &PrecursorPlan) -> Result<f64, PrecursorError> {
    let mut settings = precursor.settings(plan);
    let [n_x, n_y, n_z] = plan.n_cells;
    settings.n_cells = [n_x.min(TRIAL_CELLS), n_y.min(TRIAL_CELLS), n_z];
    let (n_cells, step) = (settings.cells() as f64, settings.interval);
    let mut air = Lattice::new(settings, precursor.start())?;
    let advance = |air: &mut Lattice| {
        air.advance(step, &[]).map_err(|source| PrecursorError::Diverged {
            source: Box::new(source),
            checkpoint: None,
            statistics: None,
        })
    };
    // The first step touches memory for the first time.
    advance(&mut air)?;
    let (started, mut n_steps) = (Instant::now(), 0);
    while n_steps < 2 || started.elapsed() < TRIAL {
        advance(&mut air)?;
        n_steps += 1;
    }
    Ok(n_cells * f64::from(n_steps) / started.elapsed().as_secs_f64())
}
