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
| formats | formats | basis flow |

| only these rooms | are |
| --- | --- |
| open files | formats |
";

/// A tidy house of three rooms with `path` holding `text` on top.
fn house_with(path: &str, text: &str) -> TempDir {
    let house = tempfile::tempdir().expect("a temporary folder");
    let write = |path: &str, text: &str| {
        let path = house.path().join(path);
        fs::create_dir_all(path.parent().expect("files lie in folders")).expect("a folder");
        fs::write(path, text).expect("a file");
    };
    write("ARCHITECTURE.md", MAP);
    write("Cargo.toml", "[workspace]\nmembers = [\"basis\", \"plant/flow\", \"formats\"]\n");
    write("basis/Cargo.toml", "[dependencies]\nglam = \"1\"\n");
    write("plant/flow/Cargo.toml", "[dependencies]\nbasis.workspace = true\n");
    write("formats/Cargo.toml", "[dependencies]\nflow.workspace = true\n");
    write("formats/src/lib.rs", "//! Files.\nuse std::fs;\n");
    write(path, text);
    house
}

fn messages(path: &str, text: &str) -> Vec<String> {
    let house = house_with(path, text);
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
    let map = MAP.replace("basis flow", "basis flow lti");
    assert_found("ARCHITECTURE.md", &map, "formats may import lti, which is no room");
    let map = MAP.replace("| open files | formats |", "| open files | formats lti |");
    assert_found("ARCHITECTURE.md", &map, "`open files` names lti, which is no room");
}

#[test]
fn a_missing_row_is_found() {
    let map = MAP.replace("| formats | formats | basis flow |\n", "").replace("| formats |", "| |");
    assert_found("ARCHITECTURE.md", &map, "no row for formats");
    let messages = messages("ARCHITECTURE.md", "# Architecture\n");
    assert!(messages[0].contains("no table"), "{messages:?}");
}

#[test]
fn sources_that_break_a_rule_are_found() {
    let file = "basis/src/lib.rs";
    assert_found(file, "fn f() {}\n", "does not start with `//!`");
    assert_found(file, &format!("//! x\n{}", "\n".repeat(700)), "701 lines, 700 are the most");
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
