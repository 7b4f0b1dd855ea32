//! `wakemix turbine import` from outside: what the input holds is written, what it lacks is listed and no
//! success.

use std::fs;
use std::process::Command;

const WINDIO: &str = include_str!("../../../experiment/formats/src/windio/small.yaml");

#[test]
fn a_file_without_all_figures_is_written_and_reported_as_incomplete() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.yaml"), WINDIO).unwrap();
    let wakemix = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_wakemix"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let output = wakemix(&["turbine", "import", "small.yaml", "-o", "small.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("wrote small.toml"), "{message}");
    let missing: Vec<&str> = message.lines().filter_map(|line| line.strip_prefix("  ")).collect();
    let written = fs::read_to_string(folder.path().join("small.toml")).unwrap();
    assert!(written.contains("hub_height = 72.0"), "{written}");
    for key in ["blade_structure", "drive_train.generator_inertia", "controller.pitch_gains"] {
        assert!(missing.contains(&key), "{key} in {message}");
        let place = key.rsplit('.').next().unwrap_or(key);
        let marked = written.lines().any(|line| line.starts_with('#') && line.contains(place));
        assert!(marked, "{key} in {written}");
    }
    // What is not whole is not taken for a turbine either.
    let output = wakemix(&["turbine", "show", "small.toml"]);
    assert_eq!(output.status.code(), Some(2));
}

/// Lacks the generator's inertia alone.
const WHOLE: &str = include_str!("../../../experiment/formats/src/windio/whole.yaml");
/// Speed of the case (m/s).
const WIND: f64 = 11.0;
const CASE: &str = r#"
name = "imported"
[wind]
speed = 11.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
[time]
spin_up = 60.0
duration = 120.0
[[turbine]]
name = "T1"
model = "whole.toml"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;

#[test]
fn a_template_that_is_filled_in_makes_a_turbine_that_runs() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("whole.yaml"), WHOLE).unwrap();
    fs::write(at("case.toml"), CASE).unwrap();
    let wakemix = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_wakemix"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let output = wakemix(&["turbine", "import", "whole.yaml", "-o", "whole.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("polars: \"Clean\" at Re 3.000e6"), "{message}");
    let template = fs::read_to_string(at("whole.missing.toml")).unwrap();
    let filled = template
        .replace("# [drive_train]", "[drive_train]")
        .replace("# generator_inertia = ?", "generator_inertia = 50000.0");
    assert_ne!(filled, template);
    fs::write(at("whole.missing.toml"), filled).unwrap();
    let import = ["turbine", "import", "whole.yaml", "-o", "whole.toml", "--overwrite"];
    let output = wakemix(&[&import[..], &["--complete", "whole.missing.toml"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = wakemix(&["run", "case.toml"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // It runs, and delivers what its own rotor has in steady wind at the speed and pitch that it came to;
    // tilt and bending take less than a tenth.
    let summary = fs::read_to_string(at("runs/imported/baseline/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let turbine = &summary["turbines"][0];
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{turbine}"));
    let mean = |key: &str| number(&turbine[key]["mean"]);
    let radius = 0.5 * number(&turbine["rotor"]["diameter"]);
    let ratio = format!("{}", mean("rotor_speed") * radius / WIND);
    let pitch = format!("{}", mean("pitch").to_degrees());
    let output = wakemix(&["turbine", "steady", "whole.toml", "--tsr", &ratio, "--pitch", &pitch]);
    let steady = String::from_utf8_lossy(&output.stdout).into_owned();
    let cell = steady.lines().nth(1).and_then(|row| row.split(',').nth(2));
    let coefficient: f64 = cell.unwrap_or_else(|| panic!("{steady}")).parse().unwrap();
    let written = fs::read_to_string(at("whole.toml")).unwrap();
    let line = written.lines().find_map(|line| line.strip_prefix("generator_efficiency = "));
    let efficiency: f64 = line.unwrap_or_else(|| panic!("{written}")).parse().unwrap();
    let area = std::f64::consts::PI * radius * radius;
    let expected = 0.5 * 1.225 * area * WIND.powi(3) * coefficient * efficiency;
    let power = mean("power");
    assert!((power / expected - 1.0).abs() < 0.1, "{power} W, {expected} W in steady wind");
}
