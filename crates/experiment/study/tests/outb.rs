//! The `.outb` of a turbine in prescribed wind holds what its series holds, under OpenFAST's names and units.

mod small;

use formats::table::TableReader;
use small::{NREL_5MW, case, done, options, written};
use std::path::Path;

const RUN: &str = r#"[[run]]
name = "baseline"
"#;

/// Generator speed over rotor speed of NREL 5 MW (–).
const GEAR_RATIO: f64 = 97.0;

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
    let folder = written(&case("geared", "", [10.0, 40.0], &[NREL_5MW], RUN));
    let output = folder.path().join("out");
    done(&options(folder.path()));
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
