//! What is asked of a tuning, and what came of it.

use crate::{Compromise, TuningFile};
use search::Found;
use std::path::PathBuf;

/// What to tune, and where its runs go.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TuneOptions {
    /// The study file.
    pub study: PathBuf,
    /// Folder for runs and results; `runs/NAME-OF-THE-FILE` when absent.
    pub output: Option<PathBuf>,
    /// Go on with what is there.
    pub resume: bool,
    /// Say what it would cost, and stop.
    pub dry_run: bool,
}

/// What a tuning will cost at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Runs still to be made, baselines among them (–).
    pub n_runs: usize,
    /// Wall time of one of them (s), where the machine's speed could be measured.
    pub time_of_one: Option<f64>,
    /// Runs at a time (–).
    pub n_at_a_time: usize,
    /// Memory of a run (bytes).
    pub memory: u64,
    /// Disk of a run (bytes).
    pub disk: u64,
    /// That of each cheaper source, by its name, made before.
    pub cheaper: Vec<(String, Cost)>,
}

/// What was found.
#[derive(Debug)]
pub struct Tuned {
    /// What was asked.
    pub file: TuningFile,
    /// Turbines whose power counts, in the order of the outputs.
    pub turbines: Vec<String>,
    /// The search.
    pub found: Found,
    /// Power against each load that is followed.
    pub compromises: Vec<Compromise>,
    /// Folder of runs and results.
    pub directory: PathBuf,
    /// The page.
    pub page: PathBuf,
}

/// How a tuning ended.
#[derive(Debug)]
pub enum TuneOutcome {
    /// With an optimum.
    Done(Box<Tuned>),
    /// The cost was reckoned, nothing was run.
    Estimated(Cost),
    /// Stopped on request; it can be resumed.
    Interrupted {
        /// Folder of the runs.
        directory: PathBuf,
    },
}
