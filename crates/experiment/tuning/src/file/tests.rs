//! Tests of the study file: what is refused, with its line, and what points become.

use super::*;
use std::fs;
use tempfile::TempDir;

/// Two turbines in wind that is the same everywhere, the first with a helix.
const CASE: &str = r#"
name = "two"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
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
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

const STUDY: &str = r#"case = "case.toml"
run = "helix"
block = 5
[budget]
runs = 9
[design]
first = 4
[[variable]]
key = "control.T1.strouhal"
from = 0.1
to = 0.5
mirrored = true
[[variable]]
key = "control.T1.amplitude_deg"
name = "amplitude"
from = 1
to = 5
step = 0.5
"#;

fn written(study: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("case.toml"), CASE).expect("a case");
    fs::write(folder.path().join("study.toml"), study).expect("a study");
    folder
}

fn read(study: &str) -> Result<TuningFile, TuningError> {
    TuningFile::read(&written(study).path().join("study.toml"))
}

#[test]
fn a_study_is_read_and_its_points_become_overrides() {
    let file = read(STUDY).expect("a sound file");
    assert_eq!((file.run.as_str(), file.baseline.as_str()), ("helix", "baseline"));
    assert_eq!((file.budget, file.n_first, file.parallel, file.block), (9, 4, 1, 5.0));
    assert!(file.is_of_run_alone());
    let there = file.overrides(&[0.25, 4.0]);
    let expected = [
        "run.helix.control.T1.strouhal=0.25",
        "run.helix.control.T1.sense=\"ccw\"",
        "run.helix.control.T1.amplitude_deg=4.0",
    ];
    assert_eq!(there, expected);
    assert_eq!(
        file.overrides(&[-0.3, 1.5])[..2],
        ["run.helix.control.T1.strouhal=0.3", "run.helix.control.T1.sense=\"cw\""]
    );
    assert_eq!(file.words(&[-0.3, 1.5]), "St = -0.3, amplitude = 1.5°");
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_key() {
    for (from, to, line, key) in [
        ("run = \"helix\"", "run = \"helx\"", 2, "`run`"),
        ("run = \"helix\"", "run = \"baseline\"", 2, "`run`"),
        ("block = 5", "baseline = \"none\"", 3, "`baseline`"),
        ("block = 5", "block = 0", 3, "`block`"),
        ("runs = 9", "runs = 0", 5, "`budget.runs`"),
        ("runs = 9", "runs = 9\nleast_gain = 2", 6, "`budget.least_gain`"),
        ("first = 4", "first = 10", 7, "`design.first`"),
        ("first = 4", "points = [[0.2, 2], [0.0, 3]]", 7, "`design.points`"),
        ("from = 0.1", "from = 0.0", 10, "`variable.from`"),
        ("to = 0.5", "to = 0.05", 11, "`variable.to`"),
        ("control.T1.amplitude_deg", "control.T1.amplitud_deg", 14, "`variable.key`"),
        ("step = 0.5", "step = 5", 18, "`variable.step`"),
    ] {
        let error = read(&STUDY.replacen(from, to, 1)).expect_err(to);
        let TuningError::File(FileError::Content { problem, fix, .. }) = &error else {
            panic!("{to}: {error:?}")
        };
        assert!(problem.starts_with(&format!("line {line}, {key}: ")), "{to}: {problem}");
        assert!(!fix.is_empty());
    }
    let unknown = read(&STUDY.replace("block = 5", "blok = 5")).expect_err("no such key");
    assert!(unknown.to_string().contains("blok"), "{unknown}");
}

#[test]
fn a_cheaper_source_is_read_or_refused_with_its_line() {
    let with = |text: &str| read(&format!("{STUDY}[[cheaper]]\n{text}"));
    let file =
        with("name = \"coarse\"\nset = [\"flow.step=0.4\"]\nruns = 7\n").expect("a sound file");
    let own = file.of_cheaper(0);
    assert_eq!((own.budget, own.n_first, own.cheaper.len()), (7, 7, 0));
    assert_eq!(own.overrides(&[0.25, 4.0])[0], "flow.step=0.4");
    assert_eq!(own.overrides(&[0.25, 4.0])[1..], file.overrides(&[0.25, 4.0])[..]);
    let n_lines = STUDY.lines().count();
    for (text, line, words) in [
        ("name = \"a/b\"\nset = [\"flow.step=0.4\"]\nruns = 7\n", 1, "`cheaper.name`"),
        ("name = \"baseline\"\nset = [\"flow.step=0.4\"]\nruns = 7\n", 1, "`cheaper.name`"),
        ("name = \"coarse\"\nruns = 7\n", 1, "`case` or `set` is expected"),
        ("name = \"coarse\"\nset = [\"flow.step=0.4\"]\nruns = 1\n", 4, "`cheaper.runs`"),
        ("name = \"coarse\"\nset = [\"flow.stp=0.4\"]\nruns = 7\n", 1, "stp"),
        ("name = \"coarse\"\ncase = \"quickstart\"\nruns = 7\n", 1, "no run called `helix`"),
    ] {
        let error = with(text).expect_err(text);
        let TuningError::File(FileError::Content { problem, .. }) = &error else {
            panic!("{text}: {error:?}")
        };
        let place = format!("line {}, ", n_lines + line);
        assert!(problem.starts_with(&place) && problem.contains(words), "{text}: {problem}");
    }
}

/// Where a lidar loop holds the hub vortex, as two numbers beside the place that the case gives.
const REFERENCE: &str = r#"case = "case.toml"
run = "closed-loop"
block = 200
[budget]
runs = 12
[[variable]]
key = "control.T1.reference_shift_tilt"
unit = "m"
from = -6
to = 6
[[variable]]
key = "run.closed-loop.control.T1.reference_shift_yaw"
unit = "m"
from = -6
to = 6
[loads]
channels = ["T1.RootMyb1", "T2.RootMyb1"]
"#;

#[test]
fn the_reference_of_a_lidar_loop_can_be_searched() {
    let folder = written(REFERENCE);
    // The shipped case in one wind: without the sweep, which ends it.
    let shipped = shipped::find("lidar-closed-loop").expect("it ships").text();
    let (one_wind, _) = shipped.split_once("[sweep]").expect("a sweep");
    fs::write(folder.path().join("case.toml"), one_wind).expect("a case");
    let file = TuningFile::read(&folder.path().join("study.toml")).expect("a sound study");
    assert_eq!(file.baseline, "open-loop");
    assert!(file.is_of_run_alone(), "one open loop serves all points");
    let overrides = file.overrides(&[-1.5, 2.0]);
    assert_eq!(
        overrides,
        [
            "run.closed-loop.control.T1.reference_shift_tilt=-1.5",
            "run.closed-loop.control.T1.reference_shift_yaw=2.0"
        ]
    );
    let case = shipped::read(&file.case, &overrides).expect("a sound case").case;
    let values = case.runs[2].control[0].values();
    let shifts = ["reference_shift_tilt", "reference_shift_yaw"].map(|key| values.number(key));
    assert_eq!(shifts, [-1.5, 2.0]);
    let far = REFERENCE.replacen("to = 6", "to = 600", 1);
    fs::write(folder.path().join("study.toml"), far).expect("a study");
    let error = TuningFile::read(&folder.path().join("study.toml")).expect_err("out of range");
    assert!(error.to_string().contains("reference_shift_tilt"), "{error}");
}
