//! What the program advises is what it accepts, and what cannot be done is known before anything is done.

mod small;

use formats::FileError;
use formats::records::RunFolder;
use miette::Diagnostic;
use small::{HALFWAY, NREL_5MW, STOP, options, run, written};
use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use study::outputs::Outputs;
use study::{Observer, Outcome, Silent, StudyError, StudyOptions};

const RUNS: &str = r#"[[run]]
name = "baseline"
[[run]]
name = "again"
"#;

fn case() -> String {
    small::case("advised", "", [10.0, 40.0], &[NREL_5MW], RUNS)
}

fn help(error: &StudyError) -> String {
    error.help().map(|help| help.to_string()).unwrap_or_default()
}

#[test]
fn a_damaged_checkpoint_says_what_then_works() {
    let folder = written(&case());
    let outputs = Outputs::standard().with(&HALFWAY);
    let first = options(folder.path());
    let outcome = study::run_with(&first, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    let checkpoint = RunFolder::new(&folder.path().join("out"), "baseline").checkpoint_path();
    let mut bytes = fs::read(&checkpoint).expect("a checkpoint");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xff;
    fs::write(&checkpoint, bytes).expect("a damaged checkpoint");
    let error = run(&StudyOptions { resume: true, ..first.clone() }).expect_err("it is damaged");
    assert!(matches!(&error, StudyError::File(FileError::Checkpoint { .. })), "{error:?}");
    let advice = help(&error);
    assert!(advice.contains("--run NAME --overwrite in place of --resume"), "{advice}");
    let followed = StudyOptions { overwrite: true, runs: vec!["baseline".into()], ..first.clone() };
    assert!(matches!(run(&followed), Ok(Outcome::Done { .. })));
    // And with that run complete, the study goes on.
    let resumed = StudyOptions { resume: true, ..first.clone() };
    assert!(matches!(run(&resumed), Ok(Outcome::Done { .. })));
    // Another study in its place, stopped in its first run: the rest of the old one is not taken for its own.
    STOP.store(false, Ordering::Relaxed);
    let overrides = vec!["time.duration=44".to_owned()];
    let other = StudyOptions { overwrite: true, overrides, ..first };
    let outcome = study::run_with(&other, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    let outcome = run(&StudyOptions { overwrite: false, resume: true, ..other });
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    assert!(summaries.iter().all(|summary| summary.conditions.duration == 44.0));
}

#[test]
fn nothing_cannot_be_resumed() {
    let folder = written(&case());
    let first = options(folder.path());
    let resumed = StudyOptions { resume: true, ..first.clone() };
    let error = run(&resumed).expect_err("nothing is there");
    assert!(matches!(&error, StudyError::NothingToResume { .. }), "{error:?}");
    assert!(help(&error).contains("leave --resume out"), "{error:?}");
    assert!(!folder.path().join("out").exists());
    let dry = run(&StudyOptions { dry_run: true, ..resumed.clone() });
    assert!(matches!(dry, Ok(Outcome::Estimated)), "{dry:?}");
    let one = StudyOptions { runs: vec!["baseline".into()], ..first };
    assert!(matches!(run(&one), Ok(Outcome::Done { .. })));
    // The other run begins, as there is a study to resume.
    assert!(matches!(run(&resumed), Ok(Outcome::Done { .. })));
}

/// What a run leaves that fails before its first step is no result.
#[test]
fn a_manifest_alone_does_not_block_the_next_try() {
    let folder = written(&case());
    let place = RunFolder::new(&folder.path().join("out"), "baseline");
    place.create().expect("folders");
    fs::write(place.manifest_path(), "{}").expect("a manifest");
    assert!(!place.holds_results());
    fs::write(place.path().join("notes.txt"), "mine").expect("a file of somebody's");
    assert!(place.holds_results());
    let error = run(&options(folder.path())).expect_err("somebody's file is there");
    assert!(matches!(error, StudyError::OutputExists { .. }), "{error:?}");
    fs::remove_file(place.path().join("notes.txt")).expect("a file");
    let outcome = run(&options(folder.path()));
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
}

/// Hears nothing but that rotors are being checked.
#[derive(Default)]
struct Ears {
    prepared: bool,
}

impl Observer for Ears {
    fn preparing(&mut self, _what: &str, _share: f64) {
        self.prepared = true;
    }
}

#[test]
fn a_folder_that_cannot_be_written_into_is_known_before_the_rotors_are_checked() {
    let folder =
        written(&case().replace("solver = \"uniform\"\nstep = 0.2", "cells_per_diameter = 8"));
    for output in ["case.toml", "case.toml/deep/out"] {
        let options =
            StudyOptions { output: Some(folder.path().join(output)), ..options(folder.path()) };
        let mut ears = Ears::default();
        let error = study::run(&options, &AtomicBool::new(false), &mut ears);
        let error = error.expect_err("a file is no folder");
        assert!(matches!(&error, StudyError::File(FileError::System { .. })), "{error:?}");
        assert!(help(&error).contains("-o DIR") && !ears.prepared, "{error:?}");
    }
}

#[test]
fn wind_that_is_not_there_leaves_nothing_behind() {
    let planes = case().replace("solver = \"uniform\"", "solver = \"planes\"");
    let planes = planes.replace("[flow]", "planes = \"none.bts\"\n[flow]");
    let folder = written(&planes);
    let Err(StudyError::Case(error)) = run(&options(folder.path())) else { panic!("no wind") };
    let problem = &error.problems()[0];
    assert_eq!(problem.line(), 6, "{problem}");
    assert!(problem.to_string().contains("the wind cannot be read"), "{problem}");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_run_that_is_named_twice_is_made_once() {
    let folder = written(&case());
    let twice = StudyOptions { runs: vec!["baseline".into(); 2], ..options(folder.path()) };
    let outcome = run(&twice);
    let Ok(Outcome::Done { .. }) = outcome else { panic!("{outcome:?}") };
    let again = StudyOptions { runs: vec!["baseline".into(); 2], overwrite: true, ..twice };
    assert!(matches!(run(&again), Ok(Outcome::Done { .. })));
}

/// What the study has in its folder bears this name; its locks bear names that no run can have.
#[test]
fn no_run_takes_a_name_that_the_study_has_in_use() {
    let named = |name: &str| {
        let text = case().replace("name = \"baseline\"", &format!("name = \"{name}\""));
        let folder = written(&text);
        let outcome = run(&options(folder.path()));
        (outcome, folder)
    };
    assert!(matches!(named("figures").0, Err(StudyError::Case(_))));
    for name in ["probes", "report", "lock.report"] {
        let (outcome, folder) = named(name);
        assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{name}: {outcome:?}");
        assert!(folder.path().join("out").join(name).join("summary.json").is_file());
    }
    for name in [".report", "report.", "a/b"] {
        assert!(matches!(named(name).0, Err(StudyError::Case(_))), "{name}");
    }
}

/// A folder with files of a run and without its manifest is somebody's; every advice leads on.
#[test]
fn files_without_a_manifest_are_neither_taken_nor_taken_away() {
    let folder = written(&case());
    let first = options(folder.path());
    let out = small::done(&first);
    let manifest = out.join("baseline/manifest.json");
    let kept = fs::read(&manifest).expect("a manifest");
    fs::remove_file(&manifest).expect("a manifest");
    fs::remove_file(out.join("baseline/summary.json")).expect("a summary");
    let checkpoint = out.join("baseline/checkpoint");
    for resume in [false, true] {
        let error = run(&StudyOptions { resume, ..first.clone() }).expect_err("it is unknown");
        assert!(matches!(error, StudyError::NoManifest { .. }), "{error:?}");
        assert!(checkpoint.is_file(), "it was taken away");
    }
    // Each of the ways that the advice names.
    fs::write(&manifest, kept).expect("a manifest");
    let resumed = run(&StudyOptions { resume: true, ..first.clone() });
    assert!(matches!(resumed, Ok(Outcome::Done { .. })), "{resumed:?}");
    fs::remove_file(&manifest).expect("a manifest");
    let replaced = run(&StudyOptions { overwrite: true, ..first });
    assert!(matches!(replaced, Ok(Outcome::Done { .. })), "{replaced:?}");
}

/// What another program identified, or swept, is told as such, and the advice leads on.
#[test]
fn records_of_an_earlier_program_are_refused_until_they_are_overwritten() {
    let folder = written(&case());
    let first = options(folder.path());
    let out = small::done(&first);
    let records =
        [("probes.json", "[{\"key\": \"a\"}]"), ("sweep.json", "{\"schema_version\": 1}")];
    for (name, text) in records {
        fs::write(out.join(name), text).expect("a record");
        let resumed = run(&StudyOptions { resume: true, ..first.clone() });
        let error = resumed.expect_err("an earlier program's");
        let told = error.to_string();
        assert!(told.contains(name) && told.contains("that of an earlier wakemix"), "{told}");
        assert!(help(&error).contains("--overwrite"), "{}", help(&error));
        let replaced = run(&StudyOptions { overwrite: true, ..first.clone() });
        assert!(matches!(replaced, Ok(Outcome::Done { .. })), "{name}: {replaced:?}");
        assert!(!out.join(name).exists(), "{name} is still there");
    }
}
