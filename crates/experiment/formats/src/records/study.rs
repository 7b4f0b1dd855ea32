//! A study read back from its folder.

use super::planes::{LAST, MEAN, PHASES};
use super::scans::SCANS;
use super::{LAST_FILAMENTS, Manifest, RunFolder, SeriesFile, read_manifest, read_summary};
use crate::{FileError, case, netcdf, vtk};
use basis::records::{Filaments, Plane, Summary, Warning, WarningKind};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Everything that the runs of a study left.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRecords {
    /// Name of the case.
    pub case_name: String,
    /// What the study is for, in one line.
    pub description: Option<String>,
    /// The case file as run (TOML), of the run that started last.
    pub case_text: String,
    /// The complete runs, in the case file's order.
    pub runs: Vec<RunRecords>,
    /// Runs of the case that are not complete: not begun, under way or interrupted.
    pub incomplete: Vec<String>,
    /// Version of the program that made the run that started last.
    pub version: String,
    /// What a reader of the numbers must know: runs of unlike versions of the case.
    pub warnings: Vec<Warning>,
}

/// What one run left.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecords {
    /// The run in numbers.
    pub summary: Summary,
    /// What was run, where and when.
    pub manifest: Manifest,
    /// Channels over time, on the disk.
    pub series: SeriesFile,
    /// Planes averaged over the analysed time, by name.
    pub mean_planes: Vec<Plane>,
    /// The same planes at the run's last instant.
    pub last_planes: Vec<Plane>,
    /// Planes averaged at phases of the excitation (rad).
    pub phase_planes: Vec<(f64, Plane)>,
    /// Files of planes at instants, by name.
    pub instant_paths: Vec<PathBuf>,
    /// Files of lidars' scans, by name.
    pub scan_paths: Vec<PathBuf>,
    /// Files of volumes, by time.
    pub volume_paths: Vec<PathBuf>,
    /// The vortices of its wakes at the last instant; none where the air has none to show.
    pub last_filaments: Option<Filaments>,
}

/// Reads the study in the folder `path` back: every run's folder, of its series the channels' names alone.
///
/// # Errors
/// [`FileError::System`] when a file cannot be read; [`FileError::Content`] when one holds something else, or
/// when no run of a study is there.
pub fn read_study(path: &Path) -> Result<StudyRecords, FileError> {
    let Found { complete, incomplete } = find_runs(path)?;
    let mut runs = Vec::with_capacity(complete.len());
    for (folder, manifest) in complete {
        runs.push(read_run(&folder, manifest)?);
    }
    // Times of this form sort as text.
    let Some(latest) = runs.iter().map(|run| &run.manifest).max_by_key(|run| &run.started) else {
        return Err(no_run(path, &incomplete));
    };
    Ok(StudyRecords {
        case_name: latest.case.clone(),
        description: latest.description.clone(),
        case_text: latest.case_text.clone(),
        version: latest.version.clone(),
        warnings: warnings(&runs, latest),
        incomplete: not_complete(&runs, latest, incomplete),
        runs,
    })
}

/// Reads what the complete runs of the study in the folder `path` came to, without their series and planes:
/// manifest and summary of each, in the case file's order; one or more.
///
/// # Errors
/// Those of [`read_study`].
pub fn read_summaries(path: &Path) -> Result<Vec<(Manifest, Summary)>, FileError> {
    let Found { complete, incomplete } = find_runs(path)?;
    if complete.is_empty() {
        return Err(no_run(path, &incomplete));
    }
    let read = |(folder, manifest): (RunFolder, Manifest)| Ok((manifest, read_summary(&folder)?));
    complete.into_iter().map(read).collect()
}

/// The runs of a study, in the case file's order.
struct Found {
    complete: Vec<(RunFolder, Manifest)>,
    /// Names of those that are under way or were interrupted.
    incomplete: Vec<String>,
}

/// The runs in the study's folder `path`.
fn find_runs(path: &Path) -> Result<Found, FileError> {
    let (mut complete, mut incomplete) = (Vec::new(), Vec::new());
    for entry in entries(path)? {
        let folder = RunFolder { path: entry };
        if !folder.manifest_path().is_file() {
            continue;
        }
        let manifest = read_manifest(&folder)?;
        if folder.is_complete() {
            complete.push((folder, manifest));
        } else {
            incomplete.push((manifest.run_index, manifest.run));
        }
    }
    let order = order(complete.iter().map(|(_, manifest)| manifest));
    let place = |name: &str| order.iter().position(|run| run == name).unwrap_or(order.len());
    let key = |run: &Manifest| (place(&run.run), run.run_index, run.run.clone());
    complete.sort_by_cached_key(|(_, manifest)| key(manifest));
    incomplete
        .sort_by_cached_key(|(index, run): &(usize, String)| (place(run), *index, run.clone()));
    Ok(Found { complete, incomplete: incomplete.into_iter().map(|(_, run)| run).collect() })
}

/// Names of the runs in the case of the one of `runs` that started last: those made before it may have had
/// fewer beside them.
fn order<'m>(runs: impl Iterator<Item = &'m Manifest> + Clone) -> Vec<String> {
    let indices: BTreeSet<usize> = runs.clone().map(|run| run.run_index).collect();
    if indices.len() == runs.clone().count() {
        let texts: BTreeSet<&str> = runs.clone().map(|run| run.case_sha256.as_str()).collect();
        // Their places tell.
        if texts.len() < 2 {
            return Vec::new();
        }
    }
    runs.max_by_key(|run| &run.started).map_or(Vec::new(), names_in_case)
}

/// Names of the runs in the case that `run` was made of; none where that does not read any more.
fn names_in_case(run: &Manifest) -> Vec<String> {
    let case = case::parse("", &run.case_text, &[]);
    case.map_or(Vec::new(), |case| case.runs.into_iter().map(|run| run.name).collect())
}

/// Runs of the case of `latest` that are not among the complete ones, `runs`, and whatever else was `begun`.
fn not_complete(runs: &[RunRecords], latest: &Manifest, begun: Vec<String>) -> Vec<String> {
    let mut names = names_in_case(latest);
    names.retain(|name| !runs.iter().any(|run| run.manifest.run == *name));
    let further: Vec<String> = begun.into_iter().filter(|name| !names.contains(name)).collect();
    names.extend(further);
    names
}

/// No run in the study's folder `path` is complete; those in `incomplete` are not.
fn no_run(path: &Path, incomplete: &[String]) -> FileError {
    let problem = match incomplete {
        [] => "there is no run in it".to_owned(),
        names => {
            format!("no run in it is complete; running or interrupted: {}", names.join(", "))
        }
    };
    let fix = "name the folder that `wakemix run CASE -o DIR` wrote, or complete it with --resume";
    FileError::content("a study", path, problem, fix)
}

/// Whether the case of `run` is that of `latest`, in what decides the run's result: other runs may have come
/// or gone since.
fn is_of_same_case(run: &Manifest, latest: &Manifest) -> bool {
    if run.case_sha256 == latest.case_sha256 {
        return true;
    }
    let of = |manifest: &Manifest, run: &str| case::fingerprint(&manifest.case_text, run);
    let now = of(latest, &run.run);
    of(run, &run.run) == now || of(run, "") == now
}

fn warnings(runs: &[RunRecords], latest: &Manifest) -> Vec<Warning> {
    let differs = |run: &&RunRecords| {
        let run = &run.manifest;
        !is_of_same_case(run, latest)
            || run.turbines_sha256 != latest.turbines_sha256
            || run.wind_sha256 != latest.wind_sha256
    };
    let warn = |run: &RunRecords| Warning {
        kind: WarningKind::MixedRuns,
        turbine: None,
        message: format!(
            "run {} was made with another version of the case, of a turbine or of a file of wind than run {}",
            run.manifest.run, latest.run
        ),
    };
    let computes_otherwise = |run: &&RunRecords| {
        run.manifest.version != latest.version || run.manifest.backend != latest.backend
    };
    let computed = |run: &Manifest| {
        let backend = run.backend.as_deref().unwrap_or("an unknown back-end");
        format!("{} with wakemix {} on {backend}", run.run, run.version)
    };
    let warn_of_bits = |run: &RunRecords| Warning {
        kind: WarningKind::MixedRuns,
        turbine: None,
        message: format!(
            "run {} was computed, and run {}: turbulence parts their last digits soon, and with them what is in the wind by chance",
            computed(&run.manifest),
            computed(latest)
        ),
    };
    let mixed = runs.iter().filter(differs).map(warn);
    mixed.chain(runs.iter().filter(computes_otherwise).map(warn_of_bits)).collect()
}

fn read_run(folder: &RunFolder, manifest: Manifest) -> Result<RunRecords, FileError> {
    let mut records = RunRecords {
        summary: read_summary(folder)?,
        manifest,
        series: SeriesFile::open(&folder.series_path())?,
        mean_planes: Vec::new(),
        last_planes: Vec::new(),
        phase_planes: Vec::new(),
        instant_paths: Vec::new(),
        scan_paths: scan_paths(folder)?,
        volume_paths: Vec::new(),
        last_filaments: None,
    };
    for path in entries(&folder.planes_path())? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with('.') || !name.ends_with(".nc") {
            continue;
        }
        if name.ends_with(MEAN) {
            records.mean_planes.push(netcdf::read_plane(&path)?);
        } else if name.ends_with(PHASES) {
            records.phase_planes.extend(netcdf::read_phases(&path)?);
        } else if name.ends_with(LAST) {
            records.last_planes.push(netcdf::read_plane(&path)?);
        } else {
            records.instant_paths.push(path);
        }
    }
    records.volume_paths = entries(&folder.volumes_path())?;
    let last = folder.volumes_path().join(LAST_FILAMENTS);
    if records.volume_paths.contains(&last) {
        records.last_filaments = Some(vtk::read_filaments(&last)?);
    }
    records.volume_paths.retain(|path| path.extension().is_some_and(|ending| ending == "vti"));
    Ok(records)
}

/// Files of the scans of the complete run in `folder`, by name.
///
/// # Errors
/// [`FileError::System`].
pub fn scan_paths(folder: &RunFolder) -> Result<Vec<PathBuf>, FileError> {
    let mut paths = entries(folder.path())?;
    paths.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(SCANS) && name.ends_with(".nc")
    });
    Ok(paths)
}

/// Paths of what is in the folder `path`, by name.
pub(super) fn entries(path: &Path) -> Result<Vec<PathBuf>, FileError> {
    let failed = |source| FileError::system("read", "the folder", path, source);
    let listed = fs::read_dir(path).map_err(failed)?;
    let mut paths = listed
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<PathBuf>, _>>()
        .map_err(failed)?;
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests;
