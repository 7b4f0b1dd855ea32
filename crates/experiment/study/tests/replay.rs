//! An estimator that is run over the records of a run believes what it believed in the run: same rotor, same calibration.

use farm::case::PhaseEstimator;
use std::f64::consts::PI;
use std::fs;
use std::sync::atomic::AtomicBool;
use study::{Options, Outcome, PhaseQuestion, Watcher};

/// The turbines stand side by side in the path of one disk of slow air, whose waves T2 takes for a helix of T1.
const CASE: &str = r#"
name = "replayed"
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
model = "own.toml"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[turbine]]
name = "T2"
model = "own.toml"
position_diameters = [5.0, 0.0]
structure = "rigid"
[[run]]
name = "joined"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 2.0, fallback = "none" KEYS }
[[run]]
name = "alone"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "absent" }
[output]
interval = 0.2
lines_at = ["T2"]
"#;

struct Silent;

impl Watcher for Silent {}

#[test]
fn a_replay_believes_what_the_run_did() {
    assert_believed("");
}

/// Noise that differs from the estimator's own makes phases differ by far more than what is allowed.
#[test]
fn a_replay_believes_in_the_noise_that_the_run_was_given() {
    assert_believed(", measurement_noise_mnm = 0.6, wandering_amplitude = 3e-3");
}

/// The case with `keys` in the control of T2: its run, and a replay of it, find the same phases.
fn assert_believed(keys: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = folder.path().join("case.toml");
    fs::write(&case, CASE.replace(" KEYS", keys)).expect("a file");
    let library = formats::library::text("nrel-5mw").expect("a turbine of the library");
    fs::write(folder.path().join("own.toml"), library).expect("a file");
    let output = folder.path().join("out");
    let options = Options { case, output: Some(output.clone()), ..Options::default() };
    let outcome = study::run(&options, &AtomicBool::new(false), &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    // The records stand without the turbine's file.
    fs::remove_file(folder.path().join("own.toml")).expect("a file");

    let ask = |estimator| {
        let question =
            PhaseQuestion { run: output.join("joined"), estimator, ..PhaseQuestion::default() };
        study::phase(&question).expect("a sound record")
    };
    let (believed, replayed) = (ask(None), ask(Some(PhaseEstimator::Robust)));
    assert!(believed.times.len() > 100, "{} instants", believed.times.len());
    let phases = believed.tilt.phase.iter().zip(&replayed.tilt.phase);
    let apart = phases.map(|(a, b)| (a - b + 3.0 * PI).rem_euclid(2.0 * PI) - PI);
    let farthest = apart.fold(0.0_f64, |farthest, apart| farthest.max(apart.abs()));
    assert!(farthest < 1e-6, "{farthest} rad");
}
