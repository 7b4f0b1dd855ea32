//! What shows only once turbines and controllers are there is reported before the first step, at its line of
//! the case file.

mod small;

use small::{options, written};
use std::sync::atomic::AtomicBool;
use study::{Estimate, Observer, Outcome, StudyError, StudyOptions};

const LATTICE: &str = r#"
name = "lattice"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
cells_per_diameter = 8
height_diameters = 3.0
[time]
spin_up = 40.0
duration = 160.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
[output]
crosswind_diameters = [1.0]
"#;

const PRESCRIBED: &str = r#"
name = "prescribed"
[wind]
speed = 9.0
turbulence_intensity = 0.1
turbulence_model = "kaimal"
[flow]
solver = "turbulence"
[time]
spin_up = 60.0
duration = 660.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "monitoring"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 0.0, amplitude_deg = 0.0 }
"#;

/// Keeps what was reported beforehand.
#[derive(Default)]
struct Reports {
    memory: u64,
    warnings: Vec<String>,
}

impl Observer for Reports {
    fn estimated(&mut self, estimate: &Estimate) {
        self.memory = estimate.memory;
    }

    fn warned(&mut self, warning: &str) {
        self.warnings.push(warning.to_owned());
    }
}

/// What a dry run of `case` comes to, and what it tells.
fn dry(case: &str) -> (Result<Outcome, StudyError>, Reports) {
    let folder = written(case);
    let options = StudyOptions { dry_run: true, ..options(folder.path()) };
    let mut reports = Reports::default();
    (study::run(&options, &AtomicBool::new(false), &mut reports), reports)
}

#[test]
fn what_does_not_fit_is_pointed_at_in_the_file() {
    for (case, from, to, line, said) in [
        (LATTICE, "[1.0]", "[40.0]", 19, "crosswind plane 40 diameters"),
        (LATTICE, "height_diameters = 3.0", "step = 2.0", 8, "flow.step = 2 s"),
        (LATTICE, "height_diameters = 3.0", "height_diameters = 1.0", 15, "outside the domain"),
        (
            PRESCRIBED,
            "\"kaimal\"",
            "\"kaimal\"\ngrid = { width = 120.0, height = 170.0, columns = 13, rows = 18 }",
            7,
            "and the rotors -62.9 to 62.9 m across and 27.1 to 152.9 m of height: give it a width of 125.9 m and a height of 125.9 m at least",
        ),
        (
            PRESCRIBED,
            "\"kaimal\"",
            "\"kaimal\"\ngrid = { width = 179.0, height = 190.0, columns = 20, rows = 20 }",
            7,
            "half of its 190 m are below the hub at 90.0 m, and reach into the ground: 180.0 m are the most",
        ),
        (
            PRESCRIBED,
            "\"turbulence\"",
            "\"turbulence\"\nstep = 8.0",
            24,
            "the controller of T2 cannot be built",
        ),
        (
            PRESCRIBED,
            "strouhal = 0.25 }",
            "strouhal = 0.25, stop = 40 }",
            22,
            "the controller of T1 cannot be built: stop = 40 s comes before the excitation has its full amplitude",
        ),
        (
            PRESCRIBED,
            "\"phase-sync\", offset_deg = 0.0, amplitude_deg = 0.0",
            "\"meandering\", factor = 0.5, amplitude_deg = 4.0, followed = \"load\", integral_gain = 1.0, azimuth_offset_deg = 0.0, delay = 10.0, moment_per_degree_mnm = 1.0",
            23,
            "the amplitude loop is unstable",
        ),
    ] {
        assert!(case.contains(from), "{from}");
        let (outcome, _) = dry(&case.replace(from, to));
        let Err(StudyError::Case(error)) = outcome else { panic!("{outcome:?}") };
        let problem = &error.problems()[0];
        assert!(problem.to_string().contains(said), "{problem}");
        assert_eq!(problem.line(), line, "{problem}");
    }
}

/// The NREL 5 MW turbine works from 3 to 25 m/s.
#[test]
fn wind_in_which_a_turbine_stands_still_is_refused_at_its_key() {
    let uniform = PRESCRIBED
        .replace("solver = \"turbulence\"", "solver = \"uniform\"")
        .replace("turbulence_model = \"kaimal\"\n", "")
        .replace("turbulence_intensity = 0.1", "turbulence_intensity = 0.0");
    let with = |event: &str| uniform.replace("[flow]", &format!("event = {event}\n[flow]"));
    let fast = uniform.replace("speed = 9.0", "speed = 39.0");
    let slow = uniform.replace("speed = 9.0", "speed = 1.0");
    let step = with("{ kind = \"step\", start = 100.0, speed = 30.0 }");
    let stairs =
        with("{ kind = \"staircase\", start = 100.0, hold = 50.0, rise = 2.0, n_steps = 9 }");
    for (case, line, said) in [
        (&fast, 4, "wind.speed = 39 m/s gives T1 a mean wind of 39.00 m/s at its hub"),
        (&slow, 4, "it works from 3 to 25 m/s"),
        (&step, 6, "wind.event, which leads to 30 m/s, gives T1"),
        (&stairs, 6, "wind.event, which leads to 27 m/s, gives T1"),
    ] {
        let (outcome, _) = dry(case);
        let Err(StudyError::Case(error)) = outcome else { panic!("{outcome:?}") };
        let problem = &error.problems()[0];
        assert!(problem.to_string().contains(said), "{problem}");
        assert!(problem.to_string().contains("[operation]"), "{problem}");
        assert_eq!(problem.line(), line, "{problem}");
    }
    // What comes and goes may lead beyond.
    let gust = with("{ kind = \"operating-gust\", start = 100.0, gust = 30.0 }");
    for case in [&uniform, &gust, &uniform.replace("speed = 9.0", "speed = 25.0")] {
        let (outcome, _) = dry(case);
        assert!(matches!(outcome, Ok(Outcome::Estimated)), "{outcome:?}");
    }
}

#[test]
fn threads_and_steps_that_hardly_end_are_refused_or_told() {
    let n_cores = std::thread::available_parallelism().map_or(1, usize::from);
    let with = |flow: &str| PRESCRIBED.replace("[time]", &format!("{flow}\n[time]"));
    if 16 * n_cores < 1024 {
        let Err(StudyError::Case(error)) = dry(&with("threads = 1024")).0 else { panic!("1024") };
        assert_eq!(error.problems()[0].line(), 9);
        assert!(error.to_string().contains("cannot be run"), "{error}");
    }
    let (outcome, reports) = dry(&with(&format!("threads = {}", n_cores + 1)));
    assert!(outcome.is_ok() && reports.warnings.iter().any(|told| told.contains("flow.threads")));
    let Err(StudyError::Case(error)) = dry(&with("step = 1e-9")).0 else { panic!("1e-9") };
    assert!(error.to_lines().contains("0.0001 <= step <= 10 s"), "{}", error.to_lines());
    let (outcome, reports) =
        dry(&with("step = 1e-4").replace("duration = 660.0", "duration = 2000.0"));
    assert!(outcome.is_ok(), "{outcome:?}");
    assert!(reports.warnings.iter().any(|told| told.contains("raise flow.step")));
}

#[test]
fn a_long_record_of_turbulence_returns_rather_than_fill_the_memory() {
    let (outcome, ten_minutes) = dry(PRESCRIBED);
    assert!(matches!(outcome, Ok(Outcome::Estimated)), "{outcome:?}");
    let returns = |reports: &Reports| {
        reports.warnings.iter().any(|warning| warning.contains("returns after"))
    };
    assert!(ten_minutes.memory > 1 << 20 && !returns(&ten_minutes));
    let (outcome, ten_hours) = dry(&PRESCRIBED.replace("660.0", "36000.0"));
    assert!(matches!(outcome, Ok(Outcome::Estimated)), "{outcome:?}");
    assert!(ten_hours.memory < 200 << 20 && returns(&ten_hours), "{} bytes", ten_hours.memory);
}
