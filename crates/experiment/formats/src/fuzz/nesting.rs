//! Files that are small and cost much: deep nesting, aliases of aliases, and counts that multiply.

use super::{Refusal, helps, memory};
use crate::openfast::ImportOptions;
use crate::{case, openfast, records, turbine_file, windio};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// Levels (–) that no reader goes down to.
const DEEP: usize = 50_000;

fn refused(name: &str, text: &str, read: impl Fn(&Path) -> Result<(), Refusal>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    let (result, peak) = memory::peak(|| read(&path));
    helps(&*result.expect_err("it was read"), &[name]).unwrap();
    assert!(peak <= super::MOST_MEMORY, "{name}: {peak} bytes");
}

fn import(path: &Path) -> Result<(), Refusal> {
    windio::import(path, &ImportOptions::default())?;
    Ok(())
}

fn read_turbine(path: &Path) -> Result<(), Refusal> {
    turbine_file::read(path)?;
    Ok(())
}

fn read_case(path: &Path) -> Result<(), Refusal> {
    case::read(path, &[])?;
    Ok(())
}

fn read_summary(path: &Path) -> Result<(), Refusal> {
    let run = path.parent().unwrap_or(path);
    let name = run.file_name().unwrap_or_default().to_string_lossy();
    records::read_summary(&records::RunFolder::new(run.parent().unwrap_or(run), &name))?;
    Ok(())
}

#[test]
fn lists_within_lists() {
    let opened = "[".repeat(DEEP);
    let closed = "]".repeat(DEEP);
    for list in [opened.clone(), format!("{opened}{closed}")] {
        refused("deep.yaml", &format!("name: {list}"), import);
        refused("deep.toml", &format!("name = {list}"), read_turbine);
        refused("case.toml", &format!("name = {list}"), read_case);
        refused("summary.json", &list, read_summary);
    }
}

#[test]
fn groups_within_groups() {
    let block: String = (0..1000).map(|level| format!("{}a:\n", " ".repeat(level))).collect();
    refused("deep.yaml", &block, import);
    refused("deep.yaml", &format!("{}1{}", "{a: ".repeat(DEEP), "}".repeat(DEEP)), import);
    refused("deep.yaml", &"- ".repeat(DEEP), import);
    let keys = vec!["a"; DEEP].join(".");
    refused("deep.toml", &format!("{keys} = 1"), read_turbine);
    refused("case.toml", &format!("[{keys}]"), read_case);
}

/// Nine levels of nine aliases each would be 387 million values.
#[test]
fn aliases_of_aliases() {
    let mut text = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n".to_owned();
    for level in 1..10 {
        let before = vec![format!("*a{}", level - 1); 9].join(", ");
        text += &format!("a{level}: &a{level} [{before}]\n");
    }
    refused("laughs.yaml", &text, import);
}

#[test]
fn turbines_times_runs() {
    let wind = "name = \"many\"\n[wind]\nspeed = 9\nturbulence_intensity = 0\n[time]\nspin_up = 0\nduration = 9\n";
    let turbine = |n: usize| {
        format!("[[turbine]]\nname = \"T{n}\"\nmodel = \"m\"\nposition_diameters = [{n}, 0]\n")
    };
    let turbines: String = (0..1001).map(turbine).collect();
    let runs: String = (0..1001).map(|n| format!("[[run]]\nname = \"r{n}\"\n")).collect();
    refused("turbines.toml", &format!("{wind}{turbines}[[run]]\nname = \"r\"\n"), read_case);
    refused("runs.toml", &format!("{wind}{}{runs}", turbine(0)), read_case);
}

#[test]
fn stations_times_angles() {
    let grid = |from: f64, to: f64, n: usize| {
        let point = |i: usize| format!("{}", from + (to - from) * i as f64 / (n - 1) as f64);
        let numbers: Vec<String> = (0..n).map(point).collect();
        format!("grid: [{0}]\n        values: [{0}]", numbers.join(", "))
    };
    let sound = windio::tests::FILE;
    let chord = "grid: [0.0, 0.25, 1.0]\n        values: [2.0, 2.0, 1.0]";
    assert!(sound.contains(chord));
    refused("stations.yaml", &sound.replace(chord, &grid(0.0, 1.0, 600)), import);
    let lift = "c_l: {grid: [-3.1416, 0.0, 0.2, 3.1416], values: [0.0, 0.4, 1.6, 0.0]}";
    assert!(sound.contains(lift));
    let many = grid(-PI, PI, 3000).replace('\n', ",");
    refused("angles.yaml", &sound.replace(lift, &format!("c_l: {{{many}}}")), import);
}

#[test]
fn one_airfoil_again_and_again() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    for (name, text) in openfast::tests::files() {
        let text = if name == "parts/ad.dat" {
            let again = "\"flat.dat\"\n".repeat(5000);
            text.replace("2   NumAFfiles", "5001 NumAFfiles").replace("\"flat.dat\"\n", &again)
        } else {
            text
        };
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("small.fst");
    let error = openfast::import(&path, &ImportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("NumAFfiles: expected a number up to 1000"), "{error}");
}
