//! The page docs/summary.md holds what a summary holds: no field is missing in it, none is too many.

use basis::records::examples;
use serde_json::Value;
use std::collections::BTreeSet;

const PAGE: &str = include_str!("../../../../../docs/summary.md");

/// Paths of all that `value` holds below `path`, such as `turbines[].power.mean`, and of what is null.
fn walk(
    value: &Value,
    path: &str,
    found: &mut BTreeSet<String>,
    kinds: &mut BTreeSet<[String; 2]>,
) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                let dot = if path.is_empty() { "" } else { "." };
                walk(value, &format!("{path}{dot}{name}"), found, kinds);
            }
        }
        Value::Array(items) if !items.is_empty() => {
            for item in items {
                walk(item, &format!("{path}[]"), found, kinds);
            }
        }
        Value::String(word) if path.ends_with("kind") || path.ends_with("sense") => {
            kinds.insert([path.to_owned(), word.clone()]);
            found.insert(path.to_owned());
        }
        // A field of the example that holds nothing would hide what it can hold.
        Value::Null | Value::Array(_) => panic!("{path} of the full example is empty"),
        _ => {
            found.insert(path.to_owned());
        }
    }
}

/// Rows of the page's tables: path, unit, meaning.
fn rows() -> Vec<[&'static str; 3]> {
    let cells = |line: &'static str| {
        let row = line.strip_prefix("| `")?.strip_suffix(" |")?;
        let (path, rest) = row.split_once("` | ")?;
        let (unit, meaning) = rest.split_once(" | ")?;
        Some([path, unit, meaning])
    };
    PAGE.lines().filter_map(cells).collect()
}

/// `path` with every statistic cut to its name: its parts have a table of their own.
fn without_statistics(path: &str) -> String {
    const PARTS: [&str; 4] = [".mean", ".standard_deviation", ".half_width_95", ".n_blocks"];
    let part = PARTS.iter().find_map(|part| path.strip_suffix(part));
    part.unwrap_or(path).to_owned()
}

#[test]
fn the_page_tells_every_field_with_its_unit() {
    let value = serde_json::to_value(examples::full()).unwrap();
    let (mut found, mut kinds) = (BTreeSet::new(), BTreeSet::new());
    walk(&value, "", &mut found, &mut kinds);
    let refusal: Vec<[&str; 3]> = rows();
    let on_page: BTreeSet<String> = refusal.iter().map(|[path, ..]| (*path).to_owned()).collect();
    let statistic = ["mean", "standard_deviation", "half_width_95", "n_blocks"];
    let mut expected: BTreeSet<String> =
        found.iter().map(|path| without_statistics(path)).collect();
    expected.extend(statistic.map(str::to_owned));
    let missing: Vec<&String> = expected.difference(&on_page).collect();
    assert!(missing.is_empty(), "docs/summary.md lacks {missing:?}");
    let unknown: Vec<&String> = on_page.difference(&expected).collect();
    assert!(unknown.is_empty(), "no summary holds {unknown:?} of docs/summary.md");
    assert_eq!(refusal.len(), on_page.len(), "a field stands twice in docs/summary.md");
    for [path, unit, meaning] in &refusal {
        assert!(!unit.is_empty() && !meaning.is_empty(), "{path}");
    }
    for [path, word] in kinds {
        let row = refusal.iter().find(|row| row[0] == path).unwrap();
        assert!(row[2].contains(&format!("`{word}`")), "{path} does not tell `{word}`");
    }
}
