//! Wind and numbers beyond what a turbine is made for: a run ends with time and place, as it does where the
//! air diverges, and what was recorded stays.

mod small;

use farm::FarmError;
use formats::records::{SeriesFile, read_summary};
use miette::Diagnostic;
use small::{options, written};
use std::fs;
use std::path::Path;
use study::{Outcome, Prepared, StudyError};

/// A flexible turbine; `wind` stands under `[wind]`, `duration` is in s.
fn case(wind: &str, solver: &str, duration: f64) -> String {
    format!(
        r#"
name = "beyond"
[wind]
{wind}
[flow]
solver = "{solver}"
[time]
spin_up = 5.0
duration = {duration:?}
[[turbine]]
name = "T1"
model = "any-wind.toml"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#
    )
}

/// A legal wind in which the turbine breaks down: 40 m/s, a turbulence intensity of 50 %.
const STORM: &str = r#"speed = 40.0
turbulence_intensity = 0.5
turbulence_model = "kaimal"
seed = 1"#;
/// Wind that rises out of all bounds.
const STAIRCASE: &str = r#"speed = 9.0
turbulence_intensity = 0.0
event = { kind = "staircase", start = 5.0, rise = 40.0, n_steps = 10, hold = 4.0 }"#;

/// The folder of `case`, with a turbine whose file states no cut-out wind speed, so that no wind is refused.
fn in_any_wind(case: &str) -> tempfile::TempDir {
    let folder = written(case);
    let library = include_str!("../../../../turbines/iea-15mw.toml");
    let (before, rest) = library.split_once("[operation]").expect("the group");
    let (_, after) = rest.split_once("[controller]").expect("the group behind it");
    fs::write(folder.path().join("any-wind.toml"), format!("{before}[controller]{after}"))
        .expect("a turbine file");
    folder
}

/// How the study of `case` ended, and the folder of its run.
fn broken(case: &str) -> (StudyError, tempfile::TempDir) {
    let folder = in_any_wind(case);
    let error = small::run(&options(folder.path())).expect_err("no turbine survives that");
    (error, folder)
}

fn series_of(folder: &Path) -> SeriesFile {
    SeriesFile::open(&folder.join("out/baseline/series.csv.part")).expect("a series")
}

#[test]
fn a_turbine_that_breaks_down_ends_its_run_with_time_and_place() {
    for (wind, solver, duration) in [(STORM, "turbulence", 120.0), (STAIRCASE, "uniform", 60.0)] {
        let (error, folder) = broken(&case(wind, solver, duration));
        let help = error.help().expect("a fix").to_string();
        let StudyError::Diverged { run, source, series, .. } = error else { panic!("{error:?}") };
        assert_eq!(run, "baseline");
        let FarmError::Turbine { turbine, time, position, breakdown } = *source else {
            panic!("{source:?}")
        };
        assert_eq!(turbine, "T1");
        assert!(time > 5.0 && time < duration, "{time} s");
        // The hub of the turbine.
        assert!(position.y.abs() < 1.0 && (position.z - 150.0).abs() < 2.0, "{position}");
        assert!(!breakdown.value.is_finite(), "{breakdown:?}");
        // What was measured up to there is kept, and told of.
        let series = series.expect("a series");
        assert!(help.contains(&series.display().to_string()), "{help}");
        let kept = series_of(folder.path()).n_rows() as f64 * 0.1;
        assert!((kept - time).abs() < 1.0, "{kept} s of {time} s are kept");
    }
}

#[test]
fn in_memory_a_broken_turbine_is_told_too() {
    let folder = in_any_wind(&case(STAIRCASE, "uniform", 60.0));
    let prepared = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    let error = prepared.ready().expect("ready").run("baseline").expect_err("no turbine survives");
    assert!(matches!(error, StudyError::Diverged { .. }), "{error:?}");
}

#[test]
fn a_rotor_that_turns_too_fast_is_warned_of() {
    // A gust to 25 m/s in a second: the pitch is too slow for it.
    let gust = r#"speed = 11.0
turbulence_intensity = 0.0
event = { kind = "step", start = 20.0, speed = 30.0 }"#;
    let folder = in_any_wind(&case(gust, "uniform", 60.0));
    let outcome = small::run(&options(folder.path()));
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    let found =
        summaries[0].warnings.iter().find(|warning| warning.message.contains("rated speed"));
    let warning = found.expect("a warning");
    assert_eq!(warning.kind, basis::records::WarningKind::Overspeed);
    assert_eq!(warning.turbine.as_deref(), Some("T1"));
    let run = formats::records::RunFolder::new(&folder.path().join("out"), "baseline");
    assert_eq!(read_summary(&run).expect("a summary").warnings, summaries[0].warnings);
}
