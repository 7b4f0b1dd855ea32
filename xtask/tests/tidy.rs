//! The house is tidy, and the checker notices when it is not.

use std::fs;
use std::path::Path;
use tempfile::TempDir;
use xtask::tidy::findings;

#[test]
fn the_house_is_tidy() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let findings = findings(&root).expect("the repository can be read");
    let lines: Vec<String> = findings.iter().map(ToString::to_string).collect();
    assert!(lines.is_empty(), "\n{}", lines.join("\n"));
}

const MAP: &str = "\
# Architecture

| room | folder | may import |
| --- | --- | --- |
| basis | basis | |
| flow | plant/flow | basis |
| formats | formats | flow |

| only these rooms | are |
| --- | --- |
| open files | formats |
";

/// A tidy house of three rooms with `files`, paths and texts, on top.
fn house_with(files: &[(&str, &str)]) -> TempDir {
    let house = tempfile::tempdir().expect("a temporary folder");
    let write = |path: &str, text: &str| {
        let path = house.path().join(path);
        fs::create_dir_all(path.parent().expect("files lie in folders")).expect("a folder");
        fs::write(path, text).expect("a file");
    };
    write("ARCHITECTURE.md", MAP);
    write("Cargo.toml", "[workspace]\nmembers = [\"basis\", \"plant/flow\", \"formats\"]\n");
    write("basis/Cargo.toml", "");
    write("plant/flow/Cargo.toml", "[dependencies]\nbasis.workspace = true\n");
    write("plant/flow/src/lib.rs", "//! Air.\nuse basis::Vector3;\n");
    write("formats/Cargo.toml", "[dependencies]\nflow.workspace = true\n");
    write("formats/src/lib.rs", "//! Files.\nuse flow::Air;\nuse std::fs;\n");
    for (path, text) in files {
        write(path, text);
    }
    house
}

fn messages(path: &str, text: &str) -> Vec<String> {
    messages_of(&[(path, text)])
}

fn messages_of(files: &[(&str, &str)]) -> Vec<String> {
    let house = house_with(files);
    let findings = findings(house.path()).expect("the house can be read");
    findings.iter().map(ToString::to_string).collect()
}

/// `text` in `path` gives exactly one finding, which says `expected`.
#[track_caller]
fn assert_found(path: &str, text: &str, expected: &str) {
    let messages = messages(path, text);
    assert!(matches!(messages.as_slice(), [one] if one.contains(expected)), "{messages:?}");
}

#[test]
fn a_tidy_house_has_no_findings() {
    let source = "\
//! One purpose.

/// A part.
pub struct Part {
    /// Length (m).
    pub length: f64,
    /// Ratio (–).
    #[serde(default)]
    pub ratio: Option<f64>,
    /// Mean, in the unit of the record.
    pub mean: f64,
}
";
    assert_eq!(messages("basis/src/lib.rs", source), Vec::<String>::new());
}

#[test]
fn a_forbidden_import_is_found() {
    let expected = "basis imports flow, which ARCHITECTURE.md does not allow";
    assert_found("basis/Cargo.toml", "[dependencies]\nflow.workspace = true\n", expected);
    assert_found("basis/Cargo.toml", "[dev-dependencies]\nflow.workspace = true\n", expected);
    let on_unix = "[target.'cfg(unix)'.dependencies]\nflow.workspace = true\n";
    assert_found("basis/Cargo.toml", on_unix, expected);
    let by_path = "[dependencies]\nelsewhere = { path = \"../../elsewhere\" }\n";
    assert_found("basis/Cargo.toml", by_path, "basis imports elsewhere");
}

#[test]
fn a_stale_row_is_found() {
    let map = MAP.replace("| basis | basis | |", "| basis | basis | |\n| lti | shared/lti | |");
    assert_found("ARCHITECTURE.md", &map, "ARCHITECTURE.md:6: stale row: lti names shared/lti");
    let map = MAP.replace("| formats | flow |", "| formats | flow lti |");
    assert_found("ARCHITECTURE.md", &map, "formats may import lti, which is no room");
    let map = MAP.replace("| open files | formats |", "| open files | formats lti |");
    assert_found("ARCHITECTURE.md", &map, "`open files` names lti, which is no room");
}

#[test]
fn a_missing_row_is_found() {
    let map = MAP.replace("| formats | formats | flow |\n", "").replace("| formats |", "| |");
    assert_found("ARCHITECTURE.md", &map, "no row for formats");
    let messages = messages("ARCHITECTURE.md", "# Architecture\n");
    assert!(messages[0].contains("no table"), "{messages:?}");
}

#[test]
fn sources_that_break_a_rule_are_found() {
    let file = "basis/src/lib.rs";
    assert_found(file, "fn f() {}\n", "does not start with `//!`");
    assert_found(file, &format!("//! x\n{}", "\n".repeat(400)), "401 lines, 400 are the most");
    let macros = [concat!("to", "do!()"), concat!("unimpl", "emented!()"), concat!("db", "g!(1)")];
    for code in macros {
        assert_found(file, &format!("//! x\nfn f() {{ {code} }}\n"), "basis/src/lib.rs:2:");
    }
    let ignored = concat!("//! x\n#[test]\n#[ig", "nore = \"slow\"]\nfn f() {}\n");
    assert_found(file, ignored, "a test that never runs");
    assert_found(
        file,
        "//! x\nstruct S {\n    /// Length.\n    pub length: f64,\n}\n",
        "`pub length` has no unit",
    );
    assert_found(file, "//! x\nuse std::fs;\n", "basis is not among those that open files");
    assert_found(file, "//! x\nfn f() { Instant::now(); }\n", "read a clock");
}

#[test]
fn lines_that_are_too_long_are_found() {
    let file = "basis/src/lib.rs";
    let (most, long) = ("x".repeat(105), "x".repeat(106));
    assert_eq!(messages(file, &format!("//! x\n// é{}\n", &most[..103])), Vec::<String>::new());
    let expected = "basis/src/lib.rs:2: 111 columns besides text, 110 are the most";
    assert_found(file, &format!("//! x\nfn {}() {{}}\n", &long[..103]), expected);
    assert_found(file, &format!("//! x\n    /{long}\n").replace("/x", "//"), expected);
    // What stands in a literal is text of the program, on as many lines as it has.
    let allowed = [
        format!("const A: &str = \"{long}\\\"{long}\";"),
        format!("const A: &str = \"\\\n{long}{long}\n\";"),
        format!("const A: &str = r#\"{long}\"{long}\"#;"),
        format!("const A: (char, &str) = ('\"', \"{long}\");"),
    ];
    for code in allowed {
        assert_eq!(messages(file, &format!("//! x\n{code}\n")), Vec::<String>::new(), "{code}");
    }
    assert_found(file, &format!("//! x\nconst A: &str = r#\"\"\"#; // {most}\n"), "columns");
    // Pages have lines as long as their paragraphs.
    assert_eq!(messages("docs/page.md", &long.repeat(3)), Vec::<String>::new());
}

#[test]
fn links_that_lead_nowhere_are_found() {
    let text =
        "[here](page.md) [up](../ARCHITECTURE.md#map) [web](https://example.org/x) [lost](no.md)\n";
    assert_found("docs/page.md", text, "docs/page.md:1: the link to no.md leads nowhere");
}

#[test]
fn words_of_one_machine_are_found_in_any_file() {
    for word in [concat!("/wo", "rk/x"), concat!("/ho", "me/x"), concat!("../sha", "red/x")] {
        assert_found("docs/page.md", &format!("see {word}\n"), "docs/page.md:1:");
    }
    assert_found(".ci/config.toml", concat!("url = \"index.crat", "es.io\"\n"), "registry host");
    assert!(messages("target/page.md", concat!("/wo", "rk/x\n")).is_empty());
}

#[test]
fn an_allowance_that_nothing_uses_is_found() {
    let map = MAP.replace("| basis | basis | |", "| basis | basis | flow |");
    assert_found("ARCHITECTURE.md", &map, "ARCHITECTURE.md:5: basis may import flow and does not");
}

#[test]
fn a_dependency_that_nothing_uses_is_found() {
    let manifest = "[dependencies]\nflow.workspace = true\nserde-json = \"1\"\n";
    let unused = "`serde-json` in [dependencies] is used by no source";
    assert_found("formats/Cargo.toml", manifest, unused);
    let source = |code: &str| format!("//! Files.\nuse flow::Air;\nuse std::fs;\n{code}");
    let with = |code: &str| {
        messages_of(&[("formats/Cargo.toml", manifest), ("formats/src/lib.rs", &source(code))])
    };
    for used in [
        "use serde_json as json;\n",
        "pub use {serde_json::Value};\n",
        "type V = serde_json::Value;\n",
    ] {
        assert_eq!(with(used), Vec::<String>::new());
    }
    for mentioned in [
        "// serde_json::Value\n",
        "const S: &str = \"serde_json::Value\";\n",
        "use a::serde_json::V;\n",
    ] {
        assert_eq!(with(mentioned).len(), 1, "{mentioned}");
    }
}

#[test]
fn dependencies_of_the_product_and_of_tests_are_distinguished() {
    let for_tests = "//! Air.\n#[cfg(test)]\nmod tests {\n    use basis::Vector3;\n}\n";
    assert_found("plant/flow/src/lib.rs", for_tests, "`basis` in [dependencies] is used by no");
    let manifest = "[dependencies]\nflow.workspace = true\n[dev-dependencies]\nproptest = \"1\"\n";
    assert_found("formats/Cargo.toml", manifest, "`proptest` in [dev-dependencies] is used by no");
    let with =
        |path: &str, text: &str| messages_of(&[("formats/Cargo.toml", manifest), (path, text)]);
    let inside =
        "//! Files.\nuse flow::Air;\n#[cfg(test)]\nmod tests {\n    use proptest::prelude::*;\n}\n";
    let example = "//! Files.\n//! ```\n//! use proptest::Strategy;\n//! ```\nuse flow::Air;\n";
    for (path, text) in [
        ("formats/src/lib.rs", inside),
        ("formats/src/lib.rs", example),
        ("formats/tests/all.rs", "//! Tests.\nproptest::proptest! {}\n"),
    ] {
        assert_eq!(with(path, text), Vec::<String>::new(), "{path}");
    }
}

const ROOT: &str = "//! Frames.\nmod a;\nmod b;\npub use a::A;\npub use b::B;\n";
const CIRCLE: &str = "a circle of basis/src/a.rs, basis/src/b.rs";

fn messages_of_modules(a: &str, b: &str, exceptions: &str) -> Vec<String> {
    messages_of(&[
        ("basis/src/lib.rs", ROOT),
        ("basis/src/a.rs", a),
        ("basis/src/b.rs", b),
        ("xtask/exceptions.toml", exceptions),
    ])
}

#[test]
fn a_circle_of_files_is_found() {
    for (a, b) in [
        ("//! A.\nuse crate::b::B;\n", "//! B.\nuse super::a::A;\n"),
        // Through the names that the crate passes on.
        ("//! A.\nuse crate::B;\n", "//! B.\nuse crate::{A, Other};\n"),
        ("//! A.\nfn f() { super::b::g() }\n", "//! B.\nuse crate::a::*;\n"),
    ] {
        let messages = messages_of_modules(a, b, "");
        assert!(matches!(messages.as_slice(), [one] if one.contains(CIRCLE)), "{messages:?}");
    }
    let for_tests = "//! B.\n#[cfg(test)]\nmod tests {\n    use crate::a::A;\n}\n";
    let none = Vec::<String>::new();
    assert_eq!(messages_of_modules("//! A.\nuse crate::b::B;\n", for_tests, ""), none);
    let to_above = [
        ("basis/src/lib.rs", "//! Frames.\nmod a;\npub use a::A;\npub struct Own;\n"),
        ("basis/src/a.rs", "//! A.\nuse crate::Own;\n"),
    ];
    assert_eq!(messages_of(&to_above), none);
}

#[test]
fn circles_may_stay_for_a_reason_and_no_longer_than_they_last() {
    let (a, b) = ("//! A.\nuse crate::b::B;\n", "//! B.\nuse crate::a::A;\n");
    let files = "[[circle]]\nfiles = [\"basis/src/a.rs\", \"basis/src/b.rs\"]\n";
    let reasoned = format!("{files}why = \"they share a number\"\n");
    assert_eq!(messages_of_modules(a, b, &reasoned), Vec::<String>::new());
    assert!(messages_of_modules(a, b, files)[0].contains("no `why`"));
    let stale = messages_of_modules(a, "//! B.\n", &reasoned);
    assert!(stale.len() == 2 && stale[0].contains("basis/src/a.rs is in no circle"), "{stale:?}");
}

#[test]
fn a_long_function_is_found() {
    let long = |n: usize, line: &str| format!("//! x\nfn f() {{\n{}}}\n", line.repeat(n));
    let file = "basis/src/lib.rs";
    assert_found(
        file,
        &long(59, "    let x = 1;\n"),
        "lib.rs:2: `f` has 61 lines, 60 are the most",
    );
    assert!(messages(file, &long(58, "    let x = 1;\n")).is_empty());
    // A table of data, and a test.
    assert!(messages(file, &long(80, "    [1.0, 2.0],\n")).is_empty());
    let test = long(80, "    let x = 1;\n");
    assert!(messages("basis/src/tests.rs", &test).is_empty());
    let exception =
        "[[long_function]]\nfile = \"basis/src/lib.rs\"\nname = \"f\"\nwhy = \"one formula\"\n";
    let with = |text: &str| messages_of(&[(file, text), ("xtask/exceptions.toml", exception)]);
    assert!(with(&long(80, "    let x = 1;\n")).is_empty());
    let stale = with(&long(9, "    let x = 1;\n"));
    assert!(stale.len() == 1 && stale[0].contains("not too long"), "{stale:?}");
}
