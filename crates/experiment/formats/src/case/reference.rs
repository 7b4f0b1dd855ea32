//! The table of keys as a page for people and as a schema for editors.

use super::keys::{
    ATMOSPHERE, BOX, CUT, EVENTS, GRID, INSTRUMENT_KINDS, INSTRUMENTS, OUTPUT, PLANES, PRECURSOR,
    PRECURSOR_TIME, ROOT, RUN, TIME, TURBINE, WIND, flow,
};
use basis::keys::{Holds, Key, LeftOut, Table};
use control::CONTROLLERS;
use farm::case::Solver;
use farm::domain::GROUND;
use farm::outputs::OUTPUTS;
use farm::refinement::TABLE as REFINEMENT;
use farm::solvers::SOLVERS;
use sensing::SENSORS;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What the page says around the tables of keys.
const PREFACE: &str = include_str!("preface.md");
/// What the page on precursors says above theirs.
const PREFACE_OF_PRECURSOR: &str = include_str!("preface_of_precursor.md");
/// What the page says above the table of flow solvers.
const WHAT_SOLVERS_DO: &str = "The flow solver. Where induction is not resolved, each turbine makes its own by blade-element momentum, and leaves no wake.";

/// The page docs/case-file.md: how a case file is read, and every key with unit, range and default.
pub fn reference() -> String {
    let mut page = PREFACE.to_owned();
    let events = EVENTS.iter().map(|(_, table)| *table);
    let wind = [&ROOT, &WIND, &GRID, &CUT].into_iter().chain(events);
    let turbines = [&TIME, &TURBINE, &INSTRUMENTS].into_iter().chain(INSTRUMENT_KINDS);
    // Writing to a string cannot fail.
    for table in wind.chain([flow(Solver::default())]) {
        let _ = write_table(&mut page, table, None);
    }
    let _ = write_solvers(&mut page);
    for table in [&GROUND, &REFINEMENT].into_iter().chain(turbines).chain([&RUN]) {
        let _ = write_table(&mut page, table, None);
    }
    for kind in CONTROLLERS.all() {
        let _ =
            write_table(&mut page, kind.table(), Some((kind.name(), "What runs on the turbine.")));
        for key in kind.table().keys {
            if let Holds::Files(table) = key.holds {
                let _ = write_table(&mut page, table, None);
            }
        }
    }
    for kind in SENSORS.all() {
        let _ = write_table(
            &mut page,
            kind.table(),
            Some((kind.name(), "Which kind of sensor it is.")),
        );
    }
    let _ = write_table(&mut page, &OUTPUT, None);
    for kind in OUTPUTS.all() {
        let about = "Which kind of output it is.";
        let _ = write_table(&mut page, kind.table(), Some((kind.name(), about)));
    }
    page
}

/// The page docs/precursor-file.md: every key of the file of a precursor.
pub fn precursor_reference() -> String {
    let mut page = PREFACE_OF_PRECURSOR.to_owned();
    for table in [&PRECURSOR, &BOX, &ATMOSPHERE, &PRECURSOR_TIME, &PLANES] {
        // Writing to a string cannot fail.
        let _ = write_table(&mut page, table, None);
    }
    page
}

/// Writes what each kind of flow solver does.
fn write_solvers(page: &mut String) -> std::fmt::Result {
    writeln!(page, "\n## `flow.solver`\n\n{WHAT_SOLVERS_DO}\n")?;
    writeln!(
        page,
        "| solver | what it does | resolves induction | keys of `[flow]` that it alone uses |"
    )?;
    writeln!(page, "| --- | --- | --- | --- |")?;
    for kind in SOLVERS.all() {
        let induction = if kind.resolves_induction { "yes" } else { "no" };
        let keys: Vec<String> = kind.keys.iter().map(|key| format!("`{}`", key.name)).collect();
        let keys = if keys.is_empty() { "none".to_owned() } else { keys.join(", ") };
        writeln!(page, "| `\"{}\"` | {} | {induction} | {keys} |", kind.name, kind.about)?;
    }
    Ok(())
}

/// Writes `table`; where it is that of a kind, with the kind's name and what its key `kind` means.
fn write_table(page: &mut String, table: &Table, kind: Option<(&str, &str)>) -> std::fmt::Result {
    writeln!(page, "\n## `{}`\n\n{}\n", table.heading, table.about)?;
    writeln!(page, "| key | holds | unit | default | meaning |\n| --- | --- | --- | --- | --- |")?;
    if let Some((name, about)) = kind {
        writeln!(page, "| `kind` | `\"{name}\"` |  | required | {about} |")?;
    }
    for key in table.keys {
        let default = match key.left_out {
            LeftOut::Required => "required".to_owned(),
            LeftOut::Value(value) => format!("`{value}`"),
            LeftOut::Otherwise(words) => words.to_owned(),
        };
        let unit = key.unit;
        writeln!(page, "| `{}` | {} | {unit} | {default} | {} |", key.name, holds(key), key.about)?;
    }
    Ok(())
}

fn holds(key: &Key) -> String {
    match key.holds {
        Holds::Text => "text".into(),
        Holds::Name => "name".into(),
        Holds::Folder => "name, `.` inside".into(),
        Holds::Model => "model or path".into(),
        Holds::Number(range) => range.describe("x", "–"),
        Holds::Whole { least, most } if most > 1 << 32 => format!("whole, {least} or more"),
        Holds::Whole { least, most } => format!("whole, {least} to {most}"),
        Holds::Choice(words) => {
            words.iter().map(|w| format!("`\"{w}\"`")).collect::<Vec<_>>().join(", ")
        }
        Holds::Pair(range) => format!("`[x, y]`, {} to {}", range.low, range.high),
        Holds::Turbines => "list of turbines' names".to_owned(),
        Holds::Numbers(range) => format!("list, each {} to {}", range.low, range.high),
        Holds::Ground(_) => "`\"slip\"` or a table".into(),
        Holds::Table(_) | Holds::Flow => "table".into(),
        Holds::Tables(_) => "one table or more".into(),
        Holds::Files(_) => "a path, or one table or more".into(),
        Holds::Event => "a table".into(),
        Holds::Control => "tables by turbine".into(),
        Holds::Sensors | Holds::Outputs => "tables by name".into(),
        Holds::Sweep => "lists by key".into(),
    }
}

/// JSON Schema (draft 2020-12) of the case file, for editors that complete and check TOML.
pub fn schema() -> String {
    schema_text(&ROOT, "wakemix case file")
}

/// The same of the file of a precursor.
pub fn precursor_schema() -> String {
    schema_text(&PRECURSOR, "wakemix precursor file")
}

fn schema_text(table: &Table, title: &str) -> String {
    let mut root = schema_of(table);
    root.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    root.insert("title".into(), json!(title));
    // A map of plain values always has a text.
    let text = serde_json::to_string_pretty(&Value::Object(root)).unwrap_or_default();
    text + "\n"
}

fn schema_of(table: &Table) -> Map<String, Value> {
    let properties: Map<String, Value> =
        table.keys.iter().map(|key| (key.name.to_owned(), schema_of_key(key))).collect();
    let required: Vec<&str> = table
        .keys
        .iter()
        .filter(|key| matches!(key.left_out, LeftOut::Required))
        .map(|key| key.name)
        .collect();
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    schema.insert("description".into(), json!(table.about));
    schema.insert("properties".into(), Value::Object(properties));
    schema.insert("required".into(), json!(required));
    schema.insert("additionalProperties".into(), json!(false));
    schema
}

fn schema_of_key(key: &Key) -> Value {
    let number = |range: basis::keys::Range| {
        let low = if range.open { "exclusiveMinimum" } else { "minimum" };
        json!({ "type": "number", low: range.low, "maximum": range.high })
    };
    let mut schema = match key.holds {
        Holds::Text | Holds::Model => json!({ "type": "string" }),
        Holds::Name => json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" }),
        Holds::Folder => {
            let pattern = "^(?=.{1,64}$)[A-Za-z0-9_-]([A-Za-z0-9_.-]*[A-Za-z0-9_-])?$";
            json!({ "type": "string", "pattern": pattern })
        }
        Holds::Number(range) => number(range),
        Holds::Whole { least, most } => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Holds::Choice(words) => json!({ "enum": words }),
        Holds::Pair(range) => {
            json!({ "type": "array", "items": number(range), "minItems": 2, "maxItems": 2 })
        }
        Holds::Turbines => json!({ "type": "array", "items": { "type": "string" } }),
        Holds::Numbers(range) => json!({ "type": "array", "items": number(range) }),
        Holds::Ground(table) => {
            json!({ "anyOf": [{ "const": "slip" }, Value::Object(schema_of(table))] })
        }
        Holds::Table(table) => Value::Object(schema_of(table)),
        Holds::Flow => Value::Object(schema_of(flow(Solver::default()))),
        Holds::Tables(table) => {
            json!({ "type": "array", "minItems": 1, "items": Value::Object(schema_of(table)) })
        }
        Holds::Files(table) => {
            let family =
                json!({ "type": "array", "minItems": 1, "items": Value::Object(schema_of(table)) });
            json!({ "anyOf": [{ "type": "string" }, family] })
        }
        Holds::Event => json!({ "oneOf": schemas_of_kinds(EVENTS) }),
        Holds::Control => {
            let all = CONTROLLERS.all();
            tables_of_kinds(all.iter().map(|kind| (kind.name(), kind.table())))
        }
        Holds::Sweep => {
            let lists =
                json!({ "anyOf": [{ "type": "array", "minItems": 1 }, { "type": "object" }] });
            json!({ "type": "object", "additionalProperties": lists })
        }
        Holds::Sensors => {
            let all = SENSORS.all();
            tables_of_kinds(all.iter().map(|kind| (kind.name(), kind.table())))
        }
        Holds::Outputs => {
            let all = OUTPUTS.all();
            tables_of_kinds(all.iter().map(|kind| (kind.name(), kind.table())))
        }
    };
    describe(key, &mut schema);
    schema
}

/// Adds what `key` is about, and what holds where it is left out, to its `schema`.
fn describe(key: &Key, schema: &mut Value) {
    if let Value::Object(schema) = schema {
        let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
        schema.insert("description".into(), json!(format!("{}{unit}", key.about)));
        if let LeftOut::Value(text) = key.left_out
            && let Some(value) = default_of(text)
        {
            schema.insert("default".into(), value);
        }
    }
}

/// Tables by name, each of one of `kinds`.
fn tables_of_kinds<'k>(kinds: impl Iterator<Item = (&'k str, &'static Table)>) -> Value {
    let one = |(name, table): (&str, &'static Table)| {
        let mut schema = schema_of(table);
        if let Some(keys) = schema.get_mut("properties").and_then(Value::as_object_mut) {
            keys.insert("kind".into(), json!({ "const": name }));
        }
        if let Some(required) = schema.get_mut("required").and_then(Value::as_array_mut) {
            required.insert(0, json!("kind"));
        }
        Value::Object(schema)
    };
    let kinds: Vec<Value> = kinds.map(one).collect();
    let items = if kinds.is_empty() { json!(false) } else { json!({ "oneOf": kinds }) };
    json!({ "type": "object", "additionalProperties": items })
}

/// Tables whose key `kind` says which one it is.
fn schemas_of_kinds(kinds: &[(&str, &'static Table)]) -> Vec<Value> {
    let one = |(name, table): &(&str, &'static Table)| {
        let mut schema = schema_of(table);
        if let Some(kind) = schema.get_mut("properties").and_then(|keys| keys.get_mut("kind")) {
            *kind = json!({ "const": name });
        }
        Value::Object(schema)
    };
    kinds.iter().map(one).collect()
}

/// A default as written in TOML, which for these plain values is JSON too.
fn default_of(text: &str) -> Option<Value> {
    serde_json::from_str(text).ok()
}
