//! Files that decide the results of a case beside the case itself, for many cases that share them.

use crate::StudyError;
use crate::atmosphere;
use crate::hosting;
use crate::linear_laws;
use crate::models;
use farm::case::Placement;
use formats::FileError;
use formats::case::CaseFile;
use formats::records;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf, absolute};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// What the files of wind hold, in words.
const WIND: &str = "the file of wind";
/// Longest file of wind that is looked at whole (bytes).
const WHOLE: u64 = 16 << 20;
/// Bytes of a longer one that are looked at, at its begin and at its end.
const END: u64 = 1 << 16;

/// Length of a file (bytes) and when it was changed; none where it is not there.
type Stamp = Option<(u64, Option<SystemTime>)>;

/// Digests of long files of wind that this process has read, by path, with the stamps that the files had:
/// thousands of tasks of a campaign share a record.
static LONG_WINDS: Mutex<BTreeMap<PathBuf, (Stamp, String)>> = Mutex::new(BTreeMap::new());

/// Digests of files by their names, with the stamps that the files had.
type Stamped = (Vec<Stamp>, BTreeMap<String, String>);

/// Fingerprints of turbine files, controllers' inputs, libraries and wind. Turbine files and wind are read
/// once, as long as their length and the time of their last change stay.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    machines: BTreeMap<Vec<String>, Stamped>,
    winds: BTreeMap<PathBuf, (Stamp, String)>,
}

impl Inputs {
    /// Fingerprint of each file that the case of `file` names, by its name: SHA-256 of turbines, controllers'
    /// inputs, libraries and laws; of a file of wind of more than 16 MiB its size and the SHA-256 of its
    /// first and last 64 KiB.
    ///
    /// # Errors
    /// [`StudyError`] for a file that cannot be read.
    pub fn of(&mut self, file: &CaseFile) -> Result<BTreeMap<String, String>, StudyError> {
        let (case, folder) = (&file.case, file.folder());
        let machines: Vec<String> = case.turbines.iter().map(Placement::machine).collect();
        // What a controller's input names is known only once it is read.
        let is_known = case.turbines.iter().all(|placement| placement.discon.is_none());
        let stamp_of = |placement: &Placement| stamp(&folder.join(&placement.model));
        let stamps: Vec<Stamp> = case.turbines.iter().map(stamp_of).collect();
        let mut found = match self.machines.get(&machines) {
            Some((then, known)) if is_known && *then == stamps => known.clone(),
            _ => {
                let texts = models::load(file)?.texts;
                let digest =
                    |(name, text): (String, String)| (name, records::sha256(text.as_bytes()));
                let digests: BTreeMap<String, String> = texts.into_iter().map(digest).collect();
                self.machines.insert(machines, (stamps, digests.clone()));
                digests
            }
        };
        found.extend(hosting::digests(case, folder));
        found.extend(linear_laws::digests(case, folder));
        if let Some(name) = &case.wind.table {
            found.insert(name.clone(), self.wind(&folder.join(name))?);
        }
        for path in atmosphere::files(case, folder)? {
            let named = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            found.insert(named, self.wind(&path)?);
        }
        Ok(found)
    }

    fn wind(&mut self, path: &Path) -> Result<String, FileError> {
        let now = stamp(path);
        if let Some((then, known)) = self.winds.get(path)
            && *then == now
        {
            return Ok(known.clone());
        }
        let print = wind_print(path)?;
        self.winds.insert(path.to_owned(), (now, print.clone()));
        Ok(print)
    }
}

/// SHA-256 of the file of wind at `path`, all of it. One of more than 16 MiB is read once in a process, as
/// long as its length and the time of its last change stay.
///
/// # Errors
/// [`FileError::System`].
pub(crate) fn wind_digest(path: &Path) -> Result<String, FileError> {
    let digest = || records::sha256_of_file(path, WIND);
    let now = stamp(path);
    let (true, Ok(whole)) = (now.is_some_and(|(length, _)| length > WHOLE), absolute(path)) else {
        return digest();
    };
    let known = || LONG_WINDS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((then, found)) = known().get(&whole)
        && *then == now
    {
        return Ok(found.clone());
    }
    // Not under the lock: other records need not wait.
    let found = digest()?;
    known().insert(whole, (now, found.clone()));
    Ok(found)
}

fn stamp(path: &Path) -> Stamp {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()))
}

/// What the file of wind at `path` is known by.
fn wind_print(path: &Path) -> Result<String, FileError> {
    let failed = |source| FileError::system("read", WIND, path, source);
    let mut file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    if length <= WHOLE {
        return records::sha256_of_file(path, WIND);
    }
    let mut ends = Vec::new();
    (&file).take(END).read_to_end(&mut ends).map_err(failed)?;
    file.seek(SeekFrom::End(-(END as i64))).map_err(failed)?;
    file.take(END).read_to_end(&mut ends).map_err(failed)?;
    Ok(format!("{length} bytes, {}", records::sha256(&ends)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::time::Duration;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn a_long_record_is_read_again_once_it_changes_and_a_short_one_always() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let write = |byte: u8, length: u64, changed: SystemTime| {
            let bytes = vec![byte; length as usize];
            fs::write(file.path(), &bytes).unwrap();
            file.as_file().set_modified(changed).unwrap();
            records::sha256(&bytes)
        };
        let found = || wind_digest(file.path()).unwrap();
        let (before, after) = (SystemTime::UNIX_EPOCH, SystemTime::UNIX_EPOCH + SECOND);
        let first = write(1, WHOLE + 1, before);
        assert_eq!(found(), first);
        let second = write(2, WHOLE + 1, before);
        assert_eq!(found(), first);
        assert_eq!(write(2, WHOLE + 1, after), second);
        assert_eq!(found(), second);
        for byte in [3, 4] {
            let short = write(byte, WHOLE, after);
            assert_eq!(found(), short);
        }
    }

    #[test]
    fn a_wind_that_is_changed_anywhere_in_a_small_file_or_at_an_end_of_a_large_one_is_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wind");
        for (length, places) in
            [(1 << 20, [0, 1 << 19, (1 << 20) - 1]), (WHOLE + 1, [0, 99, WHOLE])]
        {
            let file = File::create(&path).unwrap();
            file.set_len(length).unwrap();
            let before = wind_print(&path).unwrap();
            for place in places {
                let mut bytes = vec![0; length as usize];
                bytes[place as usize] = 1;
                fs::write(&path, bytes).unwrap();
                assert_ne!(wind_print(&path).unwrap(), before, "byte {place} of {length}");
            }
        }
    }
}
