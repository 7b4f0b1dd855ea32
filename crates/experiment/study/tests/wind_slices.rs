//! Slices behind a turbine, recorded in resolved flow, and blocks of them as the wind of another case.

mod small;

use flow::inflow::{Cut, CutPlanes, Planes};
use formats::records::RunFolder;
use formats::turbulence_box;
use small::{HALFWAY, STOP, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Outcome, Outputs, Prepared, Sample, Silent, StudyError, StudyOptions};

/// A turbine in steady, sheared wind on few cells; slices before it and in its wake, where another stands.
const SOURCE: &str = r#"
name = "source"
[wind]
speed = 9.0
turbulence_intensity = 0.0
shear_exponent = 0.2
[flow]
cells_per_diameter = 8
upstream_diameters = 2.0
downstream_diameters = 2.5
width_diameters = 5.0
height_diameters = 2.5
[time]
spin_up = 30.0
duration = 90.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[output]
last_checkpoint = "remove"
further.wake = { kind = "wind-slices", distances_diameters = [-1.5, 2.0], width = 500, height = 160, spacing = 10 }
"#;
/// The same turbine in a part of such a slice.
const SINK: &str = r#"
name = "sink"
[wind]
speed = 9.0
turbulence_intensity = 0.05
planes = "runs/baseline/slices-wake-2D.bts"
cut = { from = 5.0, duration = 54.0, width = 160, height = 160, spacing = 10.0, shift = -170.0 }
[flow]
solver = "planes"
step = 0.1
[time]
spin_up = 5.0
duration = 30.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
"#;

fn options(folder: &Path, name: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(name)), ..small::options(folder) }
}

fn run(options: &StudyOptions, outputs: &Outputs) -> Outcome {
    study::run_with(options, outputs, &STOP, &mut Silent).expect("it runs")
}

fn summary(folder: &Path) -> serde_json::Value {
    let text = fs::read_to_string(RunFolder::new(folder, "baseline").summary_path()).expect("it");
    serde_json::from_str(&text).expect("JSON")
}

fn power(folder: &Path) -> f64 {
    summary(folder)["turbines"][0]["power"]["mean"].as_f64().expect("a number")
}

/// Mean speed at the hub of a rotor `shift` (m) to the left of the middle of the slice at `path`.
fn speed(path: &Path, shift: f64) -> f64 {
    let cut = Cut { width: Some(20.0), shift, ..Cut::default() };
    let planes = turbulence_box::open(path).expect("a slice");
    CutPlanes::new(planes, &cut, 90.0).expect("a part").grid().speed
}

#[test]
fn a_turbine_meets_the_wake_or_the_wind_beside_it_and_a_break_changes_no_bit() {
    let folder = written(SOURCE);
    let outputs = Outputs::standard();
    assert!(matches!(run(&options(folder.path(), "runs"), &outputs), Outcome::Done { .. }));
    let whole = folder.path().join("runs/baseline");
    let [before, behind] = ["-1.5D", "2D"].map(|at| whole.join(format!("slices-wake-{at}.bts")));
    let grid = turbulence_box::open(&behind).expect("a slice").grid();
    assert_eq!(([grid.n_y, grid.n_z], grid.first), ([51, 17], [-250.0, 10.0]));
    // Whole steps next to a second.
    assert!(!grid.repeats && (grid.interval - 1.0).abs() < 0.1, "{grid:?}");
    assert!((grid.length() - 60.0).abs() < 2.0 * grid.interval, "{grid:?}");
    assert!(!whole.join("slices-wake-2D.bts.part").exists());
    // The wind that comes in is slowed a little, the wake much, and beside it the wind blows.
    let [inflow, wake, aside] = [speed(&before, 0.0), speed(&behind, 0.0), speed(&behind, -190.0)];
    assert!((inflow - 9.0).abs() < 0.3 && wake < 6.5 && aside > 8.7, "{inflow} {wake} {aside}");

    let mut stopped = options(folder.path(), "stopped");
    let outcome = run(&stopped, &outputs.clone().with(&HALFWAY));
    assert!(matches!(outcome, Outcome::Interrupted { .. }));
    STOP.store(false, Ordering::SeqCst);
    stopped.resume = true;
    assert!(matches!(run(&stopped, &outputs), Outcome::Done { .. }));
    for file in ["slices-wake--1.5D.bts", "slices-wake-2D.bts"] {
        let [one, other] = ["runs", "stopped"].map(|name| {
            fs::read(folder.path().join(name).join("baseline").join(file)).expect("it")
        });
        assert!(one == other, "{file} differs");
    }

    let sink = folder.path().join("sink.toml");
    fs::write(&sink, SINK).expect("a file");
    let of = |name: &str, shift: &str| {
        let options = StudyOptions {
            case: sink.clone(),
            output: Some(folder.path().join(name)),
            overrides: vec![format!("wind.cut.shift={shift}")],
            ..StudyOptions::default()
        };
        assert!(matches!(run(&options, &outputs), Outcome::Done { .. }));
        power(&folder.path().join(name))
    };
    let [in_wake, beside] = [of("in-wake", "0.0"), of("beside", "-170.0")];
    assert!(in_wake < 0.6 * beside, "{in_wake} W in the wake, {beside} W beside it");
}

/// [`SINK`] with a slice of steady wind of 9 m/s that blows across to the left by `across` (m/s).
fn in_steady_wind(across: f32) -> tempfile::TempDir {
    let folder = written(SINK);
    let runs = folder.path().join("runs/baseline");
    fs::create_dir_all(&runs).expect("a folder");
    let steady = flow::inflow::TurbulenceBox::new(
        [61, 51, 17],
        [9.0, 10.0, 10.0],
        [0.0, across, 0.0].map(|value| vec![value; 61 * 51 * 17]),
    );
    let stored = turbulence_box::StoredBox {
        turbulence: steady.expect("a box"),
        hub_speed: 9.0,
        hub_height: 90.0,
        lowest_height: 10.0,
        mean_speeds: vec![9.0; 17],
        description: "steady wind".to_owned(),
    };
    turbulence_box::write(&runs.join("slices-wake-2D.bts"), &stored).expect("a file");
    folder
}

#[test]
fn a_part_that_the_record_does_not_hold_is_refused_at_its_key() {
    let folder = in_steady_wind(0.0);
    let prepared =
        |setting: &str| Prepared::read(&folder.path().join("case.toml"), &[setting.to_owned()]);
    assert!(prepared("wind.seed=2").is_ok());
    let cases = [
        (
            "wind.cut.shift=200",
            "wind.cut.shift: runs/baseline/slices-wake-2D.bts: it takes y 120.0 to 280.0 m",
        ),
        (
            "wind.cut.block=2",
            "block 2 goes from 59.0 to 113.0 s, and the record ends at 60.0 s: only block 1 fits",
        ),
        ("wind.cut.duration=80", "wind.cut.duration"),
        ("wind.cut.spacing=8", "finer than those of the record, 10.000 m"),
        ("wind.cut.height=300", "at or below the ground"),
        ("wind.cut.widht=300", "did you mean `width`?"),
        ("wind.cut.block=0", "`wind.cut.block`"),
        ("wind.planes=\"none.bts\"", "the wind cannot be read"),
    ];
    for (setting, text) in cases {
        let told = match prepared(setting).err() {
            Some(StudyError::Case(error)) => error.to_lines(),
            other => panic!("{setting}: {:?}", other.map(|error| error.to_string())),
        };
        assert!(told.contains(text), "{setting}: {told}");
    }
    // A campaign times such a case in its own wind, however short that is.
    let file = formats::case::read(&folder.path().join("case.toml"), &[]).expect("a case");
    let sample = Sample::of(&file, &[], Some(1)).expect("it is timed");
    assert!(sample.wall_time.is_some_and(|time| time > 0.0), "{sample:?}");
    // Long enough for the rotor is known once the wind is laid around it.
    let options = StudyOptions {
        case: folder.path().join("case.toml"),
        output: Some(folder.path().join("out")),
        overrides: vec!["time.duration=40".to_owned(), "wind.cut.duration=41".to_owned()],
        ..StudyOptions::default()
    };
    // The other trial's break is none of this one's.
    let stop = AtomicBool::new(false);
    let error = study::run_with(&options, &Outputs::standard(), &stop, &mut Silent).err();
    let error = miette::Report::new(error.expect("it is refused"));
    let told = format!("{error:?}");
    assert!(
        told.contains("wind.cut takes 41.0 s of it") && told.contains("wind.cut.duration"),
        "{told}"
    );
}

/// Wind that blows across by atan(0.7/9), which is 4.45°, to the left: of a nacelle that is turned by 10°
/// to the left 5.55° are left.
#[test]
fn a_nacelle_is_turned_from_the_wind_over_its_rotor() {
    let folder = in_steady_wind(0.7);
    let options = StudyOptions {
        case: folder.path().join("case.toml"),
        output: Some(folder.path().join("out")),
        overrides: vec!["turbine.T1.yaw_deg=10".to_owned(), "wind.cut.shift=0".to_owned()],
        ..StudyOptions::default()
    };
    let stop = AtomicBool::new(false);
    let outcome = study::run_with(&options, &Outputs::standard(), &stop, &mut Silent);
    assert!(matches!(outcome.expect("it runs"), Outcome::Done { .. }));
    let turbine = &summary(&folder.path().join("out"))["turbines"][0];
    let [yaw, misalignment] = [&turbine["rotor"]["yaw_deg"], &turbine["yaw_misalignment_deg"]]
        .map(|value| value.as_f64().expect("a number"));
    let blows = 0.7_f64.atan2(9.0).to_degrees();
    assert!(
        (yaw - 10.0).abs() < 1e-6 && (yaw - misalignment - blows).abs() < 1e-2,
        "{yaw} {misalignment}"
    );
}
