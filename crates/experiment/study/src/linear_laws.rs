//! Linear control laws that a case names by their files.

use basis::records::ControlSetting;
use control::lidar_loop::MEAN_HUB_VORTEX;
use control::{Control, LawFiles, LinearLaw, LinearLaws};
use farm::case::{Case, Placement, Run};
use formats::FileError;
use formats::linear_model::{LinearModel, Port};
use formats::records::{self, RunFolder};
use formats::shipped;
use lti::Recursion;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What such a file holds, in words.
const WHAT: &str = "a control law";
/// How to have one.
const FIX: &str = "name the controller that `wakemix synthesize` wrote from a model in samples, of tilt and yaw (deg) and the hub vortex (m)";
/// Share of an interval by which two may differ and count as one (–).
const SAME_INTERVAL: f64 = 1e-6;
/// Keys that decide what the hub vortex' place in the helix frame is.
const FRAME: [&str; 8] = [
    "sense",
    "strouhal",
    "phase_deg",
    "azimuth_offset_deg",
    "vortex_filter",
    "vortex_interval",
    "vortex_centre",
    "lidar",
];
/// How names of the two components end, in the order of the loop.
const ENDINGS: [[&str; 2]; 2] = [["tilt", "up"], ["yaw", "right"]];

/// SHA-256 of the files of laws by their names.
pub(crate) type LawDigests = BTreeMap<String, String>;

/// On return every control of `case` that runs a linear law has it, with its reference where that is of a run
/// which is complete; paths are relative to `folder`. Gives what the laws' files were.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or that holds no law in discrete time of two errors (m) and
/// two commands (deg), and for a run of reference that does not tell of the turbine's hub vortex.
pub(crate) fn attach(case: &mut Case, folder: &Path) -> Result<LawDigests, FileError> {
    let mut digests = LawDigests::new();
    for run in &mut case.runs {
        for control in &mut run.control {
            let Some(files) = control.kind().law_files(control) else { continue };
            let (laws, interval) = family(&files.laws, folder, &mut digests)?;
            let laws = LinearLaws { laws, interval, reference: None };
            control.linear_laws = Some(Arc::new(laws));
        }
        *run = referred(run, &case.turbines, folder)?;
    }
    Ok(digests)
}

/// `run`, which controls `turbines` with its laws [attached](attach), with the references that complete runs
/// of reference have left by now, and none of a run that is not complete, whatever it told before.
///
/// # Errors
/// [`FileError`] for one that does not tell of the turbine's hub vortex.
pub(crate) fn referred(run: &Run, turbines: &[Placement], folder: &Path) -> Result<Run, FileError> {
    let mut run = run.clone();
    for (control, turbine) in run.control.iter_mut().zip(turbines) {
        let Some(reference_run) = reference_run(control) else { continue };
        let reference = if RunFolder::new(folder, &reference_run).is_complete() {
            let own = ControlSetting::all(control.values());
            Some(mean_hub_vortex(&reference_run, folder, (&turbine.name, &own))?)
        } else {
            None
        };
        if let Some(laws) = &mut control.linear_laws {
            Arc::make_mut(laws).reference = reference;
        }
    }
    Ok(run)
}

/// The folder of the run that `control` takes its reference from, as the case has it.
pub(crate) fn reference_run(control: &Control) -> Option<String> {
    control.kind().law_files(control)?.reference_run
}

/// That a run needs the run of reference in `folder`, which is not complete, and which nobody is about to
/// make.
pub(crate) fn not_complete(folder: &Path, run: &str) -> FileError {
    let problem = format!("{run} takes its reference from this run, which is not complete");
    let fix = "make it first, with `wakemix run CASE --run STUDY/RUN` into this folder, or name the folder of another one with `reference_run`";
    FileError::content("a run of reference", folder, problem, fix)
}

/// `control` as it can be built before its run of reference is made: with its laws at rest about nothing.
pub(crate) fn for_a_check(control: &mut Control) {
    if reference_run(control).is_some()
        && let Some(laws) = &mut control.linear_laws
    {
        Arc::make_mut(laws).reference.get_or_insert([0.0; 2]);
    }
}

/// What decides the laws of `run`, to which they are [attached](attach), by names: each law's file as it was
/// in `digests`, and the reference (m) that each of the `turbines` has of a run, by that one's folder and the
/// turbine. That run's own files may change, such as by making it again with the same result.
pub(crate) fn deciding(run: &Run, turbines: &[Placement], digests: &LawDigests) -> LawDigests {
    let mut deciding = LawDigests::new();
    for (control, turbine) in run.control.iter().zip(turbines) {
        let Some(LawFiles { laws, reference_run }) = control.kind().law_files(control) else {
            continue;
        };
        for law in laws {
            if let Some(sha256) = digests.get(&law) {
                deciding.insert(law, sha256.clone());
            }
        }
        let reference = control.linear_laws.as_ref().and_then(|laws| laws.reference);
        if let (Some(run), Some([tilt, yaw])) = (reference_run, reference) {
            deciding.insert(format!("{run} for {}", turbine.name), format!("{tilt} m, {yaw} m"));
        }
    }
    deciding
}

/// SHA-256 of each law's file of a `case` by its name, of those that can be read.
pub(crate) fn digests(case: &Case, folder: &Path) -> LawDigests {
    let controls = case.runs.iter().flat_map(|run| &run.control);
    let files = controls.filter_map(|control| control.kind().law_files(control));
    files
        .flat_map(|files| files.laws)
        .filter_map(|law| {
            let (_, sha256) = shipped::read_law(folder, &law).ok()?;
            Some((law, sha256))
        })
        .collect()
}

/// Mean of the hub vortex of a turbine in the helix frame (m), in the `run` that a case in `folder` names,
/// where it was followed as its `own` settings say.
fn mean_hub_vortex(
    run: &str,
    folder: &Path,
    (turbine, own): (&str, &[ControlSetting]),
) -> Result<[f64; 2], FileError> {
    let there = RunFolder::new(folder, run);
    let summary = records::read_summary(&there)?;
    let of_turbine = summary.turbines.iter().find(|other| other.name == turbine);
    let refused = |problem: String| {
        let fix = format!(
            "name the folder of a run in which {turbine} has `kind = \"probing\"` or `\"lidar-loop\"` with the helix and the filter of this one"
        );
        FileError::content("a run of reference", &there.summary_path(), problem, fix)
    };
    let settings = of_turbine.and_then(|other| other.control.settings.as_deref());
    for key in FRAME {
        let of = |settings: &[ControlSetting]| {
            settings.iter().find(|other| other.key == key).map(|other| other.value.clone())
        };
        let there = settings.and_then(of);
        if let (Some(there), Some(own)) = (there, of(own))
            && there != own
        {
            return Err(refused(format!("`{key}` of {turbine} was another there")));
        }
    }
    let findings = of_turbine.map_or(&[][..], |other| &other.control.findings);
    let means = MEAN_HUB_VORTEX.map(|name| {
        findings.iter().find(|finding| finding.name == name).and_then(|finding| finding.value)
    });
    match means {
        [Some(tilt), Some(yaw)] => Ok([tilt, yaw]),
        _ => Err(refused(format!("it tells of no hub vortex of {turbine}"))),
    }
}

/// The laws in `files` and the time between their samples (s), which is that of them all; each file's SHA-256
/// goes into `digests`.
fn family(
    files: &[String],
    folder: &Path,
    digests: &mut LawDigests,
) -> Result<(Vec<LinearLaw>, f64), FileError> {
    let mut laws: Vec<LinearLaw> = Vec::with_capacity(files.len());
    let mut common: Option<f64> = None;
    for file in files {
        let (law, interval, sha256) = law(file, folder)?;
        digests.insert(file.clone(), sha256);
        let refused = |problem: String, fix: &str| {
            Err(FileError::content(WHAT, &folder.join(file), problem, fix))
        };
        let first = *common.get_or_insert(interval);
        if (interval - first).abs() > SAME_INTERVAL * first {
            let problem = format!(
                "`interval_s` is {interval}, that of {} is {first}: laws that are blended sample at the same instants",
                files[0]
            );
            return refused(problem, "make all laws of the family from models of one interval");
        }
        if files.len() > 1 && !law.recursion.learns_of_limits() {
            let problem = "it has no `K`, by which a law of a family learns of the command that is applied in the place of its own".to_owned();
            return refused(problem, "make it with `wakemix synthesize`, which writes one");
        }
        laws.push(law);
    }
    // A kind that has files has one or more.
    Ok((laws, common.unwrap_or(f64::NAN)))
}

/// The law in `file`, the time between its samples (s), and the file's SHA-256.
fn law(file: &str, folder: &Path) -> Result<(LinearLaw, f64, String), FileError> {
    let path = folder.join(file);
    let (model, sha256) = shipped::read_law(folder, file)?;
    let refused = |problem: String| FileError::content(WHAT, &path, problem, FIX);
    let errors =
        places(&model.inputs, "m").map_err(|found| refused(format!("`inputs` {found}")))?;
    let commands =
        places(&model.outputs, "deg").map_err(|found| refused(format!("`outputs` {found}")))?;
    let Some(interval) = model.interval_s else {
        return Err(refused("it is in continuous time: `interval_s` is missing".to_owned()));
    };
    let LinearModel { a, b, c, d, k, .. } = model;
    let columns = |rows: Vec<Vec<f64>>, order: [usize; 2]| -> Vec<Vec<f64>> {
        rows.iter().map(|row| order.map(|place| row[place]).to_vec()).collect()
    };
    let rows = |rows: Vec<Vec<f64>>| commands.map(|place| rows[place].clone()).to_vec();
    let recursion = Recursion::new(&a, &columns(b, errors), &rows(c), &rows(columns(d, errors)));
    let recursion = match k {
        Some(gain) => recursion.with_back_calculation(&columns(gain, commands)),
        None => recursion,
    };
    Ok((LinearLaw { file: file.to_owned(), recursion }, interval, sha256))
}

/// Where tilt and yaw are among `ports`, which are in `unit`.
///
/// # Errors
/// What is there instead, in words.
fn places(ports: &[Port], unit: &str) -> Result<[usize; 2], String> {
    let names: Vec<String> =
        ports.iter().map(|Port { name, unit }| format!("{name} ({unit})")).collect();
    let found = ENDINGS.map(|endings| {
        let is_it = |port: &Port| {
            let name = port.name.to_lowercase();
            port.unit == unit && endings.iter().any(|ending| name.ends_with(ending))
        };
        ports.iter().position(is_it)
    });
    match (found, ports.len()) {
        ([Some(tilt), Some(yaw)], 2) => Ok([tilt, yaw]),
        _ => Err(format!(
            "are {}, where one that ends in tilt or up and one that ends in yaw or right are expected, both in {unit}",
            if names.is_empty() { "none".to_owned() } else { names.join(", ") }
        )),
    }
}

#[cfg(test)]
mod tests;
