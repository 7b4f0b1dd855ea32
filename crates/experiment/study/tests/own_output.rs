//! An output from outside: made in one file, handed to a study, and as safe from a break as the study's own.

mod small;

use basis::{Commands, Truth};
use formats::FileError;
use formats::checkpoint::CheckpointProblem;
use formats::records::read_series;
use small::{HALFWAY, NREL_5MW, STOP, written};
use std::fs;
use std::path::Path;
use study::outputs::{FedBy, Output, OutputKind, Scene, Schedule, Section, Stored};
use study::{Outcome, Outputs, Silent, StudyError, StudyOptions};

/// The largest power that any turbine has had, in `largest-power.txt`.
static LARGEST_POWER: OutputKind =
    OutputKind { name: "largest power", keys: &[], fed_by: FedBy::AnyFlow, disk: |_, _| 20, begin };

/// The same under another name.
static LATER: OutputKind = OutputKind { name: "later", ..LARGEST_POWER };

struct LargestPower {
    /// So far (W).
    power: f64,
}

fn begin(_scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let power = stored.map_or(Ok(0.0), Stored::state)?;
    Ok(Some(Box::new(LargestPower { power })))
}

impl Output for LargestPower {
    fn schedule(&self) -> Schedule {
        Schedule::steps(1)
    }

    fn record(&mut self, _turbine: usize, truth: &Truth, _commands: &Commands) {
        self.power = self.power.max(truth.power);
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.power)
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let path = scene.folder.path().join("largest-power.txt");
        let text = format!("{:?} W\n", self.power);
        Ok(formats::atomic::write(&path, "the largest power", text.as_bytes())?)
    }
}

/// The wind calms down before half of the run is made, and with it the power.
fn case() -> String {
    let event = r#"event = { kind = "step", start = 20.0, speed = 6.0 }
"#;
    let run = r#"[[run]]
name = "baseline"
[output]
interval = 0.2
"#;
    small::case("own", event, [10.0, 80.0], &[NREL_5MW], run)
}

fn options(folder: &Path, output: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(output)), ..small::options(folder) }
}

/// What becomes of a study with `outputs` that may be stopped.
fn run(options: &StudyOptions, outputs: &Outputs) -> Result<Outcome, StudyError> {
    STOP.store(false, std::sync::atomic::Ordering::Relaxed);
    study::run_with(options, outputs, &STOP, &mut Silent)
}

#[test]
fn an_output_from_outside_is_written_and_goes_on_after_a_break() {
    let folder = written(&case());
    let outputs = Outputs::standard().with(&LARGEST_POWER);
    let outcome = run(&options(folder.path(), "whole"), &outputs);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let whole = folder.path().join("whole/baseline");
    let largest = fs::read_to_string(whole.join("largest-power.txt")).expect("the output's file");
    let series = read_series(&whole.join("series.csv"), |_| true).expect("a series");
    let power = series.column("T1.power_w").expect("the power");
    let expected = power.iter().copied().fold(0.0, f64::max);
    assert_eq!(largest, format!("{expected:?} W\n"));
    // Only a checkpoint can know of it after the break.
    let after = power[power.len() / 2..].iter().copied().fold(0.0, f64::max);
    assert!(after < 0.9 * expected, "{after} W of {expected} W");

    let mut stopped = options(folder.path(), "stopped");
    let outcome = run(&stopped, &outputs.clone().with(&HALFWAY));
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    stopped.resume = true;
    // What was not there from the start knows nothing of the first half.
    match run(&stopped, &outputs.clone().with(&LATER)) {
        Err(StudyError::File(FileError::Checkpoint { problem, .. })) => {
            assert_eq!(problem, CheckpointProblem::Missing { section: "output later".into() });
        }
        outcome => panic!("{outcome:?}"),
    }
    let outcome = run(&stopped, &outputs);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let stopped = folder.path().join("stopped/baseline");
    for file in ["largest-power.txt", "series.csv", "T1.outb"] {
        let [whole, stopped] = [&whole, &stopped].map(|run| fs::read(run.join(file)));
        assert!(whole.expect(file) == stopped.expect(file), "{file} has other bits");
    }
}

#[test]
#[should_panic(expected = "two outputs are called `series`")]
fn no_output_takes_the_name_of_another() {
    static SECOND: OutputKind = OutputKind { name: "series", ..LARGEST_POWER };
    let _ = Outputs::standard().with(&SECOND);
}
