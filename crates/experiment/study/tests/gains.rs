//! Gains are over a run of the same wind, whenever that run was made, or there are none.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Options, Outcome, StudyError, Watcher};

const CASE: &str = r#"
name = "gains"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 100.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[[run]]
name = "pulse"
control.T1 = { kind = "pulse", amplitude_deg = 2.0, strouhal = 0.25 }
"#;

/// Keeps what was warned of.
#[derive(Default)]
struct Warned(Vec<String>);

impl Watcher for Warned {
    fn warned(&mut self, warning: &str) {
        self.0.push(warning.to_owned());
    }
}

fn options(folder: &Path, runs: &[&str]) -> Options {
    Options {
        case: folder.join("case.toml"),
        output: Some(folder.join("out")),
        runs: runs.iter().map(|&run| run.to_owned()).collect(),
        ..Options::default()
    }
}

#[test]
fn a_run_made_before_what_it_compares_with_gets_its_gains_later() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("case.toml"), CASE).expect("a file");
    let stop = AtomicBool::new(false);
    let mut first = Warned::default();
    let outcome = study::run(&options(folder.path(), &["pulse"]), &stop, &mut first);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    assert_eq!(summaries[0].array_power_gain, None);
    assert!(first.0.iter().any(|warning| warning.contains("--run baseline")), "{:?}", first.0);

    let again = Options { resume: true, ..options(folder.path(), &[]) };
    let outcome = study::run(&again, &stop, &mut Warned::default());
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
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("case.toml"), CASE).expect("a file");
    let stop = AtomicBool::new(false);
    let outcome = study::run(&options(folder.path(), &[]), &stop, &mut Warned::default());
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let before = fs::read(folder.path().join("out/pulse/summary.json")).expect("a summary");
    let other = Options {
        overwrite: true,
        overrides: vec!["wind.speed=7".to_owned()],
        ..options(folder.path(), &["pulse"])
    };
    let outcome = study::run(&other, &stop, &mut Warned::default());
    let refused = matches!(&outcome, Err(StudyError::OtherCase { run, .. }) if run == "baseline");
    assert!(refused, "{outcome:?}");
    let after = fs::read(folder.path().join("out/pulse/summary.json")).expect("a summary");
    assert!(before == after, "a refused study has touched a run");
}
