//! A TOML document as a tree in which every key and value knows its place, overrides included.

use super::error::{Problem, ProblemKind};
use super::sources::Sources;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Parts of an override's key at most (–); tables within each other are walked one by one.
const DEEPEST: usize = 32;

/// A value with its place in [`Sources`].
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) span: Range<usize>,
}

/// A value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    /// Digits of an integer that may not fit any type.
    Whole(Option<i128>),
    Number(f64),
    Flag,
    Moment,
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) key: String,
    pub(super) key_span: Range<usize>,
    pub(super) node: Node,
}

impl Node {
    /// In words, for "found …".
    pub(super) fn kind(&self) -> &'static str {
        match self.value {
            Value::Text(_) => "text",
            Value::Whole(_) => "a whole number",
            Value::Number(_) => "a number",
            Value::Flag => "true or false",
            Value::Moment => "a date",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
        }
    }
}

/// The entry of `entries` called `key`.
pub(super) fn find<'a>(entries: &'a [Entry], key: &str) -> Option<&'a Entry> {
    entries.iter().find(|entry| entry.key == key)
}

/// Reads `text` of the file `name` and applies `overrides`, each `key.path=value`.
///
/// # Errors
/// What is not TOML, and overrides that name no place.
pub(super) fn parse(
    name: &str,
    text: &str,
    overrides: &[String],
) -> (Sources, Result<Vec<Entry>, Vec<Problem>>) {
    let mut sources = Sources::new();
    let start = sources.add(name, text);
    let mut root = match DeTable::parse(text) {
        Ok(table) => entries_of(table.get_ref(), start),
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let kind = ProblemKind::Syntax { message: error.message().trim().replace('\n', "; ") };
            let problem = Problem::new(&sources, shift(&span, start), kind);
            return (sources, Err(vec![problem]));
        }
    };
    let mut problems = Vec::new();
    for text in overrides {
        let start = sources.add("--set", text);
        if let Err(kind) = apply(&mut root, text, start) {
            problems.push(Problem::new(&sources, start..start + text.len(), kind));
        }
    }
    let result = if problems.is_empty() { Ok(root) } else { Err(problems) };
    (sources, result)
}

fn shift(span: &Range<usize>, start: usize) -> Range<usize> {
    span.start + start..span.end + start
}

fn entries_of(table: &DeTable, start: usize) -> Vec<Entry> {
    let mut entries: Vec<Entry> = table
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref().to_string(),
            key_span: shift(&key.span(), start),
            node: node_of(value, start),
        })
        .collect();
    // In the order of the file, so that problems come from top to bottom.
    entries.sort_by_key(|entry| entry.key_span.start);
    entries
}

fn node_of(value: &Spanned<DeValue>, start: usize) -> Node {
    let span = shift(&value.span(), start);
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(digits) => {
            Value::Whole(i128::from_str_radix(digits.as_str(), digits.radix()).ok())
        }
        DeValue::Float(digits) => Value::Number(digits.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(_) => Value::Flag,
        DeValue::Datetime(_) => Value::Moment,
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| node_of(item, start)).collect())
        }
        DeValue::Table(table) => Value::Table(entries_of(table, start)),
    };
    Node { value, span }
}

/// Puts the value of one override, `key.path=value` at `start` of the sources, into the tree.
fn apply(root: &mut Vec<Entry>, text: &str, start: usize) -> Result<(), ProblemKind> {
    let refuse = |why: String| ProblemKind::Override { text: text.to_owned(), why };
    let Some((path, value)) = text.split_once('=') else {
        return Err(refuse("it has no `=`".into()));
    };
    let offset = start + path.len() + 1;
    let node = match DeValue::parse(value.trim_start()) {
        Ok(parsed) => node_of(&parsed, offset + value.len() - value.trim_start().len()),
        // A bare word: quotes are tedious in a shell.
        Err(_) => {
            Node { value: Value::Text(value.trim().to_owned()), span: offset..start + text.len() }
        }
    };
    let segments: Vec<&str> = path.trim().split('.').map(str::trim).collect();
    if segments.iter().any(|segment| segment.is_empty()) {
        return Err(refuse("a part of its key is empty".into()));
    }
    if segments.len() > DEEPEST {
        return Err(refuse(format!("its key has more than {DEEPEST} parts")));
    }
    insert(root, &segments, node, start..start + path.len()).map_err(refuse)
}

/// Puts `node` at `path` below `entries`, where tables that are not there are made; `span` is that of the
/// key.
pub(super) fn insert(
    entries: &mut Vec<Entry>,
    path: &[&str],
    node: Node,
    span: Range<usize>,
) -> Result<(), String> {
    let Some((first, rest)) = path.split_first() else { return Ok(()) };
    let index = entries.iter().position(|entry| entry.key == *first).unwrap_or_else(|| {
        let value = Value::Table(Vec::new());
        let node = Node { value, span: span.clone() };
        entries.push(Entry { key: (*first).to_owned(), key_span: span.clone(), node });
        entries.len() - 1
    });
    let entry = &mut entries[index];
    let Some((second, after)) = rest.split_first() else {
        entry.key_span = span;
        entry.node = node;
        return Ok(());
    };
    match &mut entry.node.value {
        Value::Table(inner) => insert(inner, rest, node, span),
        Value::List(items) => {
            let item = pick(items, second).ok_or_else(|| {
                format!("there is no {first} numbered (from 0) or named `{second}`")
            })?;
            match (&mut item.value, after.is_empty()) {
                (Value::Table(inner), false) => insert(inner, after, node, span),
                (_, true) => {
                    *item = node;
                    Ok(())
                }
                _ => Err(format!("`{first}.{second}` holds no keys")),
            }
        }
        _ => Err(format!("`{first}` holds no keys")),
    }
}

/// The item at an index, or the table with such a `name`; the name wins.
fn pick<'a>(items: &'a mut [Node], which: &str) -> Option<&'a mut Node> {
    let found = items.iter().position(|item| named(item, which));
    items.get_mut(found.or_else(|| which.parse().ok())?)
}

/// Whether `item` is a table whose `name` is `name`.
pub(super) fn named(item: &Node, name: &str) -> bool {
    match &item.value {
        Value::Table(entries) => find(entries, "name")
            .is_some_and(|entry| matches!(&entry.node.value, Value::Text(text) if text == name)),
        _ => false,
    }
}
