//! An estimator replayed on the records of a run gives the estimates of the run: same rotor, same
//! calibration.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use basis::angle::wrap_to_half_turn;
use control::phase_sync::PhaseEstimator;
use postprocessing::{PhaseQuestion, Replayed};
use small::{ABSENT, DISK, behind_helix, done, options, written};
use std::fs;

/// The turbines stand side by side in the path of one disk of slow air, whose waves T2 takes for a helix of
/// T1; `keys` are in the control of T2.
fn case(keys: &str) -> String {
    let joins = format!(
        r#"{{ kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 2.0, fallback = "none" {keys} }}"#
    );
    let runs = [behind_helix("joined", &[joins.as_str()]), behind_helix("alone", &[ABSENT])];
    let kept = r#"[output]
interval = 0.2
lines_at = ["T2"]
"#;
    let machines = [r#"model = "own.toml""#; 2];
    small::case("replayed", DISK, [100.0, 500.0], &machines, &(runs.concat() + kept))
}

#[test]
fn a_replay_estimates_what_the_run_did() {
    assert_same_phases("");
}

/// Noise that differs from the estimator's own makes phases differ by far more than what is allowed.
#[test]
fn a_replay_assumes_the_noise_that_the_run_was_given() {
    assert_same_phases(", measurement_noise_1s_mnm = 0.19, process_noise_amplitude = 3e-3");
}

/// The case with `keys` in the control of T2: its run, and a replay of it, find the same phases.
fn assert_same_phases(keys: &str) {
    let folder = written(&case(keys));
    let library = formats::library::text("nrel-5mw").expect("a turbine of the library");
    fs::write(folder.path().join("own.toml"), library).expect("a file");
    let output = folder.path().join("out");
    done(&options(folder.path()));
    // The records stand without the turbine's file.
    fs::remove_file(folder.path().join("own.toml")).expect("a file");

    let ask = |estimator| {
        let question =
            PhaseQuestion { run: output.join("joined"), estimator, ..PhaseQuestion::default() };
        postprocessing::phase(&question).expect("a sound record")
    };
    let (recorded, replayed) = (ask(None), ask(Some(Replayed::InRun(PhaseEstimator::Robust))));
    assert!(recorded.times.len() > 100, "{} instants", recorded.times.len());
    let phases = recorded.tilt.phase.iter().zip(&replayed.tilt.phase);
    let apart = phases.map(|(a, b)| wrap_to_half_turn(a - b));
    let farthest = apart.fold(0.0_f64, |farthest, apart| farthest.max(apart.abs()));
    assert!(farthest < 1e-6, "{farthest} rad");
    // So do their deviations, without which nobody could tell how sure they were.
    let [kept, again] = [&recorded, &replayed]
        .map(|found| found.tilt.consistency.as_ref().expect("deviations in the series").mean);
    assert!(kept > 0.0 && (again / kept - 1.0).abs() < 1e-6, "{kept} {again}");
    // The published forms and the linear one listen to the same records.
    for form in [
        Replayed::InRun(PhaseEstimator::Published),
        Replayed::InRun(PhaseEstimator::PublishedWithOffset),
        Replayed::Linear,
        Replayed::Smoothed,
    ] {
        let found = ask(Some(form));
        assert_eq!(found.times, recorded.times, "{form:?}");
        assert!(found.tilt.agreement.rmse.is_finite(), "{form:?}");
    }
}
