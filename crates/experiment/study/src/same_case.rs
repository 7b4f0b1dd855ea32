//! Whether records on disk are those of the case at hand.

use crate::StudyError;
use crate::prepared::Prepared;
use farm::case::Run;
use formats::case;
use formats::records::{self, RunFolder};

/// Whether what is in `folder` was made with this very case, these very turbines and controllers.
pub(crate) fn check_same(
    prepared: &Prepared,
    run: &Run,
    folder: &RunFolder,
) -> Result<(), StudyError> {
    if !folder.manifest_path().exists() {
        return Ok(());
    }
    let manifest = records::read_manifest(folder)?;
    let same_case = case::fingerprint(&manifest.case_text, &run.name)
        == case::fingerprint(&prepared.case_text, &run.name);
    let same_turbines = prepared.turbine_texts.iter().all(|(name, text)| {
        manifest.turbines_sha256.get(name) == Some(&records::sha256(text.as_bytes()))
    });
    if same_case && same_turbines {
        Ok(())
    } else {
        Err(StudyError::OtherCase { run: run.name.clone(), directory: folder.path().to_owned() })
    }
}
