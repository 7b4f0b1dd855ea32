//! Linear control laws that a case names by their files.

use control::LinearLaw;
use farm::case::Case;
use formats::FileError;
use formats::linear_model::LinearModel;
use formats::records;
use lti::Recursion;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What such a file holds, in words.
const WHAT: &str = "a control law";
/// How to have one.
const FIX: &str = "name the controller that `wakemix synthesize` wrote, with an interval and as many inputs and outputs as the loop has";

/// On return every control of `case` that runs a linear law has it; paths are relative to `folder`.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or that holds no law in discrete time of two errors and two
/// commands.
pub(crate) fn attach(case: &mut Case, folder: &Path) -> Result<(), FileError> {
    for control in case.runs.iter_mut().flat_map(|run| &mut run.control) {
        if let Some(file) = control.kind().linear_law(control) {
            control.linear_law = Some(Arc::new(law(file, folder)?));
        }
    }
    Ok(())
}

/// SHA-256 of each file that a run of `case` names, by its name; of those that can be read.
pub(crate) fn digests(case: &Case, folder: &Path) -> BTreeMap<String, String> {
    let controls = case.runs.iter().flat_map(|run| &run.control);
    let names = controls.filter_map(|control| control.kind().linear_law(control));
    let digest = |name: String| {
        Some((name.clone(), records::sha256_of_file(&folder.join(name), WHAT).ok()?))
    };
    names.filter_map(digest).collect()
}

fn law(file: String, folder: &Path) -> Result<LinearLaw, FileError> {
    let path = folder.join(&file);
    let model = LinearModel::read(&path)?;
    let refused = |problem: String| FileError::content(WHAT, &path, problem, FIX);
    let sizes = [model.inputs.len(), model.outputs.len()];
    if sizes != [2, 2] {
        let [inputs, outputs] = sizes;
        return Err(refused(format!("it has {inputs} inputs and {outputs} outputs, not 2 and 2")));
    }
    let Some(interval) = model.interval_s else {
        return Err(refused("it is in continuous time: `interval_s` is missing".to_owned()));
    };
    let LinearModel { a, b, c, d, k, .. } = model;
    let recursion = Recursion::new(&a, &b, &c, &d);
    let recursion = match k {
        Some(gain) => recursion.with_back_calculation(&gain),
        None => recursion,
    };
    Ok(LinearLaw { file, recursion, interval })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_law_of_two_errors_is_told_with_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let model = LinearModel::new(
            "one".to_owned(),
            None,
            [Vec::new(), Vec::new()],
            [Vec::new(), Vec::new(), Vec::new(), Vec::new()],
        );
        model.write(&folder.path().join("law.json")).unwrap();
        let said = law("law.json".to_owned(), folder.path()).unwrap_err().to_string();
        assert!(said.contains("law.json") && said.contains("not 2 and 2"), "{said}");
    }
}
