//! What a study of phase synchronisation has to show: its records made into the data of the report's figures.
//!
//! The figures are those of van Vondelen et al. (2025): estimates beside the truth (their Figs. 10, 11), the answer to the
//! pitch (12, 13), power and loads over the offset (14, 15), the wake (16, 17).

mod offsets;
mod tracks;
mod wake;

use crate::StudyError;
use crate::phase::{PhaseAnswer, PhaseQuestion, phase};
use analysis::phase::Reference;
use basis::angle::wrap_to_turn;
use control::excitation_rate;
use farm::case::{Case, Control, PhaseSync};
use formats::case;
use formats::records::{RunFolder, StudyRecords};
use report::Synchronisation;
use std::path::Path;

/// One run in which a turbine joins a helix, or watches for one.
struct Joined {
    /// Place among the study's runs.
    run: usize,
    /// Name of the run.
    name: String,
    sync: PhaseSync,
    /// Estimate against truth, where a run without the turbine tells the truth.
    answer: Option<PhaseAnswer>,
}

impl Joined {
    /// Lead of the pitch over the wind (rad, [0, 2π)); none where the turbine only watches.
    fn offset(&self) -> Option<f64> {
        (self.sync.amplitude > 0.0).then(|| wrap_to_turn(self.sync.offset))
    }
}

/// A study in which turbine number `turbine` joins a helix.
struct Synchronised<'a> {
    case: &'a Case,
    records: &'a StudyRecords,
    runs: Vec<Joined>,
    turbine: usize,
    reference: Reference,
    /// Rotor diameter of the first turbine (m).
    diameter: f64,
}

/// The data of the figures, and the lines of the table of phases; nothing where no turbine joins a helix.
///
/// # Errors
/// [`StudyError`] for records that cannot be analysed.
pub(crate) fn synchronisation(
    directory: &Path,
    records: &StudyRecords,
) -> Result<Option<Synchronisation>, StudyError> {
    let case = case::parse("the manifest's case", &records.case_text, &[])?;
    let joins = |index: usize| {
        let control = case.runs.get(index).map(|run| run.control.as_slice()).unwrap_or_default();
        control.iter().enumerate().find_map(|(turbine, control)| match control {
            Control::PhaseSync(sync) => Some((turbine, *sync)),
            _ => None,
        })
    };
    let mut runs = Vec::new();
    let mut found = None;
    for (place, run) in records.runs.iter().enumerate() {
        let Some((turbine, sync)) = joins(run.manifest.run_index) else { continue };
        if *found.get_or_insert(turbine) != turbine {
            continue;
        }
        let name = run.manifest.run.clone();
        let folder = RunFolder::new(directory, &name).path().to_owned();
        let answer = match phase(&PhaseQuestion { run: folder, ..PhaseQuestion::default() }) {
            Ok(answer) => Some(answer),
            // Without a true wind there is nothing to compare with; a short run says nothing of phases.
            Err(StudyError::NoTruth { .. } | StudyError::Analysis(_)) => None,
            Err(error) => return Err(error),
        };
        runs.push(Joined { run: place, name, sync, answer });
    }
    let (Some(turbine), Some(first)) = (found, runs.first()) else { return Ok(None) };
    let diameter = records.runs[first.run].summary.conditions.rotor_diameter;
    let rate = excitation_rate(first.sync.strouhal, case.wind.speed, diameter);
    let reference = Reference { rate, sense: first.sync.sense };
    let study = Synchronised { case: &case, records, runs, turbine, reference, diameter };
    let (slices, deficits) = wake::wake(&study)?;
    Ok(Some(Synchronisation {
        phases: tracks::table(&study),
        offsets: offsets::offsets(&study)?,
        tracks: tracks::tracks(&study)?,
        spectra: tracks::spectra(&study)?,
        slices,
        deficits,
    }))
}
