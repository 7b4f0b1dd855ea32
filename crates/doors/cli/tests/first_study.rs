//! The page of the first study tells what the program says of its case, the speed of the machine aside.

mod program;

use program::{said, wakemix};
use std::fs;
use std::path::Path;

/// What stands on `page` in the first block that begins with `opening`.
fn block<'p>(page: &'p str, opening: &str) -> &'p str {
    let start = page.find(opening).expect("a block") + opening.len();
    page[start..].split("```").next().expect("its end")
}

/// Takes away the line that tells how fast the machine is.
fn without_speed(lines: &str) -> Vec<&str> {
    lines.lines().filter(|line| !line.starts_with("cost: ") && !line.is_empty()).collect()
}

/// WAKEMIX_UPDATE=1 writes the page anew instead.
#[test]
fn the_cost_of_the_first_study_is_what_its_page_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/first-study.md");
    let page = fs::read_to_string(&path).expect("the page");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("first-study.toml"), block(&page, "```toml\n")).expect("a case");
    // Two runs at a time, as on any machine of two cores or more.
    let output = wakemix(&["run", "first-study.toml", "--dry-run", "--jobs", "2"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let told = String::from_utf8_lossy(&output.stderr);
    let printed = block(&page, "```text\n");
    let (on_page, now) = (without_speed(printed), without_speed(&told));
    if std::env::var_os("WAKEMIX_UPDATE").is_some() {
        fs::write(&path, page.replacen(&on_page.join("\n"), &now.join("\n"), 1)).expect("the page");
    } else {
        let fix =
            "docs/first-study.md is not current: run WAKEMIX_UPDATE=1 cargo test -p wakemix-cli";
        assert_eq!(on_page, now, "{fix}");
    }
}
