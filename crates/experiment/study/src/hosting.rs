//! Shared libraries as controllers in a study: who opens them, and whether they can begin.

use control::ControlError;
use control::library::{ANEMOMETER, LibraryError};
use farm::assemble::{AssemblyError, TurbineModel, site};
use farm::case::{Case, Control, Placement, Run};
use farm::plan::Plan;
use formats::records::{self, RunFolder};
use host::Host;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// On return every library of `case`, whose paths are relative to `folder`, has who opens it.
pub(crate) fn attach(case: &mut Case, folder: &Path) {
    for run in &mut case.runs {
        for (control, placement) in run.control.iter_mut().zip(&case.turbines) {
            if control.kind().hosted(control).is_some() {
                control.libraries = Some(Arc::new(Host::new(folder, &placement.name)));
            }
        }
    }
}

/// `run` of `case`, whose paths are relative to `at`, with what its libraries write in `folder`.
pub(crate) fn recorded(case: &Case, at: &Path, run: &Run, folder: &RunFolder) -> Run {
    let mut run = run.clone();
    for (control, placement) in run.control.iter_mut().zip(&case.turbines) {
        if control.libraries.is_some() {
            let host = Host::new(at, &placement.name).with_outputs(folder.path());
            control.libraries = Some(Arc::new(host));
        }
    }
    run
}

/// SHA-256 of each library and of each input file that a run of `case` names, by its name; of those that can
/// be read.
pub(crate) fn digests(case: &Case, folder: &Path) -> BTreeMap<String, String> {
    let controls = case.runs.iter().flat_map(|run| &run.control);
    let hosted = controls.filter_map(|control| control.kind().hosted(control));
    let names = hosted.flat_map(|hosted| [Some(hosted.request.library), hosted.request.input]);
    let digest = |name: String| {
        let digest = records::sha256_of_file(&folder.join(&name), "the controller library").ok()?;
        Some((name, digest))
    };
    names.flatten().filter_map(digest).collect()
}

/// Whether the library of `control`, if there is one, sees the wind that it asks for, and can begin on the
/// turbine of `model` at `placement`: known now, not when its run begins after hours of others.
///
/// # Errors
/// [`AssemblyError::Control`].
pub(crate) fn check(
    control: &Control,
    placement: &Placement,
    model: &TurbineModel,
    (case, plan): (&Case, &Plan),
) -> Result<(), AssemblyError> {
    let (Some(hosted), Some(libraries)) = (control.kind().hosted(control), &control.libraries)
    else {
        return Ok(());
    };
    if let Some(name) = &hosted.anemometer
        && !placement.sensors.iter().any(|sensor| sensor.name == *name)
    {
        let turbine = &placement.name;
        let message = format!(
            "{} is to see the wind (records 24 and 27) through the sensor `{name}`, and {turbine} has none of that name: add sensors.{name} = {{ kind = \"{ANEMOMETER}\" }} to its [[turbine]], or set anemometer = \"none\" for a library that looks at no wind",
            hosted.request.library
        );
        return Err(ControlError::Library(LibraryError(message)).into());
    }
    Ok(control::discon::trial(&hosted, libraries, &site(model, case, plan))?)
}
