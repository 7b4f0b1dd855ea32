//! Tasks that a campaign leaves out.

use super::{Exclusion, Factor, object};
use crate::case::document::{Entry, Value};
use crate::case::findings::Findings;
use crate::case::sweep;
use basis::records::SweptValue;

/// The exclusions at `entry` of a file of `text`, of tasks that `factors` make; notes keys and values that
/// none of them has.
pub(super) fn read(
    entry: Option<&Entry>,
    text: &str,
    factors: &[Factor],
    findings: &Findings,
) -> Vec<Exclusion> {
    const FIX: &str = "write [[exclude]] and below it \"wind.speed\" = [8, 10], for each key one or more of its levels";
    let Some(entry) = entry else { return Vec::new() };
    let Value::List(items) = &entry.node.value else {
        let message = format!("`exclude` must be tables, found {}", entry.node.kind());
        object(findings, entry.node.span.clone(), message, "no tables", FIX);
        return Vec::new();
    };
    let mut found = Vec::new();
    for item in items {
        let Value::Table(entries) = &item.value else {
            let message = "`exclude` must be tables".to_owned();
            object(findings, item.span.clone(), message, "no table", FIX);
            continue;
        };
        let mut conditions = Vec::new();
        for entry in entries {
            let values: Vec<SweptValue> = match &entry.node.value {
                Value::List(items) => items.iter().filter_map(sweep::value_of).collect(),
                _ => sweep::value_of(&entry.node).into_iter().collect(),
            };
            let known = known(&entry.key, factors);
            let stray = values.iter().find(|value| !known.contains(&value.words()));
            if known.is_empty() || values.is_empty() || stray.is_some() {
                let message = match (known.is_empty(), stray) {
                    (true, _) => format!("`{}` is not varied", entry.key),
                    (_, Some(stray)) => format!("`{}` has no level {}", entry.key, stray.words()),
                    _ => format!(
                        "`{}` names no level: {}",
                        entry.key,
                        &text[entry.node.span.clone()]
                    ),
                };
                object(findings, entry.node.span.clone(), message, "excludes nothing", FIX);
            }
            conditions.push((entry.key.clone(), values));
        }
        found.push(Exclusion { conditions });
    }
    found
}

/// All values of `key`, a key or a linked factor, in words.
fn known(key: &str, factors: &[Factor]) -> Vec<String> {
    let mut found = Vec::new();
    for factor in factors {
        for level in &factor.levels {
            if factor.is_linked && factor.name == key {
                found.push(level.name.words());
            }
            let own = level.settings.iter().filter(|setting| setting.key == key);
            found.extend(own.map(|setting| setting.value.words()));
        }
    }
    found
}
