//! Several processes and one folder of results: who writes a run keeps others out of it, until it ends in
//! whatever way.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Two runs that would take days.
const CASE: &str = r#"
name = "long"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 5.0
duration = 1e6
[output]
interval = 100.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[[run]]
name = "other"
"#;
/// The same in half a minute of simulated time.
const SHORT: [&str; 4] = ["--set", "time.duration=30", "--set", "output.interval=1"];

fn command(words: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wakemix"));
    command.args(["run", "case.toml", "-o", "out"]).args(words).current_dir(folder);
    command
}

fn wakemix(words: &[&str], folder: &Path) -> Output {
    command(words, folder).output().expect("the program")
}

/// A process that makes the run `baseline`; it has begun.
fn begun(folder: &Path) -> Child {
    let mut command = command(&["--run", "baseline"], folder);
    let mut child =
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program");
    while !folder.join("out/baseline/series.csv.part").exists() {
        assert!(child.try_wait().expect("a process").is_none(), "it has ended already");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).replace('\n', " ")
}

#[test]
fn a_run_under_way_keeps_others_out_and_a_killed_one_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    fs::write(folder.join("case.toml"), CASE).expect("a case file");
    let mut first = begun(folder);
    let manifest = || fs::read_to_string(folder.join("out/baseline/manifest.json"));
    let before = manifest().expect("a manifest");

    for words in [
        &["--run", "baseline", "--overwrite", "--set", "wind.speed=8"][..],
        &["--overwrite", "--set", "wind.speed=8"],
        &["--run", "baseline", "--resume"],
    ] {
        let output = wakemix(&[words, &SHORT[..]].concat(), folder);
        let told = told(&output);
        if words.contains(&"--resume") {
            // Another length is another case; that it is under way is told of the same one.
            assert!(told.contains("another version of the case"), "{told}");
        } else {
            assert!(told.contains("is being written by"), "{words:?}: {told}");
            assert!(told.contains(&format!("process {}", first.id())), "{words:?}: {told}");
            assert!(told.contains("--run NAME"), "{words:?}: {told}");
        }
        assert_eq!(output.status.code(), Some(2), "{words:?}: {told}");
    }
    assert_eq!(manifest().expect("a manifest"), before, "a process that was kept out has written");
    // Another run of the study can be made meanwhile.
    let beside = wakemix(&[&["--run", "other"], &SHORT[..]].concat(), folder);
    assert!(beside.status.success(), "{}", told(&beside));
    assert!(first.try_wait().expect("a process").is_none(), "the first has ended");

    first.kill().expect("a process");
    first.wait().expect("a process");
    // As a process leaves it that is killed while it writes.
    let left = ["out/baseline/.T1.outb.4711.rows", "out/baseline/.checkpoint.4711.part"];
    for name in left {
        fs::write(folder.join(name), "half").expect("a file");
    }
    let again = wakemix(&[&["--overwrite"], &SHORT[..]].concat(), folder);
    assert!(again.status.success(), "{}", told(&again));
    for name in left {
        assert!(!folder.join(name).exists(), "{name} is still there");
    }
    if cfg!(unix) {
        let names = fs::read_dir(folder.join("out")).expect("a folder");
        let names = names.map(|entry| entry.expect("an entry").file_name().into_string());
        let locks = names.filter(|name| name.as_ref().is_ok_and(|name| name.starts_with('.')));
        assert_eq!(locks.count(), 0, "locks are left");
    }
}

#[test]
fn many_processes_at_once_leave_a_whole_study_and_a_report_of_all_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let names: Vec<String> = (1..=5).map(|number| format!("run-{number}")).collect();
    let runs = names.iter().map(|name| format!("[[run]]\nname = \"{name}\"\n"));
    let (head, _) = CASE.split_once("[[run]]").expect("runs");
    let case = head.replace("1e6", "60.0").replace("100.0", "1.0") + &runs.collect::<String>();
    fs::write(folder.join("case.toml"), case).expect("a case file");
    let started = names.iter().map(|name| {
        let mut command = command(&["--run", name], folder);
        command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("the program")
    });
    let started: Vec<Child> = started.collect();
    for child in started {
        let output = child.wait_with_output().expect("a process");
        assert!(output.status.success(), "{}", told(&output));
    }
    let report = fs::read_to_string(folder.join("out/report.html")).expect("a report");
    for name in &names {
        assert!(report.contains(name.as_str()), "{name} is missing in the report");
        for file in ["manifest.json", "summary.json", "series.csv"] {
            assert!(folder.join("out").join(name).join(file).is_file(), "{name}/{file}");
        }
    }
    let figures = fs::read_dir(folder.join("out/figures")).expect("a folder");
    let hidden = figures.filter(|entry| {
        let name = entry.as_ref().expect("an entry").file_name();
        name.to_string_lossy().starts_with('.')
    });
    assert_eq!(hidden.count(), 0, "something half-written is left");
}

#[test]
fn a_study_under_way_has_a_page_that_tells_which_runs_are_to_come() {
    const N_RUNS: usize = 900;
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let runs = (1..=N_RUNS).map(|number| format!("[[run]]\nname = \"run-{number}\"\n"));
    let (head, _) = CASE.split_once("[[run]]").expect("runs");
    let case = head.replace("1e6", "2000.0") + &runs.collect::<String>();
    fs::write(folder.join("case.toml"), case).expect("a case file");
    let mut command = command(&["--jobs", "1"], folder);
    let mut child = command.stderr(Stdio::piped()).spawn().expect("the program");
    let page = folder.join("out/report.html");
    while !page.exists() {
        assert!(child.try_wait().expect("a process").is_none(), "it has ended already");
        std::thread::sleep(Duration::from_millis(20));
    }
    // It goes on with the next run before it is stopped.
    while !folder.join("out/run-2/manifest.json").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().expect("a process");
    let told = told(&child.wait_with_output().expect("a process"));
    assert_eq!(told.matches("report so far: out/report.html").count(), 1, "{told}");
    let page = fs::read_to_string(page).expect("a page");
    let notice =
        format!("Of {N_RUNS} runs 1 is complete, and on this page; not yet complete: run-2, ");
    assert!(page.contains(&notice), "no notice");
}
