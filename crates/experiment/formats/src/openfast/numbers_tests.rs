//! What no number can be, in the place of the first number of each line of a deck in turn.

use super::tests::files;
use super::{ImportOptions, import};
use crate::turbine_file::{self, Document, TurbineFileError};
use std::fs;
use std::path::Path;

/// What becomes of the deck in `folder` with `text` in its file `name`, which then is as before.
fn imported(folder: &Path, name: &str, text: &str) -> Result<Document, TurbineFileError> {
    let before = fs::read(folder.join(name)).unwrap();
    fs::write(folder.join(name), text).unwrap();
    let result = import(&folder.join("small.fst"), &ImportOptions::default());
    fs::write(folder.join(name), before).unwrap();
    result
}

/// Whether `document` can be written and read back.
fn is_taken(document: &Document) -> bool {
    let written = turbine_file::write(document);
    written.missing.is_empty() && turbine_file::parse("written.toml", &written.text).is_ok()
}

#[test]
fn they_are_refused_with_their_place_or_of_no_use_to_a_turbine() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    for (name, text) in files() {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let (main, text) = &files()[0];
    let sound = imported(folder.path(), main, text).unwrap();
    assert!(is_taken(&sound));
    let mut n_refused = 0;
    for (name, text) in files() {
        for (index, line) in text.lines().enumerate() {
            let first = line.split_whitespace().next().unwrap_or_default();
            if first.parse::<f64>().is_err() {
                continue;
            }
            for bad in ["nan", "inf", "1e999", "1e308"] {
                let damaged = text.lines().enumerate().map(|(other, line)| {
                    let bad_line = line.replacen(first, bad, 1);
                    (if other == index { bad_line } else { line.to_owned() }) + "\n"
                });
                match imported(folder.path(), name, &damaged.collect::<String>()) {
                    // No part of a turbine follows from it.
                    Ok(document) if document == sound => {}
                    Ok(document) => {
                        assert!(!is_taken(&document), "{name}, line {}: {bad}", index + 1);
                        n_refused += 1;
                    }
                    Err(error) => {
                        let message = error.to_string();
                        assert!(message.contains("expected"), "{message}");
                        n_refused += 1;
                    }
                }
            }
        }
    }
    assert!(n_refused > 200, "{n_refused}");
}
