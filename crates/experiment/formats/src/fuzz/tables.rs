//! Channels over time: OpenFAST's binary and text output, CSV, the project's own series.

use super::{Refusal, survives};
use crate::openfast_output::tests::by_hand;
use crate::openfast_output::{Encoding, Layout, OutbWriter};
use crate::records::read_series;
use crate::table::{Column, TableReader};
use std::fs;
use std::path::Path;

/// Every row of every channel, then of the first channel by its name.
fn read(path: &Path) -> Result<(), Refusal> {
    let mut table = TableReader::open(path)?;
    let names: Vec<String> = table.channels().map(|channel| channel.name.clone()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    table.select(&names)?;
    let mut row = vec![0.0; names.len() + 1];
    while table.read(&mut row)? {}
    Ok(())
}

fn written(encoding: Encoding) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.outb");
    let channel = |name: &str, unit: &str| Column { name: name.into(), unit: unit.into() };
    let channels = vec![channel("GenSpeed", "rpm"), channel("RootMyc1", "kN-m")];
    let layout = Layout { description: "small".into(), channels, start: 0.0, interval: 0.1 };
    let mut writer = OutbWriter::create(&path, layout, encoding).unwrap();
    for step in 0..7 {
        writer.write(&[f64::from(step), f64::from(step * step)]).unwrap();
    }
    writer.finish().unwrap();
    fs::read(path).unwrap()
}

const OUT: &str = "
Predictions were generated on 01-Jan-2026 using OpenFAST

Time\tWind1VelX\tRootMyc1
(s)\t(m/s)\t(kN-m)
0.0000\t 1.000E+01\t-2.500E+03
0.0500\t 1.010E+01\t-2.600-103
0.1000\t 1.020E+01\t-2.700D+03
";
const CSV: &str =
    "# by hand\n\"Time [s]\",RootMyc1 [kN-m],T1.GenPwr_kW\n0,1.5,2e6\n0.1,2.5,2e6\n\n0.2,3,2e6\n";
const SERIES: &str =
    "Time_s,T1.GenPwr_kW,T1.BldPitch1_deg\n0.1,2e6,0\n0.2,2.1e6,0.01\n0.3,2e6,0.02\n";

#[test]
fn binary_output() {
    for bytes in [by_hand(1), by_hand(2), written(Encoding::Compressed), written(Encoding::Exact)] {
        survives(vec![("run.outb", bytes)], |folder| read(&folder.join("run.outb")));
    }
}

#[test]
fn text_output() {
    survives(vec![("run.out", OUT.into())], |folder| read(&folder.join("run.out")));
}

#[test]
fn comma_separated_values() {
    survives(vec![("loads.csv", CSV.into())], |folder| read(&folder.join("loads.csv")));
}

#[test]
fn series() {
    survives(vec![("series.csv", SERIES.into())], |folder| {
        read_series(&folder.join("series.csv"), |_| true)?;
        read_series(&folder.join("series.csv"), |name| name != "T1.GenPwr")?;
        read(folder)
    });
}
