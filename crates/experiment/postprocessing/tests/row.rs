//! A row in which each turbine looks for the helix of the one before: all of them are answered for, in
//! analysis and report.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use basis::angle::wrap_to_half_turn;
use postprocessing::{PhaseAnswers, PhaseQuestion, PostprocessingError};
use small::{ABSENT, DISK, MONITORING, NREL_5MW, behind_helix, done, options, written};
use std::fs;
use std::path::Path;

/// All turbines stand in the path of one disk of slow air, whose waves T2 and T3 take for a helix.
fn case() -> String {
    let runs = [
        behind_helix("both", &[MONITORING, MONITORING]),
        behind_helix("without-t3", &[MONITORING, ABSENT]),
        behind_helix("alone", &[ABSENT, ABSENT]),
    ];
    let kept = r#"[output]
interval = 0.2
lines_at = ["T2", "T3"]
"#;
    small::case("row", DISK, [100.0, 500.0], &[NREL_5MW; 3], &(runs.concat() + kept))
}

/// What is answered of the run "both" of the study in `output`.
fn both(output: &Path) -> PhaseAnswers {
    let question = PhaseQuestion { run: output.join("both"), ..PhaseQuestion::default() };
    postprocessing::phases(&question).expect("sound records")
}

#[test]
fn every_turbine_that_estimates_a_phase_has_an_answer() {
    let folder = written(&case());
    let output = folder.path().join("out");
    let made = postprocessing::report(&done(&options(folder.path()))).expect("a report");
    let report = made.page;

    let found = both(&output);
    assert!(found.without_truth.is_empty(), "{:?}", found.without_truth);
    let named: Vec<[&str; 2]> = found
        .answers
        .iter()
        .map(|answer| [answer.turbine.as_str(), answer.truth.as_str()])
        .collect();
    // T3's wind is given by the run in which T2 does the same.
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
        let apart = wrap_to_half_turn(near - far);
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
    let [PostprocessingError::NoTruth { turbine, .. }] = reasons else { panic!("{reasons:?}") };
    assert_eq!(turbine, "T3");
}
