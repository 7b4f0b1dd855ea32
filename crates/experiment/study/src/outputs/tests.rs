//! The list of outputs agrees with the case file.

use super::*;

/// A key that the run itself follows.
const OF_THE_RUN: &str = "checkpoint_interval";

/// Keys under `[output]` of the reference.
fn keys() -> Vec<String> {
    let reference = formats::case::reference();
    let (_, output) = reference.split_once("## `[output]`").expect("the table");
    let table = output.split("\n## ").next().expect("its rows");
    let key = |line: &str| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned());
    table.lines().filter_map(key).collect()
}

#[test]
fn each_key_of_the_case_file_belongs_to_one_output() {
    let keys = keys();
    assert!(keys.len() > 5, "{keys:?}");
    for key in keys.iter().filter(|key| *key != OF_THE_RUN) {
        let owners = STANDARD.iter().filter(|kind| kind.keys.contains(&key.as_str()));
        assert_eq!(owners.count(), 1, "{key}");
    }
    for kind in STANDARD {
        let unknown = kind.keys.iter().find(|name| !keys.iter().any(|key| key == *name));
        assert_eq!(unknown, None, "{}", kind.name);
    }
}
