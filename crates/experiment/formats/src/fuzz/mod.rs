//! Bytes that no program should have written: every reader of foreign files gives a result, or an error that
//! names the file and the fix. It never panics, never runs away and never asks for more memory than a small
//! file deserves.
//!
//! Each test damages small sound files at random: bits, bytes, words, numbers, counts, lines, cuts, or all of
//! it. How often is `PROPTEST_CASES` (256 unless set); every run draws anew, and a failure prints the least
//! damage that does it.

mod cases;
mod damage;
mod decks;
mod desk;
mod fields;
pub(crate) mod memory;
mod nesting;
pub(crate) mod numbers;
mod records;
mod tables;
mod winds;

use damage::{Damage, damaged, damages};
use miette::{Diagnostic, GraphicalReportHandler};
use proptest::prelude::*;
use std::cell::Cell;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Whether a case asks for an output whose kind studies announce, which nothing here knows: their own tests
/// read it.
pub(crate) fn asks_for_what_studies_write(text: &str) -> bool {
    ["phase-averages", "wind-slices"]
        .iter()
        .any(|kind| text.contains(&format!("kind = \"{kind}\"")))
}

/// Whatever a reader refuses a file with.
type Refusal = Box<dyn Diagnostic + Send + Sync>;

/// Memory (bytes) that a reader may hold on top of what it held: buffers of a few megabytes, and a hundred
/// times the longest file.
const MOST_MEMORY: usize = (8 << 20) + 100 * damage::LONGEST;

fn config() -> ProptestConfig {
    // A failing case is to become a test of its own, in words.
    ProptestConfig {
        failure_persistence: None,
        max_shrink_iters: 4000,
        ..ProptestConfig::default()
    }
}

/// Sound files in a folder, of which at most one at a time is damaged.
struct Folder {
    folder: TempDir,
    files: Vec<(&'static str, Vec<u8>)>,
    damaged: Cell<Option<usize>>,
}

impl Folder {
    fn new(files: Vec<(&'static str, Vec<u8>)>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in &files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        Self { folder, files, damaged: Cell::new(None) }
    }

    /// On return the file number `which` is the only one with damage.
    fn damage(&self, which: usize, damages: &[Damage]) {
        let write = |which: usize, bytes: &[u8]| {
            fs::write(self.folder.path().join(self.files[which].0), bytes).unwrap();
        };
        if let Some(before) = self.damaged.replace(Some(which)) {
            write(before, &self.files[before].1);
        }
        write(which, &damaged(&self.files[which].1, damages));
    }
}

/// Hands `read` the folder of `files` again and again, one of them damaged; it must read them when they are
/// sound.
fn survives(files: Vec<(&'static str, Vec<u8>)>, read: impl Fn(&Path) -> Result<(), Refusal>) {
    let folder = Folder::new(files);
    let path = folder.folder.path();
    if let Err(error) = read(path) {
        panic!("the sound files are refused: {}", message(&*error));
    }
    let names: Vec<&str> = folder.files.iter().map(|(name, _)| *name).collect();
    proptest!(config(), |(which in 0..names.len(), damages in damages())| {
        folder.damage(which, &damages);
        let (result, peak) = memory::peak(|| read(path));
        prop_assert!(peak <= MOST_MEMORY, "{} held {peak} bytes", names[which]);
        if let Err(error) = result {
            helps(&*error, &names)?;
        }
    });
}

/// That `error` names one of the files `names` and says how to fix it, and that it can be drawn.
fn helps(error: &dyn Diagnostic, names: &[&str]) -> Result<(), TestCaseError> {
    let drawn = message(error);
    let all = format!("{error} {drawn}");
    let ends = |name: &&str| all.contains(name.rsplit('/').next().unwrap_or(name));
    prop_assert!(names.iter().any(ends), "no file is named: {all}");
    let mut related = error.related().into_iter().flatten().peekable();
    let causes = related.peek().is_some() && related.all(|cause| cause.help().is_some());
    prop_assert!(error.help().is_some() || causes, "no fix is named: {all}");
    Ok(())
}

/// `error` as a terminal shows it.
fn message(error: &dyn Diagnostic) -> String {
    let mut drawn = String::new();
    GraphicalReportHandler::new().render_report(&mut drawn, error).unwrap();
    drawn
}
