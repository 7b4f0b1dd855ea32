//! Dependencies that a manifest names and no source uses.

use super::room::Modules;
use super::source::{code_of, paths};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Folders beside `src` with sources of tests, examples and benches.
const BESIDE: [&str; 3] = ["tests", "examples", "benches"];

/// Kind and name of the dependencies in the `manifest` of the room in `folder` (relative to `root`) that none
/// of its files uses: those of the product outside tests, those of tests anywhere, examples in doc comments
/// included. What is `refused` already is not named again.
///
/// # Errors
/// When a file or folder cannot be read.
pub(super) fn unused(
    root: &Path,
    folder: &Path,
    manifest: &Table,
    refused: &BTreeSet<String>,
    modules: &Modules,
) -> io::Result<Vec<(&'static str, String)>> {
    let mut product = BTreeSet::new();
    let mut tests = BTreeSet::new();
    for module in modules.values() {
        heads(module.product(), &mut product);
        heads(&module.code, &mut tests);
        heads(&examples(&fs::read_to_string(root.join(&module.file))?), &mut tests);
    }
    let mut files = Vec::new();
    for beside in BESIDE {
        sources(&root.join(folder).join(beside), true, &mut files)?;
    }
    for file in &files {
        heads(&code_of(&fs::read_to_string(file)?), &mut tests);
    }
    // A room of nothing but benches or programs has its sources beside the manifest.
    let mut own = Vec::new();
    sources(&root.join(folder), false, &mut own)?;
    for file in &own {
        heads(&code_of(&fs::read_to_string(file)?), &mut product);
    }
    let kinds = [
        ("dependencies", &product),
        ("build-dependencies", &product),
        ("dev-dependencies", &tests),
    ];
    let unused = kinds.into_iter().flat_map(|(kind, used)| {
        let is_unused =
            move |name: &String| !used.contains(&name.replace('-', "_")) && !refused.contains(name);
        names(manifest, kind).into_iter().filter(is_unused).map(move |name| (kind, name))
    });
    Ok(unused.collect())
}

/// Names of dependencies of `kind`, on any target.
fn names(manifest: &Table, kind: &str) -> Vec<String> {
    let of = |table: &Table| {
        let names = table.get(kind).and_then(Value::as_table).into_iter().flatten();
        names.map(|(name, _)| name.clone()).collect::<Vec<_>>()
    };
    let targets = manifest.get("target").and_then(Value::as_table).into_iter().flatten();
    let on_targets = targets.filter_map(|(_, table)| table.as_table()).flat_map(of);
    of(manifest).into_iter().chain(on_targets).collect()
}

/// Adds the first word of every path in `code`.
fn heads(code: &str, heads: &mut BTreeSet<String>) {
    heads.extend(paths(code).into_iter().filter_map(|path| path.into_iter().next()));
}

/// Code of examples in the doc comments of `text`.
fn examples(text: &str) -> String {
    let lines = text.lines().filter_map(|line| {
        let line = line.trim_start();
        line.strip_prefix("///").or_else(|| line.strip_prefix("//!"))
    });
    let mut inside = false;
    let mut code = String::new();
    for line in lines {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if inside {
            code.push_str(line.trim_start().trim_start_matches("# "));
            code.push('\n');
        }
    }
    code_of(&code)
}

/// Adds the source files in `folder`, and where `deep` in those below.
fn sources(folder: &Path, deep: bool, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() && deep {
            sources(&path, deep, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(())
}
