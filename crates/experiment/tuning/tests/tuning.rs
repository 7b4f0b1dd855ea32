//! A tuning end to end in wind that is the same everywhere: runs, numbers, page; stopped and gone on with.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Observer, Silent};
use tempfile::TempDir;
use tuning::{TuneOptions, TuneOutcome, Tuned, TuningError, Watch, tune};

/// Two turbines that do not feel each other; the first pitches a helix, which costs it power.
const CASE: &str = r#"
name = "two"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 5.0
duration = 20.0
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
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

const STUDY: &str = r#"case = "case.toml"
run = "helix"
block = 5
[budget]
runs = 6
[design]
first = 3
[loads]
channels = ["T1.RootMyb1"]
[[variable]]
key = "control.T1.amplitude_deg"
from = 0.5
to = 5
step = 0.25
"#;

fn written() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("case.toml"), CASE).expect("a case");
    fs::write(folder.path().join("study.toml"), STUDY).expect("a study");
    folder
}

fn options(folder: &Path) -> TuneOptions {
    TuneOptions {
        study: folder.join("study.toml"),
        output: Some(folder.join("out")),
        ..TuneOptions::default()
    }
}

fn done(outcome: Result<TuneOutcome, TuningError>) -> Box<Tuned> {
    match outcome {
        Ok(TuneOutcome::Done(tuned)) => tuned,
        outcome => panic!("{outcome:?}"),
    }
}

/// Asks for an end at the first step after so many proposals.
struct Impatient<'a> {
    stop: &'a AtomicBool,
    left: usize,
}

impl Observer for Impatient<'_> {
    fn advanced(&mut self, _: &study::Progress) {
        if self.left == 0 {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

impl Watch for Impatient<'_> {
    fn proposed(&mut self, _: usize, _: usize, _: &[String], _: Option<f64>) {
        self.left = self.left.saturating_sub(1);
    }
}

/// A helix costs power that grows with its amplitude, and nobody gains: the least amplitude is best.
#[test]
fn a_tuning_finds_the_least_loss_and_goes_on_after_an_end_with_the_same_points() {
    let whole = written();
    let never = AtomicBool::new(false);
    let tuned = done(tune(&options(whole.path()), &never, &mut Silent));
    assert_eq!(tuned.turbines, ["T1", "T2"]);
    assert_eq!(tuned.found.history.len(), 6);
    let amplitude = tuned.found.optimum.point[0];
    assert!(amplitude <= 1.5, "{amplitude}");
    assert!(tuned.found.optimum.outputs[1].mean.abs() < 1e-6, "{:?}", tuned.found.optimum);
    assert!(tuned.compromises[0].settings.len() < 30);
    for file in ["tuning.json", "data.csv", "report.html", "points.json", "figures/iterations.svg"]
    {
        assert!(tuned.directory.join(file).is_file(), "{file}");
    }
    let data = fs::read_to_string(tuned.directory.join("data.csv")).expect("data");
    let mut lines = data.lines();
    let head = "point,control.T1.amplitude_deg,block,T1,T2,T1.RootMyb1";
    assert_eq!(lines.next(), Some(head));
    assert_eq!(lines.count(), 6 * 3);

    let other = written();
    let stop = AtomicBool::new(false);
    let mut impatient = Impatient { stop: &stop, left: 2 };
    let outcome = tune(&options(other.path()), &stop, &mut impatient);
    assert!(matches!(outcome, Ok(TuneOutcome::Interrupted { .. })), "{outcome:?}");
    let first = other.path().join("out/point-001/helix/summary.json");
    let before = fs::read(&first).expect("a complete run");
    assert!(!other.path().join("out/tuning.json").exists());
    let again = TuneOptions { resume: true, ..options(other.path()) };
    let resumed = done(tune(&again, &never, &mut Silent));
    assert_eq!(fs::read(&first).expect("the same run"), before);
    let read = |folder: &Path, file: &str| fs::read_to_string(folder.join("out").join(file));
    for file in ["points.json", "data.csv", "tuning.json"] {
        let [one, two] = [whole.path(), other.path()].map(|folder| read(folder, file).expect(file));
        assert_eq!(one, two, "{file}");
    }
    // A larger budget goes on from there; what was run stays.
    let longer = STUDY.replace("runs = 6", "runs = 7");
    fs::write(other.path().join("study.toml"), longer).expect("a study");
    let longer = done(tune(&again, &never, &mut Silent));
    assert_eq!(longer.found.history.points[..6], resumed.found.history.points[..]);
    assert_eq!(longer.found.history.len(), 7);
}

/// The same turbines in steps a quarter longer tell before what helices cost; stopped in their runs and
/// gone on with it ends the same.
#[test]
fn a_cheaper_source_is_made_before_and_goes_on_after_an_end() {
    let cheaper = "[[cheaper]]\nname = \"coarse\"\nset = [\"flow.step=0.25\"]\nruns = 4\n";
    let study = STUDY.replace("runs = 6", "runs = 3").replace("first = 3", "first = 2");
    let [whole, other] = [(); 2].map(|()| {
        let folder = written();
        fs::write(folder.path().join("study.toml"), format!("{study}{cheaper}")).expect("a study");
        folder
    });
    let never = AtomicBool::new(false);
    let dry = TuneOptions { dry_run: true, ..options(whole.path()) };
    let Ok(TuneOutcome::Estimated(cost)) = tune(&dry, &never, &mut Silent) else {
        panic!("a cost")
    };
    let before = &cost.cheaper[0];
    assert_eq!((cost.n_runs, before.0.as_str(), before.1.n_runs), (4, "coarse", 5));
    let tuned = done(tune(&options(whole.path()), &never, &mut Silent));
    assert_eq!(tuned.found.history.len(), 3);
    let amplitude = tuned.found.optimum.point[0];
    assert!(amplitude <= 1.0, "{amplitude}");
    let read = |folder: &Path, file: &str| fs::read_to_string(folder.join("out").join(file));
    let data = read(whole.path(), "coarse/data.csv").expect("data of the cheaper source");
    assert_eq!(data.lines().count(), 1 + 4 * 3);
    let text = read(whole.path(), "tuning.json").expect("numbers");
    let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let correlation = found["cheaper"][0]["correlation"].as_f64().expect("a number");
    assert!((0.3..=1.0).contains(&correlation), "{correlation}");

    let stop = AtomicBool::new(false);
    let mut impatient = Impatient { stop: &stop, left: 1 };
    let outcome = tune(&options(other.path()), &stop, &mut impatient);
    assert!(matches!(outcome, Ok(TuneOutcome::Interrupted { .. })), "{outcome:?}");
    let again = TuneOptions { resume: true, ..options(other.path()) };
    done(tune(&again, &never, &mut Silent));
    for file in ["points.json", "data.csv", "coarse/data.csv", "tuning.json"] {
        let [one, two] = [&whole, &other].map(|folder| read(folder.path(), file).expect(file));
        assert_eq!(one, two, "{file}");
    }
}

#[test]
fn folders_that_do_not_fit_are_refused_and_a_dry_run_makes_nothing() {
    let folder = written();
    let never = AtomicBool::new(false);
    let dry = TuneOptions { dry_run: true, ..options(folder.path()) };
    let outcome = tune(&dry, &never, &mut Silent);
    let Ok(TuneOutcome::Estimated(cost)) = outcome else { panic!("{outcome:?}") };
    assert_eq!((cost.n_runs, cost.n_at_a_time), (7, 1));
    assert!(!folder.path().join("out").exists());
    let resume = TuneOptions { resume: true, ..options(folder.path()) };
    let refused = tune(&resume, &never, &mut Silent).expect_err("nothing there");
    assert!(matches!(refused, TuningError::NothingToResume { .. }), "{refused}");
    let longer = STUDY.replace("block = 5", "block = 600");
    fs::write(folder.path().join("study.toml"), longer).expect("a study");
    let refused = tune(&options(folder.path()), &never, &mut Silent).expect_err("too short");
    assert!(matches!(refused, TuningError::NoBlock { .. }), "{refused}");
}
