//! `wakemix inflow` from outside: the wind of a case sampled, other kinds of wind refused, profiles beside
//! boxes, an atmosphere recorded.

mod program;

use program::{said, wakemix};
use std::fs;

const CASE: &str = r#"
name = "gusty"
[wind]
speed = 10.0
turbulence_intensity = 0.0
shear_exponent = 0.0
event = { kind = "step", start = 5.0, speed = 14.0 }
[flow]
solver = "uniform"
[time]
spin_up = 0
duration = 9.5
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;

#[test]
fn the_wind_of_a_case_becomes_a_full_field() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("gusty.toml"), CASE).unwrap();
    let grid = ["--size", "3x5", "--spacing", "20x25", "--time-step", "0.5"];
    let made = ["inflow", "sample", "gusty.toml", "-o", "gusty.bts"];
    let output = wakemix(&[&made[..], &grid[..]].concat(), folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let output = wakemix(&["inflow", "info", "gusty.bts", "--json"], folder.path());
    let info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(info["n_points"], serde_json::json!([20, 3, 5]));
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    // Ten planes at 10 m/s and ten at 14 m/s, carried along at 10 m/s and centred on the hub at 90 m.
    assert!((number(&info["hub_speed"]) - 10.0).abs() < 1e-4);
    assert!((number(&info["lowest_height"]) - 40.0).abs() < 1e-4);
    assert!((number(&info["mean_speeds"][0]) - 12.0).abs() < 1e-3);
    assert!((number(&info["turbulence_intensity"]) - 0.2).abs() < 1e-3);
    let output = wakemix(&["inflow", "convert", "gusty.bts", "field.toml"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let output = wakemix(&["inflow", "info", "field_v.bin", "--json"], folder.path());
    let converted: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // Binaries keep the fluctuations that the field has, and the means to the last digit.
    assert_eq!(converted, info);
}

#[test]
fn turbulence_is_not_sampled() {
    let folder = tempfile::tempdir().unwrap();
    let event = "event = { kind = \"step\", start = 5.0, speed = 14.0 }\n";
    fs::write(folder.path().join("gusty.toml"), CASE.replace(event, "")).unwrap();
    let arguments =
        ["inflow", "sample", "gusty.toml", "--set", "flow.solver=turbulence", "-o", "gusty.bts"];
    let output = wakemix(&arguments, folder.path());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && message.contains("flow.solver=uniform"), "{message}");
    assert!(!folder.path().join("gusty.bts").exists());
}

#[test]
fn a_box_has_the_given_profile_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let generate = |profile: &[&str]| {
        let size = ["--size", "16x8x4", "--spacing", "10", "--hub-height", "90"];
        let box_of =
            ["inflow", "generate", "--speed", "10", "--ti", "0.06", "-o", "logarithmic.toml"];
        wakemix(&[&box_of[..], &size[..], profile].concat(), folder.path())
    };
    let output = generate(&["--roughness-length", "0.03"]);
    assert!(output.status.success(), "{}", said(&output));
    let output = wakemix(&["inflow", "info", "logarithmic.toml", "--json"], folder.path());
    let info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for (row, speed) in info["mean_speeds"].as_array().unwrap().iter().enumerate() {
        let height = 5.0 + 10.0 * row as f64;
        let expected = 10.0 * (height / 0.03_f64).ln() / (90.0 / 0.03_f64).ln();
        assert!((speed.as_f64().unwrap() - expected).abs() < 1e-9, "{height} m: {speed}");
    }
    for (refused, message) in [
        (&["--roughness-length", "9.5"][..], "roughness length (m) = 9.5"),
        (&["--roughness-length", "0.03", "--shear-exponent", "0.1"][..], "cannot be used with"),
    ] {
        let output = generate(refused);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(message), "{error}");
    }
}

const PRECURSOR: &str = r#"
name = "small"
[box]
length = 400
width = 400
height = 200
cell = 12.5
[atmosphere]
latitude_deg = 52.6
roughness_length = 0.01
geostrophic_wind = 8.0
inversion_height = 100
inversion_strength = 2
inversion_depth = 25
[time]
spin_up = 20
record = 10
statistics_interval = 2
[planes]
hub_height = 70
"#;

#[test]
fn a_precursor_is_told_recorded_and_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.toml"), PRECURSOR).unwrap();
    let made = wakemix(&["inflow", "precursor", "small.toml"], folder.path());
    assert!(made.status.success(), "{}", said(&made));
    let told = said(&made);
    assert!(told.contains("32 × 32 × 16 = 0.02 million cells of 12.5 m"), "{told}");
    assert!(told.contains("planes stand across the wind at hub height"), "{told}");
    let table = String::from_utf8_lossy(&made.stdout).into_owned();
    assert!(table.contains("hub 70 m: ") && table.contains("TI of u"), "{table}");
    let file = "runs/small/planes.bts";
    let info = wakemix(&["inflow", "info", file, "--json"], folder.path());
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!(info["n_points"], serde_json::json!([13, 32, 8]));
    let again =
        wakemix(&["inflow", "precursor", "small.toml", "--resume", "--json"], folder.path());
    let result: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let speeds = [&result["planes"]["hub_speed"], &info["hub_speed"]].map(number);
    assert!((speeds[0] - speeds[1]).abs() < 1e-3, "{speeds:?}");
}

#[test]
fn a_precursor_tells_its_cost_and_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = ["inflow", "precursor", "precursor-offshore", "--dry-run"];
    let output = wakemix(&shipped, folder.path());
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("224 × 224 × 64 = 3.21 million cells"), "{}", said(&output));
    let output =
        wakemix(&["inflow", "precursor", "precursor-seed-000", "--dry-run"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("268 × 160 × 80 = 3.43 million cells"), "{}", said(&output));
    let output = wakemix(&[&shipped[..], &["--set", "box.height=700"]].concat(), folder.path());
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("`atmosphere.inversion_height` = 700 m"), "{}", said(&output));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_block_of_a_record_is_cut_for_other_programs() {
    let folder = tempfile::tempdir().unwrap();
    let made = ["inflow", "generate", "--model", "kaimal", "--speed", "8", "--ti", "0.06"];
    let grid = ["--size", "60x21x9", "--spacing", "20", "--time-step", "1", "-o", "wide.bts"];
    assert!(wakemix(&[&made[..], &grid[..]].concat(), folder.path()).status.success());
    let cut = |more: &[&str], output: &str| {
        let part = ["inflow", "cut", "wide.bts", "--duration", "20", "--width", "160"];
        wakemix(&[&part[..], more, &["-o", output]].concat(), folder.path())
    };
    for file in ["block.bts", "block.wnd"] {
        let output = cut(&["--block", "2", "--shift", "-120"], file);
        let told = said(&output);
        assert!(
            output.status.success() && told.contains("part: 21 planes of 9 × 9 points"),
            "{told}"
        );
        let output = wakemix(&["inflow", "info", file, "--json"], folder.path());
        let info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(info["n_points"], serde_json::json!([21, 9, 9]), "{file}");
    }
    let refused = [
        (&["--block", "3"][..], "third.bts", "--block: wide.bts: block 3 goes from 40.0 to 60.0 s"),
        (&["--shift", "130"], "aside.bts", "take a shift from -120.0 to 120.0 m"),
        (&["--spacing", "10"], "fine.bts", "finer than those of the record, 20.000 m"),
        (&[], "block.bts", "--overwrite"),
        (&[], "box.toml", "name it NAME.bts or NAME.wnd"),
    ];
    for (more, file, text) in refused {
        let output = cut(more, file);
        let told = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!output.status.success() && told.contains(text), "{more:?}: {told}");
    }
}
