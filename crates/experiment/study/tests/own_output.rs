//! An output from outside: made in one file, handed to a study, and as safe from a break as the study's own.

mod small;

use basis::keys::LeftOut::Value as Otherwise;
use basis::keys::{Holds, Objection, Table, from, key};
use basis::registry::Named;
use basis::{Commands, Truth};
use farm::outputs::{OUTPUTS, OutputKeys};
use formats::FileError;
use formats::checkpoint::CheckpointProblem;
use formats::records::read_series;
use small::{HALFWAY, NREL_5MW, STOP, written};
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use study::outputs::{FedBy, Keys, Output, OutputKind, OwnKeys, Scene, Schedule, Section, Stored};
use study::{Outcome, Outputs, Silent, StudyError, StudyOptions};

/// The largest power that any turbine has had, in `largest-power.txt`.
static LARGEST_POWER: OutputKind = OutputKind {
    name: "largest power",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::AnyFlow,
    disk: |_, _, _| 20,
    begin,
};

/// The same under another name.
static LATER: OutputKind = OutputKind { name: "later", ..LARGEST_POWER };

/// The same of some turbines from some time on, in `NAME.txt`; the case says which and when.
static ASKED_FOR: OutputKind = OutputKind {
    name: "largest-power",
    keys: Keys::Own(&OwnKeys {
        table: Table {
            heading: "output.further.NAME = { kind = \"largest-power\", … }",
            about: "The largest power that any of some turbines has had.",
            keys: &[
                key("since", from(0.0, 1e6), "s", Otherwise("0"), "Time from which it counts."),
                key(
                    "turbines",
                    Holds::Turbines,
                    "",
                    Otherwise("[]"),
                    "Those that count; all if none.",
                ),
            ],
        },
        check: |values| {
            let objection = || Objection {
                key: Some("since"),
                message: "= 13 s brings bad luck".to_owned(),
                label: "thirteen",
                fix: "take 14".to_owned(),
            };
            Vec::from_iter((values.number("since") == 13.0).then(objection))
        },
    }),
    disk: |_, _, values| if values.number("since") > 0.0 { 20 } else { 30 },
    ..LARGEST_POWER
};

/// What only a flow with cells can feed.
static OF_CELLS: OutputKind =
    OutputKind { name: "cells", fed_by: FedBy::ResolvedFlow, ..ASKED_FOR };

/// All that is to be done beside the kind itself.
fn add() {
    static ADDED: std::sync::Once = std::sync::Once::new();
    ADDED.call_once(|| {
        for kind in [&ASKED_FOR, &OF_CELLS] {
            OUTPUTS.add(kind).expect("no kind is called so yet");
        }
    });
}

struct LargestPower {
    since: f64,
    /// Those that count, by their places in the run.
    turbines: Vec<usize>,
    /// So far (W).
    power: f64,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let power = stored.map_or(Ok(0.0), Stored::state)?;
    let names = scene.values.names("turbines");
    let counts = |index: &usize| {
        let turbine = &scene.setup.case.turbines[*index].name;
        names.is_empty() || names.contains(turbine)
    };
    let turbines = scene.run.present().enumerate();
    let turbines = turbines.filter(|(_, index)| counts(index)).map(|(place, _)| place).collect();
    let since = scene.values.optional_number("since").unwrap_or(0.0);
    Ok(Some(Box::new(LargestPower { since, turbines, power })))
}

impl Output for LargestPower {
    fn schedule(&self) -> Schedule {
        Schedule::steps(1)
    }

    fn record(&mut self, turbine: usize, truth: &Truth, _commands: &Commands) {
        if truth.time >= self.since && self.turbines.contains(&turbine) {
            self.power = self.power.max(truth.power);
        }
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.power)
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let path = scene.folder.path().join(format!("{}.txt", scene.name.replace(' ', "-")));
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
    // One at a time: another test's study would stop with it.
    static STOPPING: Mutex<()> = Mutex::new(());
    let _alone = STOPPING.lock();
    STOP.store(false, std::sync::atomic::Ordering::Relaxed);
    study::run_with(options, outputs, &STOP, &mut Silent)
}

/// The power that an output told of (W).
fn watts(text: &str) -> f64 {
    text.trim_end().strip_suffix(" W").and_then(|value| value.parse().ok()).expect("a power")
}

/// Equal but for the last bits, which kilowatts in the series cost.
fn is_close(power: f64, expected: f64) -> bool {
    (power / expected - 1.0).abs() < 1e-14
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
    let power = series.column("T1.GenPwr").expect("the power");
    let expected = power.iter().copied().fold(0.0, f64::max);
    assert!(is_close(watts(&largest), expected), "{largest} {expected}");
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

#[test]
#[should_panic(expected = "the output `largest-power` is asked for by name")]
fn what_a_case_asks_for_by_name_is_no_output_of_every_run() {
    let _ = Outputs::standard().with(&ASKED_FOR);
}

/// Two outputs of one kind, each with its keys; `keys` are those of the first.
fn asked_for(keys: &str) -> String {
    let further = format!(
        "further.early = {{ kind = \"largest-power\"{keys} }}\nfurther.late = {{ kind = \"largest-power\", since = 25.0 }}\n"
    );
    case() + &further
}

#[test]
fn a_case_asks_for_outputs_by_name_and_they_go_on_after_a_break() {
    add();
    let text = asked_for(", turbines = [\"T1\"]");
    let folder = written(&text);
    let outputs = Outputs::standard();
    let outcome = run(&options(folder.path(), "whole"), &outputs);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let whole = folder.path().join("whole/baseline");
    let series = read_series(&whole.join("series.csv"), |_| true).expect("a series");
    let column = |name: &str| series.column(name).expect(name);
    let rows = || column("Time").iter().zip(column("T1.GenPwr"));
    let largest =
        |since: f64| rows().filter(|row| *row.0 >= since).map(|row| *row.1).fold(0.0, f64::max);
    let read = |name: &str| fs::read_to_string(whole.join(name)).expect(name);
    for (file, since) in [("early.txt", 0.0), ("late.txt", 25.0)] {
        assert!(is_close(watts(&read(file)), largest(since)), "{file}");
    }
    assert_ne!(read("early.txt"), read("late.txt"));

    let mut stopped = options(folder.path(), "stopped");
    let outcome = run(&stopped, &outputs.clone().with(&HALFWAY));
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    stopped.resume = true;
    let outcome = run(&stopped, &outputs);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    for file in ["early.txt", "late.txt", "series.csv"] {
        let other = fs::read(folder.path().join("stopped/baseline").join(file)).expect(file);
        assert!(fs::read(whole.join(file)).expect(file) == other, "{file} has other bits");
    }
    let prepared = study::Prepared::read(&folder.path().join("case.toml"), &[]).expect("sound");
    let plain = written(&case());
    let without = study::Prepared::read(&plain.path().join("case.toml"), &[]).expect("sound");
    let bytes = |setup: &study::Prepared| outputs.disk_of_run(setup, &setup.case.runs[0]);
    assert_eq!(bytes(&prepared), bytes(&without) + 30 + 20);
}

#[test]
fn keys_of_an_output_are_checked_like_all_others_and_stand_in_the_reference() {
    add();
    let parse = |text: &str| formats::case::parse("own.toml", text, &[]);
    let problems = |keys: &str| parse(&asked_for(keys)).expect_err("a bad case").to_lines();
    let line = 1 + asked_for("").lines().position(|line| line.contains("early")).expect("a line");
    let cases = [
        (
            ", since = -1",
            "`output.further.early.since` = -1 is out of range: 0 <= since <= 1000000 s; Time from",
        ),
        (", sinse = 1", "there is no key `output.further.early.sinse`; did you mean `since`?"),
        (", since = \"1 s\"", "must be a number, found text \"1 s\"; write 1, without quotes"),
        (", turbines = [\"T9\"]", "`output.further.early.turbines` names the turbine `T9`"),
        (", since = 13", "`output.further.early.since` = 13 s brings bad luck; take 14"),
        ("s", "`output.further.early.kind` = \"largest-powers\" is unknown"),
    ];
    for (keys, expected) in cases {
        let text = if keys == "s" {
            parse(&asked_for("").replacen("-power\"", "-powers\"", 1)).expect_err("bad").to_lines()
        } else {
            problems(keys)
        };
        let place = format!("own.toml:{line}: ");
        assert!(text.starts_with(&place) && text.contains(expected), "{keys}: {text}");
        assert_eq!(text.lines().count(), 1, "{text}");
    }
    let misplaced = parse(&asked_for("").replace("largest-power", "cells")).expect_err("no cells");
    let misplaced = misplaced.to_lines();
    assert!(
        misplaced
            .contains("`output.further.early`: `cells` is made of resolved flow; leave it out"),
        "{misplaced}"
    );
    let unnamed = parse(&asked_for("").replace("further.early", "further.\"so early\""));
    assert!(unnamed.expect_err("no name").to_lines().contains("is not a valid name"));
    assert!(formats::case::reference().contains("| `since` | 0 <= x <= 1000000 | s | `0` | Time"));
    assert!(formats::case::schema().contains("\"largest-power\""));

    let case = parse(&asked_for(", since = 3")).expect("a sound case");
    let requested = &case.output.further[0];
    assert_eq!((requested.name.as_str(), requested.values.number("since")), ("early", 3.0));
    assert_eq!(requested.values.names("turbines").len(), 0);
    let again = parse(&formats::case::write(&case));
    assert_eq!(again.expect("what was written is read"), case);
    let other = parse(&asked_for(", since = 4")).expect("a sound case");
    assert_ne!(other, case);
    // A case without any is written as it always was.
    let plain = formats::case::write(&parse(&self::case()).expect("a sound case"));
    assert!(!plain.contains("further"), "{plain}");
}

#[test]
fn an_output_that_nobody_writes_is_refused_by_name() {
    struct KeysAlone;

    impl Named for KeysAlone {
        fn name(&self) -> &'static str {
            "keys-alone"
        }
    }

    impl OutputKeys for KeysAlone {
        fn table(&self) -> &'static Table {
            &Table {
                heading: "output.further.NAME = { kind = \"keys-alone\" }",
                about: "",
                keys: &[],
            }
        }
    }

    OUTPUTS.add(&KeysAlone).expect("no kind is called so yet");
    let folder = written(&(case() + "further.lost = { kind = \"keys-alone\" }\n"));
    match run(&options(folder.path(), "out"), &Outputs::standard()) {
        Err(StudyError::NotWritten { name, kind }) => {
            assert_eq!((name.as_str(), kind), ("lost", "keys-alone"));
        }
        outcome => panic!("{outcome:?}"),
    }
}
