//! A kind of controller from outside: its law, its keys and its signal in this file, one line that adds it to
//! the list.

mod small;

use basis::keys::LeftOut::Value as Otherwise;
use basis::keys::{Objection, Table, Values, from, key};
use basis::registry::Named;
use basis::{Channel, Commands, Measurements, Unit};
use control::{
    CONTROLLERS, Control, ControlError, Controller, ControllerKind, ForeignState, Place, Site,
    from_bytes, to_bytes,
};
use small::{case, done, options, written};
use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Observer, Outcome, Progress, Silent};

/// Less torque than greedy control asks for, by a share that grows with the number of instants: it has a
/// state.
struct Derated {
    inner: Box<dyn Controller>,
    share: f64,
    n_instants: u32,
}

impl Controller for Derated {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        self.n_instants += 1;
        let mut commands = self.inner.update(measurements);
        commands.generator_torque *= 1.0 - self.derating();
        commands
    }

    fn describe(&self) -> String {
        format!("derated by {:.0} %", 100.0 * self.share)
    }

    fn signals(&self) -> Vec<Channel> {
        vec![Channel::new("Derating", Unit::One)]
    }

    fn write_signals(&self, values: &mut [f64]) {
        values.copy_from_slice(&[self.derating()]);
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&(self.n_instants, self.inner.save()))
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let (n_instants, inner): (u32, Vec<u8>) = from_bytes(state)?;
        self.n_instants = n_instants;
        self.inner.restore(&inner)
    }
}

impl Derated {
    fn derating(&self) -> f64 {
        self.share * (1.0 - (-0.01 * f64::from(self.n_instants)).exp())
    }
}

struct DeratedKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"derated\", … }",
    about: "Less torque than baseline.",
    keys: &[key(
        "share",
        from(0.0, 0.5),
        "–",
        Otherwise("0.1"),
        "Share of the torque that is left out.",
    )],
};

impl Named for DeratedKind {
    fn name(&self) -> &'static str {
        "derated"
    }
}

impl ControllerKind for DeratedKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        let too_much = values.number("share") == 0.5;
        let objection = || Objection {
            key: Some("share"),
            message: format!("= 0.5 stalls {}", place.turbine),
            label: "too much",
            fix: "take less".to_owned(),
        };
        Vec::from_iter(too_much.then(objection))
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let share = control.values().number("share");
        Ok(Box::new(Derated { inner: site.baseline(), share, n_instants: 0 }))
    }
}

/// All that is to be done beside the kind itself.
fn add() {
    static ADDED: std::sync::Once = std::sync::Once::new();
    ADDED.call_once(|| CONTROLLERS.add(&DeratedKind).expect("no kind is called so yet"));
}

fn text(keys: &str) -> String {
    let runs = format!(
        "[[run]]\nname = \"baseline\"\n[[run]]\nname = \"own\"\ncontrol.T1 = {{ kind = \"derated\"{keys} }}\n"
    );
    case("own", "", [10.0, 60.0], &[small::NREL_5MW], &runs)
}

#[test]
fn a_study_runs_it_and_its_signal_stands_in_the_series() {
    add();
    let folder = written(&text(", share = 0.2"));
    let options = options(folder.path());
    done(&options);
    let series = fs::read_to_string(folder.path().join("out/own/series.csv")).expect("a series");
    let names: Vec<&str> = series.lines().next().expect("a heading").split(',').collect();
    let column = names.iter().position(|name| *name == "T1.Derating_-").expect("its signal");
    let last: Vec<&str> = series.lines().last().expect("rows").split(',').collect();
    let value: f64 = last[column].parse().expect("a number");
    // 300 instants.
    assert!((value - 0.2 * (1.0 - (-3.0_f64).exp())).abs() < 1e-3, "{value}");
    let summary = fs::read_to_string(folder.path().join("out/own/summary.json")).expect("numbers");
    assert!(summary.contains("derated by 20 %"), "{summary}");
}

/// Asks for an end once half of the steps are made.
struct Halfway<'a>(&'a AtomicBool);

impl Observer for Halfway<'_> {
    fn advanced(&mut self, progress: &Progress) {
        self.0.store(2 * progress.step >= progress.n_steps, Ordering::Relaxed);
    }
}

#[test]
fn a_stopped_run_goes_on_to_the_same_bits() {
    add();
    let text = text("").replace("duration = 60.0", "duration = 900.0");
    let whole = written(&text);
    done(&options(whole.path()));
    let parted = written(&text);
    let mut again = options(parted.path());
    let stop = AtomicBool::new(false);
    let first = study::run(&again, &stop, &mut Halfway(&stop)).expect("a sound study");
    assert!(matches!(first, Outcome::Interrupted { .. }), "it was stopped: {first:?}");
    again.resume = true;
    for _ in 0..3 {
        let outcome = study::run(&again, &AtomicBool::new(false), &mut Silent).expect("sound");
        if matches!(outcome, Outcome::Done { .. }) {
            break;
        }
    }
    let read = |folder: &tempfile::TempDir| {
        fs::read(folder.path().join("out/own/series.csv")).expect("a series")
    };
    assert!(read(&whole) == read(&parted), "the bits differ");
}

#[test]
fn its_keys_are_checked_like_all_others_and_stand_in_the_reference() {
    add();
    let problems = |keys: &str| {
        let error = formats::case::parse("own.toml", &text(keys), &[]).expect_err("a bad case");
        error.to_lines()
    };
    let unknown = problems(", shar = 0.2");
    assert!(unknown.contains("did you mean `share`?"), "{unknown}");
    let range = problems(", share = 0.7");
    assert!(range.contains("0 <= share <= 0.5"), "{range}");
    let own = problems(", share = 0.5");
    assert!(own.contains("`run.own.control.T1.share` = 0.5 stalls T1; take less"), "{own}");
    assert!(formats::case::reference().contains("Share of the torque that is left out."));
    assert!(formats::case::schema().contains("\"derated\""));
    let case = formats::case::parse("own.toml", &text(""), &[]).expect("a sound case");
    let again = formats::case::parse("again", &formats::case::write(&case), &[]);
    assert_eq!(again.expect("what was written is read"), case);
}
