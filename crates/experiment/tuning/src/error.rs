//! Why a controller cannot be tuned.

use analysis::AnalysisError;
use formats::FileError;
use miette::Diagnostic;
use report::ReportError;
use search::SearchError;
use std::path::PathBuf;
use study::StudyError;
use thiserror::Error;

/// Why a controller cannot be tuned.
#[derive(Debug, Error, Diagnostic)]
pub enum TuningError {
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// A run cannot be made.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Study(Box<StudyError>),
    /// The search cannot go on.
    #[error("the search cannot go on: {0}")]
    #[diagnostic(help("change `variable`, `design` or `budget` of the study file"))]
    Search(#[from] SearchError),
    /// The folder holds a tuning.
    #[error("{} already holds a tuning", directory.display())]
    #[diagnostic(help("use --resume to go on with it, or another folder with -o"))]
    Begun {
        /// The folder.
        directory: PathBuf,
    },
    /// There is nothing to go on with.
    #[error("{} holds no tuning to resume", directory.display())]
    #[diagnostic(help("leave --resume out to begin one, or name its folder with -o"))]
    NothingToResume {
        /// The folder.
        directory: PathBuf,
    },
    /// The folder holds another tuning.
    #[error("{} holds a tuning of another {what}: {before} there, {now} in the study file", directory.display())]
    #[diagnostic(help("put the study file back, or tune into another folder with -o"))]
    Other {
        /// The folder.
        directory: PathBuf,
        /// What differs.
        what: &'static str,
        /// What it was.
        before: String,
        /// What it is now.
        now: String,
    },
    /// Records that are too short for a block.
    #[error("the analysed {analysed:.0} s of {} hold no block of {block:.0} s", path.display())]
    #[diagnostic(help("raise time.duration in the case, or lower `block` in the study file"))]
    NoBlock {
        /// The run.
        path: PathBuf,
        /// Time that is analysed (s).
        analysed: f64,
        /// Length of a block (s).
        block: f64,
    },
    /// A channel that a run does not have.
    #[error("{} has no channel {channel}", path.display())]
    #[diagnostic(help(
        "name another one in `loads.channels`; the header of series.csv lists them, without their units"
    ))]
    NoChannel {
        /// The series.
        path: PathBuf,
        /// The channel.
        channel: String,
    },
    /// Runs with other turbines.
    #[error("run {run} and its baseline {baseline} do not have the same turbines")]
    #[diagnostic(help("compare with a run in which the same turbines are there"))]
    OtherTurbines {
        /// Run that is tuned.
        run: String,
        /// The one that it compares with.
        baseline: String,
    },
    /// A cheaper source with other turbines.
    #[error("the cheaper source {name} has the turbines {there}, and what is tuned has {here}")]
    #[diagnostic(help("give it the same turbines, by the same names in the same order"))]
    OtherSource {
        /// The source.
        name: String,
        /// Its turbines.
        there: String,
        /// Those of the case that is tuned.
        here: String,
    },
    /// Numbers of a run that cannot be worked out.
    #[error("{} cannot be compared with its baseline: {source}", path.display())]
    Analysis {
        /// The run.
        path: PathBuf,
        /// Why.
        source: AnalysisError,
    },
    /// Figures cannot be drawn.
    #[error("the page cannot be made")]
    Report(#[from] ReportError),
}

impl From<StudyError> for TuningError {
    fn from(error: StudyError) -> Self {
        Self::Study(Box::new(error))
    }
}
