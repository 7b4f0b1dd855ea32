//! The wind of a file: what it was is kept beside the results, and another one is noticed.

mod small;

use flow::inflow::TurbulenceBox;
use formats::records::RunFolder;
use formats::records::{read_manifest, sha256};
use formats::turbulence_box::{self, StoredBox};
use miette::Diagnostic;
use small::{HALFWAY, STOP, options, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use study::outputs::{FedBy, Keys, Output, OutputKind, Scene, Schedule};
use study::{Outcome, Outputs, Silent, StudyError, StudyOptions};
use tempfile::TempDir;

/// A turbine in the wind of `wind/w.bts`, twice.
const CASE: &str = r#"
name = "file"
[wind]
speed = 9.0
turbulence_intensity = 0.05
planes = "wind/w.bts"
[flow]
solver = "planes"
step = 0.2
[time]
spin_up = 5.0
duration = 40.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[[run]]
name = "pulse"
control.T1 = { kind = "pulse", amplitude_deg = 2.0, strouhal = 0.25 }
"#;

/// Writes a box of wind that swings by `swing` (m/s) about 9 m/s.
fn blow(path: &Path, swing: f32) {
    let n_points = [80, 9, 9];
    let n = n_points.iter().product::<usize>();
    let along = (0..n).map(|point| swing * (point as f32 * 0.7).sin()).collect();
    let velocity = [along, vec![0.0; n], vec![0.0; n]];
    let turbulence =
        TurbulenceBox::new(n_points, [9.0, 20.0, 20.0], velocity).expect("a sound box");
    let stored = StoredBox {
        turbulence,
        hub_speed: 9.0,
        hub_height: 90.0,
        lowest_height: 10.0,
        mean_speeds: vec![9.0; 9],
        description: "a trial".to_owned(),
    };
    turbulence_box::write(path, &stored).expect("a file");
}

/// The case with its wind.
fn study() -> TempDir {
    let folder = written(CASE);
    fs::create_dir(folder.path().join("wind")).expect("a folder");
    blow(&folder.path().join("wind/w.bts"), 0.4);
    folder
}

/// Whether `error` says what to do with `wind/w.bts`, which was of this digest.
fn check_told(error: &StudyError, digest: &str) {
    let told = error.to_string();
    assert!(told.contains("wind/w.bts"), "{told}");
    let help = error.help().expect("a fix").to_string();
    assert!(help.contains(digest) && help.contains("--overwrite"), "{help}");
}

#[test]
fn another_wind_is_not_gone_on_with() {
    let folder = study();
    let path = folder.path().join("wind/w.bts");
    let digest = sha256(&fs::read(&path).expect("a file"));
    let outputs = Outputs::standard().with(&HALFWAY);
    let stopped = study::run_with(&options(folder.path()), &outputs, &STOP, &mut Silent);
    assert!(matches!(stopped, Ok(Outcome::Interrupted { .. })), "{stopped:?}");
    let manifest = read_manifest(&RunFolder::new(&folder.path().join("out"), "baseline"));
    let kept = manifest.expect("a manifest").wind_sha256;
    assert_eq!(kept.into_iter().collect::<Vec<_>>(), [("wind/w.bts".to_owned(), digest.clone())]);

    let sound = fs::read(&path).expect("a file");
    blow(&path, 0.5);
    let resumed = StudyOptions { resume: true, ..options(folder.path()) };
    let error = small::run(&resumed).expect_err("another wind");
    assert!(matches!(error, StudyError::OtherFile { .. }), "{error:?}");
    check_told(&error, &digest);
    fs::write(&path, sound).expect("a file");
    let outcome = small::run(&resumed);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");

    // Nor are gains over a run in another wind.
    blow(&path, 0.5);
    let alone =
        StudyOptions { runs: vec!["pulse".to_owned()], overwrite: true, ..options(folder.path()) };
    let error = small::run(&alone).expect_err("another wind");
    assert!(matches!(&error, StudyError::OtherFile { run, .. } if run == "baseline"), "{error:?}");
    check_told(&error, &digest);
}

/// Records of a program that kept no digests of winds do not tell that there was none.
#[test]
fn a_run_that_does_not_tell_its_wind_is_made_again() {
    let folder = study();
    small::done(&options(folder.path()));
    let run = RunFolder::new(&folder.path().join("out"), "baseline");
    let mut manifest = read_manifest(&run).expect("a manifest");
    manifest.wind_sha256.clear();
    formats::records::write_manifest(&run, &manifest).expect("a manifest");
    let resumed = StudyOptions { resume: true, ..options(folder.path()) };
    let error = small::run(&resumed).expect_err("nobody knows its wind");
    assert!(
        matches!(&error, StudyError::UntoldWind { file, .. } if file == "wind/w.bts"),
        "{error:?}"
    );
    let help = error.help().expect("a fix").to_string();
    assert!(help.contains("--overwrite") && !help.contains("away"), "{help}");
}

/// Whether the wind has been replaced.
static REPLACED: AtomicBool = AtomicBool::new(false);

/// Puts another wind in the place of the file when the first run is complete.
static REPLACING: OutputKind = OutputKind {
    name: "replacing",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::AnyFlow,
    disk: |_, _, _| 0,
    begin: |_, _| Ok(Some(Box::new(Replacing))),
};

struct Replacing;

impl Output for Replacing {
    fn schedule(&self) -> Schedule {
        Schedule::at_the_end()
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if !REPLACED.swap(true, Ordering::Relaxed) {
            let folder = scene.folder.path().ancestors().nth(2).expect("the folder of the case");
            blow(&folder.join("wind/w.bts"), 0.6);
        }
        Ok(())
    }
}

#[test]
fn a_wind_that_changes_between_two_runs_is_noticed() {
    let folder = study();
    let digest = sha256(&fs::read(folder.path().join("wind/w.bts")).expect("a file"));
    let outputs = Outputs::standard().with(&REPLACING);
    let never = AtomicBool::new(false);
    // One after the other: side by side both would begin in the same wind.
    let one_by_one = StudyOptions { jobs: Some(1), ..options(folder.path()) };
    let outcome = study::run_with(&one_by_one, &outputs, &never, &mut Silent);
    let error = outcome.expect_err("another wind");
    assert!(matches!(&error, StudyError::ChangedWind { run, .. } if run == "pulse"), "{error:?}");
    check_told(&error, &digest);
    assert!(folder.path().join("out/baseline/summary.json").is_file());
    assert!(!folder.path().join("out/pulse/series.csv.part").exists());
}

#[test]
fn all_files_of_a_box_count() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, expected) in [
        ("w.bts", vec!["w.bts"]),
        ("w.wnd", vec!["w.wnd", "w.sum"]),
        ("w.toml", vec!["w.toml", "w_u.bin", "w_v.bin", "w_w.bin"]),
        ("w_v.bin", vec!["w.toml", "w_u.bin", "w_v.bin", "w_w.bin"]),
    ] {
        if !name.ends_with(".bin") {
            blow(&folder.path().join(name), 0.4);
        }
        let files = turbulence_box::files(&folder.path().join(name)).expect("a sound box");
        let expected: Vec<_> = expected.iter().map(|name| folder.path().join(name)).collect();
        assert_eq!(files, expected, "{name}");
        assert!(files.iter().all(|file| file.is_file()), "{files:?}");
    }
}

/// A rise from 8 to 10 m/s, half way.
const TABLE: &str = "time_s,speed_m_s\n0,8\n30,8\n30,10\n60,10\n";

/// The case in the wind of `u.csv`, which holds `table`; `more` follows under `[wind]`.
fn in_table(table: &str, more: &str) -> tempfile::TempDir {
    let wind = format!("table = \"u.csv\"\n{more}");
    let run = "[[run]]\nname = \"baseline\"\n";
    let folder = written(&small::case("table", &wind, [10.0, 60.0], &[small::NREL_5MW], run));
    fs::write(folder.path().join("u.csv"), table).expect("a table");
    folder
}

#[test]
fn wind_follows_a_table() {
    let folder = in_table(TABLE, "shear_exponent = 0.0\n");
    let out = small::done(&options(folder.path()));
    let path = RunFolder::new(&out, "baseline").series_path();
    let series = formats::records::read_series(&path, |name| name == "Time" || name == "Wind.U");
    let series = series.expect("a series");
    let rows = series.columns[0].iter().zip(&series.columns[1]);
    let mut n_rows = 0;
    for (time, wind) in rows {
        let expected = if *time < 30.0 { 8.0 } else { 10.0 };
        // The row at the step itself may hold either side.
        let fits = (wind - expected).abs() < 1e-9 || (time - 30.0).abs() < 0.25;
        assert!(fits, "{wind} m/s at {time} s");
        n_rows += 1;
    }
    assert!(n_rows > 100, "{n_rows}");
    let manifest = read_manifest(&RunFolder::new(&out, "baseline")).expect("a manifest");
    assert_eq!(manifest.wind_sha256.keys().collect::<Vec<_>>(), ["u.csv"]);
}

#[test]
fn a_table_that_does_not_fit_is_refused_at_its_key() {
    let refused = |table: &str, more: &str| {
        let folder = in_table(table, more);
        let path = folder.path().join("case.toml");
        match study::Prepared::read(&path, &[]) {
            Err(StudyError::Case(error)) => error.to_lines(),
            Err(error) => panic!("{error:?}"),
            Ok(_) => panic!("{table:?} is taken"),
        }
    };
    let short = refused("time_s,speed_m_s\n0,8\n40,9\n", "");
    assert!(short.contains("ends at 40 s, and runs last 60 s: add a row"), "{short}");
    let wrong = refused("time_s,speed_m_s\n0,x\n", "");
    assert!(wrong.contains("line 2, speed_m_s: expected 0 to 200, found x"), "{wrong}");
    let storm = refused("time_s,speed_m_s\n0,30\n60,30\n", "");
    assert!(storm.contains("the file of wind.table, with 30 m/s"), "{storm}");
    let both = refused(TABLE, "event = { kind = \"step\", start = 5.0, speed = 9.0 }\n");
    assert!(both.contains("wind.table says what happens in time"), "{both}");
}
