//! Keys of controls, which stand for those of every run that takes them.

use super::Shipped;
use crate::atomic;
use crate::case::document::{self, Entry, Value, find};
use crate::case::error::CaseError;
use crate::case::sweep;
use std::path::Path;

/// What a campaign must know of its case to tell where a key goes.
pub(super) struct Places {
    runs: Vec<Vec<Entry>>,
    /// Whether the case sweeps keys itself.
    pub(super) sweeps: bool,
}

impl Places {
    /// Of no case.
    pub(super) fn none() -> Self {
        Self { runs: Vec::new(), sweeps: false }
    }

    /// Of the case at `path`, or the shipped one that it stands for.
    ///
    /// # Errors
    /// [`CaseError`] for a file that cannot be read, or is no TOML.
    pub(super) fn read(path: &Path, shipped: Shipped) -> Result<Self, CaseError> {
        let named = path.to_str().filter(|_| !path.is_file()).and_then(shipped);
        let text = match named {
            Some(text) => text,
            None => atomic::read_text(path, "the case of a campaign")?,
        };
        let name = path.display().to_string();
        let (_, document) = document::parse(&name, &text, &[]);
        let entries = document.map_err(|problems| CaseError::Invalid { name, problems })?;
        let runs = match find(&entries, "run").map(|entry| &entry.node.value) {
            Some(Value::List(items)) => {
                let table = |item: &document::Node| match &item.value {
                    Value::Table(table) => Some(table.clone()),
                    _ => None,
                };
                items.iter().filter_map(table).collect()
            }
            _ => Vec::new(),
        };
        Ok(Self { runs, sweeps: find(&entries, "sweep").is_some() })
    }

    /// The keys of the case that `key` stands for: itself, or of a key of controls that of each run which
    /// takes it.
    ///
    /// # Errors
    /// Why none does.
    pub(super) fn of(&self, key: &str) -> Result<Vec<String>, String> {
        let path: Vec<&str> = key.split('.').collect();
        if path.iter().any(|part| part.is_empty()) {
            return Err(format!("a part of the key `{key}` is empty"));
        }
        if path[0] != "control" {
            return Ok(vec![key.to_owned()]);
        }
        let name = |run: &[Entry]| super::name_of(run).unwrap_or_default().to_owned();
        let taking = self.runs.iter().filter(|run| sweep::takes(run, &name(run), &path));
        let places: Vec<String> = taking.map(|run| format!("run.{}.{key}", name(run))).collect();
        if places.is_empty() {
            return Err(format!(
                "no run of the case takes `{key}`: none has a control of that turbine that knows it"
            ));
        }
        Ok(places)
    }
}
