//! The case file: TOML in, a checked [`Case`] out, and an arrow at everything that is wrong.
//!
//! Every key stands once, in the table of `keys`: the reader checks against it, [`reference()`] prints
//! it and [`schema`] hands it to editors. Keys and overrides are documented in docs/case-file.md.

mod campaign;
mod check;
mod cut;
mod difference;
mod document;
mod error;
mod event;
mod findings;
mod grid;
mod instruments;
mod keys;
mod kinds;
mod momentum;
mod objection;
mod position;
mod precursor;
mod reference;
mod section;
mod solver;
mod sources;
mod spelling;
mod sweep;
mod text;
mod values;
mod wind;
mod write;

pub use campaign::{
    CampaignFile, Draw, Exclusion, Factor, Keep, Level, LevelSetting, Shipped, read_campaign,
};
pub use difference::{Difference, differences};
pub use error::{CaseError, Problem, ProblemKind};
pub use objection::objection;
pub use precursor::{PrecursorFile, parse_precursor, read_precursor};
pub use reference::{precursor_reference, precursor_schema, reference, schema};
pub use solver::unused_flow_keys;
pub(crate) use spelling::nearest;
pub use write::write;

use crate::atomic;
use basis::records::Sweep;
use document::Entry;
use farm::case::Case;
use sha2::Digest;
use std::path::{Path, PathBuf};

/// A case with the file that it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseFile {
    /// The case, overrides applied.
    pub case: Case,
    /// The file's text, without overrides.
    pub text: String,
    /// Overrides that were applied, in order.
    pub overrides: Vec<String>,
    /// The file.
    pub path: PathBuf,
    /// Which of the studies of its sweep, from 0; 0 without one.
    pub study: usize,
}

/// The cases that a file makes.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseFiles {
    /// One for each study; only one without a sweep of keys that make studies.
    pub files: Vec<CaseFile>,
    /// What is swept; none where nothing is.
    pub sweep: Option<Sweep>,
}

impl CaseFile {
    /// A case that stands in no file, checked as if it did: its text is what [`write()`] makes of it, and
    /// errors point there.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] with everything that is wrong in it.
    pub fn of(case: Case) -> Result<Self, CaseError> {
        let path = PathBuf::from("the case");
        let file = Self { text: String::new(), overrides: Vec::new(), path, case, study: 0 };
        if let Some(message) = misfit(&file.case) {
            return Err(objection(&file, &[], message));
        }
        let text = write(&file.case);
        parse("the case", &text, &[])?;
        Ok(Self { text, ..file })
    }

    /// Folder that paths in the case are relative to.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }
}

/// What of `case` no file could say: places of turbines that are not there, and controls for more or fewer
/// than there are.
fn misfit(case: &Case) -> Option<String> {
    let n_turbines = case.turbines.len();
    let run = case.runs.iter().find(|run| run.control.len() != n_turbines);
    if let Some(run) = run {
        let n_controls = run.control.len();
        let name = &run.name;
        return Some(format!(
            "run {name} has {n_controls} controls for {n_turbines} turbines; give one for each, in their order"
        ));
    }
    let mut places = case.output.lines_at.iter().chain(&case.output.inflow_at);
    places.find(|&&place| place >= n_turbines).map(|place| {
        format!(
            "output names turbine number {place}, and the case has {n_turbines}; the first is number 0"
        )
    })
}

/// Reads the case file at `path` and applies `overrides`, each `key.path=value` such as `wind.speed=8`.
///
/// Tables under one heading are picked by number from 0 or by name: `turbine.0.model=iea-22mw`,
/// `run.helix.control.T1.amplitude_deg=3`. Text needs no quotes.
///
/// # Errors
/// [`CaseError::File`] when the file cannot be read, [`CaseError::Invalid`] with everything that is wrong in
/// it.
pub fn read(path: &Path, overrides: &[String]) -> Result<CaseFile, CaseError> {
    let text = atomic::read_text(path, "the case file")?;
    let case = parse(&path.display().to_string(), &text, overrides)?;
    Ok(CaseFile { case, text, overrides: overrides.to_vec(), path: path.to_owned(), study: 0 })
}

/// The same of a file that may sweep keys which make studies.
///
/// # Errors
/// Those of [`read`].
pub fn read_all(path: &Path, overrides: &[String]) -> Result<CaseFiles, CaseError> {
    let text = atomic::read_text(path, "the case file")?;
    of_text(path, text, overrides)
}

/// The same of the `text` of a file that would stand at `path`.
pub(crate) fn of_text(
    path: &Path,
    text: String,
    overrides: &[String],
) -> Result<CaseFiles, CaseError> {
    let (cases, sweep) = parse_all(&path.display().to_string(), &text, overrides)?;
    let file = |(study, case)| {
        let (text, overrides) = (text.clone(), overrides.to_vec());
        CaseFile { case, text, overrides, path: path.to_owned(), study }
    };
    Ok(CaseFiles { files: cases.into_iter().enumerate().map(file).collect(), sweep })
}

/// Reads the case file in `text`; errors call it `name`.
///
/// # Errors
/// [`CaseError::Invalid`] with everything that is wrong in it, and for a file that makes several studies.
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Case, CaseError> {
    let (cases, sweep) = parse_all(name, text, overrides)?;
    match <[Case; 1]>::try_from(cases) {
        Ok([case]) => Ok(case),
        Err(_) => Err(several(name, text, overrides, sweep)),
    }
}

/// Reads all cases of the file in `text`, and what is swept in it.
///
/// # Errors
/// [`CaseError::Invalid`] with everything that is wrong in it; of several studies with the same fault, of the
/// first.
pub fn parse_all(
    name: &str,
    text: &str,
    overrides: &[String],
) -> Result<(Vec<Case>, Option<Sweep>), CaseError> {
    let invalid = |problems| CaseError::Invalid { name: name.to_owned(), problems };
    let (sources, document) = document::parse(name, text, overrides);
    let expanded = document.and_then(|entries| sweep::expand(entries, text.len(), &sources));
    let expanded = expanded.map_err(invalid)?;
    let check = |entries: &Vec<Entry>| check::check(entries, text.len(), &sources);
    let cases: Result<Vec<Case>, Vec<Problem>> = expanded.studies.iter().map(check).collect();
    let cases = cases.map_err(invalid)?;
    let (base, replaced) = &expanded.replaced;
    let mut problems =
        if base.is_empty() { Vec::new() } else { check(base).err().unwrap_or_default() };
    problems.retain(|problem| replaced.iter().any(|place| problem.stands_in(place)));
    if !problems.is_empty() {
        return Err(invalid(problems));
    }
    if let Some(sweep) = &expanded.sweep {
        sweep::check_seeds(sweep, &cases, &sources).map_err(invalid)?;
    }
    Ok((cases, expanded.sweep))
}

/// That the file in `text` makes the several studies of `sweep`, where one is asked for.
fn several(name: &str, text: &str, overrides: &[String], sweep: Option<Sweep>) -> CaseError {
    let path = PathBuf::from(name);
    let keys = sweep.map_or(Vec::new(), |sweep| sweep.keys);
    let keys = keys.into_iter().filter(|key| key.of_studies).map(|key| key.key);
    let keys = keys.collect::<Vec<_>>().join(", ");
    let message = format!(
        "[sweep] of {keys} makes several studies; take one of them: without these lists, and the keys set"
    );
    let (sources, document) = document::parse(&path.display().to_string(), text, overrides);
    let span = document.ok().and_then(|entries| {
        let sweep = entries.iter().find(|entry| entry.key == "sweep")?;
        Some(sweep.key_span.clone())
    });
    let kind = ProblemKind::Unfit { message };
    let problem = Problem::new(&sources, span.unwrap_or(0..0), kind);
    CaseError::Invalid { name: name.to_owned(), problems: vec![problem] }
}

/// The override that has the cases of `file` met in `n_seeds` winds: those of their own seed and the ones
/// that follow.
///
/// # Errors
/// [`CaseError`] for a case that sweeps `wind.seed` already.
pub fn seeds_override(file: &CaseFiles, n_seeds: usize) -> Result<String, CaseError> {
    let is_seed = |key: &&basis::records::SweptKey| key.key == sweep::SEED;
    if let Some(sweep) = &file.sweep
        && sweep.keys.iter().any(|key| is_seed(&key))
    {
        let message = "`wind.seed` is swept already, so that --seeds has no effect; leave one out";
        return Err(objection(&file.files[0], &["sweep"], message.to_owned()));
    }
    let first = file.files[0].case.wind.seed;
    let seeds: Vec<String> = (first..).take(n_seeds).map(|seed| seed.to_string()).collect();
    Ok(format!("sweep.wind.seed=[{}]", seeds.join(", ")))
}

/// The case in `text` with its run `run` alone, without what changes no result: description, threads,
/// checkpoints and comparison. None when that is no case.
fn decisive(text: &str, run: &str) -> Option<Case> {
    let mut case = bare(parse("", text, &[]).ok()?);
    for other in &mut case.runs {
        other.compare_with = None;
    }
    case.runs.retain(|other| other.name == run);
    Some(case)
}

/// `case` without description, threads and checkpoints.
fn bare(mut case: Case) -> Case {
    case.description = None;
    case.flow.threads = None;
    case.output.checkpoint_interval = 300.0;
    case.output.keeps_checkpoint = true;
    case
}

/// What decides the results of all runs of `case`, as a file: the case without description, threads and
/// checkpoints.
pub fn decisive_text(case: &Case) -> String {
    write(&bare(case.clone()))
}

/// What decides the bits of the run `run` of the case in `text`: SHA-256 of the case without what changes no
/// result, which is its description, threads, checkpoints, comparison and other runs. Of the bare text when
/// that is no case.
pub fn fingerprint(text: &str, run: &str) -> [u8; 32] {
    let decisive = decisive(text, run).map(|case| write(&case));
    sha2::Sha256::digest(decisive.as_deref().unwrap_or(text)).into()
}

/// The same but for the time at which the run ends: what decides the bits of its state at any time before.
pub fn fingerprint_of_state(text: &str, run: &str) -> [u8; 32] {
    let decisive = decisive(text, run).map(|mut case| {
        case.time.duration = f64::INFINITY;
        write(&case)
    });
    sha2::Sha256::digest(decisive.as_deref().unwrap_or(text)).into()
}

#[cfg(test)]
mod sweep_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod wind_tests;
