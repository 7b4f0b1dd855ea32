//! A study too short to say anything of phases still ends with its report.

use std::fs;
use std::sync::atomic::AtomicBool;
use study::{Options, Outcome, Watcher};

const CASE: &str = r#"
name = "short"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 40.0
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
[[run]]
name = "watching"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
"#;

struct Silent;

impl Watcher for Silent {}

#[test]
fn a_run_shorter_than_a_period_of_the_helix_gets_its_report() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = folder.path().join("short.toml");
    fs::write(&case, CASE).expect("a file");
    let options = Options { case, output: Some(folder.path().join("out")), ..Options::default() };
    let outcome = study::run(&options, &AtomicBool::new(false), &mut Silent);
    let Ok(Outcome::Done { report, .. }) = outcome else { panic!("{outcome:?}") };
    assert!(fs::metadata(&report).is_ok_and(|found| found.len() > 0), "{}", report.display());
}
