//! What a reader of free wakes is told before the runs, and that wakes are carried by the wind that blows.

mod small;

use basis::records::Filaments;
use farm::self_check::SelfCheck;
use flow::inflow::TurbulenceBox;
use formats::turbulence_box::{self, StoredBox};
use miette::Diagnostic;
use small::{options, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Observer, Prepared, StudyError, StudyOptions};

/// One turbine in even wind.
const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.0
shear_exponent = 0.0
[flow]
solver = "vortex"
steps_per_turn = 16
wake_length_diameters = 4.0
near_wake_diameters = 0.2
far_wake_filaments = 4
points_per_diameter = 4
[time]
spin_up = 200.0
duration = 220.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
"#;

/// The case with each text of `changes` replaced by the one behind it.
fn changed(changes: &[[&str; 2]]) -> String {
    changes.iter().fold(CASE.to_owned(), |text, [from, to]| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// What is told of the case with `changes`.
fn warnings(changes: &[[&str; 2]]) -> Vec<String> {
    let folder = written(&changed(changes));
    let prepared = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    prepared.warnings.iter().map(|warning| warning.message.clone()).collect()
}

/// Whether `words` are told of the case with `changes`.
fn told(changes: &[[&str; 2]], words: &str) -> bool {
    warnings(changes).iter().any(|warning| warning.contains(words))
}

/// Keeps what is told of rotors.
#[derive(Default)]
struct Told(Vec<SelfCheck>);

impl Observer for Told {
    fn checked(&mut self, check: &SelfCheck) {
        self.0.push(check.clone());
    }
}

#[test]
fn a_wake_that_is_too_short_for_its_rotor_is_told_of_and_falls_through_the_check() {
    let short = |length: &'static str| [["wake_length_diameters = 4.0", length]];
    let words = "raise flow.wake_length_diameters to 3.6 or more";
    assert!(told(&short("wake_length_diameters = 3.5"), words));
    assert!(!told(&short("wake_length_diameters = 3.6"), words));
    let check = |length: &'static str| {
        let folder = written(&changed(&short(length)));
        let dry = StudyOptions { dry_run: true, check: true, ..options(folder.path()) };
        let mut told = Told::default();
        study::run(&dry, &AtomicBool::new(false), &mut told).expect("a sound case");
        told.0.remove(0)
    };
    let (long, short) =
        (check("wake_length_diameters = 20.0"), check("wake_length_diameters = 0.5"));
    // Steps of 22° are coarse; the end at 0.5 D is what differs.
    let excess = short.power_error() - long.power_error();
    assert!(!short.passes() && excess > 0.15, "{short:?} {long:?}");
}

#[test]
fn a_spin_up_in_which_wakes_do_not_grow_is_told_of() {
    // 4 × 126 m at 0.65 × 9 m/s: 86 s.
    let words = "wakes take some 86 s to grow to their length, and time.spin_up = 80 s is shorter";
    assert!(told(&[["spin_up = 200.0", "spin_up = 80.0"]], words));
    assert!(!told(&[], "to grow to their length"));
}

#[test]
fn keys_of_other_solvers_are_told_of() {
    let words = "flow.sides, flow.cells_per_diameter have no effect with flow.solver = \"vortex\", for \"lattice\" to read; leave them out";
    let more = ["[time]", "sides = \"open\"\ncells_per_diameter = 16\n[time]"];
    assert!(told(&[more], words), "{:?}", warnings(&[more]));
    // Of the lattice those of free wakes.
    let other = ["solver = \"vortex\"", "solver = \"lattice\""];
    let words = "flow.far_wake_filaments, flow.points_per_diameter have no effect with flow.solver = \"lattice\", for \"vortex\" to read";
    assert!(told(&[other], words), "{:?}", warnings(&[other]));
    assert!(!told(&[], "no effect"));
}

#[test]
fn shear_of_a_file_is_told_of_where_it_carries_wakes() {
    let carried = ["[time]", "wake_shear = \"carried\"\n[time]"];
    let file = ["shear_exponent = 0.0", "shear_exponent = 0.0\ntable = \"u.csv\""];
    let folder = written(&changed(&[carried, file]));
    fs::write(folder.path().join("u.csv"), table()).expect("a table");
    let prepared = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    let is_told =
        |warning: &study::SetupWarning| warning.message.contains("carries wakes faster above");
    assert!(prepared.warnings.iter().any(is_told));
    assert!(!told(&[carried], "carries wakes faster above"));
}

/// A table of steady wind whose exponent is 0.2.
fn table() -> &'static str {
    "time_s,speed_m_s,shear_exponent\n0,9,0.2\n400,9,0.2\n"
}

/// Writes a box of wind with that exponent, and no turbulence, over the rotor and beside it.
fn box_of_wind(path: &Path) {
    let n_points = [80, 21, 21];
    let n = n_points.iter().product::<usize>();
    let velocity = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    let spacing = [9.0, 10.0, 10.0];
    let turbulence = TurbulenceBox::new(n_points, spacing, velocity).expect("a sound box");
    let mean = |row: u32| 9.0 * ((10.0 + 10.0 * f64::from(row)) / 90.0).powf(0.2);
    let stored = StoredBox {
        turbulence,
        hub_speed: 9.0,
        hub_height: 90.0,
        lowest_height: 10.0,
        mean_speeds: (0..21).map(mean).collect(),
        description: "a trial".to_owned(),
    };
    turbulence_box::write(path, &stored).expect("a file");
}

/// How much farther downwind a wake's oldest pieces are above the hub than below (m), after twenty seconds
/// in the wind that `wind` names, whose shear the case itself does not know.
fn lean(wind: &str, shear: &str) -> f64 {
    let flow = format!("wake_shear = \"{shear}\"\n[time]");
    let wind = format!("shear_exponent = 0.0\n{wind}");
    let folder = written(&changed(&[
        ["shear_exponent = 0.0", &wind],
        ["[time]", &flow],
        ["spin_up = 200.0", "spin_up = 5.0"],
        ["duration = 220.0", "duration = 20.0"],
    ]));
    fs::write(folder.path().join("u.csv"), table()).expect("a table");
    box_of_wind(&folder.path().join("w.bts"));
    let done = small::done(&options(folder.path()));
    let records = formats::records::read_study(&done).expect("records");
    let last = records.runs[0].last_filaments.as_ref().expect("vortices");
    place_of_oldest(last, |height| height > 110.0) - place_of_oldest(last, |height| height < 70.0)
}

/// Mean place along the wind (m) of the nodes that left the blades in the first seconds, at heights (m) where
/// `is_there`.
fn place_of_oldest(filaments: &Filaments, is_there: impl Fn(f32) -> bool) -> f64 {
    let oldest = filaments.pieces.iter().filter(|piece| piece.age > 12.0);
    let nodes = oldest.map(|piece| filaments.nodes[piece.ends[0] as usize]);
    let places: Vec<f64> =
        nodes.filter(|node| is_there(node[2])).map(|node| f64::from(node[0])).collect();
    assert!(places.len() > 20, "{}", places.len());
    places.iter().sum::<f64>() / places.len() as f64
}

#[test]
fn the_shear_of_a_file_is_left_out_as_the_file_has_it() {
    for wind in ["table = \"u.csv\"", "planes = \"w.bts\""] {
        let [carried, left_out] = ["carried", "left-out"].map(|shear| lean(wind, shear));
        // Some 1.5 m/s between the halves, for more than twelve seconds.
        assert!(carried > 15.0 && left_out.abs() < 0.25 * carried, "{wind} {carried} {left_out}");
    }
}

#[test]
fn a_rotor_that_turns_faster_than_its_steps_are_made_for_ends_its_run_with_a_fix() {
    // Held at a tip-speed ratio that the plan does not know of.
    let folder = written(&changed(&[
        ["steps_per_turn = 16", "step = 0.7"],
        [
            "name = \"baseline\"",
            "name = \"fast\"\ncontrol.T1 = { kind = \"held-speed\", held_tip_speed_ratio = 12.0 }",
        ],
        ["spin_up = 200.0", "spin_up = 5.0"],
        ["duration = 220.0", "duration = 20.0"],
    ]));
    let error = small::run(&options(folder.path())).expect_err("it turns too far");
    assert!(matches!(error, StudyError::Diverged { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("run fast ended early: a rotor turned by 50°"), "{text}");
    let help = error.help().expect("a fix").to_string();
    assert!(help.contains("lower flow.step or raise flow.steps_per_turn"), "{help}");
}
