//! A controller in a shared library: the same law as a controller of our own, one state for each turbine, the
//! same bits after a stop, and what becomes of a library that fails.

mod foreign;
mod small;

use basis::registry::Named;
use basis::{Commands, Measurements, PerBlade};
use control::{CONTROLLERS, Control, ControlError, Controller, ControllerKind, ForeignState, Site};
use farm::FarmError;
use foreign::{GAINS, GEAR_RATIO, RATED_SPEED, TORQUE_GAIN, compiled, input};
use formats::records::{RunFolder, read_manifest, read_series, read_summary};
use miette::Diagnostic;
use small::{HALFWAY, STOP, case, done, options, written};
use std::fs;
use std::path::Path;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use study::outputs::Outputs;
use study::{Outcome, Prepared, Silent, StudyError};
use tempfile::TempDir;

const MACHINE: &str =
    "model = \"nrel-5mw\"\nsensors.anemometer = { kind = \"anemometer\", factor = 0.5 }";
const LIBRARY: &str = "kind = \"discon\", library = \"libdiscon.so\", input = \"DISCON.IN\"";

/// The law of `law.c`, from what crosses the interface in single precision.
struct Reference {
    integral: Option<f64>,
}

impl Controller for Reference {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let single = |value: f64| f64::from(value as f32);
        let [proportional, integral_gain, greatest] = GAINS;
        let speed = single(GEAR_RATIO * measurements.generator_speed);
        let integral = self.integral.get_or_insert(single(measurements.pitch[0]));
        let error = speed - RATED_SPEED;
        *integral += integral_gain * error * single(measurements.interval);
        *integral = integral.clamp(0.0, greatest);
        let pitch = (*integral + proportional * error).clamp(0.0, greatest);
        let torque = TORQUE_GAIN * speed.min(RATED_SPEED).powi(2);
        Commands {
            pitch: PerBlade::splat(3, single(pitch)),
            generator_torque: GEAR_RATIO * single(torque),
            yaw_rate: 0.0,
        }
    }

    fn describe(&self) -> String {
        "reference".to_owned()
    }

    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    fn restore(&mut self, _: &[u8]) -> Result<(), ForeignState> {
        Ok(())
    }
}

struct ReferenceKind;

static TABLE: basis::keys::Table =
    basis::keys::Table { heading: "reference", about: "The law of law.c.", keys: &[] };

impl Named for ReferenceKind {
    fn name(&self) -> &'static str {
        "reference"
    }
}

impl ControllerKind for ReferenceKind {
    fn table(&self) -> &'static basis::keys::Table {
        &TABLE
    }

    fn build(&self, _: &Control, _: &Site) -> Result<Box<dyn Controller>, ControlError> {
        Ok(Box::new(Reference { integral: None }))
    }
}

/// A folder with the case of `runs` in `speed` (m/s), the library, and its input: it does `trick` from `when`
/// (s) on.
fn folder(speed: &str, machines: &[&str], runs: &str, (trick, when): (&str, f64)) -> TempDir {
    let text = case("foreign", "", [10.0, 60.0], machines, runs)
        .replace("speed = 9.0", &format!("speed = {speed}"));
    let folder = written(&text);
    compiled(folder.path());
    input(folder.path(), trick, when);
    folder
}

/// One run with the library on T1.
fn alone(more_keys: &str) -> String {
    format!("[[run]]\nname = \"own\"\ncontrol.T1 = {{ {LIBRARY}{more_keys} }}\n")
}

fn column(folder: &Path, run: &str, channel: &str) -> Vec<f64> {
    let path = RunFolder::new(&folder.join("out"), run).series_path();
    let series = read_series(&path, |name| name == channel).expect("a series");
    let index = series.names.iter().position(|name| name == channel);
    series.columns[index.unwrap_or_else(|| panic!("no {channel}"))].clone()
}

fn error_of(folder: &TempDir) -> StudyError {
    small::run(&options(folder.path())).expect_err("it cannot run")
}

fn text_of(error: &StudyError) -> String {
    match error {
        StudyError::Case(error) => error.to_lines(),
        error => panic!("{error:?}"),
    }
}

#[test]
fn it_does_what_the_same_law_does_in_rust() {
    static ADDED: Once = Once::new();
    ADDED.call_once(|| CONTROLLERS.add(&ReferenceKind).expect("no kind is called so yet"));
    for speed in ["8.0", "13.0"] {
        let runs = alone("")
            + "[[run]]\nname = \"reference\"\ncontrol.T1 = { kind = \"reference\" }\n"
            + "[[run]]\nname = \"collective\"\ncontrol.T1 = { "
            + LIBRARY
            + ", pitch_control = \"collective\" }\n";
        let folder = folder(speed, &[MACHINE], &runs, ("-", 0.0));
        let out = done(&options(folder.path()));
        for channel in ["T1.GenPwr", "T1.BldPitch1", "T1.RotSpeed"] {
            let of = |run: &str| column(folder.path(), run, channel);
            let (own, reference) = (of("own"), of("reference"));
            assert_eq!(own.len(), reference.len());
            for (own, reference) in own.iter().zip(&reference) {
                assert_eq!(own.to_bits(), reference.to_bits(), "{channel} in {speed} m/s");
            }
            assert_eq!(own, of("collective"));
        }
        // The pitch law is at work in strong wind alone.
        let pitch = column(folder.path(), "own", "T1.BldPitch1");
        let last = *pitch.last().expect("rows");
        assert_eq!(last > 0.02, speed == "13.0", "{last} rad in {speed} m/s");
        let summary = read_summary(&RunFolder::new(&out, "own")).expect("a summary");
        assert_eq!(summary.turbines[0].control.description, "discon libdiscon.so");
        assert!(!summary.warnings.iter().any(|w| w.message.contains("library")), "{summary:?}");
        // What it writes lies with the run, and it was told of its end.
        let log = fs::read_to_string(out.join("own/T1.SrvD.log")).expect("a log");
        assert_eq!(log, "ended at 59.8 s\n");
        let manifest = read_manifest(&RunFolder::new(&out, "own")).expect("a manifest");
        for file in ["libdiscon.so", "DISCON.IN"] {
            let bytes = fs::read(folder.path().join(file)).expect("a file");
            assert_eq!(manifest.turbines_sha256[file], formats::records::sha256(&bytes));
        }
    }
}

#[test]
fn turbines_with_one_library_have_states_of_their_own() {
    let run = |name: &str, turbines: &[&str]| {
        let controls = turbines.iter().map(|name| format!("control.{name} = {{ {LIBRARY} }}\n"));
        format!("[[run]]\nname = \"{name}\"\n{}", controls.collect::<String>())
    };
    let runs = run("both", &["T1", "T2"]) + &run("T1", &["T1"]) + &run("T2", &["T2"]);
    let folder = folder("13.0", &[MACHINE, MACHINE], &runs, ("-", 0.0));
    done(&options(folder.path()));
    for (turbine, other) in [("T1", "T2"), ("T2", "T1")] {
        let of = |run: &str| column(folder.path(), run, &format!("{turbine}.GenPwr"));
        assert!(of("both") == of(turbine), "{turbine} differs from a turbine alone");
        // Under the built-in controller it does something else.
        assert!(of("both") != of(other));
    }
}

#[test]
fn an_excitation_goes_on_top_of_it() {
    let under = "library = \"libdiscon.so\", input = \"DISCON.IN\"";
    let helix = |name: &str, amplitude: f64| {
        format!(
            "[[run]]\nname = \"{name}\"\ncontrol.T1 = {{ kind = \"helix\", sense = \"ccw\", amplitude_deg = {amplitude:?}, strouhal = 0.25, {under} }}\n"
        )
    };
    let runs = alone("") + &helix("still", 0.0) + &helix("helix", 2.0);
    let folder = folder("9.0", &[MACHINE], &runs, ("-", 0.0));
    done(&options(folder.path()));
    let of = |run: &str| column(folder.path(), run, "T1.GenTq");
    assert!(of("still") == of("own"), "no amplitude changes nothing");
    let pitch = column(folder.path(), "helix", "T1.BldPitch2");
    let largest = pitch.iter().fold(0.0_f64, |most, pitch| most.max(pitch.abs()));
    assert!((largest.to_degrees() - 2.0).abs() < 0.2, "{largest} rad");
}

/// Stops the study of `folder` halfway and resumes it.
fn parted(folder: &TempDir) -> Result<Outcome, StudyError> {
    let outputs = Outputs::standard().with(&HALFWAY);
    STOP.store(false, Ordering::Relaxed);
    let first = study::run_with(&options(folder.path()), &outputs, &STOP, &mut Silent);
    assert!(matches!(first, Ok(Outcome::Interrupted { .. })), "{first:?}");
    let again = study::StudyOptions { resume: true, ..options(folder.path()) };
    let outputs = Outputs::standard().with(&HALFWAY);
    study::run_with(&again, &outputs, &AtomicBool::new(false), &mut Silent)
}

#[test]
fn a_stopped_run_goes_on_to_the_same_bits_or_says_why_not() {
    let whole = folder("13.0", &[MACHINE], &alone(""), ("-", 0.0));
    done(&options(whole.path()));
    let stopped = folder("13.0", &[MACHINE], &alone(""), ("warn", 59.0));
    let outcome = parted(&stopped).expect("a library that follows from what it is sent");
    let Outcome::Done { summaries, .. } = outcome else { panic!("{outcome:?}") };
    assert_eq!(summaries.len(), 1);
    for channel in ["T1.GenPwr", "T1.BldPitch1"] {
        let of = |folder: &TempDir| column(folder.path(), "own", channel);
        assert!(of(&whole) == of(&stopped), "the bits of {channel} differ");
    }

    let clock = folder("13.0", &[MACHINE], &alone(""), ("clock", 0.0));
    let error = parted(&clock).expect_err("it looks at a clock");
    let words = error.to_string();
    assert!(
        words.contains("run own ended early: the controller of T1 stopped the run at 30.00 s"),
        "{words}"
    );
    assert!(words.contains("cannot be resumed: sent the same as before the checkpoint"), "{words}");
}

#[test]
fn a_library_that_fails_ends_the_run_with_its_message() {
    let folder = folder("9.0", &[MACHINE], &alone(""), ("fail", 20.0));
    let error = error_of(&folder);
    let help = error.help().expect("what to do").to_string();
    let StudyError::Diverged { run, source, series, .. } = error else { panic!("{error:?}") };
    let FarmError::Controller { turbine, time, message } = *source else { panic!("{source:?}") };
    assert_eq!((run.as_str(), turbine.as_str()), ("own", "T1"));
    // The first instant after 20 s, in steps of 0.2 s.
    assert!((time - 20.2).abs() < 1e-9 || (time - 20.0).abs() < 1e-9, "{time} s");
    assert_eq!(message, "it failed with aviFAIL = -1: the gearbox is too hot");
    assert!(help.contains(&series.expect("a series").display().to_string()), "{help}");

    input(folder.path(), "number", 0.0);
    let words = text_of(&error_of(&folder));
    assert!(words.contains("libdiscon.so cannot begin: record 42 came back as"), "{words}");
}

#[test]
fn what_it_warns_of_is_told_once() {
    let folder = folder("9.0", &[MACHINE], &alone(""), ("warn", 40.0));
    let out = done(&options(folder.path()));
    let summary = read_summary(&RunFolder::new(&out, "own")).expect("a summary");
    let told: Vec<_> = summary.warnings.iter().filter(|w| w.message.contains("library")).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    let expected =
        "own: T1's controller library warned with aviFAIL = 1: the gearbox is warm, at 40.";
    assert!(told[0].message.starts_with(expected), "{}", told[0].message);
}

#[test]
fn the_yaw_rate_that_it_asks_for_turns_the_nacelle() {
    let folder = folder("9.0", &[MACHINE], &alone(""), ("yaw", 0.0));
    let out = done(&options(folder.path()));
    let path = RunFolder::new(&out, "own").series_path();
    let series = formats::records::read_series(&path, |_| true).expect("a series");
    let last = |name: &str| *series.column(name).expect("its column").last().expect("rows");
    // 0.01 rad/s all the time, behind a lag of a second.
    let (time, yaw) = (last("Time"), last("T1.NacYaw"));
    assert!((yaw - 0.01 * (time - 1.0)).abs() < 0.005, "{yaw} rad after {time} s");
}

#[test]
fn what_cannot_serve_is_refused_before_any_run() {
    let folder = folder("9.0", &[MACHINE], &alone(""), ("-", 0.0));
    let at = |name: &str| folder.path().join(name);
    let refused = |keys: &str, words: &[&str]| {
        let control = format!("control.T1 = {{ kind = \"discon\", {keys} }}");
        let text = fs::read_to_string(at("case.toml")).expect("a case");
        let line = text.lines().find(|line| line.starts_with("control.T1")).expect("a line");
        fs::write(at("case.toml"), text.replace(line, &control)).expect("a case");
        let Err(error) = Prepared::read(&at("case.toml"), &[]) else { panic!("{keys} is taken") };
        let text = text_of(&error);
        for words in words {
            assert!(text.contains(words), "{keys}: {text}");
        }
    };
    let input_of = "input = \"DISCON.IN\"";
    refused("library = \"no.so\"", &["there is no library", "relative to the case file"]);
    refused(
        "library = \"libdiscon.so\", input = \"no.IN\"",
        &["there is no input file of the controller library", "no.IN"],
    );
    refused("library = \"DISCON.IN\"", &["DISCON.IN: it is no shared library: expected machine"]);
    let mut foreign = fs::read(at("libdiscon.so")).expect("a library");
    foreign[..2].copy_from_slice(b"MZ");
    fs::write(at("other.dll"), foreign).expect("a file");
    refused("library = \"other.dll\"", &["made for Windows", "compile or download it for this"]);
    refused(
        "library = \"libdiscon.so\", procedure = \"CONTROLLER\"",
        &["it has no procedure `CONTROLLER`: export it under this name"],
    );
    refused(
        &format!("library = \"libdiscon.so\", {input_of}, anemometer = \"Mast\""),
        &["through the sensor `Mast`", "add sensors.Mast = { kind = \"anemometer\" }"],
    );
    refused(
        "library = \"libdiscon.so\"",
        &["libdiscon.so cannot begin: it failed with aviFAIL = -1: cannot open the input file"],
    );
}
