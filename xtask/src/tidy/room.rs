//! The source files of a room, as modules.

use super::source::{code_of, product_of, test_modules};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// One file of a room's `src`.
pub(super) struct Module {
    /// File, relative to the root.
    pub(super) file: PathBuf,
    /// Its code, comments and strings blanked.
    pub(super) code: String,
    /// Whether it is there for tests alone.
    pub(super) is_test: bool,
}

impl Module {
    /// Its code without tests.
    pub(super) fn product(&self) -> &str {
        if self.is_test { "" } else { product_of(&self.code) }
    }
}

/// Modules in files, by their path below the crate; the crate itself has none.
pub(super) type Modules = BTreeMap<Vec<String>, Module>;

/// The modules of the room in `folder` (relative to `root`); a library and a program beside it count as one.
///
/// # Errors
/// When a file or folder cannot be read.
pub(super) fn modules(root: &Path, folder: &Path) -> io::Result<Modules> {
    let mut modules = Modules::new();
    read(root, &folder.join("src"), &[], &mut modules)?;
    let for_tests: Vec<Vec<String>> = modules
        .iter()
        .flat_map(|(path, module)| {
            let child = |name: &&str| [path.as_slice(), &[(*name).to_owned()]].concat();
            test_modules(&module.code).iter().map(child).collect::<Vec<_>>()
        })
        .collect();
    for (path, module) in &mut modules {
        let name = path.last().map_or("", String::as_str);
        module.is_test = name == "tests"
            || name.ends_with("_tests")
            || path.iter().any(|part| part == "tests")
            || for_tests.iter().any(|test| path.starts_with(test));
    }
    Ok(modules)
}

fn read(root: &Path, folder: &Path, path: &[String], modules: &mut Modules) -> io::Result<()> {
    if !root.join(folder).is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(root.join(folder))? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let file = folder.join(&name);
        if root.join(&file).is_dir() {
            read(root, &file, &[path, &[name]].concat(), modules)?;
        } else if let Some(stem) = name.strip_suffix(".rs") {
            // A program beside a library is a module like others.
            let whole = ["lib", "mod"].contains(&stem)
                || stem == "main" && !root.join(folder).join("lib.rs").exists();
            let path = if whole { path.to_vec() } else { [path, &[stem.to_owned()]].concat() };
            let code = code_of(&fs::read_to_string(root.join(&file))?);
            modules.insert(path, Module { file, code, is_test: false });
        }
    }
    Ok(())
}
