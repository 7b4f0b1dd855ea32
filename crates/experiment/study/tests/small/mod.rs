//! Small studies for trials: cases in wind that is the same everywhere, in folders that go away.
#![allow(dead_code, reason = "each test binary uses its part")]

use farm::assemble::TurbineModel;
use farm::case::Case;
use farm::{Air, Plan};
use flow::inflow::{MeanProfile, PrescribedWind};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use study::outputs::{FedBy, Keys, Output, OutputKind, Scene, Schedule};
use study::{Outcome, Silent, StudyError, StudyOptions};
use tempfile::TempDir;

/// What a turbine of [`case`] is.
pub(crate) const NREL_5MW: &str = r#"model = "nrel-5mw""#;
/// A disk of slow air that circles in the wind of [`case`], whose waves a turbine takes for a helix.
pub(crate) const DISK: &str = r#"event = { kind = "rotating-disk", speed = 6.0, strouhal = 0.25 }
"#;
/// Control that estimates the phase of a helix and does nothing.
pub(crate) const MONITORING: &str =
    r#"{ kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }"#;
/// Control of a turbine that is not there.
pub(crate) const ABSENT: &str = r#"{ kind = "absent" }"#;

/// The case `name` in 9 m/s, with the lines `more_wind` under `[wind]`: spin-up and duration are `times` (s),
/// the stiff turbines T1, T2, … stand 5 D apart, each with the lines that `machines` hold, and `rest` ends
/// the file with its runs.
pub(crate) fn case(
    name: &str,
    more_wind: &str,
    times: [f64; 2],
    machines: &[&str],
    rest: &str,
) -> String {
    let [spin_up, duration] = times;
    let mut text = format!(
        r#"
name = "{name}"
[wind]
speed = 9.0
turbulence_intensity = 0.0
{more_wind}[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = {spin_up:?}
duration = {duration:?}
"#
    );
    for (index, machine) in machines.iter().enumerate() {
        let (number, downwind) = (index + 1, 5.0 * index as f64);
        text += &format!(
            r#"[[turbine]]
name = "T{number}"
{machine}
position_diameters = [{downwind:?}, 0.0]
structure = "rigid"
"#
        );
    }
    text + rest
}

/// The run `name` in which T1 pitches a helix and T2, T3, … do what `others` say.
pub(crate) fn behind_helix(name: &str, others: &[&str]) -> String {
    let mut text = format!(
        r#"[[run]]
name = "{name}"
control.T1 = {{ kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }}
"#
    );
    for (index, control) in others.iter().enumerate() {
        text += &format!("control.T{} = {control}\n", index + 2);
    }
    text
}

/// A folder with the `case` in its `case.toml`.
pub(crate) fn written(case: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("case.toml"), case).expect("a case file");
    folder
}

/// The study of the case in `folder`, with its results in `out` beside it.
pub(crate) fn options(folder: &Path) -> StudyOptions {
    StudyOptions {
        case: folder.join("case.toml"),
        output: Some(folder.join("out")),
        ..StudyOptions::default()
    }
}

/// What becomes of a study that is left alone.
pub(crate) fn run(options: &StudyOptions) -> Result<Outcome, StudyError> {
    study::run(options, &AtomicBool::new(false), &mut Silent)
}

/// Runs a study to its end; gives the folder of its records.
pub(crate) fn done(options: &StudyOptions) -> PathBuf {
    match run(options) {
        Ok(Outcome::Done { directory, .. }) => directory,
        outcome => panic!("{outcome:?}"),
    }
}

/// What tells of the machine and the hour, with how long a run took.
const OF_THE_HOUR: [&str; 3] = ["manifest.json", "summary.json", "checkpoint"];

/// Everything that a run left but what tells of the machine and the hour, by its place in the run's folder.
pub(crate) fn left(run: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for folder in [run.to_owned(), run.join("planes"), run.join("volumes")] {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            if path.is_file() && !OF_THE_HOUR.contains(&name.as_str()) {
                let place = path.strip_prefix(run).expect("in the run").to_owned();
                files.push((place, fs::read(&path).expect("a file")));
            }
        }
    }
    files.sort();
    files
}

/// Whether the runs in both folders have left the same files with the same bits.
pub(crate) fn assert_alike(whole: &Path, other: &Path) {
    let (whole, other) = (left(whole), left(other));
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&whole), names(&other));
    assert!(whole.len() > 10, "{:?}", names(&whole));
    assert!(names(&whole).contains(&PathBuf::from("T1.outb")), "{:?}", names(&whole));
    for ((name, before), (_, after)) in whole.iter().zip(&other) {
        assert!(before == after, "{} has other bits", name.display());
    }
}

/// The case in `text` with `overrides`, laid out, and the turbine of the library called `model` that stands
/// in it.
pub(crate) fn laid_out(
    text: &str,
    overrides: &[String],
    model: &str,
) -> (Case, Plan, TurbineModel) {
    let case = formats::case::parse("case.toml", text, overrides)
        .unwrap_or_else(|error| panic!("{}", error.to_lines()));
    let file = formats::library::load(model).expect("a turbine of the library");
    let machine =
        TurbineModel { definition: Arc::new(file.definition), constants: file.controller };
    let machine = machine.equipped(case.flow.solver, case.wind.air_density).into_owned();
    let footprints = BTreeMap::from([(model.to_owned(), machine.footprint(case.wind.speed))]);
    let plan = farm::plan(&case, &footprints).expect("the layout fits");
    (case, plan, machine)
}

/// The prescribed wind of `case`, the same everywhere.
pub(crate) fn uniform_air(case: &Case) -> Air {
    let profile = Arc::new(MeanProfile::Uniform { speed: case.wind.speed });
    Box::new(PrescribedWind::everywhere(profile))
}

/// What [`HALFWAY`] asks for an end with; one study at a time may listen to it.
pub(crate) static STOP: AtomicBool = AtomicBool::new(false);

/// Leaves nothing, and asks for an end when half of a run is made.
pub(crate) static HALFWAY: OutputKind = OutputKind {
    name: "halfway",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::AnyFlow,
    disk: |_, _, _| 0,
    begin: |_, _| Ok(Some(Box::new(Halfway))),
};

struct Halfway;

impl Output for Halfway {
    fn schedule(&self) -> Schedule {
        Schedule::steps(1)
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if scene.farm.step() == scene.setup.plan.n_steps / 2 {
            STOP.store(true, Ordering::Relaxed);
        }
        Ok(())
    }
}
