//! Gains are over a run of the same wind, whenever that run was made, or there are none.

mod small;

use formats::records::{RunFolder, read_manifest, write_manifest};
use small::{NREL_5MW, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Observer, Outcome, StudyError, StudyOptions};

fn case() -> String {
    let runs = r#"[[run]]
name = "baseline"
[[run]]
name = "pulse"
control.T1 = { kind = "pulse", amplitude_deg = 2.0, strouhal = 0.25 }
"#;
    small::case("gains", "", [10.0, 100.0], &[NREL_5MW], runs)
}

/// Keeps what was warned of.
#[derive(Default)]
struct Warned(Vec<String>);

impl Observer for Warned {
    fn warned(&mut self, warning: &str) {
        self.0.push(warning.to_owned());
    }
}

fn options(folder: &Path, runs: &[&str]) -> StudyOptions {
    let runs = runs.iter().map(|&run| run.to_owned()).collect();
    StudyOptions { runs, ..small::options(folder) }
}

#[test]
fn a_run_made_before_what_it_compares_with_gets_its_gains_later() {
    let folder = written(&case());
    let stop = AtomicBool::new(false);
    let mut first = Warned::default();
    let outcome = study::run(&options(folder.path(), &["pulse"]), &stop, &mut first);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    assert_eq!(summaries[0].array_power_gain, None);
    assert!(first.0.iter().any(|warning| warning.contains("--run baseline")), "{:?}", first.0);

    let again = StudyOptions { resume: true, ..options(folder.path(), &[]) };
    let outcome = small::run(&again);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    let pulse = summaries.iter().find(|summary| summary.run == "pulse").expect("its summary");
    let gain = pulse.array_power_gain.expect("a gain");
    // A pulse costs the turbine that pitches it.
    assert!(gain.mean < 0.0, "{gain:?}");
    assert_eq!(pulse.turbines[0].power_gain, Some(gain));
    assert_eq!(pulse.compare_with.as_deref(), Some("baseline"));
}

#[test]
fn another_wind_is_no_comparison() {
    let folder = written(&case());
    let outcome = small::run(&options(folder.path(), &[]));
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let before = fs::read(folder.path().join("out/pulse/summary.json")).expect("a summary");
    let other = StudyOptions {
        overwrite: true,
        overrides: vec!["wind.speed=7".to_owned()],
        ..options(folder.path(), &["pulse"])
    };
    let outcome = small::run(&other);
    let refused = matches!(&outcome, Err(StudyError::OtherCase { run, .. }) if run == "baseline");
    assert!(refused, "{outcome:?}");
    let after = fs::read(folder.path().join("out/pulse/summary.json")).expect("a summary");
    assert!(before == after, "a refused study has touched a run");
}

#[test]
fn another_version_of_the_program_is_no_comparison() {
    let folder = written(&case());
    small::done(&options(folder.path(), &["baseline"]));
    let baseline = RunFolder::new(&folder.path().join("out"), "baseline");
    let mut manifest = read_manifest(&baseline).expect("a manifest");
    manifest.version = "0.0.1".to_owned();
    write_manifest(&baseline, &manifest).expect("a manifest");
    let mut told = Warned::default();
    let pulse = StudyOptions { resume: true, ..options(folder.path(), &["pulse"]) };
    let outcome = study::run(&pulse, &AtomicBool::new(false), &mut told);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    let pulse = summaries.iter().find(|summary| summary.run == "pulse").expect("its summary");
    assert_eq!(pulse.array_power_gain, None);
    assert!(told.0.iter().any(|warning| warning.contains("or of the program")), "{:?}", told.0);
}
