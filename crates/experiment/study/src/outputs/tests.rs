//! The list of outputs agrees with the case file.

use super::*;

/// Keys that the run itself follows, or that stand for outputs asked for by name.
const OF_THE_RUN: [&str; 2] = ["checkpoint_interval", "further"];

/// Keys of `[output]` that `kind` follows.
fn followed(kind: &OutputKind) -> &'static [&'static str] {
    match kind.keys {
        Keys::OfOutput(keys) => keys,
        Keys::Own(_) => &[],
    }
}

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
    for key in keys.iter().filter(|key| !OF_THE_RUN.contains(&key.as_str())) {
        let owners = STANDARD.iter().filter(|kind| followed(kind).contains(&key.as_str()));
        assert_eq!(owners.count(), 1, "{key}");
    }
    for kind in STANDARD {
        let unknown = followed(kind).iter().find(|name| !keys.iter().any(|key| key == *name));
        assert_eq!(unknown, None, "{}", kind.name);
    }
}
