//! A study that goes on for longer: the bits of one of the full length, or a refusal that says what prevents
//! it. In resolved flow `lattice.rs` tells the same.

mod small;

use basis::records::{Cost, Summary};
use small::{HALFWAY, NREL_5MW, STOP, options, written};
use std::fs;
use std::path::Path;
use study::outputs::Outputs;
use study::{Outcome, Silent, StudyError, StudyOptions};

/// A baseline and a helix of two flexible turbines, for `duration` (s), with `output` under `[output]`.
fn case(duration: f64, output: &str) -> String {
    let runs = format!(
        "[[run]]\nname = \"baseline\"\n{}[output]\n{output}",
        small::behind_helix("helix", &[small::MONITORING])
    );
    let more = "event = { kind = \"rotating-disk\", speed = 6.0, strouhal = 0.25 }\n";
    let text = small::case("longer", more, [5.0, duration], &[NREL_5MW, NREL_5MW], &runs);
    text.replace("structure = \"rigid\"", "instruments.rotor_speed = { noise_rpm = 0.05 }")
}

/// What the run `name` below `out` came to, but for what it cost.
fn summary(out: &Path, name: &str) -> Summary {
    let folder = formats::records::RunFolder::new(out, name);
    let mut summary = formats::records::read_summary(&folder).expect("a summary");
    summary.cost = Cost::default();
    summary
}

fn assert_alike(whole: &Path, other: &Path) {
    for name in ["baseline", "helix"] {
        assert_eq!(summary(whole, name), summary(other, name), "{name}");
        for file in ["series.csv", "T1.outb", "T2.outb"] {
            let read = |folder: &Path| fs::read(folder.join(name).join(file)).expect("a file");
            assert!(read(whole) == read(other), "{name}/{file} has other bits");
        }
        assert!(!other.join(name).join("series.csv.part").exists(), "{name}");
    }
}

#[test]
fn a_lengthened_study_is_that_of_the_full_length() {
    let folder = written(&case(20.0, ""));
    let first = options(folder.path());
    let out = small::done(&first);
    fs::write(folder.path().join("case.toml"), case(45.0, "")).expect("a case");
    let whole =
        small::done(&StudyOptions { output: Some(folder.path().join("whole")), ..first.clone() });
    // It may be stopped on the way, too.
    let resumed = StudyOptions { resume: true, jobs: Some(1), ..first };
    let outputs = Outputs::standard().with(&HALFWAY);
    let stopped = study::run_with(&resumed, &outputs, &STOP, &mut Silent);
    assert!(matches!(stopped, Ok(Outcome::Interrupted { .. })), "{stopped:?}");
    small::done(&resumed);
    assert_alike(&whole, &out);
    let manifest =
        formats::records::read_manifest(&formats::records::RunFolder::new(&out, "helix"));
    let manifest = manifest.expect("a manifest");
    assert!(manifest.finished.is_some() && manifest.case_text.contains("duration = 45.0"));
}

#[test]
fn what_prevents_it_is_said() {
    // Shorter, or otherwise changed: every key with what it was and is.
    let folder = written(&case(20.0, ""));
    let first = options(folder.path());
    let resumed = StudyOptions { resume: true, ..first.clone() };
    small::done(&first);
    let changed = case(15.0, "").replace("amplitude_deg = 4.0", "amplitude_deg = 3.0");
    fs::write(folder.path().join("case.toml"), changed).expect("a case");
    let error = small::run(&resumed).expect_err("it is shorter").to_string();
    assert!(
        error.contains("run baseline") && error.contains("time.duration: 20 before, 15 now"),
        "{error}"
    );
    let helix = StudyOptions { runs: vec!["helix".into()], ..resumed };
    let error = small::run(&helix).expect_err("it is shorter").to_string();
    let key = "run.helix.control.T1.amplitude_deg: 4 before, 3 now";
    assert!(error.contains(key) && error.contains("time.duration"), "{error}");

    // Without a checkpoint at its end.
    let remove = "last_checkpoint = \"remove\"\n";
    let folder = written(&case(20.0, remove));
    let first = options(folder.path());
    let out = small::done(&first);
    assert!(!out.join("helix/checkpoint").exists());
    fs::write(folder.path().join("case.toml"), case(30.0, remove)).expect("a case");
    let error = small::run(&StudyOptions { resume: true, ..first }).expect_err("nothing is kept");
    assert!(matches!(&error, StudyError::NotLengthened { .. }), "{error:?}");
    assert!(error.to_string().contains("from 20 s to 30 s: it left no checkpoint"), "{error}");

    // Turbulence in a box that is as long as the run.
    let turbulent = |duration: f64| {
        case(duration, "")
            .replace("turbulence_intensity = 0.0", "turbulence_intensity = 0.1")
            .replace("event = {", "# event = {")
            .replace("solver = \"uniform\"", "solver = \"turbulence\"")
    };
    let folder = written(&turbulent(20.0));
    let first = StudyOptions { runs: vec!["baseline".into()], ..options(folder.path()) };
    let out = small::done(&first);
    let before = fs::read(out.join("baseline/summary.json")).expect("a summary");
    fs::write(folder.path().join("case.toml"), turbulent(200.0)).expect("a case");
    let error = small::run(&StudyOptions { resume: true, ..first }).expect_err("another wind");
    assert!(error.to_string().contains("is another wind"), "{error}");
    assert_eq!(before, fs::read(out.join("baseline/summary.json")).expect("a summary"));
}
