//! Case files and overrides of them.

use super::damage::{damaged, damages};
use super::{config, helps, memory, survives};
use crate::case::{self, CaseError};
use miette::Diagnostic;
use proptest::prelude::*;

/// Every way of writing a case that the shipped ones know.
const CASES: [&str; 4] = [
    include_str!("../../../../../cases/helix-two-turbines.toml"),
    include_str!("../../../../../cases/one-turbine.toml"),
    include_str!("../../../../../cases/synchronised-helix.toml"),
    include_str!("../../../../../cases/meandering.toml"),
];
const OVERRIDES: [&str; 5] = [
    "wind.speed=8",
    "turbine.0.position_diameters=[0.0, 1.5]",
    "run.0.control.T1.amplitude_deg=3",
    "run.0.control.T1={ kind = \"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25 }",
    "name=other",
];

/// That everything that is wrong has a line, and is reported.
fn lines(error: &CaseError) -> Result<(), TestCaseError> {
    prop_assert!(!error.to_lines().is_empty());
    for problem in error.problems() {
        prop_assert!(problem.line() > 0 && !problem.to_string().is_empty());
    }
    Ok(())
}

#[test]
fn case_files() {
    for text in CASES {
        survives(vec![("case.toml", text.into())], |folder| {
            let path = folder.join("case.toml");
            let read = case::read(&path, &[]);
            if let Err(error) = &read {
                lines(error).map_err(|_| miette::miette!("a problem has no line"))?;
            }
            let read = read?;
            let _ = case::write(&read.case);
            let _ = case::fingerprint(&read.text, "helix");
            Ok(())
        });
    }
}

#[test]
fn precursor_files() {
    let text = include_str!("../../../../../cases/precursor-offshore.toml");
    survives(vec![("precursor.toml", text.into())], |folder| {
        let read = case::read_precursor(&folder.join("precursor.toml"), &[]);
        if let Err(error) = &read {
            lines(error).map_err(|_| miette::miette!("a problem has no line"))?;
        }
        let _ = read?.fingerprint();
        Ok(())
    });
}

#[test]
fn overrides() {
    proptest!(config(), |(which in 0..OVERRIDES.len(), damages in damages())| {
        let text = damaged(OVERRIDES[which].as_bytes(), &damages);
        let changed = [String::from_utf8_lossy(&text).into_owned()];
        let (result, peak) = memory::peak(|| case::parse("case.toml", CASES[0], &changed));
        prop_assert!(peak <= super::MOST_MEMORY, "{peak} bytes");
        if let Err(error) = result {
            lines(&error)?;
            helps(&error as &dyn Diagnostic, &["case.toml"])?;
        }
    });
}
