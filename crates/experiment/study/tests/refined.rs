//! A study with a box of finer cells, from case to records, stopped on the way: what it leaves has the same
//! bits, and cells, memory and disk are as they were told.

mod small;

use small::{HALFWAY, STOP, assert_alike, left, written};
use std::fs;
use study::{Outcome, Outputs, Prepared, Silent, StudyOptions};

const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.08
[flow]
cells_per_diameter = 8
upstream_diameters = 2.0
downstream_diameters = 3.0
width_diameters = 4.0
height_diameters = 3.0
[[flow.refinement]]
downstream_diameters = 1.5
[time]
spin_up = 20.0
duration = 80.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [1.5, 0.0]
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3 }
control.T2 = { kind = "absent" }
[output]
lines_at = ["T2"]
inflow_at = ["T2"]
plane_interval = 20.0
volume_interval = 30.0
crosswind_diameters = [1.0]
"#;

#[test]
fn a_stopped_study_in_a_box_leaves_what_one_that_was_left_alone_does() {
    let folder = written(CASE);
    let options = |output: &str| StudyOptions {
        output: Some(folder.path().join(output)),
        ..small::options(folder.path())
    };
    let outcome = small::run(&options("whole"));
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };

    let mut again = options("stopped");
    let outputs = Outputs::standard().with(&HALFWAY);
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    again.resume = true;
    small::done(&again);
    let run = folder.path().join("stopped/helix");
    assert_alike(&folder.path().join("whole/helix"), &run);

    // Cells, memory and disk are as they were told.
    let setup = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    let summary = &summaries[0];
    let grids = &summary.flow.as_ref().expect("it tells").grids;
    assert_eq!(grids.len(), 2);
    let diameter = summary.conditions.rotor_diameter;
    assert_eq!((grids[0].spacing, grids[1].spacing), (diameter / 8.0, diameter / 16.0));
    let size = grids[1].size.map(|length| length / diameter);
    assert!(size.iter().zip([4.0, 2.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{size:?}");
    assert_eq!(summary.conditions.cells_per_diameter, Some(16.0));
    assert_eq!(summary.cost.n_cells, setup.plan.cells() as u64);
    let told = (setup.case.flow.solver.memory)(&setup.case, &setup.plan) as f64;
    let taken = summary.cost.memory as f64;
    assert!((0.9..1.2).contains(&(told / taken)), "{told} told, {taken} taken");
    let told = setup.disk_of_run(0, &Outputs::standard()) as f64;
    let checkpoint = fs::metadata(run.join("checkpoint")).expect("a checkpoint").len();
    let files: usize = left(&run).iter().map(|(_, bytes)| bytes.len()).sum();
    let taken = files as f64 + 2.0 * checkpoint as f64;
    assert!((1.0..2.0).contains(&(told / taken)), "{told} bytes told, {taken} taken");
}

#[test]
fn a_box_that_does_not_fit_is_pointed_at() {
    let folder = written(&CASE.replace("downstream_diameters = 1.5", "downstream_diameters = 2.5"));
    let refused = small::run(&small::options(folder.path())).unwrap_err();
    let words = match refused {
        study::StudyError::Case(error) => error.to_lines(),
        other => panic!("{other}"),
    };
    let place = "case.toml:13: the box flow.refinement.0 spans x = -126 to 504 m";
    assert!(words.contains(place) && words.contains("lower its downstream_diameters"), "{words}");
}
