//! The records that a question about phases is put to.

use super::{PhaseQuestion, Truth, tells, truth};
use crate::PostprocessingError;
use crate::error::{InRecords, case_of};
use analysis::phase::{Band, Reference};
use basis::records::{Series, Summary};
use control::excitation_rate;
use control::phase_sync::{PHASE_SYNC, PhaseSyncSettings, azimuth_offset_of, calibration_of};
use estimation::helix::Calibration;
use farm::case::{Case, Control, helix_upstream};
use formats::records::{self, Manifest, RunFolder};
use formats::{library, turbine_file};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use turbine::Definition;

/// The run that a question is about, read once for all its turbines.
pub(super) struct Records<'q> {
    question: &'q PhaseQuestion,
    folder: RunFolder,
    manifest: Manifest,
    case: Case,
    /// Places in the case of the turbines that the question is about, in the case's order; one or more.
    pub(super) turbines: Vec<usize>,
    summary: Summary,
    series: Series,
    /// Series of runs without one of the turbines, by their paths, as far as they were asked for.
    without: BTreeMap<PathBuf, Series>,
}

/// A query about one turbine.
pub(super) struct Query<'r> {
    /// Name of the run.
    pub(super) run: &'r str,
    pub(super) case: &'r Case,
    /// Name of the turbine.
    pub(super) name: &'r str,
    pub(super) reference: Reference,
    /// Its rotor.
    pub(super) definition: Arc<Definition>,
    /// What the run made of its own pitch, where it asked.
    pub(super) calibration: Option<Calibration>,
    /// How it was set to join a helix, where it was.
    pub(super) sync: Option<PhaseSyncSettings>,
    /// Whether it pitches a helix of its own.
    pub(super) pitches: bool,
    /// What [`tells`] of the phase, over time.
    pub(super) series: &'r Series,
    /// Where that stands.
    pub(super) path: PathBuf,
    pub(super) truth: Truth,
    /// The same through the published filter, where the records can hold its band.
    pub(super) published: Option<Truth>,
    /// Azimuth offset of the transformation (rad) with which it pitched, where that was recorded.
    pub(super) transformation_offset: Option<f64>,
}

impl<'q> Records<'q> {
    pub(super) fn read(question: &'q PhaseQuestion) -> Result<Self, PostprocessingError> {
        let folder = folder_of(&question.run);
        let manifest = records::read_manifest(&folder)?;
        let case = case_of(&folder, &manifest)?;
        let turbines = turbines_of(question, &case, &manifest, &folder)?;
        let summary = records::read_summary(&folder)?;
        let wanted = |channel: &str| tells_of_any(&case, &turbines, channel);
        let series = records::read_series(&folder.series_path(), wanted)?;
        let without = BTreeMap::new();
        Ok(Self { question, folder, manifest, case, turbines, summary, series, without })
    }

    /// The query about turbine number `index` of the case.
    ///
    /// # Errors
    /// [`PostprocessingError::NoHelix`], [`PostprocessingError::NoTruth`], and [`PostprocessingError`] for
    /// records that cannot be read.
    pub(super) fn query(&mut self, index: usize) -> Result<Query<'_>, PostprocessingError> {
        let (manifest, case, without) = (&self.manifest, &self.case, &mut self.without);
        let turbines = &self.turbines;
        let turbine = &case.turbines[index];
        let control = &case.runs[manifest.run_index].control;
        let helix = control[index].helix().or(helix_upstream(index, &case.places(), control));
        let (sense, strouhal) = helix.ok_or_else(|| PostprocessingError::NoHelix {
            run: manifest.run.clone(),
            turbine: turbine.name.clone(),
            folder: self.folder.path().to_owned(),
        })?;
        let rate =
            excitation_rate(strouhal, case.wind.speed, self.summary.conditions.rotor_diameter);
        let reference = Reference { rate, sense };
        let study = self.folder.path().parent().unwrap_or(Path::new("")).to_owned();
        let truth_folder = truth_folder(self.question, case, control, index, &study);
        let frequency = reference.frequency();
        let band = self.question.band.unwrap_or(Band::around(frequency, Band::RATIO));
        let (truth, published) = match truth_folder {
            Some(folder) => {
                let path = folder.series_path();
                let wanted = |channel: &str| tells_of_any(case, turbines, channel);
                let series = read_once(without, path.clone(), wanted)?;
                let through = |band| truth(&folder.run(), &turbine.name, series, &reference, band);
                let published = Band::published(frequency).map(through);
                let truth = through(band).in_records(&path)?;
                (truth, published.and_then(Result::ok).flatten())
            }
            None => (None, None),
        };
        let truth = truth.ok_or_else(|| PostprocessingError::NoTruth {
            turbine: turbine.name.clone(),
            directory: study,
        })?;
        let own = control[index].kind().pitching(&control[index]);
        let pitches = own.is_some_and(|own| own.sense.is_some() && own.amplitude != 0.0);
        let definition = Arc::new(rotor(&turbine.model, manifest, &self.folder)?);
        let recorded = self.summary.turbines.iter().find(|recorded| recorded.name == turbine.name);
        let response = recorded.and_then(|recorded| recorded.pitch_response.as_ref());
        let calibration = response.and_then(calibration_of);
        Ok(Query {
            run: &manifest.run,
            case,
            name: &turbine.name,
            reference,
            definition,
            calibration,
            sync: PhaseSyncSettings::of(&control[index]),
            pitches,
            series: &self.series,
            path: self.folder.series_path(),
            truth,
            published,
            transformation_offset: response.and_then(azimuth_offset_of),
        })
    }
}

/// The folder of the run that holds the true wind of turbine `index` in a run of `case` under `control`: the
/// one that `question` names, or else a complete one in the folder `study`.
fn truth_folder(
    question: &PhaseQuestion,
    case: &Case,
    control: &[Control],
    index: usize,
    study: &Path,
) -> Option<RunFolder> {
    if let Some(path) = &question.truth {
        return Some(folder_of(path));
    }
    let runs = case.runs.iter().filter(|run| {
        case.output.lines_at.contains(&index) && tells_truth(case, &run.control, control, index)
    });
    runs.map(|run| RunFolder::new(study, &run.name)).find(RunFolder::is_complete)
}

/// Whether `channel` [`tells`] of the phase at one of the `turbines` of `case`.
fn tells_of_any(case: &Case, turbines: &[usize], channel: &str) -> bool {
    turbines.iter().any(|&index| tells(&case.turbines[index].name, channel))
}

/// The `wanted` channels of the series at `path`, which are kept in `read` from then on.
fn read_once(
    read: &mut BTreeMap<PathBuf, Series>,
    path: PathBuf,
    wanted: impl Fn(&str) -> bool,
) -> Result<&Series, PostprocessingError> {
    Ok(match read.entry(path) {
        Entry::Occupied(found) => found.into_mut(),
        Entry::Vacant(place) => {
            let series = records::read_series(place.key(), wanted)?;
            place.insert(series)
        }
    })
}

/// Places in `case` of the turbine that `question` names, or of those that look for a helix in the run of
/// `manifest` where it names none; one or more.
fn turbines_of(
    question: &PhaseQuestion,
    case: &Case,
    manifest: &Manifest,
    folder: &RunFolder,
) -> Result<Vec<usize>, PostprocessingError> {
    let control = &case.runs[manifest.run_index].control;
    let is_asked = |&index: &usize| match &question.turbine {
        Some(name) => case.turbines[index].name == *name,
        None => control[index].is(&PHASE_SYNC),
    };
    let turbines: Vec<usize> = (0..case.turbines.len()).filter(is_asked).collect();
    if turbines.is_empty() {
        return Err(PostprocessingError::NobodySeeks {
            run: manifest.run.clone(),
            requested: question.turbine.clone(),
            turbines: case.turbines.iter().map(|turbine| turbine.name.clone()).collect(),
            folder: folder.path().to_owned(),
        });
    }
    Ok(turbines)
}

/// Whether a run under `without` holds the true wind of turbine `index` in one under `with`: it is away
/// there, and the turbines upstream of it do the same.
pub(crate) fn tells_truth(
    case: &Case,
    without: &[Control],
    with: &[Control],
    index: usize,
) -> bool {
    let places = case.places();
    let x = |turbine: usize| places[turbine][0];
    let mut upstream = (0..case.turbines.len()).filter(|&other| x(other) < x(index));
    let is_away = without.get(index).is_some_and(|control| !control.is_there());
    is_away && upstream.all(|other| without.get(other) == with.get(other))
}

/// The turbine called `model` as it was in the run of `manifest`, in `folder`.
pub(crate) fn rotor(
    model: &str,
    manifest: &Manifest,
    folder: &RunFolder,
) -> Result<Definition, PostprocessingError> {
    let name = || format!("own_turbines.{model} of {}", folder.manifest_path().display());
    let file = match manifest.own_turbines.get(model) {
        Some(text) => turbine_file::parse(&name(), text)?,
        None => library::load(model)?,
    };
    Ok(file.definition)
}

/// The run in the folder `path`.
pub(crate) fn folder_of(path: &Path) -> RunFolder {
    // A bare name has no parent to look for other runs in.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    RunFolder::new(path.parent().unwrap_or(Path::new("")), &name.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_series_is_read_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("series.csv");
        let mut writer =
            records::SeriesWriter::create(&path, &[basis::channels::TIME]).expect("a file");
        writer.write(&[0.5]).expect("a row");
        writer.finish().expect("a file");
        let mut read = BTreeMap::new();
        let first = read_once(&mut read, path.clone(), |_| true).expect("a sound file").clone();
        assert_eq!(first.columns, [[0.5]]);
        // What is gone from the disk cannot be read again.
        fs::remove_file(&path).expect("a file");
        assert_eq!(*read_once(&mut read, path, |_| true).expect("kept"), first);
        assert!(read_once(&mut read, folder.path().join("other.csv"), |_| true).is_err());
    }
}
