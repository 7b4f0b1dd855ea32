//! What is allowed to break a rule, and why: `xtask/exceptions.toml`.

use super::Finding;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

const FILE: &str = "xtask/exceptions.toml";

/// A circle of files that may stay.
#[derive(Debug)]
pub(super) struct Circle {
    /// Files, relative to the root.
    pub(super) files: BTreeSet<PathBuf>,
}

/// All that may stay.
#[derive(Debug, Default)]
pub(super) struct Exceptions {
    /// Circles of files.
    pub(super) circles: Vec<Circle>,
    /// Manifest (relative to the root) and name of dependencies that no source uses.
    pub(super) dependencies: BTreeSet<(PathBuf, String)>,
    /// File (relative to the root) and name of functions that may be long.
    pub(super) functions: BTreeSet<(PathBuf, String)>,
}

impl Exceptions {
    /// The exceptions of the repository at `root`, none without the file; adds those that say no reason.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(super) fn read(root: &Path, findings: &mut Vec<Finding>) -> io::Result<Self> {
        if !root.join(FILE).exists() {
            return Ok(Self::default());
        }
        let table = fs::read_to_string(root.join(FILE))?.parse::<Table>().map_err(|error| {
            io::Error::new(io::ErrorKind::InvalidData, format!("{FILE}: {error}"))
        })?;
        let entries = |kind: &str| {
            table
                .get(kind)
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .cloned()
                .collect::<Vec<_>>()
        };
        let text = |entry: &Value, key: &str| {
            entry.get(key).and_then(Value::as_str).unwrap_or_default().to_owned()
        };
        let [circles, dependencies, functions] =
            ["circle", "dependency", "long_function"].map(entries);
        for entry in circles.iter().chain(&dependencies).chain(&functions) {
            if text(entry, "why").is_empty() {
                report(format!("no `why` in {entry}"), findings);
            }
        }
        let files = |entry: &Value| {
            let files = entry.get("files").and_then(Value::as_array).into_iter().flatten();
            files.filter_map(Value::as_str).map(PathBuf::from).collect()
        };
        let named = |entries: &[Value]| {
            let key = |entry: &Value| (PathBuf::from(text(entry, "file")), text(entry, "name"));
            entries.iter().map(key).collect()
        };
        Ok(Self {
            circles: circles.iter().map(|entry| Circle { files: files(entry) }).collect(),
            dependencies: named(&dependencies),
            functions: named(&functions),
        })
    }

    /// Adds what is excepted without need, given all files of circles, all unused dependencies and all long
    /// functions.
    pub(super) fn check_needed(
        &self,
        circular: &BTreeSet<PathBuf>,
        unused: &BTreeSet<(PathBuf, String)>,
        long: &BTreeSet<(PathBuf, String)>,
        findings: &mut Vec<Finding>,
    ) {
        for file in self.circles.iter().flat_map(|circle| circle.files.difference(circular)) {
            report(format!("{} is in no circle any more: take it out", file.display()), findings);
        }
        for (file, name) in self.dependencies.difference(unused) {
            let message = format!("`{name}` in {} is used: take it out", file.display());
            report(message, findings);
        }
        for (file, name) in self.functions.difference(long) {
            let message = format!("`{name}` in {} is not too long: take it out", file.display());
            report(message, findings);
        }
    }
}

fn report(message: String, findings: &mut Vec<Finding>) {
    findings.push(Finding { file: PathBuf::from(FILE), line: None, message });
}
