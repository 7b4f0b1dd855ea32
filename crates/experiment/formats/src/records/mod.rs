//! What a run leaves behind: `DIR/RUN/` with summary, series, planes, volumes, manifest and checkpoint.
//!
//! `summary.json` comes last: a run whose folder has one is complete. Everything that a report needs is in
//! these files, planes included, so that a study can be reported anew from its folder alone.

mod manifest;
mod phase_averages;
mod pitch_responses;
mod planes;
mod precursor;
mod scans;
mod series;
mod series_file;
mod slices;
mod study;
#[cfg(test)]
mod summary_page;
mod sweep;

pub use crate::clock::now;
pub use manifest::{Machine, Manifest, read_manifest, sha256, sha256_of_file, write_manifest};
pub use phase_averages::{
    PhaseAveragesWriter, StoredPhaseAverages, is_phase_averages, phase_averages_bytes,
    write_phase_averages,
};
pub use pitch_responses::{
    PitchResponseRecord, add_pitch_responses, discard_unreadable_pitch_responses,
    read_pitch_responses, write_pitch_responses,
};
pub use planes::{
    AtPhase, InstantWriter, PlacedTurbine, PlaneSetting, write_last_plane, write_mean_plane,
    write_phase_planes,
};
pub use precursor::{
    Drift, PRECURSOR_VERSION, PrecursorFolder, PrecursorResult, ProfileRow, RecordedPlanes,
};
pub use scans::{
    ScanInstant, ScanSetting, ScanWriter, StoredScans, read_scans, scan_bytes, scans_name,
};
pub use series::SeriesWriter;
pub use series_file::{SeriesFile, read_series};
pub use study::{RunRecords, StudyRecords, read_study, read_summaries, scan_paths};
pub use sweep::{read_sweep, remove_sweep, sweep_path, write_sweep, write_table};

use crate::lock::Lock;
pub use crate::vtk::filament_bytes;
use crate::{FileError, atomic, leftovers, vtk};
use basis::records::{Filaments, SCHEMA_VERSION, Summary};
use flow::lattice::Volume;
use scans::SCANS;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What the name of a recorded wind begins with.
const INFLOW: &str = "inflow-";
/// What the name of a turbine's record in OpenFAST's format ends with.
const OUTB: &str = ".outb";
const SUMMARY: &str = "the summary of a run";
/// Name of the vortices at a run's last instant.
const LAST_FILAMENTS: &str = "filaments-last.vtp";

/// The folder of one run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// The folder of the run `run` in the study's folder `study`; nothing is touched.
    pub fn new(study: &Path, run: &str) -> Self {
        Self { path: study.join(run) }
    }

    /// Makes the folder, with those for planes and volumes in it.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(&self) -> Result<(), FileError> {
        atomic::create_folder(&self.planes_path())?;
        atomic::create_folder(&self.volumes_path())
    }

    /// Takes away what an earlier run of this name left, summary first, so that no mixture is ever taken for
    /// a run.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn clear(&self) -> Result<(), FileError> {
        let part = self.path.join("series.csv.part");
        let [summary, series] = [self.summary_path(), self.series_path()];
        for file in [summary, self.checkpoint_path(), series, part, self.manifest_path()] {
            gone(fs::remove_file(&file), &file)?;
        }
        for beginning in [INFLOW, slices::SLICES, SCANS, phase_averages::AVERAGES] {
            self.remove_named(beginning, "")?;
        }
        self.remove_named("", OUTB)?;
        for folder in [self.planes_path(), self.volumes_path()] {
            gone(fs::remove_dir_all(&folder), &folder)?;
        }
        Ok(())
    }

    /// Whether the run is complete.
    pub fn is_complete(&self) -> bool {
        self.summary_path().is_file()
    }

    /// The lock of the run: whoever holds it, until it is dropped, writes the run.
    ///
    /// # Errors
    /// [`FileError::Held`] says who else does; [`FileError::System`].
    pub fn lock(&self) -> Result<Lock, FileError> {
        let (study, run) = (self.path.parent().unwrap_or(Path::new("")), self.run());
        let what = format!("run {run} in {}", study.display());
        Lock::take(&study.join(format!(".{run}.lock")), &what)
    }

    /// Whether there is something in it of which no manifest tells what it is.
    pub fn is_unknown(&self) -> bool {
        !self.manifest_path().exists() && self.holds_results()
    }

    /// Whether there is anything in it that a run has made: more than a manifest and empty folders, which one
    /// leaves that fails before its first step.
    pub fn holds_results(&self) -> bool {
        let own = [self.manifest_path(), self.planes_path(), self.volumes_path()];
        let is_bare = |path: &PathBuf| {
            *path == own[0]
                || own.contains(path) && study::entries(path).is_ok_and(|e| e.is_empty())
        };
        match study::entries(&self.path) {
            Ok(entries) => !entries.iter().all(is_bare),
            // What is no folder, or cannot be looked into, is somebody's.
            Err(_) => fs::symlink_metadata(&self.path).is_ok(),
        }
    }

    /// Takes away the files whose names begin with `beginning` and end in `ending`.
    fn remove_named(&self, beginning: &str, ending: &str) -> Result<(), FileError> {
        if !self.path.is_dir() {
            return Ok(());
        }
        for file in study::entries(&self.path)? {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with(beginning) && name.ends_with(ending) {
                gone(fs::remove_file(&file), &file)?;
            }
        }
        Ok(())
    }

    /// Makes the run one that is under way again, where it was complete; what it has left stays.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn reopen(&self) -> Result<(), FileError> {
        gone(fs::remove_file(self.summary_path()), &self.summary_path())
    }

    /// Takes the checkpoint away once the run is complete, and what else was there to resume from.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn remove_checkpoint(&self) -> Result<(), FileError> {
        self.remove_named(INFLOW, ".part")?;
        self.remove_named(slices::SLICES, ".part")?;
        gone(fs::remove_file(self.checkpoint_path()), &self.checkpoint_path())
    }

    /// Takes away what a killed process was writing: no name that anything reads. Only whoever holds the
    /// [`lock`](Self::lock) may.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn remove_leftovers(&self) -> Result<(), FileError> {
        for folder in [self.path.clone(), self.planes_path(), self.volumes_path()] {
            if folder.is_dir() {
                leftovers::remove_leftovers(&folder)?;
            }
        }
        Ok(())
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Name of the run.
    pub fn run(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// `summary.json`.
    pub fn summary_path(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// `manifest.json`.
    pub fn manifest_path(&self) -> PathBuf {
        self.path.join("manifest.json")
    }

    /// `series.csv`; until the run is complete its rows are in `series.csv.part`.
    pub fn series_path(&self) -> PathBuf {
        self.path.join("series.csv")
    }

    /// `inflow-T2.bts`: the wind at the place of the turbine called `turbine`.
    pub fn inflow_path(&self, turbine: &str) -> PathBuf {
        self.path.join(format!("{INFLOW}{turbine}.bts"))
    }

    /// `checkpoint`.
    pub fn checkpoint_path(&self) -> PathBuf {
        self.path.join("checkpoint")
    }

    /// `planes/hub-height.nc`: the plane called `plane` at instants; until the run is complete they are in
    /// `planes/hub-height.nc.part`.
    pub fn instants_path(&self, plane: &str) -> PathBuf {
        self.planes_path().join(format!("{plane}.nc"))
    }

    /// Folder of the planes.
    pub fn planes_path(&self) -> PathBuf {
        self.path.join("planes")
    }

    /// The files of planes, by name.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn plane_files(&self) -> Result<Vec<PathBuf>, FileError> {
        study::entries(&self.planes_path())
    }

    /// Folder of the volumes.
    pub fn volumes_path(&self) -> PathBuf {
        self.path.join("volumes")
    }
}

/// The lock on what all runs of the study in the folder `study` share under the name `what`, once whoever
/// holds it has let it go. No run can have the name of its file.
///
/// # Errors
/// [`FileError::System`].
pub fn lock_shared(study: &Path, what: &str) -> Result<Lock, FileError> {
    Lock::wait(&study.join(format!(".lock.{what}")))
}

/// Whether the folder `folder` of a study, or of a sweep of studies, holds anything to go on with: a run that
/// was begun, or what was identified before the runs.
pub fn is_begun(folder: &Path) -> bool {
    let is_run = |path: &PathBuf| RunFolder { path: path.clone() }.manifest_path().is_file();
    let is_study = |folder: &Path| {
        pitch_responses::path_in(folder).is_file()
            || study::entries(folder).is_ok_and(|entries| entries.iter().any(is_run))
    };
    any_study(folder, is_study)
}

/// Whether a run in the folder `folder` of a study, or of a sweep of studies, was stopped with a checkpoint.
pub fn has_checkpoint(folder: &Path) -> bool {
    let left = |path: PathBuf| {
        let folder = RunFolder { path };
        folder.checkpoint_path().is_file() && !folder.is_complete()
    };
    let has =
        |study: &Path| study::entries(study).is_ok_and(|entries| entries.into_iter().any(left));
    any_study(folder, has)
}

/// Whether `is_so` of the study in `folder`, or of one of those in it where that is the folder of a sweep.
fn any_study(folder: &Path, is_so: impl Fn(&Path) -> bool) -> bool {
    let inner = || study::entries(folder).unwrap_or_default();
    is_so(folder) || sweep_path(folder).is_file() && inner().iter().any(|inner| is_so(inner))
}

/// On return the file or folder is not there.
fn gone(removed: std::io::Result<()>, path: &Path) -> Result<(), FileError> {
    match removed {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(FileError::system("remove", "what an earlier run left,", path, error))
        }
        _ => Ok(()),
    }
}

/// Writes a volume, the `index`-th kept: `volumes/velocity-0000.vti`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_volume(folder: &RunFolder, index: u64, volume: &Volume) -> Result<(), FileError> {
    vtk::write_volume(&folder.volumes_path().join(format!("velocity-{index:04}.vti")), volume)
}

/// Writes the vortices of wakes, the `index`-th kept: `volumes/filaments-0000.vtp`; without one those of the
/// last instant: `volumes/filaments-last.vtp`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_filaments(
    folder: &RunFolder,
    index: Option<u64>,
    filaments: &Filaments,
) -> Result<(), FileError> {
    let name = index.map_or(LAST_FILAMENTS.to_owned(), |index| format!("filaments-{index:04}.vtp"));
    vtk::write_filaments(&folder.volumes_path().join(name), filaments)
}

/// Writes the summary; the run is complete with it.
///
/// # Errors
/// [`FileError::System`].
pub fn write_summary(folder: &RunFolder, summary: &Summary) -> Result<(), FileError> {
    write_json(&folder.summary_path(), SUMMARY, summary)
}

/// Reads the summary of a run.
///
/// # Errors
/// [`FileError::System`], and [`FileError::Content`] when it is something else or of another version of the
/// layout.
pub fn read_summary(folder: &RunFolder) -> Result<Summary, FileError> {
    read_layout(&folder.summary_path(), SUMMARY, SCHEMA_VERSION)
}

/// Reads what stands at `path` in the layout `expected`, of a study.
fn read_layout<T: DeserializeOwned>(
    path: &Path,
    what: &'static str,
    expected: u32,
) -> Result<T, FileError> {
    const AGAIN: &str = "make the run again with `wakemix run CASE --overwrite`, or read it with the wakemix that manifest.json names";
    const LATER: &str = "use the wakemix that manifest.json names, or a later one";
    read_layout_or(path, what, expected, AGAIN, LATER)
}

/// Reads what stands at `path` in the layout `expected`; `again` and `later` are the fixes for an earlier
/// layout and for a later one.
fn read_layout_or<T: DeserializeOwned>(
    path: &Path,
    what: &'static str,
    expected: u32,
    again: &'static str,
    later: &'static str,
) -> Result<T, FileError> {
    let text = atomic::read_text(path, what)?;
    // Another version holds other fields: what it is comes before what it lacks.
    let (found, fix) = match version_of(&text, path, what)? {
        None => ("it has no schema_version, as that of an earlier wakemix".to_owned(), again),
        Some(version) => {
            let (writer, fix) = match version.cmp(&expected) {
                Ordering::Equal => return parse_json(&text, path, what),
                Ordering::Less => ("an earlier", again),
                Ordering::Greater => ("a later", later),
            };
            (format!("its schema_version is {version}, that of {writer} wakemix"), fix)
        }
    };
    let problem = format!("{found}; this one reads {expected}");
    Err(FileError::content(what, path, problem, fix))
}

/// Version of the layout of `text`, which stands at `path`; none where it tells none, such as a bare list.
fn version_of(text: &str, path: &Path, what: &'static str) -> Result<Option<u32>, FileError> {
    #[derive(Deserialize)]
    struct Layout {
        schema_version: Option<u32>,
    }
    if text.trim_start().starts_with('[') {
        return Ok(None);
    }
    parse_json(text, path, what).map(|layout: Layout| layout.schema_version)
}

fn write_json(path: &Path, what: &'static str, value: &impl Serialize) -> Result<(), FileError> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| FileError::system("write", what, path, error.into()))?;
    atomic::write(path, what, (text + "\n").as_bytes())
}

fn parse_json<T: DeserializeOwned>(
    text: &str,
    path: &Path,
    what: &'static str,
) -> Result<T, FileError> {
    serde_json::from_str(text).map_err(|error| {
        // The library's message ends with line and column.
        let fix = "restore the file, or make the run again";
        FileError::content(what, path, error.to_string(), fix)
    })
}
