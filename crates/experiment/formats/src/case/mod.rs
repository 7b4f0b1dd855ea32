//! The case file: TOML in, a checked [`Case`] out, and an arrow at everything that is wrong.
//!
//! Every key stands once, in the table of `keys`: the reader checks against it, [`reference()`] prints
//! it and [`schema`] hands it to editors. Keys and overrides are documented in docs/case-file.md.

mod check;
mod document;
mod error;
mod findings;
mod instruments;
mod keys;
mod kinds;
mod momentum;
mod objection;
mod position;
mod reference;
mod section;
mod solver;
mod sources;
mod spelling;
mod text;
mod values;
mod wind;
mod write;

pub use error::{CaseError, Problem, ProblemKind};
pub use objection::objection;
pub use reference::{reference, schema};
pub(crate) use spelling::nearest;
pub use write::write;

use crate::atomic;
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
}

impl CaseFile {
    /// A case that stands in no file, checked as if it did: its text is what [`write()`] makes of it, and
    /// errors point there.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] with everything that is wrong in it.
    pub fn of(case: Case) -> Result<Self, CaseError> {
        let path = PathBuf::from("the case");
        let file = Self { text: String::new(), overrides: Vec::new(), path, case };
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
    Ok(CaseFile { case, text, overrides: overrides.to_vec(), path: path.to_owned() })
}

/// Reads the case file in `text`; errors call it `name`.
///
/// # Errors
/// [`CaseError::Invalid`] with everything that is wrong in it.
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Case, CaseError> {
    let (sources, document) = document::parse(name, text, overrides);
    document
        .and_then(|entries| check::check(&entries, text.len(), &sources))
        .map_err(|problems| CaseError::Invalid { name: name.to_owned(), problems })
}

/// What decides the bits of the run `run` of the case in `text`: SHA-256 of the case without what changes no
/// result, which is its description, threads, checkpoint interval, comparison and other runs. Of the bare
/// text when that is no case.
pub fn fingerprint(text: &str, run: &str) -> [u8; 32] {
    let decisive = parse("", text, &[]).map(|mut case| {
        case.description = None;
        case.flow.threads = None;
        case.output.checkpoint_interval = 300.0;
        for other in &mut case.runs {
            other.compare_with = None;
        }
        case.runs.retain(|other| other.name == run);
        write(&case)
    });
    sha2::Sha256::digest(decisive.as_deref().unwrap_or(text)).into()
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod wind_tests;
