//! What a prepared study will cost, known before it starts.

use crate::StudyError;
use crate::observer::Estimate;
use crate::outputs::{Outputs, outb, phase_averages, series, volumes, wind_slices};
use crate::prepared::Prepared;
use farm::case::Solver;
use farm::pitch_response::IdentificationCost;
use formats::machine;
use formats::records::RunFolder;
use std::path::Path;

/// Bytes of the state of a turbine and its controller in a checkpoint, at most about.
const TURBINE_STATE: u64 = 32 << 10;
/// Bytes of a run's summary and manifest, text of case and turbines aside: of each turbine, and of the rest.
const SUMMARY_OF_TURBINE: u64 = 12 << 10;
const SUMMARY_OF_RUN: u64 = 4 << 10;
/// Bytes of a study's report with its figures, about.
const REPORT: u64 = 4 << 20;
/// Bytes of what is told as a GB, and as a GiB.
const GB: f64 = 1e9;
const GIB: f64 = 1024.0 * 1024.0 * 1024.0;

impl Prepared {
    /// Channels in the series of run number `index` (–).
    pub fn channels_of_run(&self, index: usize) -> u64 {
        series::n_channels(self, &self.case.runs[index])
    }

    /// Disk (bytes) that a row of the series of run number `index` takes, that in the `.outb` of its turbines
    /// included.
    pub fn row_of_run(&self, index: usize) -> u64 {
        let run = &self.case.runs[index];
        series::row_bytes(self, run) + outb::row_bytes(self, run)
    }

    /// Disk (bytes) that run number `index` with its `outputs` takes at most at any time: what it leaves, and
    /// what it needs on the way.
    pub fn disk_of_run(&self, index: usize, outputs: &Outputs) -> u64 {
        let run = &self.case.runs[index];
        let n_turbines = run.present().count() as u64;
        let texts = self.turbine_texts.values().map(String::len).sum::<usize>();
        let records = (self.case_text.len() + texts) as u64
            + SUMMARY_OF_RUN
            + n_turbines * SUMMARY_OF_TURBINE;
        self.checkpoints_of_run(index) + outputs.disk_of_run(self, run) + records
    }

    /// Bytes of the checkpoints of run number `index`: a new one stands beside the old one until it is
    /// whole.
    fn checkpoints_of_run(&self, index: usize) -> u64 {
        2 * self.checkpoint_of_run(index)
    }

    /// Bytes of one checkpoint of run number `index`.
    fn checkpoint_of_run(&self, index: usize) -> u64 {
        let n_turbines = self.case.runs[index].present().count() as u64;
        (self.case.flow.solver.memory)(&self.case, &self.plan)
            + self.memory_beside
            + n_turbines * TURBINE_STATE
    }

    /// Bytes of the checkpoint that run number `index` keeps when it is complete.
    fn kept_checkpoint(&self, index: usize) -> u64 {
        if self.case.output.keeps_checkpoint { self.checkpoint_of_run(index) } else { 0 }
    }

    /// The cost of the `open` runs (their places in the case) with their `outputs`, and of the
    /// identifications before them, which cost `costs`; the machine's speed is not known yet.
    pub(crate) fn estimate(
        &self,
        open: &[usize],
        costs: &[IdentificationCost],
        outputs: &Outputs,
    ) -> Estimate {
        let plan = &self.plan;
        let field = (self.case.flow.solver.memory)(&self.case, plan);
        let made = farm::wind::turbulence(&self.site()).map(|turbulence| turbulence.memory);
        let turbulence = made.or(self.recorded.map(|recorded| recorded.memory));
        let checkpoints = || open.iter().map(|&index| self.checkpoints_of_run(index));
        let disks = || open.iter().map(|&index| self.disk_of_run(index, outputs));
        let kept = || open.iter().map(|&index| self.kept_checkpoint(index));
        // What goes again, of one run at a time.
        let passing = checkpoints().zip(kept()).map(|(all, kept)| all - kept).max().unwrap_or(0);
        Estimate {
            n_runs: open.len(),
            n_identifications: costs.len(),
            n_identification_steps: costs.iter().map(|cost| cost.n_steps).sum(),
            identification_work: costs.iter().map(|cost| cost.work).sum(),
            n_cells: plan.n_cells,
            spacing: plan.spacing,
            grids: plan.grids(),
            updates: plan.effort().until(plan.n_steps),
            interval: plan.interval,
            n_steps: plan.n_steps,
            memory: field
                + turbulence.unwrap_or(0)
                + self.memory_beside
                + volumes::memory(self)
                + phase_averages::memory(self)
                + wind_slices::memory(self),
            disk: disks().max().unwrap_or(0),
            n_rows: series::n_rows(self),
            row: open.iter().map(|&index| self.row_of_run(index)).max().unwrap_or(0),
            disk_in_all: disks().sum::<u64>() - checkpoints().sum::<u64>()
                + kept().sum::<u64>()
                + passing
                + REPORT,
            kept_checkpoints: kept().sum(),
            passing_checkpoint: passing,
            n_studies: 1,
            n_jobs: 1,
            work: open.len() as f64 * plan.effort().until(plan.n_steps),
            n_steps_in_all: open.len() as u64 * plan.n_steps,
            updates_per_second: None,
            blockage: plan.blockage,
            wall_gain: farm::wind::wall_gain(&self.case, plan),
            lattice_speed: plan.lattice_speed,
        }
    }
}

/// The cost of several studies, whose estimates are `of_studies`, with `n_jobs` runs at a time; one at least.
pub(crate) fn together(of_studies: &[Estimate], n_jobs: usize) -> Estimate {
    let sum = |part: fn(&Estimate) -> u64| of_studies.iter().map(part).sum::<u64>();
    let most = |part: fn(&Estimate) -> u64| of_studies.iter().map(part).max().unwrap_or(0);
    let speeds = of_studies.iter().filter_map(|estimate| estimate.updates_per_second);
    let first = &of_studies[0];
    // Each reckons with one run under way; so many are at a time, and one report is over all.
    let passing = (n_jobs as u64 - 1) * most(|estimate| estimate.passing_checkpoint);
    Estimate {
        n_runs: of_studies.iter().map(|estimate| estimate.n_runs).sum(),
        n_studies: of_studies.len(),
        n_jobs,
        work: of_studies.iter().map(|estimate| estimate.work).sum(),
        n_steps_in_all: sum(|estimate| estimate.n_steps_in_all),
        memory: n_jobs as u64 * most(|estimate| estimate.memory),
        disk: most(|estimate| estimate.disk),
        n_rows: most(|estimate| estimate.n_rows),
        row: most(|estimate| estimate.row),
        disk_in_all: sum(|estimate| estimate.disk_in_all) + passing,
        kept_checkpoints: sum(|estimate| estimate.kept_checkpoints),
        updates_per_second: speeds.reduce(f64::min),
        ..first.clone()
    }
}

/// Whether this machine's free memory carries `estimate` of a study in the air of `solver`; passes where the
/// system does not report it.
///
/// # Errors
/// [`StudyError::Memory`].
pub(crate) fn check_memory(estimate: &Estimate, solver: Solver) -> Result<(), StudyError> {
    let needed = estimate.memory as f64 / GIB;
    match machine::free_memory() {
        Some(free) if (free as f64) < estimate.memory as f64 => {
            let (available, fix) = (free as f64 / GIB, solver.less_memory);
            Err(StudyError::Memory { needed, available, fix })
        }
        _ => Ok(()),
    }
}

/// Whether the disk of `directory` carries `estimate`, what is in the `folders` of the runs to be made
/// included; passes where the system does not tell.
///
/// # Errors
/// [`StudyError::Disk`].
pub(crate) fn check_disk<'a>(
    estimate: &Estimate,
    directory: &Path,
    folders: impl Iterator<Item = &'a RunFolder>,
) -> Result<(), StudyError> {
    let Some(free) = machine::free_disk(directory) else { return Ok(()) };
    let own: u64 = folders.map(|folder| machine::size_of_folder(folder.path())).sum();
    is_enough(estimate.disk_in_all, free.saturating_add(own), directory)
}

/// Whether `available` bytes for `directory` are as many as `needed`.
fn is_enough(needed: u64, available: u64, directory: &Path) -> Result<(), StudyError> {
    if needed <= available {
        return Ok(());
    }
    let [needed, available] = [needed, available].map(|bytes| bytes as f64 / GB);
    Err(StudyError::Disk { needed, available, directory: directory.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_that_is_too_small_is_told_with_both_numbers() {
        let folder = Path::new("runs/long");
        assert!(is_enough(7, 7, folder).is_ok());
        let error = is_enough(7_300_000_000, 2_040_000_000, folder).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the study needs up to 7.3 GB of disk, 2.0 GB are free for runs/long"
        );
        let help = miette::Diagnostic::help(&error).expect("a fix").to_string();
        assert!(help.contains("-o") && help.contains("output.interval"), "{help}");
    }
}
