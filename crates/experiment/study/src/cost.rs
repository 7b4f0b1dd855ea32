//! What a prepared study will cost, known before it starts.

use crate::StudyError;
use crate::observer::Estimate;
use crate::outputs::Outputs;
use crate::pitch_identification::PitchIdentifications;
use crate::prepared::Prepared;
use crate::warnings::wall_gain;

impl Prepared {
    /// The cost of `n_runs` runs with their `outputs`, and of `identifications` before them; the machine's
    /// speed is not known yet.
    pub(crate) fn estimate(
        &self,
        n_runs: usize,
        identifications: &PitchIdentifications,
        outputs: &Outputs,
    ) -> Estimate {
        let plan = &self.plan;
        let costs = identifications.costs();
        let field = (self.case.flow.solver.memory)(plan);
        let turbulence = farm::wind::turbulence(&self.site());
        Estimate {
            n_runs,
            n_identifications: costs.len(),
            n_identification_steps: costs.iter().map(|cost| cost.n_steps).sum(),
            identification_work: costs.iter().map(|cost| cost.work).sum(),
            n_cells: plan.n_cells,
            spacing: plan.spacing,
            interval: plan.interval,
            n_steps: plan.n_steps,
            memory: field + turbulence.map_or(0, |turbulence| turbulence.memory),
            // A new checkpoint stands beside the old one until it is complete.
            disk: 2 * field + outputs.disk(self),
            updates_per_second: None,
            blockage: plan.blockage,
            wall_gain: wall_gain(plan.blockage),
            lattice_speed: plan.lattice_speed,
        }
    }
}

/// Whether this machine's free memory carries `estimate`; passes where the system does not report it.
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
