//! What the keys of a kind hold: read from a table of the file one by one, and written as they stand there.

use super::document::Value as Written;
use super::section::Section;
use super::text::quoted;
use basis::keys::{Holds, Key, Table, Value, Values};

/// What `keys` hold in `section`, defaults included, in the order of the keys.
pub(super) fn values_of(section: &Section, keys: &[Key]) -> Values {
    let mut values = Values::none();
    for key in keys {
        let read = value_of(section, key).map(|value| (key.name, value));
        values.extend(read.or_else(|| key.default()));
    }
    values
}

/// What `key` holds in `section`; none when it is left out.
///
/// # Panics
/// For what no kind can have a key for: events, what belongs to `[[turbine]]` and `[[run]]`.
fn value_of(section: &Section, key: &Key) -> Option<Value> {
    let name = key.name;
    match key.holds {
        Holds::Number(_) => section.optional_number(name).map(Value::Number),
        Holds::Whole { .. } => section.optional_whole(name).map(Value::Whole),
        Holds::Text | Holds::Name | Holds::Folder | Holds::Model => {
            section.optional_text(name).map(Value::Text)
        }
        Holds::Choice(_) if !section.has(name) => {
            // Where it must not be left out, that is noted.
            section.entry(name);
            None
        }
        Holds::Choice(_) => Some(Value::Text(section.choice(name).to_owned())),
        Holds::Pair(_) => section.entry(name).map(|_| Value::Numbers(section.pair(name).to_vec())),
        Holds::Numbers(_) => section.entry(name).map(|_| Value::Numbers(section.numbers(name))),
        Holds::Turbines => section.entry(name).map(|_| Value::Names(section.turbines(name))),
        Holds::Ground(table) => ground_of(section, name, table),
        Holds::Table(table) => section.entry(name).map(|_| inner(section, name, table)),
        Holds::Tables(table) => section.entry(name).map(|_| tables(section, name, table)),
        Holds::Files(table) => files_of(section, name, table),
        holds => panic!("no kind can have a key like `{name}`, which holds {holds:?}"),
    }
}

/// What the tables `name` in `section` hold.
fn tables(section: &Section, name: &str, table: &'static Table) -> Value {
    let sections = section.sections(name, table);
    Value::Tables(sections.iter().map(|one| values_of(one, table.keys)).collect())
}

fn files_of(section: &Section, name: &str, table: &'static Table) -> Option<Value> {
    let node = &section.entry(name)?.node;
    match &node.value {
        Written::Text(text) => Some(Value::Text(text.clone())),
        Written::List(_) => Some(tables(section, name, table)),
        _ => {
            section.wrong_type(name, node, &format!("a file in quotes, or {}", table.heading));
            None
        }
    }
}

/// What the table `name` in `section` holds.
fn inner(section: &Section, name: &str, table: &'static Table) -> Value {
    Value::Table(values_of(&section.section(name, table), table.keys))
}

fn ground_of(section: &Section, name: &str, table: &'static Table) -> Option<Value> {
    let node = &section.entry(name)?.node;
    match &node.value {
        Written::Text(text) if text == "slip" => Some(Value::Text(text.clone())),
        Written::Table(_) => Some(inner(section, name, table)),
        _ => {
            section.wrong_type(name, node, "\"slip\" or { roughness_length = 0.001 }");
            None
        }
    }
}

/// `value` as it stands in the file.
pub(super) fn text_of(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Whole(number) => number.to_string(),
        Value::Text(word) => quoted(word),
        Value::Numbers(numbers) => format!("{numbers:?}"),
        Value::Names(names) => {
            format!("[{}]", names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", "))
        }
        Value::Tables(tables) => {
            let tables: Vec<String> = tables.iter().map(table_text).collect();
            format!("[{}]", tables.join(", "))
        }
        Value::Table(values) => table_text(values),
    }
}

/// A table as it stands in a file, in a line.
fn table_text(values: &Values) -> String {
    let keys: Vec<String> = assignments(values).collect();
    if keys.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", keys.join(", ")) }
}

/// `key = value` for each of `values`.
pub(super) fn assignments(values: &Values) -> impl Iterator<Item = String> {
    values.iter().map(|(key, value)| format!("{key} = {}", text_of(value)))
}
