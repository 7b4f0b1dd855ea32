//! `wakemix fatigue` from outside: tables in, loads with their convention out, bad input told.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn wakemix(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wakemix"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// A wave of amplitude 3 and one of 0.5, both of 1 Hz, sampled at 20 Hz over `seconds` from their peaks.
fn waves(seconds: usize) -> String {
    let rows = (0..=20 * seconds).map(|index| {
        let angle = std::f64::consts::TAU * index as f64 / 20.0;
        format!("{:?},{:?},{:?}\n", index as f64 / 20.0, 3.0 * angle.cos(), 0.5 * angle.cos())
    });
    std::iter::once("time_s,RootMyc1 [kN-m],TwrBsMyt_kN-m\n".to_owned()).chain(rows).collect()
}

#[test]
fn loads_are_printed_with_their_convention() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("waves.csv"), waves(60)).unwrap();
    let arguments = [
        "fatigue",
        "waves.csv",
        "--channel",
        "RootMyc1,TwrBsMyt",
        "--slope",
        "10,4",
        "--from",
        "10",
    ];
    let output = wakemix(&arguments, folder.path());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "waves.csv: 10 to 60 s, 50 s, 1001 samples");
    let cells = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(cells(lines[2]), ["RootMyc1", "(kN-m)", "10", "6.00000", "50.0", "6.00000"]);
    assert_eq!(cells(lines[5]), ["TwrBsMyt_kN-m", "4", "1.00000", "50.0", "1.00000"]);
    assert!(lines[6].contains("peak to peak") && lines[6].contains("1 Hz"), "{text}");
}

#[test]
fn json_is_for_programs() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("waves.csv"), waves(30)).unwrap();
    let arguments = [
        "fatigue",
        "waves.csv",
        "--channel",
        "RootMyc1",
        "--slope",
        "4",
        "--bins",
        "200",
        "--json",
    ];
    let output = wakemix(&arguments, folder.path());
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let channel = &value["channels"][0];
    assert_eq!(value["duration_s"], 30.0);
    assert_eq!(channel["n_cycles"], 30.0);
    // All ranges are the largest, whose bin has its middle half a bin below.
    let load = channel["loads"][0]["damage_equivalent_load"].as_f64().unwrap();
    assert!((load - 6.0 * (1.0 - 0.5 / 200.0)).abs() < 1e-9, "{load}");
    assert!(value["convention"].as_str().unwrap().contains("200 equal bins"));
}

#[test]
fn bad_input_ends_with_code_2_and_a_fix() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("waves.csv"), waves(2)).unwrap();
    fs::write(folder.path().join("nan.csv"), "time,a\n0,1\n1,NaN\n2,0\n").unwrap();
    fs::write(folder.path().join("cut.outb"), [4, 0, 10, 0, 1, 0]).unwrap();
    let cases = [
        (["waves.csv", "--channel", "RootMyc2", "--slope", "4"], "did you mean"),
        (["nan.csv", "--channel", "a", "--slope", "4"], "line 3 (1 s): a is NaN"),
        (["cut.outb", "--channel", "a", "--slope", "4"], "it ends after 6 bytes"),
        (["gone.csv", "--channel", "a", "--slope", "4"], "check that gone.csv exists"),
        (["waves.csv", "--channel", "RootMyc1", "--slope", "0"], "at least 1"),
    ];
    for (arguments, expected) in cases {
        let output = wakemix(&[&["fatigue"], arguments.as_slice()].concat(), folder.path());
        // Drawn messages wrap; what matters is the words.
        let told = String::from_utf8(output.stderr).unwrap();
        let told: Vec<&str> = told.split_whitespace().filter(|word| *word != "│").collect();
        let told = told.join(" ");
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(expected), "{told}\n{expected}");
        assert!(output.stdout.is_empty());
    }
    let arguments =
        ["fatigue", "waves.csv", "--channel", "RootMyc1", "--slope", "4", "--from", "9"];
    let told = String::from_utf8(wakemix(&arguments, folder.path()).stderr).unwrap();
    assert!(told.contains("leaves 0 samples to count: it ends at 2 s"), "{told}");
}

#[test]
fn the_count_ends_where_it_is_asked_to() {
    let folder = tempfile::tempdir().unwrap();
    // What stands behind the asked time need not be sound.
    fs::write(folder.path().join("waves.csv"), waves(60) + "60.1,1,NaN\n").unwrap();
    let run = |times: &[&str]| {
        let channel = ["fatigue", "waves.csv", "--channel", "TwrBsMyt", "--slope", "4"];
        wakemix(&[&channel[..], times].concat(), folder.path())
    };
    let output = run(&["--from", "10", "--to", "40"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}");
    assert!(text.starts_with("waves.csv: 10 to 40 s, 30 s, 601 samples\n"), "{text}");
    let cells: Vec<&str> = text.lines().nth(2).unwrap().split_whitespace().collect();
    assert_eq!(cells, ["TwrBsMyt_kN-m", "4", "1.00000", "30.0", "1.00000"]);
    let output = run(&["--to", "20", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["from_s"], 0.0);
    assert_eq!(value["to_s"], 20.0);
    for times in [&["--to", "-1"][..], &["--from", "30", "--to", "20"]] {
        let output = run(times);
        // Drawn messages wrap; what matters is the words.
        let told = String::from_utf8(output.stderr).unwrap();
        let told: Vec<&str> = told.split_whitespace().filter(|word| *word != "│").collect();
        let told = told.join(" ");
        assert_eq!(output.status.code(), Some(2), "{told}");
        let expected = "leaves 0 samples to count before --to: it begins at 0 s";
        assert!(told.contains(expected) && told.contains("after --from"), "{told}");
    }
    assert_eq!(run(&[]).status.code(), Some(2));
}
