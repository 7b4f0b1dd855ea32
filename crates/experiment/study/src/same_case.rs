//! Whether records on disk are those of the case at hand.

use crate::StudyError;
use crate::prepared::Prepared;
use farm::case::Run;
use formats::case;
use formats::records::{self, RunFolder};
use std::collections::BTreeMap;

/// SHA-256 of each file of wind that a case reads, by its path as the case names it.
pub(crate) type WindDigests = BTreeMap<String, String>;

/// Whether what is in `folder` was made with this very case, these very turbines and controllers, and files
/// of `wind` like these.
///
/// # Errors
/// [`StudyError::OtherCase`], or [`StudyError::OtherFile`] names the file.
pub(crate) fn check_same(
    prepared: &Prepared,
    wind: &WindDigests,
    run: &Run,
    folder: &RunFolder,
) -> Result<(), StudyError> {
    if !folder.manifest_path().exists() {
        return Ok(());
    }
    let manifest = records::read_manifest(folder)?;
    let same_case = case::fingerprint(&manifest.case_text, &run.name)
        == case::fingerprint(&prepared.case_text, &run.name);
    let (run, directory) = (run.name.clone(), folder.path().to_owned());
    if !same_case {
        return Err(StudyError::OtherCase { run, directory });
    }
    let turbine = another(&manifest.turbines_sha256, &prepared.machine_digests());
    match turbine.or_else(|| another(&manifest.wind_sha256, wind)) {
        None => Ok(()),
        Some((file, sha256)) => Err(StudyError::OtherFile { run, directory, file, sha256 }),
    }
}

/// The first file of which `before` and `now` have not the same digest, with that of before; none where all
/// have.
pub(crate) fn another(
    before: &BTreeMap<String, String>,
    now: &BTreeMap<String, String>,
) -> Option<(String, Option<String>)> {
    let mut names = before.keys().chain(now.keys());
    let name = names.find(|name| before.get(*name) != now.get(*name))?;
    Some((name.clone(), before.get(name).cloned()))
}

impl Prepared {
    /// SHA-256 of turbine files, of controllers' inputs and of shared libraries, by their names.
    fn machine_digests(&self) -> BTreeMap<String, String> {
        let texts = self.turbine_texts.iter();
        let texts = texts.map(|(name, text)| (name.clone(), records::sha256(text.as_bytes())));
        texts.chain(self.libraries.clone()).collect()
    }

    /// SHA-256 of each file of wind that the case reads, as the files are now.
    ///
    /// # Errors
    /// [`StudyError::File`] for one that cannot be read.
    pub(crate) fn wind_digests(&self) -> Result<WindDigests, StudyError> {
        let mut digests = BTreeMap::new();
        if let Some(name) = &self.case.wind.table {
            let digest = records::sha256_of_file(&self.folder().join(name), "the table of wind")?;
            digests.insert(name.clone(), digest);
        }
        let Some(name) = self.case.wind.planes.as_ref() else { return Ok(digests) };
        for path in formats::turbulence_box::files(&self.folder().join(name))? {
            let named = path.strip_prefix(self.folder()).unwrap_or(&path);
            let digest = records::sha256_of_file(&path, "the file of wind")?;
            digests.insert(named.display().to_string(), digest);
        }
        Ok(digests)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digests(files: &[(&str, &str)]) -> BTreeMap<String, String> {
        files.iter().map(|&(name, digest)| (name.to_owned(), digest.to_owned())).collect()
    }

    #[test]
    fn a_file_that_came_went_or_changed_is_another() {
        let before = digests(&[("w.sum", "1"), ("w.wnd", "2")]);
        assert_eq!(another(&before, &before), None);
        let found = |now: &[(&str, &str)]| another(&before, &digests(now));
        let was = |digest: &str| Some(digest.to_owned());
        assert_eq!(found(&[("w.wnd", "2")]), Some(("w.sum".into(), was("1"))));
        assert_eq!(found(&[("w.sum", "1"), ("w.wnd", "3")]), Some(("w.wnd".into(), was("2"))));
        let more = [("v.wnd", "4"), ("w.sum", "1"), ("w.wnd", "2")];
        assert_eq!(found(&more), Some(("v.wnd".into(), None)));
    }
}
