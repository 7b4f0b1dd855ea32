//! The `.outb` of a turbine in prescribed wind holds what its series holds, under OpenFAST's names and units.

use formats::table::TableReader;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Options, Outcome, Watcher};

const CASE: &str = r#"
name = "geared"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 40.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
"#;

/// Generator speed over rotor speed of NREL 5 MW (–).
const GEAR_RATIO: f64 = 97.0;

struct Silent;

impl Watcher for Silent {}

/// Unit of the channel `name` in the table at `path`, and its values.
fn channel(path: &Path, name: &str) -> (String, Vec<f64>) {
    let mut table = TableReader::open(path).expect("a table");
    table.select(&[name]).expect("the channel");
    let unit = table.selected().map(|column| column.unit.clone()).collect();
    let (mut row, mut values) = ([0.0; 2], Vec::new());
    while table.read(&mut row).expect("a row") {
        values.push(row[1]);
    }
    (unit, values)
}

#[test]
fn generator_torque_is_that_of_the_generator_s_side() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = folder.path().join("geared.toml");
    fs::write(&case, CASE).expect("a file");
    let output = folder.path().join("out");
    let options = Options { case, output: Some(output.clone()), ..Options::default() };
    let outcome = study::run(&options, &AtomicBool::new(false), &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let run = output.join("baseline");
    let (unit, torque) = channel(&run.join("T1.outb"), "GenTq");
    let (_, low_speed) = channel(&run.join("series.csv"), "T1.generator_torque_nm");
    assert_eq!((unit.as_str(), torque.len()), ("kN-m", low_speed.len()));
    // Packed into 16 bits: a step of less than 0.001 kN m up to the 43 kN m of rated torque.
    for (torque, low_speed) in torque.iter().zip(&low_speed) {
        assert!((torque - low_speed / GEAR_RATIO / 1e3).abs() < 1e-3, "{torque} {low_speed}");
    }
    assert!(torque.last().is_some_and(|torque| (5.0..43.2).contains(torque)), "{torque:?}");
}
