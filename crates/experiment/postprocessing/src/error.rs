//! Why records give no answer.

use crate::seeds::SeedsError;
use analysis::AnalysisError;
use farm::assemble::AssemblyError;
use formats::atomic::FileError;
use formats::case::CaseError;
use formats::turbine_file::TurbineFileError;
use miette::Diagnostic;
use report::ReportError;
use std::path::PathBuf;
use thiserror::Error;

/// Why records give no answer.
#[derive(Debug, Error, Diagnostic)]
pub enum PostprocessingError {
    /// The case in the records cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] CaseError),
    /// The turbine in the records cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Turbine(#[from] TurbineFileError),
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// An estimator or a loop cannot be set up.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The records cannot be analysed.
    #[error("the records cannot be analysed")]
    Analysis(#[from] AnalysisError),
    /// Several studies tell no gains together.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Seeds(#[from] SeedsError),
    /// The report cannot be made.
    #[error("the report cannot be made")]
    Report(#[from] ReportError),
    /// No turbine of a run, or not the requested one, looks for a helix.
    #[error("{}", nobody(run, requested))]
    #[diagnostic(help("its turbines are {}; name one with --turbine", turbines.join(", ")))]
    NobodySeeks {
        /// Run.
        run: String,
        /// Turbine requested.
        requested: Option<String>,
        /// Turbines of the case.
        turbines: Vec<String>,
    },
    /// No helix comes from upstream.
    #[error(
        "no helix comes from upstream of {turbine} in run {run}: there is no phase to be found"
    )]
    NoHelix {
        /// Run.
        run: String,
        /// Turbine.
        turbine: String,
    },
    /// No run holds the true wind at a turbine's place.
    #[error("no run in {} holds the true wind at the place of {turbine}", directory.display())]
    #[diagnostic(help(
        "run the case with `output.lines_at = [\"{turbine}\"]` and a run in which {turbine} is absent and all upstream of it do as in this run, or name one with --truth"
    ))]
    NoTruth {
        /// Turbine.
        turbine: String,
        /// Folder of the study.
        directory: PathBuf,
    },
    /// No run joins a helix with an offset and compares with another.
    #[error("no run in {} joins a helix with an offset and compares with another", directory.display())]
    #[diagnostic(help(
        "give a turbine `kind = \"phase-sync\"` with an `amplitude_deg` above 0, and its run a `compare_with`"
    ))]
    NoOffsets {
        /// Folder of the study.
        directory: PathBuf,
    },
    /// Something set that is not understood.
    #[error("--{setting} {given}: {expected}")]
    #[diagnostic(help("{fix}"))]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// What was given.
        given: String,
        /// What was expected.
        expected: &'static str,
        /// What to write.
        fix: &'static str,
    },
    /// A series lacks a channel.
    #[error("the series has no channel `{channel}`")]
    #[diagnostic(help("the file is of another version; run the case again"))]
    MissingChannel {
        /// Channel.
        channel: String,
    },
}

fn nobody(run: &str, requested: &Option<String>) -> String {
    match requested {
        Some(name) => format!("run {run} has no turbine called `{name}`"),
        None => format!("no turbine of run {run} looks for a helix"),
    }
}
