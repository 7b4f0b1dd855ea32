//! What is asked of a study, and how it ended.

use basis::records::Summary;
use std::path::PathBuf;

/// What to run, and where the results go.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyOptions {
    /// Case file, or the name of a shipped case.
    pub case: PathBuf,
    /// Folder for the results; `runs/NAME-OF-THE-CASE` when absent.
    pub output: Option<PathBuf>,
    /// Runs to make; all when empty.
    pub runs: Vec<String>,
    /// Overrides of the case's keys, `key.path=value`.
    pub overrides: Vec<String>,
    /// Continue what is there.
    pub resume: bool,
    /// Replace old results.
    pub overwrite: bool,
    /// Say what it would cost, and stop.
    pub dry_run: bool,
    /// In a dry run, check the rotors as well, as a run does before it begins.
    pub check: bool,
    /// Runs to make at a time; as many as cores and memory carry when absent.
    pub jobs: Option<usize>,
    /// Threads of a run whose case does not say; when absent all cores, which runs at a time share.
    pub threads: Option<usize>,
    /// The rotors were checked in another study, with the same cells and wind: they are only timed.
    pub is_checked: bool,
    /// Winds in which every run is made, of as many seeds of the turbulence: a sweep of `wind.seed`.
    pub seeds: Option<usize>,
}

/// How a study ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// All runs that were asked for are complete.
    Done {
        /// Their summaries, and those of runs that were complete before.
        summaries: Vec<Summary>,
        /// Folder of the results.
        directory: PathBuf,
    },
    /// The cost was reported, nothing was run.
    Estimated,
    /// Stopped on request; it can be resumed.
    Interrupted {
        /// Folder of the results.
        directory: PathBuf,
    },
}
