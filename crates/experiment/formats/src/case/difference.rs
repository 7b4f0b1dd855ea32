//! What two versions of a case say differently of one run.

use super::document::{self, Entry, Node, Value};
use super::{decisive, write};
use std::collections::BTreeMap;
use std::fmt;

/// A key of which two versions of a case say something else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The key, dotted.
    pub key: String,
    /// What it held, as it stands in a case file; none where it was not there.
    pub before: Option<String>,
    /// What it holds now.
    pub now: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = |value: &Option<String>| value.clone().unwrap_or_else(|| "left out".to_owned());
        write!(formatter, "{}: {} before, {} now", self.key, word(&self.before), word(&self.now))
    }
}

/// What the cases in the texts `before` and `now` say differently of the run `run`, of what decides its
/// result; nothing where one of them is no case.
pub fn differences(before: &str, now: &str, run: &str) -> Vec<Difference> {
    let [Some(before), Some(now)] = [before, now].map(|text| values(text, run)) else {
        return Vec::new();
    };
    let keys = before.keys().chain(now.keys().filter(|key| !before.contains_key(*key)));
    let differ = keys.filter(|key| before.get(*key) != now.get(*key));
    let difference = |key: &String| Difference {
        key: key.clone(),
        before: before.get(key).cloned(),
        now: now.get(key).cloned(),
    };
    differ.map(difference).collect()
}

/// What every key of the case in `text` holds that decides the result of its run `run`.
fn values(text: &str, run: &str) -> Option<BTreeMap<String, String>> {
    let text = write(&decisive(text, run)?);
    let (_, entries) = document::parse("", &text, &[]);
    let mut values = BTreeMap::new();
    gather(&entries.ok()?, "", &mut values);
    Some(values)
}

fn gather(entries: &[Entry], above: &str, values: &mut BTreeMap<String, String>) {
    for Entry { key, node, .. } in entries {
        let path = if above.is_empty() { key.clone() } else { format!("{above}.{key}") };
        gather_node(node, &path, values);
    }
}

fn gather_node(node: &Node, path: &str, values: &mut BTreeMap<String, String>) {
    match &node.value {
        Value::Table(entries) => gather(entries, path, values),
        Value::List(items) if items.iter().any(|item| matches!(item.value, Value::Table(_))) => {
            for (place, item) in items.iter().enumerate() {
                let which = name_of(item).unwrap_or_else(|| place.to_string());
                gather_node(item, &format!("{path}.{which}"), values);
            }
        }
        _ => {
            values.insert(path.to_owned(), words(node));
        }
    }
}

fn name_of(node: &Node) -> Option<String> {
    let Value::Table(entries) = &node.value else { return None };
    match &document::find(entries, "name")?.node.value {
        Value::Text(name) => Some(name.clone()),
        _ => None,
    }
}

/// A value as it stands in a file.
fn words(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => super::text::quoted(text),
        Value::Whole(number) => number.map_or(String::new(), |number| number.to_string()),
        Value::Number(number) => number.to_string(),
        Value::List(items) => {
            format!("[{}]", items.iter().map(words).collect::<Vec<_>>().join(", "))
        }
        Value::Flag | Value::Moment | Value::Table(_) => node.kind().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"
name = "a"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
[time]
spin_up = 5.0
duration = 20.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

    #[test]
    fn every_key_that_decides_is_named_with_both_values() {
        let now = CASE
            .replace("duration = 20.0", "duration = 30.0")
            .replace("amplitude_deg = 4.0", "amplitude_deg = 3.5")
            .replace("name = \"a\"\n", "name = \"a\"\ndescription = \"other words\"\n")
            .replace("[0.0, 0.0]", "[0.0, 1.0]");
        let found: Vec<String> =
            differences(CASE, &now, "helix").iter().map(Difference::to_string).collect();
        assert_eq!(
            found,
            [
                "run.helix.control.T1.amplitude_deg: 4 before, 3.5 now",
                "time.duration: 20 before, 30 now",
                "turbine.T1.position_diameters: [0, 0] before, [0, 1] now",
            ]
        );
        assert_eq!(differences(CASE, &now, "baseline").len(), 2);
        let wider = CASE.replace("speed = 9.0", "speed = 9.0\nveer_deg_per_m = 0.01");
        let found = differences(CASE, &wider, "helix");
        assert!(found[0].to_string().starts_with("wind.veer_deg_per_m: "), "{found:?}");
        assert!(differences(CASE, CASE, "helix").is_empty());
    }
}
