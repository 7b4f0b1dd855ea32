//! What killed processes have left of the files that they wrote [beside](crate::beside) their place.

use crate::FileError;
use crate::beside::meant;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::time::Duration;

/// Age of a file of nobody's from which on it is taken for a killed process' (s): a new one is locked long
/// before.
const ABANDONED: Duration = Duration::from_secs(60);

/// Takes from `folder`, into which nobody else writes, what processes that were killed were writing there.
///
/// # Errors
/// [`FileError::System`].
pub fn remove_leftovers(folder: &Path) -> Result<(), FileError> {
    remove(folder, |_, _| true)
}

/// Takes from `folder`, into which others may write, what processes that were killed were writing there: of
/// the file called `only` alone, or of all where that is absent.
///
/// # Errors
/// [`FileError::System`].
pub fn remove_abandoned(folder: &Path, only: Option<&str>) -> Result<(), FileError> {
    // What cannot be opened or asked for its age is somebody's.
    remove(folder, |path, meant| {
        only.is_none_or(|only| only == meant) && is_abandoned(path).unwrap_or(false)
    })
}

/// Whether nobody writes the file at `path` any more.
fn is_abandoned(path: &Path) -> io::Result<bool> {
    let file = File::options().read(true).write(true).open(path)?;
    let age = file.metadata()?.modified()?.elapsed().unwrap_or_default();
    Ok(age >= ABANDONED && file.try_lock().is_ok())
}

fn remove(folder: &Path, is_left: impl Fn(&Path, &str) -> bool) -> Result<(), FileError> {
    let failed = |source| FileError::system("tidy", "the folder", folder, source);
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if meant(&name).is_some_and(|meant| is_left(&path, meant)) {
            match fs::remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
                _ => {}
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beside::claim;
    use std::time::SystemTime;

    const LEFT: [&str; 4] = [
        ".checkpoint.4711.part",
        ".mean-hub-height.nc.9.part",
        ".T1.outb.12.rows",
        ".box.bts.7.part",
    ];
    const KEPT: [&str; 7] = [
        "checkpoint",
        "series.csv.part",
        ".hidden",
        ".notes.part",
        ".a.b1.part",
        ".12.part",
        ".T1.outb.12.rose",
    ];

    /// A folder with all these files, as old as `age`.
    fn folder(age: Duration) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in LEFT.iter().chain(&KEPT) {
            let file = File::create(folder.path().join(name)).unwrap();
            file.set_modified(SystemTime::now() - age).unwrap();
        }
        folder
    }

    fn left_in(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn sorted(names: &[&str]) -> Vec<String> {
        let mut names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_a_killed_process_left_goes_and_nothing_else() {
        let folder = folder(Duration::ZERO);
        remove_leftovers(folder.path()).unwrap();
        assert_eq!(left_in(folder.path()), sorted(&KEPT));
    }

    #[test]
    fn what_somebody_may_still_write_stays() {
        let young = folder(Duration::ZERO);
        remove_abandoned(young.path(), None).unwrap();
        assert_eq!(left_in(young.path()).len(), LEFT.len() + KEPT.len());

        let old = folder(2 * ABANDONED);
        let claimed = File::options().write(true).open(old.path().join(LEFT[0])).unwrap();
        claim(&claimed);
        remove_abandoned(old.path(), Some("box.bts")).unwrap();
        let without_box = [&LEFT[..3], &KEPT[..]].concat();
        assert_eq!(left_in(old.path()), sorted(&without_box));
        remove_abandoned(old.path(), None).unwrap();
        let still = [&LEFT[..1], &KEPT[..]].concat();
        assert_eq!(left_in(old.path()), sorted(&still));
        // As after the death of its process.
        drop(claimed);
        remove_abandoned(old.path(), None).unwrap();
        assert_eq!(left_in(old.path()), sorted(&KEPT));
    }
}
