//! Turbines: OpenFAST decks with all their files, ROSCO's input and table, windIO files, the project's own.

use super::{Folder, survives};
use crate::openfast::{self, ImportOptions};
use crate::turbine_file::{self, Document};
use crate::{rosco, windio};

/// The deck of the importer's own tests, as its files.
fn deck() -> Vec<(&'static str, Vec<u8>)> {
    openfast::tests::files().into_iter().map(|(name, text)| (name, text.into_bytes())).collect()
}

fn turbine() -> String {
    let folder = Folder::new(deck());
    let path = folder.folder.path().join("small.fst");
    let document = openfast::import(&path, &ImportOptions::default()).unwrap();
    turbine_file::write(&document).text
}

/// What follows an import: the turbine is written, and read where it is complete.
fn use_of(document: &Document) {
    let text = turbine_file::write(document).text;
    let _ = turbine_file::parse("written.toml", &text);
}

#[test]
fn openfast_decks() {
    survives(deck(), |folder| {
        use_of(&openfast::import(&folder.join("small.fst"), &ImportOptions::default())?);
        Ok(())
    });
}

#[test]
fn rosco_inputs() {
    let [discon, table] = [rosco::tests::DISCON, rosco::tests::TABLE].map(str::as_bytes);
    let files = vec![("DISCON.IN", discon.to_vec()), ("table.txt", table.to_vec())];
    survives(files, |folder| {
        rosco::read(&folder.join("DISCON.IN"))?;
        Ok(())
    });
}

#[test]
fn windio_files() {
    survives(vec![("small.yaml", windio::tests::FILE.into())], |folder| {
        use_of(&windio::import(&folder.join("small.yaml"), &ImportOptions::default())?);
        Ok(())
    });
}

#[test]
fn turbine_files() {
    survives(vec![("small.toml", turbine().into())], |folder| {
        turbine_file::read(&folder.join("small.toml"))?;
        Ok(())
    });
}
