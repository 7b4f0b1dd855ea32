//! A study too short to say anything of phases still ends with its report.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use small::{MONITORING, NREL_5MW, behind_helix, case, done, options, written};
use std::fs;

#[test]
fn a_run_shorter_than_a_period_of_the_helix_gets_its_report() {
    let run = behind_helix("monitoring", &[MONITORING]);
    let folder = written(&case("short", "", [10.0, 40.0], &[NREL_5MW; 2], &run));
    let made = postprocessing::report(&done(&options(folder.path()))).expect("a report");
    let report = made.page;
    assert!(fs::metadata(&report).is_ok_and(|found| found.len() > 0), "{}", report.display());
}
