//! A study in free vortices, from case to records, stopped on the way: what it leaves has the same bits; and
//! what of a case it cannot take.

mod small;

use farm::FarmError;
use farm::self_check::SelfCheck;
use flow::FlowError;
use miette::Diagnostic;
use small::{HALFWAY, STOP, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Estimate, Observer, Outcome, Outputs, Prepared, Silent, StudyError, StudyOptions};

/// Two turbines so close that the first one's wake reaches the second, in sheared turbulence.
const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.06
shear_exponent = 0.2
turbulence_model = "kaimal"
[flow]
solver = "vortex"
steps_per_turn = 16
wake_length_diameters = 2.0
near_wake_diameters = 0.2
far_wake_filaments = 4
far_wake_steps = 1
points_per_diameter = 4
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
position_diameters = [1.0, 0.2]
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3 }
[output]
crosswind_diameters = [1.0]
volume_interval = 10.0
filament_interval = 5.0
"#;

fn options(folder: &Path, name: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(name)), ..small::options(folder) }
}

/// Files below `folder` that hold physics, by their names.
fn physics(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for place in [folder.to_owned(), folder.join("planes"), folder.join("volumes")] {
        let mut names: Vec<_> = fs::read_dir(&place)
            .unwrap_or_else(|error| panic!("{}: {error}", place.display()))
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| {
                let kind = path.extension().and_then(|kind| kind.to_str());
                kind.is_some_and(|kind| ["csv", "nc", "vti", "vtp", "outb"].contains(&kind))
            })
            .collect();
        names.sort();
        for path in names {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            files.push((name, fs::read(&path).expect("a file")));
        }
    }
    files
}

#[test]
fn a_stopped_study_leaves_what_one_that_was_left_alone_does() {
    let folder = written(CASE);
    let outcome = small::run(&options(folder.path(), "whole"));
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let mut again = options(folder.path(), "stopped");
    let outputs = Outputs::standard().with(&HALFWAY);
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    again.resume = true;
    let outcome = small::run(&again);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    assert!(summaries[0].has_wakes());
    let whole = physics(&folder.path().join("whole/helix"));
    assert_eq!(physics(&folder.path().join("stopped/helix")), whole);
    let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).collect();
    // The instants 10 and 15 s, and the last one, which is no whole 20 s.
    for name in ["series.csv", "T2.outb", "hub-height-mean.nc", "filaments-0001.vtp"] {
        assert!(names.contains(&name), "{name} of {names:?}");
    }
    assert_eq!(names.iter().filter(|name| name.ends_with(".vtp")).count(), 3);
    let records = formats::records::read_study(&folder.path().join("whole")).expect("records");
    let last = records.runs[0].last_filaments.as_ref().expect("vortices");
    assert!((last.time - 20.0).abs() < 0.2, "{}", last.time);
    let of = |turbine: u32| last.pieces.iter().filter(|piece| piece.turbine == turbine).count();
    assert!(of(0) > 500 && of(0) + of(1) == last.pieces.len(), "{} {}", of(0), of(1));
    assert!(records.runs[0].summary.flow.as_ref().is_some_and(|flow| !flow.limits.is_empty()));
}

/// Keeps what is told of cost and rotors.
#[derive(Default)]
struct Told(Vec<Estimate>, Vec<SelfCheck>);

impl Observer for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.0.push(estimate.clone());
    }

    fn checked(&mut self, check: &SelfCheck) {
        self.1.push(check.clone());
    }
}

#[test]
fn cost_and_rotors_are_told_before_the_runs() {
    let folder = written(CASE);
    let told = |check: bool| {
        let mut told = Told::default();
        let dry = StudyOptions { dry_run: true, check, ..options(folder.path(), "dry") };
        study::run(&dry, &AtomicBool::new(false), &mut told).expect("a sound case");
        told
    };
    let Told(estimates, checks) = told(false);
    assert!(checks.is_empty() && estimates.len() == 2, "{}", estimates.len());
    let Estimate { work, n_steps_in_all, memory, .. } = estimates[1];
    // Wakes of 2 D are not whole before 2 × 126 m / (0.65 × 9 m/s) = 43 s, so that no step of 20 s costs all;
    // a tenth of it is there without any wake.
    let share = work / n_steps_in_all as f64;
    assert!((share - 0.1 - 0.9 * 0.5 * 20.0 / 43.1).abs() < 0.01, "{share}");
    assert!(memory > 100_000 && estimates[0].updates_per_second.is_none());
    assert!(estimates[1].wall_time().is_some_and(|time| time > 0.01 && time < 600.0));
    // Both turbines are of one kind. Steps of 22° are coarse, but a rotor without a wake has some 40 % more.
    let Told(estimates, checks) = told(true);
    assert_eq!(checks.len(), 1);
    assert!(estimates.last().is_some_and(|estimate| estimate.updates_per_second.is_some()));
    assert!(checks[0].thrust_error().abs() < 0.2, "{:?}", checks[0]);
}

#[test]
fn a_wake_that_blows_up_ends_its_run_and_leaves_the_checkpoint_before() {
    // Wind that rises beyond the speed of sound, on a stiff turbine that knows no cut-out.
    let event =
        "event = { kind = \"staircase\", start = 19.0, rise = 40.0, n_steps = 10, hold = 2.0 }";
    let case = |duration: f64| {
        CASE.replace("turbulence_intensity = 0.06", "turbulence_intensity = 0.0")
            .replace("turbulence_model = \"kaimal\"", event)
            .replace("duration = 20.0", &format!("duration = {duration:?}"))
            .replace("model = \"nrel-5mw\"", "model = \"any-wind.toml\"\nstructure = \"rigid\"")
    };
    let folder = written(&case(20.0));
    let library = include_str!("../../../../turbines/nrel-5mw.toml");
    let (before, rest) = library.split_once("[operation]").expect("the group");
    let (_, after) = rest.split_once("[controller]").expect("the group behind it");
    let turbine = format!("{before}[controller]{after}");
    fs::write(folder.path().join("any-wind.toml"), turbine).expect("a turbine file");
    small::done(&options(folder.path(), "out"));
    fs::write(folder.path().join("case.toml"), case(60.0)).expect("a case file");
    let longer = StudyOptions { resume: true, ..options(folder.path(), "out") };
    for _ in 0..2 {
        let error = small::run(&longer).expect_err("no wake is as fast");
        // Its own keys, none of the lattice's.
        let help = error.help().expect("a fix").to_string();
        assert!(help.contains("flow.core_growth") && !help.contains("cells"), "{help}");
        let StudyError::Diverged { source, checkpoint, series, .. } = error else {
            panic!("{error:?}")
        };
        let FarmError::Flow(FlowError::Diverged { time, speed, position }) = *source else {
            panic!("{source:?}")
        };
        assert!((19.0..39.0).contains(&time) && speed > 340.0, "{time} {speed}");
        assert!(position.x.is_finite() && position.x > -10.0, "{position}");
        // From the checkpoint it comes to the same end again.
        assert!(checkpoint.is_some_and(|path| path.is_file()) && series.is_some());
    }
}

#[test]
fn vortices_are_asked_for_where_there_are_some() {
    let text = CASE
        .replace("solver = \"vortex\"", "solver = \"turbulence\"")
        .replace("volume_interval = 10.0\n", "");
    let keys = ["steps_per_turn", "wake_length", "near_wake", "far_wake", "points_per"];
    let kept = text.lines().filter(|line| !keys.iter().any(|key| line.starts_with(key)));
    let folder = written(&kept.collect::<Vec<_>>().join("\n"));
    let Err(StudyError::Case(error)) = Prepared::read(&folder.path().join("case.toml"), &[]) else {
        panic!("it is taken")
    };
    let text = error.to_lines();
    let expected = "`output.filament_interval` has no effect here: flow.solver = \"turbulence\" has no vortices";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn steps_that_turn_a_rotor_too_far_are_refused_and_long_ones_warned_of() {
    let lay_out = |flow: &str| {
        let text = CASE.replace("steps_per_turn = 16", flow);
        let folder = written(&text);
        Prepared::read(&folder.path().join("case.toml"), &[])
    };
    // Turbulent wind may bring it to its rated speed, 12.1 rpm: 73° a second.
    let Err(StudyError::Case(error)) = lay_out("step = 1.0") else { panic!("it is taken") };
    let text = error.to_lines();
    assert!(text.contains("T1 turns by 73° in a step at its rated speed"), "{text}");
    let warned = |flow: &str| {
        let prepared = lay_out(flow).expect("it can be");
        let warnings: Vec<String> =
            prepared.warnings.iter().map(|warning| warning.message.clone()).collect();
        warnings.iter().any(|warning| warning.contains("in a step: its wake is a polygon"))
    };
    assert!(warned("step = 0.4") && !warned("step = 0.2"));
}

#[test]
fn wakes_that_end_behind_the_last_rotor_cost_less_and_are_told_of() {
    let lay_out = |flow: &str| {
        let keys = format!("nacelle_wake_diameters = 0.0\n{flow}\nnear_wake_diameters");
        let text = CASE.replace("near_wake_diameters", &keys);
        let folder = written(&text);
        Prepared::read(&folder.path().join("case.toml"), &[]).expect("it can be")
    };
    let told = |prepared: &Prepared| -> Vec<String> {
        let early = |message: &&String| message.contains("ends early");
        prepared.warnings.iter().map(|w| &w.message).filter(early).cloned().collect()
    };
    let (whole, ended) = (lay_out(""), lay_out("wake_beyond_last_diameters = 0.6"));
    assert!(told(&whole).is_empty());
    // Wakes of 1.6 and 0.6 D in place of two of 2 D, each with 0.2 D of finer rows that stay.
    let kind = whole.case.flow.solver;
    let memory = |prepared: &Prepared| (kind.memory)(&prepared.case, &prepared.plan) as f64;
    let of_blades = kind.most_filaments.expect("it has some");
    let pieces = |prepared: &Prepared| of_blades(&prepared.case, &prepared.plan) as f64;
    assert!(memory(&ended) < 0.9 * memory(&whole) && pieces(&ended) < 0.9 * pieces(&whole));
    let growing = |prepared: &Prepared| prepared.plan.n_growing_steps as f64;
    assert!((growing(&ended) / growing(&whole) - 0.8).abs() < 0.01);
    let behind = |prepared: &Prepared| {
        let plan = &prepared.plan;
        plan.origin.x + plan.n_points[0] as f64 * plan.spacing - plan.positions[1].x
    };
    for (prepared, length) in [(&whole, 2.0), (&ended, 0.6)] {
        let found = behind(prepared) / prepared.plan.diameter;
        assert!((found - length).abs() < 0.15, "{found} {length}");
    }
    let told = told(&ended);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[1].starts_with("the wake of T2 ends early") && told[1].contains("more power"));
    // One that is longer than wakes are ends none.
    let longer = lay_out("wake_beyond_last_diameters = 3.0");
    assert_eq!((growing(&longer), behind(&longer)), (growing(&whole), behind(&whole)));
}
