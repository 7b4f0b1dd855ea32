//! The campaigns of examples/campaign, planned as a user plans them, in wind that stands in for what their
//! source leaves.

mod program;

use program::{said, wakemix};
use std::fs;
use std::path::{Path, PathBuf};

/// Steady wind of 8 m/s, sampled where slices of `wake-slices` have their points.
const SOURCE: &str = r#"
name = "steady"
[wind]
speed = 8.0
turbulence_intensity = 0.0
shear_exponent = 0.1
[flow]
solver = "uniform"
[time]
spin_up = 0
duration = 3805.0
[[turbine]]
name = "T1"
model = "iea-22mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/campaign").join(name)
}

/// Steady wind at every path that the campaign of `text` names.
fn stand_in(folder: &Path, text: &str) -> usize {
    fs::write(folder.join("steady.toml"), SOURCE).unwrap();
    let grid = ["--size", "65x20", "--spacing", "17.75", "--time-step", "5", "-o", "steady.bts"];
    let output = wakemix(&[&["inflow", "sample", "steady.toml"][..], &grid].concat(), folder);
    assert!(output.status.success(), "{}", said(&output));
    let mut n_files = 0;
    for path in text.split('"').filter(|word| word.ends_with(".bts")) {
        let path = folder.join(path);
        if path.is_file() {
            continue;
        }
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::hard_link(folder.join("steady.bts"), path).unwrap();
        n_files += 1;
    }
    n_files
}

/// Nine slices over seven shifts and one before the turbine, in five blocks, with five ways to run: and one
/// of them is made.
#[test]
fn slices_become_a_database_of_loads() {
    let folder = tempfile::tempdir().unwrap();
    let path = example("slices.toml");
    let plan = ["campaign", "plan", path.to_str().unwrap(), "-o", "loads"];
    // Without the records it says what is missing.
    let output = wakemix(&plan, folder.path());
    assert!(
        !output.status.success() && said(&output).contains("slices-wake-"),
        "{}",
        said(&output)
    );
    assert_eq!(stand_in(folder.path(), &fs::read_to_string(&path).unwrap()), 10);
    let output = wakemix(&plan, folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("1600 tasks"), "{told}");

    let output = wakemix(&["campaign", "run", "loads", "--limit", "1"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let output = wakemix(&["campaign", "collect", "loads", "-o", "loads.csv"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let table = fs::read_to_string(folder.path().join("loads.csv")).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let (names, row) = (lines.next().unwrap(), lines.next().unwrap());
    let number = |name: &str| {
        let place = names.iter().position(|found| found.starts_with(name));
        row[place.unwrap_or_else(|| panic!("no {name} in {names:?}"))].parse::<f64>().unwrap()
    };
    // The profile is (z/170)^0.1, so that up is faster than down; there is no turbulence but rounding.
    let [up, right, down, left] = ["up", "right", "down", "left"].map(|quarter| {
        assert!(number(&format!("T1.sector_{quarter}.turbulence_intensity")) < 1e-4);
        number(&format!("T1.sector_{quarter}.wind_speed"))
    });
    assert!((right - left).abs() < 1e-3 && (7.9..8.0).contains(&left), "{right} {left}");
    assert!((up / 8.0 - 1.0 - 0.040).abs() < 0.01 && down < left, "{up} {down}");
    assert!(number("T1.RootMyb1.del_m10") > 0.0);
}

#[test]
fn the_database_in_kaimal_turbulence_is_planned() {
    let folder = tempfile::tempdir().unwrap();
    let path = example("loads.toml");
    let output = wakemix(&["campaign", "plan", path.to_str().unwrap(), "-o", "out"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("tasks"), "{told}");
}
