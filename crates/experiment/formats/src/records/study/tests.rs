//! Studies that were left, read back.

use super::super::*;
use super::*;
use basis::Vector3;
use basis::records::{PlaneAxes, examples};

const CASE: &str = include_str!("../../../../../../cases/quickstart.toml");

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
    let manifest = Manifest::start("0.1.0", &case, text, run_index, [("iea-15mw", "a turbine")]);
    let folder = RunFolder::new(study, &manifest.run);
    folder.create().unwrap();
    write_manifest(&folder, &manifest).unwrap();
    let mut series = SeriesWriter::create(&folder.series_path(), &[basis::channels::TIME]).unwrap();
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
        pressure: None,
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
    // One that has not begun, and one that was interrupted.
    assert_eq!(read_study(study.path()).unwrap().incomplete, ["helix-ccw"]);
    let folder = leave(study.path(), 1, CASE);
    assert!(read_study(study.path()).unwrap().incomplete.is_empty());
    fs::remove_file(folder.summary_path()).unwrap();
    assert_eq!(read_study(study.path()).unwrap().incomplete, ["helix-ccw"]);
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
