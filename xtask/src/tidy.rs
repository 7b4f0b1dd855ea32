//! The rules of the house that a compiler does not know, checked against the files themselves.

mod architecture;
mod circles;
mod exceptions;
mod functions;
mod links;
mod room;
mod source;
mod text;
mod unused;
mod width;

use architecture::Rules;
use exceptions::Exceptions;
use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// One breach of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// File, relative to the root.
    pub file: PathBuf,
    /// Line, from one; none where the whole file is meant.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(formatter, "{line}:")?;
        }
        write!(formatter, " {}", self.message)
    }
}

/// Every breach in the repository at `root`; none in a tidy one.
///
/// # Errors
/// When a file or folder cannot be read.
pub fn findings(root: &Path) -> io::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    let exceptions = Exceptions::read(root, &mut findings)?;
    let rules = architecture::check(root, &exceptions, &mut findings)?;
    check_rooms(root, &rules, &exceptions, &mut findings)?;
    let mut files = Vec::new();
    collect(root, Path::new(""), &mut files)?;
    for file in files {
        // What is not text, such as a picture, has no lines to check.
        if let Ok(text) = String::from_utf8(fs::read(root.join(&file))?) {
            text::check(&file, &text, &rules, &mut findings);
            links::check(root, &file, &text, &mut findings);
            width::check(&file, &text, &mut findings);
        }
    }
    Ok(findings)
}

/// Adds circles of files and long functions of the rooms, and exceptions that none needs.
fn check_rooms(
    root: &Path,
    rules: &Rules,
    exceptions: &Exceptions,
    findings: &mut Vec<Finding>,
) -> io::Result<()> {
    let (mut circular, mut long) = (BTreeSet::new(), BTreeSet::new());
    for folder in rules.folders.values() {
        let modules = room::modules(root, folder)?;
        circular.extend(circles::check(&modules, exceptions, findings));
        for module in modules.values() {
            long.extend(functions::check(module, exceptions, findings));
        }
    }
    exceptions.check_needed(&circular, &rules.unused, &long, findings);
    Ok(())
}

/// Files below `folder`, without what git ignores and without what is not ours to word.
fn collect(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    let mut entries: Vec<_> = fs::read_dir(root.join(folder))?.collect::<io::Result<_>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = folder.join(&name);
        let kind = entry.file_type()?;
        let ignored = [".git", ".venv", "runs", "Cargo.lock"].contains(&name.as_str())
            || name.starts_with("target")
            || name.starts_with("LICENSE");
        if ignored || kind.is_symlink() {
            continue;
        }
        if kind.is_dir() {
            collect(root, &path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
