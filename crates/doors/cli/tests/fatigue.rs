//! `wakemix fatigue` from outside: tables in, loads with their convention out, bad input reported.

mod program;

use program::{said, wakemix};
use std::fs;

/// A wave of amplitude 3 and one of 0.5, both of 1 Hz, sampled at 20 Hz over `seconds` from their peaks.
fn waves(seconds: usize) -> String {
    let rows = (0..=20 * seconds).map(|index| {
        let angle = std::f64::consts::TAU * index as f64 / 20.0;
        format!("{:?},{:?},{:?}\n", index as f64 / 20.0, 3.0 * angle.cos(), 0.5 * angle.cos())
    });
    std::iter::once("Time_s,RootMyc1 [kN-m],TwrBsMyt_kN-m\n".to_owned()).chain(rows).collect()
}

/// Lines that were one before they met the terminal's width.
fn joined(lines: &[&str]) -> String {
    lines.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
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
    let convention = joined(&lines[6..]);
    assert!(convention.contains("peak to peak") && convention.contains("1 Hz"), "{text}");
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
        let message = said(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}\n{expected}");
        assert!(output.stdout.is_empty());
    }
    let arguments =
        ["fatigue", "waves.csv", "--channel", "RootMyc1", "--slope", "4", "--from", "9"];
    let message = String::from_utf8(wakemix(&arguments, folder.path()).stderr).unwrap();
    assert!(message.contains("leaves 0 samples to count: it ends at 2 s"), "{message}");
}

#[test]
fn the_count_ends_at_the_given_time() {
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
        let message = said(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        let expected = "leaves 0 samples to count before --to: it begins at 0 s";
        assert!(message.contains(expected) && message.contains("after --from"), "{message}");
    }
    assert_eq!(run(&[]).status.code(), Some(2));
}

/// A blade that swings by 10 degrees at the reference's 600 degrees in 10 minutes, and steady moments;
/// `pitch` names its column, of which one degree is `degree`, and `prefix` stands before the moments.
fn pitching(prefix: &str, pitch: &str, degree: f64) -> String {
    let rows = (0..=120_i32).map(|index| {
        let swing = f64::from((index % 40 - 20).abs()) / 2.0;
        format!("{:?},{:?},3000.0,4000.0\n", f64::from(index) / 2.0, degree * swing)
    });
    let names = format!("Time_s,{pitch},{prefix}RootMyb1_kN-m,{prefix}RootMxb1_kN-m\n");
    std::iter::once(names).chain(rows).collect()
}

#[test]
fn a_bearing_carries_steady_moments_where_they_press() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("swing.csv"), pitching("", "BldPitch1_deg", 1.0)).unwrap();
    let output = wakemix(&["fatigue", "swing.csv", "--bearing"], folder.path());
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "swing.csv: 0 to 60 s, 60 s, 121 samples");
    assert_eq!(
        lines[1],
        "pitch BldPitch1_deg, M_flap RootMyb1_kN-m, M_edge RootMxb1_kN-m, slope 3"
    );
    assert_eq!(lines[2], "pitch travel 60.0000 deg, 600.000 deg in 10 minutes");
    let cells = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(cells(lines[4]), ["0", "3000.00"]);
    assert_eq!(cells(lines[13]), ["90", "4000.00"]);
    assert_eq!(cells(lines[22]), ["180", "0.00000"]);
    let convention = joined(&lines[40..]);
    assert!(convention.starts_with("pitch-bearing load (van der Hoek et al., Eq. 9)"), "{text}");
    assert!(convention.ends_with("samples every 0.5 s"), "{text}");
}

#[test]
fn the_bearing_of_a_turbine_in_the_records_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let series = pitching("T2.", "T2.BldPitch1_deg", 1.0);
    fs::write(folder.path().join("series.csv"), series).unwrap();
    let requested = ["fatigue", ".", "--bearing", "--turbine", "T2", "--slope", "4", "--json"];
    let output = wakemix(&[&requested[..], &["--from", "20"]].concat(), folder.path());
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["pitch"], "T2.BldPitch1_deg");
    assert_eq!(value["unit"], "kN-m");
    assert_eq!(value["slope"], 4.0);
    assert_eq!(value["duration_s"], 40.0);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((number(&value["travel_deg"]) - 40.0).abs() < 1e-9, "{value}");
    let positions = value["positions"].as_array().unwrap();
    assert_eq!(positions.len(), 36);
    for position in positions {
        let (sine, cosine) = number(&position["position_deg"]).to_radians().sin_cos();
        let expected = (3000.0 * cosine + 4000.0 * sine).max(0.0);
        assert!((number(&position["load"]) - expected).abs() < 1e-6, "{position}");
    }
}

#[test]
fn a_bearing_that_cannot_be_counted_is_refused_with_a_fix() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("waves.csv"), waves(2)).unwrap();
    fs::write(folder.path().join("swing.csv"), pitching("", "BldPitch1_deg", 1.0)).unwrap();
    fs::write(folder.path().join("bare.csv"), pitching("", "BldPitch1", 1.0)).unwrap();
    let mixed = pitching("", "BldPitch1_deg", 1.0).replacen("RootMxb1_kN-m", "RootMxb1_N-m", 1);
    fs::write(folder.path().join("mixed.csv"), mixed).unwrap();
    let cases: [(&[&str], &str); 7] = [
        (&["waves.csv"], "\"BldPitch1\" is none of its channels"),
        (&["swing.csv", "--turbine", "T1"], "--turbine T1"),
        (&["swing.csv", "--blade", "2"], "has no pitch of blade 2"),
        (&["bare.csv"], "with the unit behind its name, such as BldPitch1_deg"),
        (&["mixed.csv"], "RootMyb1_kN-m is in \"kN-m\", RootMxb1_N-m in \"N-m\""),
        (&["swing.csv", "--slope", "3,4"], "--bearing with 2 slopes"),
        (&["swing.csv", "--channel", "RootMyb1"], "cannot be used with"),
    ];
    for (arguments, expected) in cases {
        let output = wakemix(&[&["fatigue", "--bearing"][..], arguments].concat(), folder.path());
        let message = said(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}\n{expected}");
    }
}
