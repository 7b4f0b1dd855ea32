//! The `.outb` of a turbine holds what its series holds, under the same names and in the same units.

mod small;

use formats::records::SeriesFile;
use formats::table::TableReader;
use small::{NREL_5MW, case, done, options, written};
use std::f64::consts::PI;
use std::path::Path;

const RUN: &str = r#"[[run]]
name = "baseline"
"#;

/// Generator speed over rotor speed of NREL 5 MW (–).
const GEAR_RATIO: f64 = 97.0;
/// What of its power becomes electrical (–).
const EFFICIENCY: f64 = 0.944;

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
fn it_has_the_channels_of_the_series_with_their_units_and_values() {
    let folder = written(&case("whole", "", [10.0, 40.0], &[NREL_5MW], RUN));
    let output = folder.path().join("out");
    done(&options(folder.path()));
    let run = output.join("baseline");
    let series = SeriesFile::open(&run.join("series.csv")).expect("a series");
    let table = TableReader::open(&run.join("T1.outb")).expect("a table");
    let found: Vec<(String, String)> =
        table.channels().map(|column| (column.name.clone(), column.unit.clone())).collect();
    let wind = ["Wind1VelX", "Wind1VelY", "Wind1VelZ"];
    let own = |name: &str| name.strip_prefix("T1.").map(str::to_owned);
    let expected: Vec<(String, String)> = series
        .names()
        .iter()
        .zip(series.units())
        .filter(|(name, _)| *name != "Time")
        .enumerate()
        .map(|(place, (name, unit))| {
            (own(name).unwrap_or_else(|| wind[place].to_owned()), unit.symbol().to_owned())
        })
        .collect();
    assert_eq!(found, expected);
    for name in ["RotSpeed", "BldPitch3", "RootMyb2", "PitchCmd1", "RtAeroFxh"] {
        let (_, packed) = channel(&run.join("T1.outb"), name);
        let (_, written) = channel(&run.join("series.csv"), &format!("T1.{name}"));
        let range = written.iter().fold(0.0_f64, |range, value| range.max(value.abs()));
        // The 16 bits of the format.
        assert_eq!(packed.len(), written.len());
        for (packed, written) in packed.iter().zip(&written) {
            assert!((packed - written).abs() <= range * 2e-5, "{name}: {packed} {written}");
        }
    }
}

/// The generator's side of the gearbox is the fast one: torque times speed there is the power that it takes
/// in.
#[test]
fn torque_and_speed_are_those_of_the_generator_s_side() {
    let folder = written(&case("geared", "", [10.0, 40.0], &[NREL_5MW], RUN));
    let output = folder.path().join("out");
    done(&options(folder.path()));
    let run = output.join("baseline");
    let of = |name: &str| channel(&run.join("series.csv"), &format!("T1.{name}")).1;
    let (torque, speed) = (of("GenTq"), of("GenSpeed"));
    let (power, rotor) = (of("GenPwr"), of("RotSpeed"));
    // The first row knows of no torque yet.
    for row in 1..torque.len() {
        let taken = torque[row] * speed[row] * PI / 30.0 * EFFICIENCY;
        assert!((power[row] / taken - 1.0).abs() < 1e-12, "{} kW of {taken} kW", power[row]);
        assert!((speed[row] / rotor[row] / GEAR_RATIO - 1.0).abs() < 0.01, "{row}");
    }
    assert!(torque.last().is_some_and(|torque| (5.0..43.2).contains(torque)), "{torque:?}");
}
