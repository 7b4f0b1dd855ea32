//! A row in which each turbine seeks the helix of the one before: all of them are answered for, in analysis and report.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Options, Outcome, PhaseAnswers, PhaseQuestion, StudyError, Watcher};

/// All turbines stand in the path of one disk of slow air, whose waves T2 and T3 take for a helix.
const CASE: &str = r#"
name = "row"
[wind]
speed = 9.0
turbulence_intensity = 0.0
event = { kind = "rotating-disk", speed = 6.0, strouhal = 0.25 }
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 100.0
duration = 500.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
structure = "rigid"
[[turbine]]
name = "T3"
model = "nrel-5mw"
position_diameters = [10.0, 0.0]
structure = "rigid"
[[run]]
name = "both"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
control.T3 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
[[run]]
name = "without-t3"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
control.T3 = { kind = "absent" }
[[run]]
name = "alone"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "absent" }
control.T3 = { kind = "absent" }
[output]
interval = 0.2
lines_at = ["T2", "T3"]
"#;

struct Silent;

impl Watcher for Silent {}

/// What is answered of the run "both" of the study in `output`.
fn both(output: &Path) -> PhaseAnswers {
    let question = PhaseQuestion { run: output.join("both"), ..PhaseQuestion::default() };
    study::phases(&question).expect("sound records")
}

#[test]
fn every_turbine_that_seeks_a_helix_is_answered_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = folder.path().join("case.toml");
    fs::write(&case, CASE).expect("a file");
    let output = folder.path().join("out");
    let options = Options { case, output: Some(output.clone()), ..Options::default() };
    let outcome = study::run(&options, &AtomicBool::new(false), &mut Silent);
    let Ok(Outcome::Done { report, .. }) = outcome else { panic!("{outcome:?}") };

    let found = both(&output);
    assert!(found.without_truth.is_empty(), "{:?}", found.without_truth);
    let named: Vec<[&str; 2]> = found
        .answers
        .iter()
        .map(|answer| [answer.turbine.as_str(), answer.truth.as_str()])
        .collect();
    // T3's wind is told by the run in which T2 does the same.
    assert_eq!(named, [["T2", "alone"], ["T3", "without-t3"]]);
    // One wind met both.
    let [near, far] = [0, 1].map(|index: usize| &found.answers[index].yaw.true_phase);
    assert!(
        near.len() > 100 && near.len() == far.len(),
        "{} and {} instants",
        near.len(),
        far.len()
    );
    for (near, far) in near.iter().zip(far) {
        let apart = (near - far + 3.0 * PI).rem_euclid(2.0 * PI) - PI;
        assert!(apart.abs() < 1e-9, "{apart} rad");
    }

    let page = fs::read_to_string(&report).expect("a report");
    for turbine in ["T2", "T3"] {
        let part = format!("<h2>Phase synchronisation of {turbine}</h2>");
        let figure = format!("<figure id=\"phases-both-{turbine}\">");
        assert!(page.contains(&part) && page.contains(&figure), "{turbine}");
    }

    // What tells nothing of T3's wind any more takes nothing from T2.
    fs::remove_dir_all(output.join("without-t3")).expect("a folder less");
    let found = both(&output);
    assert_eq!(found.answers.len(), 1);
    assert_eq!(found.answers[0].turbine, "T2");
    let reasons = found.without_truth.as_slice();
    let [StudyError::NoTruth { turbine, .. }] = reasons else { panic!("{reasons:?}") };
    assert_eq!(turbine, "T3");
}
