//! What every command shares: how much it says and in what colours, what the shell and the manual know of
//! it, and that nothing beside the program is needed.

mod program;
mod small;

use program::{said, wakemix};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Its turbines and runs behind the first turbine.
const REST: &str = r#"[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "pulse"
control.T1 = { kind = "pulse", amplitude_deg = 2.0, strouhal = 0.5 }
"#;

fn small_case() -> String {
    small::case("small", REST)
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), small_case()).unwrap();
    folder
}

fn success(arguments: &[&str], folder: &Path) -> Output {
    let output = wakemix(arguments, folder);
    assert!(output.status.success(), "{arguments:?}: {}", said(&output));
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn as_much_is_said_as_is_asked_for() {
    let folder = folder();
    let run = |more: &[&str]| {
        let words = ["run", "case.toml", "--overwrite"];
        success(&[&words[..], more].concat(), folder.path())
    };
    let usual = text(&run(&[]).stderr);
    assert!(usual.contains("done: baseline") && usual.contains("warning: "), "{usual}");
    assert!(!usual.lines().any(|line| line.starts_with("time: ")), "{usual}");
    let quiet = run(&["-q"]);
    // What a reader of the numbers must know, and nothing else.
    let warnings = text(&quiet.stderr);
    assert!(warnings.contains("warning: "), "{warnings}");
    assert!(warnings.lines().all(|line| line.starts_with("warning: ")), "{warnings}");
    assert_eq!(quiet.stdout, run(&["-qq"]).stdout);
    assert!(run(&["--quiet", "--quiet"]).stderr.is_empty());
    let more = text(&run(&["--verbose", "--jobs", "1"]).stderr);
    for words in [
        "read: case case.toml",
        "read: nrel-5mw",
        "which comes with the program",
        "built: 2 turbines, 2 runs; flow solver uniform",
        "built: run pulse: T1 pulse, T2 baseline",
        " s reading and laying out",
        " s pulse (2/2)",
        " s report",
        " s in all",
    ] {
        assert!(more.contains(words), "{words}: {more}");
    }
    // Errors are never kept back.
    let refused = wakemix(&["-qq", "turbine", "show", "nobody"], folder.path());
    assert!(said(&refused).contains("no turbine is called"), "{}", said(&refused));
    assert!(text(&success(&["turbine", "list", "-v"], folder.path()).stderr).contains("time: "));
}

#[test]
fn colours_come_as_they_are_asked_for() {
    let folder = folder();
    let wrong = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_wakemix"));
        command.args(arguments).current_dir(folder.path()).env_remove("NO_COLOR");
        text(&command.output().unwrap().stderr)
    };
    for command in [&["run", "none.toml"][..], &["turbine", "list", "--oops"]] {
        // Nobody looks at a pipe.
        assert!(!wrong(command).contains('\u{1b}'), "{command:?}");
        assert!(!wrong(&[command, &["--color", "never"]].concat()).contains('\u{1b}'));
        assert!(wrong(&[command, &["--color=always"]].concat()).contains("\u{1b}["), "{command:?}");
    }
}

#[test]
fn tables_say_nothing_of_a_sum_without_wakes_and_fit() {
    let folder = folder();
    let output = success(&["run", "case.toml"], folder.path());
    let table = text(&output.stdout);
    assert!(table.contains("T2") && !table.contains(" all "), "{table}");
    for line in table.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    let page = fs::read_to_string(folder.path().join("runs/small/report.html")).unwrap();
    // What it says, scripts aside.
    let parts =
        page.split("<script").map(|part| part.split_once("</script>").unwrap_or(("", part)).1);
    let page: String = parts.collect();
    assert!(page.contains("T2 made") || page.contains("pulse"), "{page}");
    for word in ["together", "for the array", ">All<"] {
        assert!(!page.contains(word), "{word}");
    }
    for list in
        [&["validate"][..], &["cases"], &["turbine", "list"], &["turbine", "show", "iea-15mw"]]
    {
        let text = text(&success(list, folder.path()).stdout);
        let widest = text.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 100, "{list:?}: {widest}");
    }
}

#[test]
fn shells_and_manual_know_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let commands =
        ["run", "init", "cases", "report", "turbine", "inflow", "fatigue", "analyse", "man"];
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = text(&success(&["completions", shell], folder.path()).stdout);
        for word in commands.iter().chain(&["dry-run", "quiet", "strouhal-low"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    let page = text(&success(&["man"], folder.path()).stdout);
    assert!(page.contains(".TH wakemix 1"), "{page}");
    for command in commands {
        assert!(page.contains(&format!("wakemix\\-{command}(1)")), "{command}: {page}");
    }
    let page = text(&success(&["man", "turbine", "show"], folder.path()).stdout);
    assert!(page.contains(".TH wakemix-turbine-show 1") && page.contains("\\-\\-file"), "{page}");
    let refused = wakemix(&["man", "turbine", "paint"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    success(&["man", "-o", "man1"], folder.path());
    for page in ["wakemix.1", "wakemix-run.1", "wakemix-analyse-gains.1"] {
        assert!(folder.path().join("man1").join(page).is_file(), "{page}");
    }
}

/// Cases and turbines come with the program: an empty folder is enough.
#[test]
fn a_shipped_case_runs_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let short = ["--set", "time.spin_up=10", "--set", "time.duration=40", "--run", "baseline"];
    let output = success(&[&["run", "one-turbine"][..], &short].concat(), folder.path());
    assert!(text(&output.stdout).contains("baseline"), "{}", said(&output));
    assert!(folder.path().join("runs/one-turbine/report.html").is_file());
    success(&["cases", "one-turbine"], folder.path());
    let refused = wakemix(&["cases", "one-turbine"], folder.path());
    assert!(said(&refused).contains("is there already"), "{}", said(&refused));
    let dry = ["run", "one-turbine.toml", "--dry-run"];
    assert!(said(&success(&dry, folder.path())).contains("prescribed wind: "));
    let refused = wakemix(&["run", "cases/one-turbine.toml"], folder.path());
    assert!(said(&refused).contains("give its name, one-turbine"), "{}", said(&refused));
    let refused = wakemix(&["cases", "no-such-case"], folder.path());
    assert!(said(&refused).contains("quickstart"), "{}", said(&refused));
}

#[test]
fn a_dry_run_reads_every_file_and_checks_rotors_only_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    success(&["init", "row.toml", "--turbine", "nrel-5mw"], folder.path());
    let small = ["--set", "flow.cells_per_diameter=8"];
    let dry = |more: &[&str]| {
        wakemix(&[&["run", "row.toml", "--dry-run"][..], &small, more].concat(), folder.path())
    };
    let quick = said(&dry(&[]));
    assert!(quick.contains("grid: ") && quick.contains("cost: about "), "{quick}");
    assert!(!quick.contains("check: "), "{quick}");
    let checked = said(&dry(&["--check"]));
    assert!(checked.contains("check: nrel-5mw") && checked.contains("cost: about "), "{checked}");
    assert!(!folder.path().join("runs").exists());
    assert!(said(&wakemix(&["run", "row.toml", "--check"], folder.path())).contains("--dry-run"));
    // What is named has to be there, and to be what it is named for.
    fs::write(folder.path().join("wind.bts"), "no wind").unwrap();
    for (setting, words) in [
        ("turbine.T1.model=gone.toml", "gone.toml"),
        ("turbine.T1.discon=DISCON.IN", "cannot read DISCON.IN"),
    ] {
        let refused = dry(&["--set", setting]);
        assert_eq!(refused.status.code(), Some(2), "{setting}: {}", said(&refused));
        assert!(said(&refused).contains(words), "{setting}: {}", said(&refused));
    }
    for planes in ["gone.bts", "wind.bts"] {
        let case = small_case().replace("\"uniform\"", "\"planes\"");
        let case = case.replace("speed = 9.0", &format!("speed = 9.0\nplanes = {planes:?}"));
        fs::write(folder.path().join("planes.toml"), case).unwrap();
        let refused = wakemix(&["run", "planes.toml", "--dry-run"], folder.path());
        assert_eq!(refused.status.code(), Some(2), "{planes}: {}", said(&refused));
        assert!(said(&refused).contains("the wind cannot be read"), "{}", said(&refused));
    }
}
