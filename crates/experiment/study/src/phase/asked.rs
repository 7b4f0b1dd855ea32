//! The records that a question about phases is put to.

use super::{PhaseQuestion, Truth, tells, truth};
use crate::StudyError;
use crate::probes::calibration_of;
use analysis::phase::Reference;
use basis::records::Series;
use control::excitation_rate;
use estimation::helix::Calibration;
use farm::case::{Case, Control, PhaseSync, helix_upstream};
use formats::records::{self, Manifest, RunFolder};
use formats::{case, library, turbine_file};
use std::path::Path;
use std::sync::Arc;
use turbine::Definition;

/// What a question is about, read.
pub(super) struct Asked {
    /// Name of the run.
    pub(super) run: String,
    pub(super) case: Case,
    /// Place of the turbine in the case.
    pub(super) index: usize,
    pub(super) reference: Reference,
    /// Its rotor.
    pub(super) definition: Arc<Definition>,
    /// What the run made of its own pitch, where it asked.
    pub(super) calibration: Option<Calibration>,
    /// How it was asked to join a helix, where it was.
    pub(super) sync: Option<PhaseSync>,
    /// Whether it pitches a helix of its own.
    pub(super) pitches: bool,
    /// What [`tells`] of the phase, over time.
    pub(super) series: Series,
    pub(super) truth: Truth,
}

impl Asked {
    pub(super) fn read(question: &PhaseQuestion) -> Result<Self, StudyError> {
        let folder = folder_of(&question.run);
        let manifest = records::read_manifest(&folder)?;
        let case = case::parse("the manifest's case", &manifest.case_text, &[])?;
        let index = turbine_of(question, &case, &manifest)?;
        let name = case.turbines[index].name.clone();
        let control = &case.runs[manifest.run_index].control;
        let helix = control[index].helix().or(helix_upstream(index, &case.turbines, control));
        let (sense, strouhal) = helix.ok_or_else(|| StudyError::NoHelix {
            run: manifest.run.clone(),
            turbine: name.clone(),
        })?;
        let summary = records::read_summary(&folder)?;
        let rate = excitation_rate(strouhal, case.wind.speed, summary.conditions.rotor_diameter);
        let reference = Reference { rate, sense };
        let study = folder.path().parent().unwrap_or(Path::new("")).to_owned();
        let without = match &question.truth {
            Some(path) => Some(folder_of(path)),
            None => case
                .runs
                .iter()
                .filter(|run| {
                    case.output.lines_at.contains(&index)
                        && tells_truth(&case, &run.control, control, index)
                })
                .map(|run| RunFolder::new(&study, &run.name))
                .find(RunFolder::is_complete),
        };
        let truth = match without {
            Some(without) => {
                let series =
                    records::read_series(&without.series_path(), |channel| tells(&name, channel))?;
                truth(&without.run(), &name, &series, &reference)?
            }
            None => None,
        };
        let truth =
            truth.ok_or_else(|| StudyError::NoTruth { turbine: name.clone(), directory: study })?;
        let series = records::read_series(&folder.series_path(), |channel| tells(&name, channel))?;
        let pitches = match control[index] {
            Control::Helix(helix) => helix.amplitude != 0.0,
            Control::PhaseSync(sync) => sync.amplitude != 0.0,
            _ => false,
        };
        let sync = match control[index] {
            Control::PhaseSync(sync) => Some(sync),
            _ => None,
        };
        let definition = Arc::new(rotor(&case.turbines[index].model, &manifest)?);
        let summary = summary.turbines.into_iter().find(|turbine| turbine.name == name);
        let response = summary.and_then(|turbine| turbine.pitch_response);
        let calibration = response.as_ref().and_then(calibration_of);
        Ok(Self {
            run: manifest.run,
            case,
            index,
            reference,
            definition,
            calibration,
            sync,
            pitches,
            series,
            truth,
        })
    }

    /// Name of the turbine.
    pub(super) fn name(&self) -> &str {
        &self.case.turbines[self.index].name
    }
}

/// The turbine that `question` is about.
fn turbine_of(
    question: &PhaseQuestion,
    case: &Case,
    manifest: &Manifest,
) -> Result<usize, StudyError> {
    let found = match &question.turbine {
        Some(name) => case.turbines.iter().position(|turbine| turbine.name == *name),
        None => seeking(case, manifest).next(),
    };
    found.ok_or_else(|| nobody_seeks(question, case, manifest))
}

/// Names of the turbines that seek a helix in the run that `question` is about, in the case's order; one or more.
pub(super) fn seekers(question: &PhaseQuestion) -> Result<Vec<String>, StudyError> {
    let manifest = records::read_manifest(&folder_of(&question.run))?;
    let case = case::parse("the manifest's case", &manifest.case_text, &[])?;
    let names: Vec<String> =
        seeking(&case, &manifest).map(|index| case.turbines[index].name.clone()).collect();
    if names.is_empty() { Err(nobody_seeks(question, &case, &manifest)) } else { Ok(names) }
}

/// Places of the turbines that seek a helix in the run of `manifest`.
fn seeking<'c>(case: &'c Case, manifest: &Manifest) -> impl Iterator<Item = usize> + use<'c> {
    let control = case.runs[manifest.run_index].control.iter().enumerate();
    control.filter_map(|(index, control)| matches!(control, Control::PhaseSync(_)).then_some(index))
}

fn nobody_seeks(question: &PhaseQuestion, case: &Case, manifest: &Manifest) -> StudyError {
    StudyError::NobodySeeks {
        run: manifest.run.clone(),
        asked: question.turbine.clone(),
        turbines: case.turbines.iter().map(|turbine| turbine.name.clone()).collect(),
    }
}

/// Whether a run under `without` holds the true wind of turbine `index` in one under `with`: it is away there, and the
/// turbines upstream of it do the same.
pub(crate) fn tells_truth(
    case: &Case,
    without: &[Control],
    with: &[Control],
    index: usize,
) -> bool {
    let x = |turbine: usize| case.turbines[turbine].position_diameters[0];
    let mut upstream = (0..case.turbines.len()).filter(|&other| x(other) < x(index));
    without[index] == Control::Absent && upstream.all(|other| without[other] == with[other])
}

/// The turbine called `model` as it was in the run of `manifest`.
fn rotor(model: &str, manifest: &Manifest) -> Result<Definition, StudyError> {
    let file = match manifest.own_turbines.get(model) {
        Some(text) => turbine_file::parse(&format!("{model} of run {}", manifest.run), text)?,
        None => library::load(model)?,
    };
    Ok(file.definition)
}

/// The run in the folder `path`.
fn folder_of(path: &Path) -> RunFolder {
    // A bare name has no parent to look for other runs in.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    RunFolder::new(path.parent().unwrap_or(Path::new("")), &name.unwrap_or_default())
}
