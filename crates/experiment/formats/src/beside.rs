//! Files that a process writes beside their place: hidden, of a name of its own, and claimed.

use std::ffi::OsString;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Ends the name of a file that will be moved to its place when it is whole.
pub(crate) const PART: &str = "part";
/// Ends the name of rows that are gathered for a file.
pub(crate) const ROWS: &str = "rows";

/// Name beside `path`, hidden, of this process alone, ending in `ending`: `.NAME.PROCESS.ENDING`.
pub(crate) fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.{ending}", std::process::id()));
    path.with_file_name(name)
}

/// Says that `file`, [beside](beside) its place, is being written: it is locked until it is closed. Where
/// the file system knows no locks it is not, and its age alone guards it.
pub(crate) fn claim(file: &File) {
    // Nobody else opens a file of this process' name but to see whether it is claimed.
    let _ = file.try_lock();
}

/// The name of the file for which `name` was written beside it; none of other names.
pub(crate) fn meant(name: &str) -> Option<&str> {
    let name = name.strip_prefix('.')?;
    let (name, ending) = name.rsplit_once('.')?;
    let (name, process) = name.rsplit_once('.')?;
    let is_number = !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit());
    (is_number && !name.is_empty() && [PART, ROWS].contains(&ending)).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_beside_are_told_from_others() {
        let path = Path::new("out/box.bts");
        for ending in [PART, ROWS] {
            let beside = beside(path, ending);
            assert_eq!(beside.parent(), path.parent());
            let name = beside.file_name().unwrap().to_string_lossy();
            assert_eq!(meant(&name), Some("box.bts"));
        }
        for other in ["series.csv.part", ".hidden", ".notes.part", ".a.b1.part", ".12.part"] {
            assert_eq!(meant(other), None, "{other}");
        }
    }
}
