//! Whether records on disk are those of the case at hand.

use crate::StudyError;
use crate::atmosphere;
use crate::inputs::wind_digest;
use crate::prepared::Prepared;
use farm::case::Run;
use farm::wind::Site;
use formats::case::{self, Difference};
use formats::records::{self, Manifest, RunFolder};
use std::collections::BTreeMap;

/// SHA-256 of each file of wind that a case reads, by its path as the case names it.
pub(crate) type WindDigests = BTreeMap<String, String>;

/// What is in the folder of a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Standing {
    /// Nothing that a manifest tells of, or what was made with this very case.
    Same,
    /// What was made with this very case, but for a shorter time (s).
    Shorter(f64),
}

/// What is in `folder`, made with this very case, these very turbines and controllers, and files of `wind`
/// like these, if for a shorter time.
///
/// # Errors
/// [`StudyError::OtherCase`] names what differs, [`StudyError::OtherFile`] and [`StudyError::UntoldWind`] the
/// file.
pub(crate) fn standing(
    prepared: &Prepared,
    wind: &WindDigests,
    run: &Run,
    folder: &RunFolder,
) -> Result<Standing, StudyError> {
    if !folder.manifest_path().exists() {
        return Ok(Standing::Same);
    }
    let manifest = records::read_manifest(folder)?;
    let (name, directory) = (run.name.clone(), folder.path().to_owned());
    let standing = match case_standing(prepared, &manifest, run) {
        Ok(standing) => standing,
        Err(differences) => {
            return Err(StudyError::OtherCase { run: name, directory, differences });
        }
    };
    let machines = prepared.machine_digests(&prepared.referred(run)?);
    if let Some((file, sha256)) = another(&manifest.turbines_sha256, &machines) {
        return Err(StudyError::OtherFile { run: name, directory, file, sha256 });
    }
    match another(&manifest.wind_sha256, wind) {
        None => Ok(standing),
        Some((file, _)) if manifest.wind_sha256.is_empty() => {
            Err(StudyError::UntoldWind { run: name, directory, file })
        }
        Some((file, sha256)) => Err(StudyError::OtherFile { run: name, directory, file, sha256 }),
    }
}

/// How the case of `manifest` stands to that of `prepared`; errs with what differs.
fn case_standing(
    prepared: &Prepared,
    manifest: &Manifest,
    run: &Run,
) -> Result<Standing, Vec<Difference>> {
    let (before, now) = (&manifest.case_text, &prepared.case_text);
    if case::fingerprint(before, &run.name) == case::fingerprint(now, &run.name) {
        return Ok(Standing::Same);
    }
    let differences = case::differences(before, now, &run.name);
    if let [Difference { key, before: Some(before), .. }] = differences.as_slice()
        && key == "time.duration"
        && let Ok(before) = before.parse::<f64>()
        && before < prepared.case.time.duration
    {
        return Ok(Standing::Shorter(before));
    }
    Err(differences)
}

/// Nothing where what is in `folder` was made with this very case, these very turbines and controllers, and
/// files of `wind` like these.
///
/// # Errors
/// Those of [`standing`], [`StudyError::OtherCase`] for a shorter time, too.
pub(crate) fn check_same(
    prepared: &Prepared,
    wind: &WindDigests,
    run: &Run,
    folder: &RunFolder,
) -> Result<(), StudyError> {
    let Standing::Shorter(before) = standing(prepared, wind, run, folder)? else { return Ok(()) };
    let words = |duration: f64| Some(duration.to_string());
    let differences = vec![Difference {
        key: "time.duration".to_owned(),
        before: words(before),
        now: words(prepared.case.time.duration),
    }];
    let (run, directory) = (run.name.clone(), folder.path().to_owned());
    Err(StudyError::OtherCase { run, directory, differences })
}

/// Nothing where what is in `folder`, made for the time `before` (s), can go on to the end of `run`.
///
/// # Errors
/// [`StudyError::NotLengthened`] says what prevents it.
pub(crate) fn check_longer(
    prepared: &Prepared,
    run: &Run,
    folder: &RunFolder,
    before: f64,
) -> Result<(), StudyError> {
    let reason = if !folder.checkpoint_path().exists() {
        if !folder.is_complete() {
            // It begins at time zero.
            return Ok(());
        }
        "it left no checkpoint at its end".to_owned()
    } else {
        let mut shorter = prepared.case.clone();
        shorter.time.duration = before;
        let site = prepared.site();
        let boxes = [&shorter, site.case]
            .map(|case| farm::wind::turbulence(&Site { case, ..site }).map(|t| t.n_points));
        match boxes {
            [Some(before), Some(now)] if before != now => format!(
                "its turbulence is in a box that is as long as the run, of {} points, and that of the longer run, of {}, is another wind",
                product(before),
                product(now)
            ),
            _ => return Ok(()),
        }
    };
    let (run, directory) = (run.name.clone(), folder.path().to_owned());
    let now = prepared.case.time.duration;
    Err(StudyError::NotLengthened { run, directory, before, now, reason })
}

/// Numbers of points along, across and up, in words.
fn product([along, across, up]: [usize; 3]) -> String {
    format!("{along} × {across} × {up}")
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
    /// SHA-256 of turbine files, of controllers' inputs, of shared libraries and of what decides the linear
    /// laws of `run`, by their names.
    fn machine_digests(&self, run: &Run) -> BTreeMap<String, String> {
        let texts = self.turbine_texts.iter();
        let texts = texts.map(|(name, text)| (name.clone(), records::sha256(text.as_bytes())));
        texts.chain(self.libraries_of(run)).collect()
    }

    /// SHA-256 of each file of wind that the case reads, as the files are now: by their
    /// [digests](wind_digest).
    ///
    /// # Errors
    /// [`StudyError::File`] for one that cannot be read.
    pub(crate) fn wind_digests(&self) -> Result<WindDigests, StudyError> {
        let mut digests = BTreeMap::new();
        if let Some(name) = &self.case.wind.table {
            let digest = wind_digest(&self.folder().join(name))?;
            digests.insert(name.clone(), digest);
        }
        for path in atmosphere::files(&self.case, self.folder())? {
            let named = path.strip_prefix(self.folder()).unwrap_or(&path);
            let digest = wind_digest(&path)?;
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
