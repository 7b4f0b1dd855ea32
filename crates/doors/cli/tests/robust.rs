//! What a program meets in the wild: pipes that close, disks that are full, files that are none, names that
//! are taken, and numbers that nobody meant.

mod program;
mod small;

use program::{said, wakemix};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// On return the command was refused as bad input, with `words` in what it said.
fn refused(arguments: &[&str], folder: &Path, words: &str) {
    let output = wakemix(arguments, folder);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
    assert!(said(&output).contains(words), "{arguments:?}: {}", said(&output));
}

/// Its turbines and runs behind the first turbine.
const REST: &str = r#"[[run]]
name = "baseline"
"#;

fn small_case() -> String {
    small::case("small", REST)
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_the_program_in_silence() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), small_case()).unwrap();
    for arguments in [
        &["schema"][..],
        &["turbine", "list"],
        &["turbine", "show", "nrel-5mw", "--file"],
        &["turbine", "steady", "nrel-5mw"],
        &["validate"],
        &["run", "case.toml", "--json"],
    ] {
        // Nobody reads, from the first byte on.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(env!("CARGO_BIN_EXE_wakemix"))
            .args(arguments)
            .current_dir(folder.path())
            .stdout(writer)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(141), "{arguments:?}: {}", said(&output));
        assert!(!said(&output).contains("panicked"), "{arguments:?}: {}", said(&output));
    }
    assert!(folder.path().join("runs/small/report.html").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let full = || fs::File::options().write(true).open("/dev/full").unwrap();
    for arguments in [&["turbine", "list"][..], &["schema"], &["validate"]] {
        let output = Command::new(env!("CARGO_BIN_EXE_wakemix"))
            .args(arguments)
            .current_dir(folder.path())
            .stdout(full())
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains("cannot write to standard output"), "{}", said(&output));
    }
    // Nor is it a reason to panic that what goes wrong cannot be told.
    let status = Command::new(env!("CARGO_BIN_EXE_wakemix"))
        .args(["turbine", "show", "nobody"])
        .stderr(full())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(2));
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).display().to_string();
    assert!(Command::new("mkfifo").arg(place("pipe.toml")).status().unwrap().success());
    fs::create_dir(place("folder.toml")).unwrap();
    let pipe = place("pipe.toml");
    for file in [pipe.as_str(), "/dev/zero"] {
        let is_none = "it is no file, but a device, a pipe or a socket";
        let case = small_case().replace("\"nrel-5mw\"", &format!("{file:?}"));
        fs::write(place("case.toml"), case).unwrap();
        refused(&["run", "case.toml", "--dry-run"], folder.path(), is_none);
        refused(&["run", file, "--dry-run"], folder.path(), is_none);
        refused(&["turbine", "show", file], folder.path(), is_none);
        refused(&["fatigue", file, "--channel", "a", "--slope", "4"], folder.path(), is_none);
        let discon = small_case().replace("model", &format!("discon = {file:?}\nmodel"));
        fs::write(place("case.toml"), discon).unwrap();
        refused(&["run", "case.toml", "--dry-run"], folder.path(), "a device, a pipe or a socket");
    }
    refused(&["inflow", "info", &pipe], folder.path(), "it is no file");
    refused(&["turbine", "show", &place("folder.toml")], folder.path(), "cannot read");
    // No file has so many bytes that a text of it makes sense; this one takes no room.
    fs::File::create(place("long.toml")).unwrap().set_len(300 << 20).unwrap();
    refused(&["run", "long.toml", "--dry-run"], folder.path(), "it has more than 256 MiB");
    refused(&["turbine", "show", "long.toml"], folder.path(), "it has more than 256 MiB");
}

#[test]
fn files_that_are_there_are_not_lost() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let mine = |name: &str| fs::write(place(name), "mine").unwrap();
    let is_mine = |name: &str| fs::read(place(name)).unwrap() == b"mine";
    fs::write(place("case.toml"), small_case()).unwrap();
    fs::write(
        place("small.yaml"),
        include_str!("../../../experiment/formats/src/windio/small.yaml"),
    )
    .unwrap();
    let size = ["--size", "16x8x4", "--spacing", "10", "--hub-height", "90"];
    let generate = [&["inflow", "generate", "--speed", "10", "--ti", "0.06"][..], &size].concat();
    let sample = ["inflow", "sample", "case.toml", "--size", "3x3"];
    let made = |begin: &[&str], name: &str| {
        let output = wakemix(&[begin, &["-o", name]].concat(), folder.path());
        assert!(output.status.success(), "{}", said(&output));
    };
    made(&generate, "box.bts");
    for (begin, name, beside) in [
        (&generate[..], "a.toml", "a_v.bin"),
        (&generate[..], "b.bts", "b.bts"),
        (&generate[..], "c.wnd", "c.sum"),
        (&sample[..], "d.bts", "d.bts"),
    ] {
        mine(beside);
        refused(&[begin, &["-o", name]].concat(), folder.path(), "is there already");
        assert!(is_mine(beside), "{beside}");
        made(&[begin, &["--overwrite"]].concat(), name);
        assert!(!is_mine(beside), "{beside}");
    }
    mine("e.wnd");
    refused(&["inflow", "convert", "box.bts", "e.wnd"], folder.path(), "--overwrite");
    assert!(is_mine("e.wnd"));
    let output = wakemix(&["inflow", "convert", "box.bts", "e.wnd", "--overwrite"], folder.path());
    assert!(output.status.success() && !is_mine("e.wnd"), "{}", said(&output));
    mine("t.toml");
    refused(&["turbine", "import", "small.yaml", "-o", "t.toml"], folder.path(), "--overwrite");
    assert!(is_mine("t.toml"));
    // Before any work is done.
    refused(
        &[&generate[..], &["-o", "none/a.bts"]].concat(),
        folder.path(),
        "there is no folder none",
    );
}

#[test]
fn numbers_that_nobody_meant_are_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), "time,a\n0,1\n1,2\n2,1\n").unwrap();
    let fatigue = ["fatigue", "a.csv", "--channel", "a", "--slope", "4"];
    for more in [["--bins", "4000000000"], ["--from", "nan"], ["--to", "nan"], ["--from", "inf"]] {
        refused(&[&fatigue[..], &more].concat(), folder.path(), "is no number");
    }
    let generate = ["inflow", "generate", "--ti", "0.06", "-o", "a.bts", "--spacing", "10"];
    let with = |more: &[&'static str]| [&generate[..], more].concat();
    refused(&with(&["--speed", "nan", "--size", "16x8x4"]), folder.path(), "is no number");
    refused(
        &with(&["--speed", "10", "--size", "16x8x4", "--shear-exponent", "inf"]),
        folder.path(),
        "is no number",
    );
    let large = with(&["--speed", "10", "--size", "1000000x10000x1000"]);
    refused(&large, folder.path(), "of memory");
    for wind in ["0.001", "39", "9:39:3"] {
        refused(&["turbine", "offset", "nrel-5mw", "--wind", wind], folder.path(), "stands still");
    }
    let slow = ["turbine", "offset", "nrel-5mw", "--strouhal", "1e-6"];
    refused(&slow, folder.path(), "turns once in");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn names_cannot_steer_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let evil = small_case().replace("name = \"T1\"", "name = \"\\u001b[2J\\u0007\"");
    fs::write(folder.path().join("case.toml"), evil).unwrap();
    let text = "time,\u{1b}]0;a\u{7}\n0,1\n1,2\n2,1\n";
    fs::write(folder.path().join("a.csv"), text).unwrap();
    for arguments in [
        &["run", "case.toml", "--dry-run"][..],
        &["fatigue", "a.csv", "--channel", "b", "--slope", "4"],
        &["fatigue", "a.csv", "--channel", "\u{1b}]0;a\u{7}", "--slope", "4"],
        &["turbine", "show", "\u{1b}[2J"],
    ] {
        let output = wakemix(arguments, folder.path());
        for bytes in [&output.stdout, &output.stderr] {
            assert!(!bytes.contains(&0x1b) && !bytes.contains(&7), "{arguments:?}: {output:?}");
        }
    }
}

/// The study is whole after all that was refused.
#[test]
fn a_run_says_what_it_will_not_do() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), small_case()).unwrap();
    refused(&["run", "case.toml", "--resume"], folder.path(), "holds no run to resume");
    refused(
        &["run", "case.toml", "--set", "run.0.name=figures"],
        folder.path(),
        "its own `figures`",
    );
    refused(&["run", "case.toml", "--set", "wind.speed=39"], folder.path(), "[operation]");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let output = wakemix(&["run", "case.toml"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    refused(&["run", "case.toml"], folder.path(), "already holds results");
}
