//! What can be wrong with a turbine, and where.

use miette::Diagnostic;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// Why a turbine cannot be read.
#[derive(Debug, Error, Diagnostic)]
pub enum TurbineFileError {
    /// The file cannot be opened.
    #[error("cannot read {}", path.display())]
    #[diagnostic(code(wakemix::turbine::unreadable))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
        /// How to fix it.
        #[help]
        fix: String,
    },
    /// No such turbine in the library, and no such file.
    #[error("no turbine is called \"{name}\"")]
    #[diagnostic(code(wakemix::turbine::unknown))]
    Unknown {
        /// What was requested.
        name: String,
        /// What there is.
        #[help]
        fix: String,
    },
    /// Text that is not what the format asks for.
    #[error("{file}, line {line}: {message}")]
    #[diagnostic(code(wakemix::turbine::syntax))]
    Syntax {
        /// The file.
        file: String,
        /// Line, from 1 (–).
        line: usize,
        /// What the reader stumbled over.
        message: String,
        /// How to fix it.
        #[help]
        fix: String,
    },
    /// A figure that cannot be.
    #[error("{file}{}, {key}: expected {expected}, found {found}", place(*line))]
    #[diagnostic(code(wakemix::turbine::value))]
    Value {
        /// The file.
        file: Box<str>,
        /// Line, from 1 (–); 0 of figures that stand in no text.
        line: usize,
        /// Key, as a path through the file.
        key: Box<str>,
        /// What should be there.
        expected: Box<str>,
        /// What is there.
        found: Box<str>,
        /// How to fix it.
        #[help]
        fix: Box<str>,
    },
}

impl TurbineFileError {
    pub(crate) fn unreadable(path: &Path, source: std::io::Error) -> Self {
        let fix = "check the path; names of known turbines are listed by `wakemix turbine list`";
        Self::Unreadable { path: path.to_owned(), source, fix: fix.to_owned() }
    }

    pub(crate) fn syntax(file: &str, text: &str, error: &toml::de::Error) -> Self {
        let place = error.span().map_or(text.len(), |span| span.start);
        let message = error.message().trim().replace('\n', "; ");
        // Of a value, the reader says what it is, and not whose.
        let key = if message.starts_with("invalid") { key_at(text, place) } else { String::new() };
        let message = if key.is_empty() { message } else { format!("{key}: {message}") };
        let fix = if message.starts_with("unknown field") {
            "correct or remove this key; `wakemix turbine show nrel-5mw --file` prints a complete one"
        } else if message.starts_with("missing field") {
            "add the key to this group; `wakemix turbine show nrel-5mw --file` prints a complete one"
        } else {
            "`wakemix turbine show nrel-5mw --file` prints a complete one"
        };
        Self::Syntax {
            file: file.to_owned(),
            line: line_of(text, place),
            message,
            fix: fix.to_owned(),
        }
    }
}

fn place(line: usize) -> String {
    if line == 0 { String::new() } else { format!(", line {line}") }
}

/// The key whose value stands at byte number `place` of `text`, as a path through the file; empty where none
/// does, and where the text cannot be read that far.
fn key_at(text: &str, place: usize) -> String {
    let Ok(root) = DeTable::parse(text) else { return String::new() };
    let (mut table, mut path) = (root.get_ref(), String::new());
    loop {
        let holds = |value: &toml::Spanned<DeValue>| value.span().contains(&place);
        let Some((key, value)) = table.iter().find(|(_, value)| holds(value)) else { return path };
        path += if path.is_empty() { "" } else { "." };
        path += key.get_ref();
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => return path,
        }
    }
}

/// Line (from 1) of byte number `place` of `text`.
pub(crate) fn line_of(text: &str, place: usize) -> usize {
    1 + text.as_bytes()[..place.min(text.len())].iter().filter(|byte| **byte == b'\n').count()
}

/// The file that is being checked.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

/// One step of a path through a file.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step<'a> {
    Key(&'a str),
    Row(usize),
}

impl Place<'_> {
    /// The error that at `path` (as far as it exists) something else was expected.
    pub(super) fn error(
        &self,
        path: &[Step],
        expected: impl Into<String>,
        found: impl Into<String>,
        fix: impl Into<String>,
    ) -> TurbineFileError {
        let mut key = String::new();
        for step in path {
            match step {
                Step::Key(name) if key.is_empty() => key.push_str(name),
                Step::Key(name) => key.push_str(&format!(".{name}")),
                Step::Row(row) => key.push_str(&format!("[{}]", row + 1)),
            }
        }
        TurbineFileError::Value {
            file: self.file.into(),
            line: if self.text.is_empty() { 0 } else { line_of(self.text, self.byte_of(path)) },
            key: key.into(),
            expected: expected.into().into(),
            found: found.into().into(),
            fix: fix.into().into(),
        }
    }

    fn byte_of(&self, path: &[Step]) -> usize {
        let Ok(root) = DeTable::parse(self.text) else { return 0 };
        let mut byte = 0;
        let mut node: Option<&toml::Spanned<DeValue>> = None;
        for step in path {
            let next = match (step, node.map(|node| node.get_ref())) {
                (Step::Key(name), None) => {
                    root.get_ref().iter().find(|(key, _)| key.get_ref() == *name)
                }
                (Step::Key(name), Some(DeValue::Table(table))) => {
                    table.iter().find(|(key, _)| key.get_ref() == *name)
                }
                (Step::Row(row), Some(DeValue::Array(rows))) => match rows.get(*row) {
                    Some(value) => {
                        byte = value.span().start;
                        node = Some(value);
                        continue;
                    }
                    None => None,
                },
                _ => None,
            };
            let Some((key, value)) = next else { break };
            byte = key.span().start;
            node = Some(value);
        }
        byte
    }
}

impl Place<'_> {
    /// Nothing when `value` lies from `low` to `high`; `unit` follows the figures of the error.
    pub(super) fn within(
        &self,
        path: &[Step],
        value: f64,
        low: f64,
        high: f64,
        unit: &str,
    ) -> Result<(), TurbineFileError> {
        if value.is_finite() && (low..=high).contains(&value) {
            return Ok(());
        }
        let expected = format!("{low} to {high}{unit}");
        Err(self.error(
            path,
            expected,
            value.to_string(),
            "check figure and unit; keys without a unit are SI",
        ))
    }

    /// Nothing when the first `column` of a table increases, from row to row where `strictly`, and has
    /// `least` rows or more.
    pub(super) fn rising(
        &self,
        group: &str,
        key: &str,
        column: &[f64],
        least: usize,
        strictly: bool,
    ) -> Result<(), TurbineFileError> {
        if column.len() < least {
            return Err(self.error(
                &[Step::Key(group), Step::Key(key)],
                format!("{least} rows or more"),
                column.len().to_string(),
                "add rows, root or bottom first",
            ));
        }
        for row in 1..column.len() {
            let (before, here) = (column[row - 1], column[row]);
            if !(here > before || here == before && !strictly) {
                return Err(self.error(
                    &[Step::Key(group), Step::Key(key), Step::Row(row)],
                    format!("a first column that increases, more than {before}"),
                    here.to_string(),
                    "sort the rows by their first column",
                ));
            }
        }
        Ok(())
    }
}
