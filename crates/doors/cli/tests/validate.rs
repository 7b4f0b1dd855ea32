//! `wakemix validate` as a gate: its exit code, and its rows as data.

use std::process::{Command, Output};

fn validate(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wakemix")).arg("validate").args(arguments).output().unwrap()
}

#[test]
fn rows_come_as_data_and_are_as_recorded() {
    let done = validate(&["meandering-bench", "--json"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let data: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(data["as_recorded"], true);
    for day in ["recorded", "made"] {
        let day = &data["validations"][0][day];
        assert!(day["date"].as_str().unwrap().starts_with("20"), "{day}");
        assert!(day["conditions"].as_str().unwrap().contains("version"), "{day}");
    }
    let rows = data["validations"][0]["rows"].as_array().unwrap();
    let short = rows.iter().filter(|row| row["verdict"] == "short").count();
    assert!(rows.len() > 10 && short > 0, "{} rows, {short} short", rows.len());
    for row in rows {
        assert_eq!([&row["finding"], &row["figure"]], ["as-recorded", "finite"], "{row}");
        assert!(row["measured"].is_number() && row["expected"].is_number(), "{row}");
        assert!(
            !row["tolerance"].is_null() && !row["source"].as_str().unwrap().is_empty(),
            "{row}"
        );
    }
}

#[test]
fn a_call_that_cannot_be_meant_is_refused() {
    for arguments in [
        &["no-such-thing"][..],
        &["--json"],
        &["structure", "--quick"],
        &["structure", "--accept-worse"],
    ] {
        let done = validate(arguments);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}");
        assert!(done.stdout.is_empty() && !done.stderr.is_empty());
    }
    // Outside the repository there is no record to renew.
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_wakemix"));
    let done = command.args(["validate", "--pages"]).current_dir(folder.path()).output().unwrap();
    assert_eq!(done.status.code(), Some(2));
}
