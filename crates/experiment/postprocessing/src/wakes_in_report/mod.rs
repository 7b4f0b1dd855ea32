//! Wakes of runs taken apart, as parts of a report: by phase, their energy, their modes and their budget.
//!
//! They are the figures of `wakemix analyse phases`, `vortices`, `entrainment`, `modes` and `budget`, of what
//! runs kept. What cannot be read, or would take long, is told on the page; it withholds nothing else.

mod budget;
mod by_phase;
mod energy;
mod kept;
#[cfg(feature = "modes")]
mod modes;

use crate::PostprocessingError;
use budget::Budgets;
use by_phase::ByPhase;
use energy::Energies;
use formats::records::{RunFolder, StudyRecords};
use kept::{Kept, Run};
use report::Signals;
use std::path::Path;

/// All parts of the report of the study in `directory` that are about wakes taken apart; `records` are its
/// own. None where no run kept averages by phase, planes at instants or volumes.
///
/// # Errors
/// [`PostprocessingError::File`] for a folder that cannot be read.
pub(crate) fn of_study(
    records: &StudyRecords,
    directory: &Path,
) -> Result<Vec<Signals>, PostprocessingError> {
    let summaries: Vec<_> = records.runs.iter().map(|run| &run.summary).collect();
    let colours = report::colours(&summaries);
    let (mut phases, mut energies) = (ByPhase::default(), Energies::default());
    let mut budgets = Budgets::default();
    let mut parts = Vec::new();
    for (records, colour) in records.runs.iter().zip(colours) {
        let folder = RunFolder::new(directory, &records.manifest.run);
        let run = Run { summary: &records.summary, colour, folder, study: directory };
        for path in run.folder.phase_averages_paths()? {
            match Kept::of(&run, &path) {
                Ok(kept) => look(&run, kept, &mut phases, &mut energies, &mut budgets),
                Err(note) => phases.notes.push(note),
            }
        }
        if !records.volume_paths.is_empty() {
            budgets.add_instants(&run);
        }
        #[cfg(feature = "modes")]
        parts.extend(modes::of_run(&run, records));
    }
    let shown = [phases.signals(), energies.signals(), budgets.signals()];
    let is_empty =
        |part: &Signals| part.maps.is_empty() && part.tracks.is_empty() && part.notes.is_empty();
    let mut all: Vec<Signals> = shown.into_iter().filter(|part| !is_empty(part)).collect();
    all.append(&mut parts);
    Ok(all)
}

/// Has all parts take what they show of `kept`.
fn look(
    run: &Run,
    kept: Kept,
    phases: &mut ByPhase,
    energies: &mut Energies,
    budgets: &mut Budgets,
) {
    phases.add_samples(run, &kept);
    energies.add(run, &kept);
    if kept.averaged.grid().spanned().len() == 3 {
        budgets.add_averages(run, &kept);
    }
    if kept.averaged.grid().n_points[0] > 1 {
        phases.add_wake(run, kept);
    }
}
