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
