//! What a study of phase synchronisation has to show: its records made into the data of the report's figures.
//!
//! The figures are those of van Vondelen et al. (2025): estimates beside the truth (their Figs. 10, 11), the answer to the
//! pitch (12, 13), power and loads over the offset (14, 15), the wake (16, 17).

mod offsets;
mod tracks;
mod wake;

use crate::StudyError;
use crate::phase::asked::tells_truth;
use crate::phase::{PhaseAnswer, compare, recorded, truth};
use analysis::AnalysisError;
use analysis::phase::Reference;
use basis::angle::wrap_to_turn;
use control::excitation_rate;
use farm::case::{Case, Control, PhaseSync};
use formats::case;
use formats::records::{RunRecords, StudyRecords};
use report::Synchronisation;

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
    let joined = records.runs.iter().enumerate().filter_map(|(place, run)| {
        let (turbine, sync) = joins(run.manifest.run_index)?;
        Some((place, run, turbine, sync))
    });
    let joined: Vec<_> = joined.collect();
    let Some(&(_, first, turbine, sync)) = joined.first() else { return Ok(None) };
    let diameter = first.summary.conditions.rotor_diameter;
    let rate = excitation_rate(sync.strouhal, case.wind.speed, diameter);
    let reference = Reference { rate, sense: sync.sense };
    let name = &case.turbines[turbine].name;
    // Without a true wind there is nothing to compare with; a short run says nothing of phases.
    let control = |run: &RunRecords| case.runs[run.manifest.run_index].control.as_slice();
    let truth_of = |own: &RunRecords| {
        let mut without = records
            .runs
            .iter()
            .filter(|run| tells_truth(&case, control(run), control(own), turbine));
        without
            .find_map(|run| truth(&run.manifest.run, name, &run.series, &reference).ok().flatten())
    };
    let from = case.time.spin_up;
    let mut runs = Vec::new();
    for (place, run, _, sync) in joined.into_iter().filter(|joined| joined.2 == turbine) {
        let (series, own) = (&run.series, &run.manifest.run);
        let answer = match truth_of(run) {
            Some(truth) => {
                let estimates = recorded(series, name)?;
                match compare(own, name, series, &estimates, &truth, &reference, from) {
                    Ok(answer) => Some(answer),
                    Err(StudyError::Analysis(_)) => None,
                    Err(error) => return Err(error),
                }
            }
            None => None,
        };
        runs.push(Joined { run: place, name: own.clone(), sync, answer });
    }
    let study = Synchronised { case: &case, records, runs, turbine, reference, diameter };
    let (slices, deficits) = unless_short(wake::wake(&study))?;
    Ok(Some(Synchronisation {
        phases: tracks::table(&study),
        offsets: unless_short(offsets::offsets(&study))?,
        tracks: unless_short(tracks::tracks(&study))?,
        spectra: unless_short(tracks::spectra(&study))?,
        slices,
        deficits,
    }))
}

/// `found`, or nothing to show where records are too short for it: that is no reason to withhold the rest of a report.
fn unless_short<T: Default>(found: Result<T, StudyError>) -> Result<T, StudyError> {
    match found {
        Err(StudyError::Analysis(AnalysisError::TooShort { .. })) => Ok(T::default()),
        found => found,
    }
}
