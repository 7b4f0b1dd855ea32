//! What a prepared study will cost, known before it starts.

use crate::StudyError;
use crate::prepared::Prepared;
use crate::probes::Probes;
use crate::simulate::VOLUME_STRIDE;
use crate::turbulence;
use crate::warnings::wall_gain;
use crate::watcher::Estimate;

/// Channels of a turbine with three blades, about (–).
const CHANNELS_PER_TURBINE: u64 = 40;
/// Bytes of a value in `series.csv`, about.
const SERIES_VALUE_BYTES: u64 = 19;
/// Bytes of a cell in the flow field, boundaries included.
const CELL_BYTES: u64 = 80;

impl Prepared {
    /// The cost of `n_runs` runs and of `probes` before them, the machine's speed not known yet.
    pub(crate) fn estimate(&self, n_runs: usize, probes: &Probes) -> Estimate {
        let plan = &self.plan;
        let costs = probes.costs();
        let channels = 4 + CHANNELS_PER_TURBINE * self.case.turbines.len() as u64;
        let n_rows = plan.n_steps / plan.row_stride;
        let field = plan.cells() as u64 * CELL_BYTES;
        Estimate {
            n_runs,
            n_probes: costs.len(),
            n_probe_steps: costs.iter().map(|cost| cost.n_steps).sum(),
            probe_work: costs.iter().map(|cost| cost.work).sum(),
            n_cells: plan.n_cells,
            spacing: plan.spacing,
            interval: plan.interval,
            n_steps: plan.n_steps,
            memory: field + turbulence::memory(&self.case, plan, &self.models),
            // A new checkpoint stands beside the old one until it is complete.
            disk: 2 * field + channels * n_rows * SERIES_VALUE_BYTES + self.pictures(),
            updates_per_second: None,
            blockage: plan.blockage,
            wall_gain: wall_gain(plan.blockage),
            lattice_speed: plan.lattice_speed,
        }
    }

    /// Planes and volumes of one run (bytes).
    fn pictures(&self) -> u64 {
        const POINT_BYTES: u64 = 3 * size_of::<f32>() as u64;
        let (plan, output) = (&self.plan, &self.case.output);
        let [n_x, n_y, n_z] = plan.n_cells.map(|n| n as u64);
        let n_across = output.crosswind_diameters.len() as u64;
        let planes = (n_x * n_y + n_x * n_z + n_across * n_y * n_z) * POINT_BYTES;
        let volume = plan.cells() as u64 * POINT_BYTES / VOLUME_STRIDE.pow(3) as u64;
        let analysed = self.case.time.duration - self.case.time.spin_up;
        let times = |every: Option<f64>| every.map_or(0, |every| (analysed / every) as u64 + 1);
        // The averages, then those of single instants.
        planes * (1 + times(output.plane_interval)) + volume * times(output.volume_interval)
    }
}

/// Whether this machine's free memory carries `estimate`; passes where the system does not tell.
///
/// # Errors
/// [`StudyError::Memory`].
pub(crate) fn check_memory(estimate: &Estimate) -> Result<(), StudyError> {
    const GIB: f64 = 1024.0 * 1024.0 * 1024.0;
    let needed = estimate.memory as f64 / GIB;
    match formats::machine::free_memory() {
        Some(free) if (free as f64) < estimate.memory as f64 => {
            Err(StudyError::Memory { needed, available: free as f64 / GIB })
        }
        _ => Ok(()),
    }
}
