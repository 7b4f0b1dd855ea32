//! Files that decide the results of a case beside the case itself, for many cases that share them.

use crate::StudyError;
use crate::hosting;
use crate::linear_laws;
use crate::models;
use farm::case::Placement;
use formats::FileError;
use formats::case::CaseFile;
use formats::records;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What the files of wind hold, in words.
const WIND: &str = "the file of wind";
/// Bytes of a file of wind that are looked at: header and first values, which no two winds share.
const HEAD: u64 = 1 << 16;

/// Fingerprints of turbine files, controllers' inputs, libraries and wind, each file read once.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    machines: BTreeMap<Vec<String>, BTreeMap<String, String>>,
    winds: BTreeMap<PathBuf, String>,
}

impl Inputs {
    /// Fingerprint of each file that the case of `file` names, by its name: SHA-256 of turbines, controllers'
    /// inputs, libraries and laws; of a file of wind, which may be gigabytes, its size and the SHA-256 of its
    /// first 64 KiB.
    ///
    /// # Errors
    /// [`StudyError`] for a file that cannot be read.
    pub fn of(&mut self, file: &CaseFile) -> Result<BTreeMap<String, String>, StudyError> {
        let (case, folder) = (&file.case, file.folder());
        let machines: Vec<String> = case.turbines.iter().map(Placement::machine).collect();
        let mut found = match self.machines.get(&machines) {
            Some(known) => known.clone(),
            None => {
                let texts = models::load(file)?.texts;
                let digest =
                    |(name, text): (String, String)| (name, records::sha256(text.as_bytes()));
                let digests: BTreeMap<String, String> = texts.into_iter().map(digest).collect();
                self.machines.insert(machines, digests.clone());
                digests
            }
        };
        found.extend(hosting::digests(case, folder));
        found.extend(linear_laws::digests(case, folder));
        if let Some(name) = &case.wind.table {
            found.insert(name.clone(), self.wind(&folder.join(name))?);
        }
        if let Some(name) = &case.wind.planes {
            for path in formats::turbulence_box::files(&folder.join(name))? {
                let named = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
                found.insert(named, self.wind(&path)?);
            }
        }
        Ok(found)
    }

    fn wind(&mut self, path: &Path) -> Result<String, FileError> {
        if let Some(known) = self.winds.get(path) {
            return Ok(known.clone());
        }
        let failed = |source| FileError::system("read", WIND, path, source);
        let file = File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        let mut head = Vec::new();
        file.take(HEAD).read_to_end(&mut head).map_err(failed)?;
        let print = format!("{length} bytes, {}", records::sha256(&head));
        self.winds.insert(path.to_owned(), print.clone());
        Ok(print)
    }
}
