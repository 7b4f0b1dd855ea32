//! A controller library that takes the program along: it is told whose it was, and no result looks complete.
#![cfg(unix)]

#[path = "../../../experiment/study/tests/foreign/mod.rs"]
mod foreign;
mod program;
mod small;

use foreign::{compiled, input};
use program::{said, wakemix};
use std::fs;

/// Its turbines and runs behind the first turbine.
const REST: &str = r#"[[run]]
name = "own"
control.T1 = { kind = "discon", library = "libdiscon.so", input = "DISCON.IN", anemometer = "none" }
"#;

fn small_case() -> String {
    small::case("crash", REST)
}

#[test]
fn a_library_that_crashes_or_ends_the_program_is_named() {
    let folder = tempfile::tempdir().unwrap();
    compiled(folder.path());
    fs::write(folder.path().join("case.toml"), small_case()).unwrap();
    for trick in ["crash", "exit"] {
        input(folder.path(), trick, 5.0);
        let output = wakemix(&["run", "case.toml", "-o", trick], folder.path());
        let words = said(&output);
        assert!(!output.status.success(), "{trick}: {words}");
        assert!(
            words.contains("libdiscon.so of T1 ended the program within its procedure DISCON"),
            "{trick}: {words}"
        );
        assert!(!folder.path().join(trick).join("own/summary.json").exists(), "{trick}");
    }
    // The program itself is well.
    input(folder.path(), "fail", 5.0);
    let output = wakemix(&["run", "case.toml", "-o", "fail"], folder.path());
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("it failed with aviFAIL = -1: the gearbox is too hot"));
}
