//! What a study of phase synchronisation has to show: its records made into the data of the report's figures.
//!
//! The figures are those of van Vondelen et al. (2025): estimates beside the truth (their Figs. 10, 11), the
//! answer to the pitch (12, 13), power and loads over the offset (14, 15), the wake (16, 17).

pub(crate) mod curve;
mod offsets;
mod tracks;
mod wake;

use crate::PostprocessingError;
use crate::error::{InRecords, case_in};
use crate::phase::query::tells_truth;
use crate::phase::{PhaseAnswer, Truth, compare, recorded, tells, truth};
use analysis::AnalysisError;
use analysis::phase::{Band, Reference};
use basis::angle::wrap_to_turn;
use control::excitation_rate;
use control::phase_sync::PhaseSyncSettings;
use farm::case::{Case, Control, Sense};
use formats::records::{RunRecords, StudyRecords};
use report::Synchronisation;
use std::path::Path;

/// One run in which a turbine joins a helix, or monitors one.
struct Joined {
    /// Place among the study's runs.
    run: usize,
    /// Name of the run.
    name: String,
    sync: PhaseSyncSettings,
    /// Estimate against truth, where a run without the turbine tells the truth.
    answer: Option<PhaseAnswer>,
}

impl Joined {
    /// Lead of the pitch over the wind (rad, [0, 2π)); none where the turbine only monitors.
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

/// A turbine and one helix that it joins, or monitors.
struct Pairing {
    /// Place of the turbine in the case.
    turbine: usize,
    sense: Sense,
    strouhal: f64,
    /// Places of the runs in which it does, and how it was set to.
    runs: Vec<(usize, PhaseSyncSettings)>,
}

impl Pairing {
    fn is_of(&self, turbine: usize, sync: &PhaseSyncSettings) -> bool {
        (self.turbine, self.sense, self.strouhal) == (turbine, sync.sense, sync.strouhal)
    }

    /// The turbine's name, with the helix's sense and Strouhal number where `all` hold another helix that it
    /// joins.
    fn name(&self, case: &Case, all: &[Self]) -> String {
        let name = &case.turbines[self.turbine].name;
        let Self { sense, strouhal, .. } = self;
        if all.iter().filter(|other| other.turbine == self.turbine).count() == 1 {
            name.clone()
        } else {
            format!("{name} {sense} St {strouhal}")
        }
    }
}

/// What is joined in the runs number `run_indices` of `case`, by turbines from upstream to downstream.
fn pairings(case: &Case, run_indices: &[usize]) -> Vec<Pairing> {
    let mut found: Vec<Pairing> = Vec::new();
    for (place, &index) in run_indices.iter().enumerate() {
        let control = case.runs.get(index).map(|run| run.control.as_slice()).unwrap_or_default();
        for (turbine, control) in control.iter().enumerate() {
            let Some(sync) = PhaseSyncSettings::of(control) else { continue };
            let run = (place, sync);
            match found.iter_mut().find(|pairing| pairing.is_of(turbine, &sync)) {
                Some(pairing) => pairing.runs.push(run),
                None => found.push(Pairing {
                    turbine,
                    sense: sync.sense,
                    strouhal: sync.strouhal,
                    runs: vec![run],
                }),
            }
        }
    }
    let places = case.places();
    let x = |pairing: &Pairing| places[pairing.turbine][0];
    found.sort_by(|a, b| x(a).total_cmp(&x(b)));
    found
}

/// The data of the figures and the lines of the table of phases, for each turbine and each helix that it
/// joins; `records` are those of the study in `directory`.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be analysed.
pub(crate) fn synchronisation(
    records: &StudyRecords,
    directory: &Path,
) -> Result<Vec<Synchronisation>, PostprocessingError> {
    let case = case_in(directory, &records.case_text)?;
    let run_indices: Vec<usize> = records.runs.iter().map(|run| run.manifest.run_index).collect();
    let pairings = pairings(&case, &run_indices);
    let found = pairings.iter().map(|pairing| {
        let name = pairing.name(&case, &pairings);
        synchronised(&case, records, pairing, name)
    });
    found.collect()
}

/// What there is to show of `pairing`, under the name `name`.
fn synchronised(
    case: &Case,
    records: &StudyRecords,
    pairing: &Pairing,
    name: String,
) -> Result<Synchronisation, PostprocessingError> {
    let turbine = pairing.turbine;
    let (first, _) = pairing.runs[0];
    let diameter = records.runs[first].summary.conditions.rotor_diameter;
    let rate = excitation_rate(pairing.strouhal, case.wind.speed, diameter);
    let reference = Reference { rate, sense: pairing.sense };
    let band = Band::around(reference.frequency(), Band::RATIO);
    let own_name = &case.turbines[turbine].name;
    // Without a true wind there is nothing to compare with; a short run says nothing of phases.
    let control = |run: &RunRecords| control_of(case, run);
    let truth_of = |own: &RunRecords| -> Result<Option<Truth>, PostprocessingError> {
        for run in &records.runs {
            if !tells_truth(case, control(run), control(own), turbine) {
                continue;
            }
            let series = run.series.read(|channel| tells(own_name, channel))?;
            if let Ok(Some(truth)) = truth(&run.manifest.run, own_name, &series, &reference, band) {
                return Ok(Some(truth));
            }
        }
        Ok(None)
    };
    let from = case.time.spin_up;
    let mut runs = Vec::new();
    for &(place, sync) in &pairing.runs {
        let run = &records.runs[place];
        let own = &run.manifest.run;
        let answer = match truth_of(run)? {
            Some(truth) => {
                let series = run.series.read(|channel| tells(own_name, channel))?;
                let estimates = recorded(&series, own_name).in_records(run.series.path())?;
                match compare(own, own_name, &series, &estimates, &truth, &reference, from) {
                    Ok(answer) => Some(answer),
                    Err(PostprocessingError::Analysis { .. }) => None,
                    Err(error) => return Err(error),
                }
            }
            None => None,
        };
        runs.push(Joined { run: place, name: own.clone(), sync, answer });
    }
    let study = Synchronised { case, records, runs, turbine, reference, diameter };
    let (slices, deficits) = unless_short(wake::wake(&study))?;
    Ok(Synchronisation {
        name,
        phases: tracks::table(&study),
        offsets: unless_short(offsets::offsets(&study))?,
        tracks: unless_short(tracks::tracks(&study))?,
        spectra: unless_short(tracks::spectra(&study))?,
        slices,
        deficits,
    })
}

/// What controls the turbines of `case` in `run`; nothing where that is of another version of the case.
fn control_of<'c>(case: &'c Case, run: &RunRecords) -> &'c [Control] {
    let found = case.runs.get(run.manifest.run_index);
    found.map(|run| run.control.as_slice()).unwrap_or_default()
}

/// `found`, or nothing to show where records are too short for it: that is no reason to withhold the rest of
/// a report.
fn unless_short<T: Default>(
    found: Result<T, PostprocessingError>,
) -> Result<T, PostprocessingError> {
    match found {
        Err(PostprocessingError::Analysis { source: AnalysisError::TooShort { .. }, .. }) => {
            Ok(T::default())
        }
        found => found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::case;

    const ROW: &str = r#"
name = "row"
[wind]
speed = 9.0
turbulence_intensity = 0.05
[time]
spin_up = 300.0
duration = 900.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T3"
model = "iea-15mw"
position_diameters = [10.0, 0.0]
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "monitoring"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
[[run]]
name = "not-made"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.2 }
control.T2 = { kind = "phase-sync", offset_deg = 90.0, amplitude_deg = 4.0 }
[[run]]
name = "both"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 150.0, amplitude_deg = 4.0 }
control.T3 = { kind = "phase-sync", offset_deg = 210.0, amplitude_deg = 4.0 }
[[run]]
name = "other-sense"
control.T1 = { kind = "helix", sense = "cw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 150.0, amplitude_deg = 4.0 }
"#;

    /// Name, runs and offsets (deg) of what is joined in the runs number `run_indices`.
    fn found(run_indices: &[usize]) -> Vec<(String, Vec<usize>, Vec<f64>)> {
        let case = case::parse("row.toml", ROW, &[]).expect("a sound case");
        let pairings = pairings(&case, run_indices);
        let reported = pairings.iter().map(|pairing| {
            let runs = pairing.runs.iter();
            let (places, offsets): (Vec<usize>, Vec<f64>) =
                runs.map(|(place, sync)| (*place, sync.offset.to_degrees().round())).unzip();
            (pairing.name(&case, &pairings), places, offsets)
        });
        reported.collect()
    }

    #[test]
    fn each_turbine_and_each_helix_that_it_joins_is_kept_apart() {
        let joined = |name: &str, places: &[usize], offsets: &[f64]| {
            (name.to_owned(), places.to_vec(), offsets.to_vec())
        };
        // Places are among the runs that were made; T2 stands before T3, whatever the case's order.
        let expected = [
            joined("T2 ccw St 0.25", &[0, 1], &[0.0, 150.0]),
            joined("T2 cw St 0.25", &[2], &[150.0]),
            joined("T3", &[1], &[210.0]),
        ];
        assert_eq!(found(&[0, 2, 3]), expected);
        let expected = [joined("T2", &[0, 1], &[0.0, 150.0]), joined("T3", &[1], &[210.0])];
        assert_eq!(found(&[0, 2]), expected);
        assert!(found(&[]).is_empty());
    }
}
