//! A study in free vortices, from case to records, stopped on the way: what it leaves has the same bits; and
//! what of a case it cannot take.

mod small;

use small::{HALFWAY, STOP, written};
use std::fs;
use std::path::Path;
use study::{Outcome, Outputs, Prepared, Silent, StudyError, StudyOptions};

/// Two turbines so close that the first one's wake reaches the second, in sheared turbulence.
const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.06
shear_exponent = 0.2
turbulence_model = "kaimal"
[flow]
solver = "vortex"
steps_per_turn = 16
wake_length_diameters = 2.0
near_wake_diameters = 0.2
far_wake_filaments = 4
far_wake_steps = 1
points_per_diameter = 4
[time]
spin_up = 5.0
duration = 20.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [1.0, 0.2]
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3 }
[output]
crosswind_diameters = [1.0]
volume_interval = 10.0
"#;

fn options(folder: &Path, name: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(name)), ..small::options(folder) }
}

/// Files below `folder` that hold physics, by their names.
fn physics(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for place in [folder.to_owned(), folder.join("planes"), folder.join("volumes")] {
        let mut names: Vec<_> = fs::read_dir(&place)
            .unwrap_or_else(|error| panic!("{}: {error}", place.display()))
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| {
                let kind = path.extension().and_then(|kind| kind.to_str());
                kind.is_some_and(|kind| ["csv", "nc", "vti", "vtk", "outb"].contains(&kind))
            })
            .collect();
        names.sort();
        for path in names {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            files.push((name, fs::read(&path).expect("a file")));
        }
    }
    files
}

#[test]
fn a_stopped_study_leaves_what_one_that_was_left_alone_does() {
    let folder = written(CASE);
    let outcome = small::run(&options(folder.path(), "whole"));
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let mut again = options(folder.path(), "stopped");
    let outputs = Outputs::standard().with(&HALFWAY);
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    again.resume = true;
    let outcome = small::run(&again);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    assert!(summaries[0].has_wakes());
    let whole = physics(&folder.path().join("whole/helix"));
    assert_eq!(physics(&folder.path().join("stopped/helix")), whole);
    let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).collect();
    for name in ["series.csv", "T2.outb", "hub-height-mean.nc"] {
        assert!(names.contains(&name), "{name} of {names:?}");
    }
}

#[test]
fn steps_that_turn_a_rotor_too_far_are_refused_and_long_ones_warned_of() {
    let lay_out = |flow: &str| {
        let text = CASE.replace("steps_per_turn = 16", flow);
        let folder = written(&text);
        Prepared::read(&folder.path().join("case.toml"), &[])
    };
    // NREL 5 MW at its best tip-speed ratio, 7.5, turns by 61° a second in 9 m/s.
    let Err(StudyError::Case(error)) = lay_out("step = 1.0") else { panic!("it is taken") };
    let text = error.to_lines();
    assert!(text.contains("T1 turns by 61° in it, the maximum is 45°"), "{text}");
    let warned = |flow: &str| {
        let prepared = lay_out(flow).expect("it can be");
        let warnings: Vec<String> =
            prepared.warnings.iter().map(|warning| warning.message.clone()).collect();
        warnings.iter().any(|warning| warning.contains("in a step: its wake is a polygon"))
    };
    assert!(warned("step = 0.4") && !warned("step = 0.2"));
}
