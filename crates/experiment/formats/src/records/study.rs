//! A study read back from its folder.

use super::planes::{LAST, MEAN, PHASES};
use super::{Manifest, RunFolder, SeriesFile, read_manifest, read_summary};
use crate::{FileError, case, netcdf};
use basis::records::{Plane, Summary, Warning, WarningKind};
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
    /// Runs that are under way or were interrupted.
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
    /// Files of volumes, by time.
    pub volume_paths: Vec<PathBuf>,
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
        incomplete,
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
    let Some(latest) = runs.max_by_key(|run| &run.started) else { return Vec::new() };
    let case = case::parse("", &latest.case_text, &[]);
    case.map_or(Vec::new(), |case| case.runs.into_iter().map(|run| run.name).collect())
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
        volume_paths: Vec::new(),
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
    records.volume_paths.retain(|path| path.extension().is_some_and(|ending| ending == "vti"));
    Ok(records)
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
mod tests {
    use super::super::*;
    use super::*;
    use basis::Vector3;
    use basis::records::{PlaneAxes, examples};

    const CASE: &str = include_str!("../../../../../cases/quickstart.toml");

    fn summary(run: &str) -> Summary {
        // Numbers whose digits do not end.
        let turbine = examples::turbine("T1", 1.1e7 / 3.0);
        Summary { run: run.to_owned(), ..examples::summary(run, vec![turbine]) }
    }

    fn plane(name: &str, averaged: f64) -> Plane {
        Plane {
            name: name.into(),
            axes: PlaneAxes::Horizontal,
            origin: [0.0, 0.0, 150.0],
            spacing: [15.0, 15.0],
            n_points: [2, 2],
            time: 1500.0,
            averaged,
            velocity: [vec![9.0, 8.0, 7.0, 6.5], vec![0.0; 4], vec![0.1; 4]],
        }
    }

    /// A complete run as the program leaves it.
    fn leave(study: &Path, run_index: usize, text: &str) -> RunFolder {
        let case = crate::case::parse("quickstart.toml", text, &[]).unwrap();
        let manifest =
            Manifest::start("0.1.0", &case, text, run_index, [("iea-15mw", "a turbine")]);
        let folder = RunFolder::new(study, &manifest.run);
        folder.create().unwrap();
        write_manifest(&folder, &manifest).unwrap();
        let mut series =
            SeriesWriter::create(&folder.series_path(), &[basis::channels::TIME]).unwrap();
        series.write(&[0.1]).unwrap();
        series.finish().unwrap();
        let (setting, now) = (PlaneSetting::example(), plane("hub-height", 0.0));
        write_mean_plane(&folder, &setting, &plane("hub-height", 1200.0)).unwrap();
        write_last_plane(&folder, &setting, &now).unwrap();
        let at_phase = AtPhase { phase: 0.5, n_instants: 3, plane: &now };
        write_phase_planes(&folder, &setting, &[at_phase]).unwrap();
        let instants = folder.instants_path("hub-height");
        let mut instants = InstantWriter::create(&instants, &setting, &now).unwrap();
        instants.write(&now).unwrap();
        instants.finish().unwrap();
        let volume = Volume {
            origin: Vector3::ZERO,
            spacing: 30.0,
            n_points: [1, 1, 1],
            time: 5.0,
            velocity: [vec![9.0], vec![0.0], vec![0.0]],
        };
        write_volume(&folder, 0, &volume).unwrap();
        write_summary(&folder, &summary(&manifest.run)).unwrap();
        write_manifest(&folder, &manifest.finish("portable")).unwrap();
        folder
    }

    #[test]
    fn a_study_comes_back_as_it_was_left() {
        let study = tempfile::tempdir().unwrap();
        leave(study.path(), 1, CASE);
        leave(study.path(), 0, CASE);
        fs::write(study.path().join("report.html"), "a page").unwrap();
        let records = read_study(study.path()).unwrap();
        assert_eq!(records.case_name, "quickstart");
        assert_eq!(records.case_text, CASE);
        let names: Vec<&str> = records.runs.iter().map(|run| run.summary.run.as_str()).collect();
        assert_eq!(names, ["baseline", "helix-ccw"]);
        let run = &records.runs[0];
        assert_eq!(run.summary, summary("baseline"));
        assert_eq!(run.series.read(|_| true).unwrap().columns, [[0.1]]);
        assert_eq!(run.mean_planes, [plane("hub-height", 1200.0)]);
        assert_eq!(run.last_planes, [plane("hub-height", 0.0)]);
        assert!(run.instant_paths[0].ends_with("baseline/planes/hub-height.nc"));
        assert_eq!(run.phase_planes, [(0.5, plane("hub-height", 0.0))]);
        assert!(run.volume_paths[0].ends_with("baseline/volumes/velocity-0000.vti"));
        assert!(run.manifest.finished.is_some() && run.manifest.machine.n_cores > 0);
        assert!(records.warnings.is_empty() && records.incomplete.is_empty());
        let read = read_summaries(study.path()).unwrap();
        let kept = records.runs.into_iter().map(|run| (run.manifest, run.summary));
        assert_eq!(read, kept.collect::<Vec<_>>());
    }

    #[test]
    fn a_summary_with_every_field_comes_back_to_the_bit() {
        let study = tempfile::tempdir().unwrap();
        let folder = leave(study.path(), 0, CASE);
        let mut full = examples::full();
        full.array_power.mean = 1.1e7 / 3.0;
        full.turbines[0].loads[1].value = 0.1 + 0.2;
        write_summary(&folder, &full).unwrap();
        assert_eq!(read_summary(&folder).unwrap(), full);
    }

    #[test]
    fn a_summary_of_another_layout_says_who_wrote_it_and_what_to_do() {
        let study = tempfile::tempdir().unwrap();
        let folder = leave(study.path(), 0, CASE);
        let other = |version: u32| {
            let text = format!("{{\"schema_version\": {version}, \"case\": \"quickstart\"}}");
            fs::write(folder.summary_path(), text).unwrap();
            let error = read_summary(&folder).unwrap_err();
            let help = miette::Diagnostic::help(&error).unwrap().to_string();
            (error.to_string(), help)
        };
        let (problem, help) = other(1);
        let written = "its schema_version is 1, that of an earlier wakemix; this one reads 3";
        assert!(problem.contains(written), "{problem}");
        assert!(help.contains("--overwrite") && help.contains("manifest.json"), "{help}");
        let (problem, help) = other(4);
        assert!(problem.contains("schema_version is 4, that of a later wakemix"), "{problem}");
        assert!(help.contains("a later one"), "{help}");
    }

    #[test]
    fn incomplete_runs_and_mixed_cases_are_reported() {
        let study = tempfile::tempdir().unwrap();
        leave(study.path(), 0, CASE);
        let folder = leave(study.path(), 1, CASE);
        fs::remove_file(folder.summary_path()).unwrap();
        let records = read_study(study.path()).unwrap();
        assert_eq!(records.incomplete, ["helix-ccw"]);
        leave(study.path(), 1, &CASE.replace("speed = 9.0", "speed = 8.0"));
        assert_eq!(read_study(study.path()).unwrap().warnings.len(), 1);
    }

    #[test]
    fn a_folder_without_runs_is_reported() {
        let study = tempfile::tempdir().unwrap();
        let error = read_study(study.path()).unwrap_err().to_string();
        assert!(error.contains("does not hold a study: there is no run in it"), "{error}");
        assert_eq!(read_summaries(study.path()).unwrap_err().to_string(), error);
        let error = read_study(&study.path().join("none")).unwrap_err().to_string();
        assert!(error.contains("cannot read the folder"), "{error}");
    }

    #[test]
    fn a_broken_summary_is_reported_with_its_line() {
        let study = tempfile::tempdir().unwrap();
        let folder = leave(study.path(), 0, CASE);
        fs::write(folder.summary_path(), "{\n  \"schema_version\": \"one\"\n}").unwrap();
        let error = read_study(study.path()).unwrap_err().to_string();
        assert!(error.contains("summary.json does not hold the summary of a run"), "{error}");
        assert!(error.contains("line 2"), "{error}");
    }

    #[test]
    fn a_cleared_folder_holds_nothing_of_the_earlier_run() {
        let study = tempfile::tempdir().unwrap();
        let folder = leave(study.path(), 0, CASE);
        fs::write(folder.checkpoint_path(), "x").unwrap();
        folder.clear().unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        folder.clear().unwrap();
        folder.create().unwrap();
    }
}
