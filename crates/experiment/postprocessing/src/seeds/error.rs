//! Why studies do not belong together.

use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// Why several studies tell no gains together.
#[derive(Clone, Debug, Error, Diagnostic, PartialEq)]
pub enum SeedsError {
    /// An interval over one study.
    #[error("gains over several winds need two studies or more, not {n_studies}")]
    #[diagnostic(help(
        "name the folders of studies of one case in several winds, as `wakemix run CASE --set wind.seed=2 -o DIR` makes them"
    ))]
    TooFew {
        /// Studies given (–).
        n_studies: usize,
    },
    /// No run compares with another.
    #[error("no run in {} compares with another that is there", folder.display())]
    #[diagnostic(help(
        "complete the study with --resume: gains are over the run that `compare_with` names, the first when it is left out"
    ))]
    NoGains {
        /// Folder of the study.
        folder: PathBuf,
    },
    /// Gains of a run that is in some studies only.
    #[error("{} has no gains of {}", folder.display(), missing.join(", "))]
    #[diagnostic(help("{}", common_help(common)))]
    Runs {
        /// Folder of the study.
        folder: PathBuf,
        /// Runs that it lacks, or that lack the run which they compare with.
        missing: Vec<String>,
        /// Runs whose gains all studies have.
        common: Vec<String>,
    },
    /// Other turbines.
    #[error("run {run} has the turbines {} and {}", turbines[0], turbines[1])]
    #[diagnostic(help("name studies of one case; only wind.seed may differ"))]
    Turbines {
        /// Run.
        run: String,
        /// Turbines and folder of either study, in words.
        turbines: [String; 2],
    },
    /// Another case.
    #[error(
        "run {run} in {} was made of another case, or of other turbines, than in {}",
        folders[0].display(), folders[1].display()
    )]
    #[diagnostic(help("name studies of one case; only wind.seed may differ"))]
    Cases {
        /// Run.
        run: String,
        /// Folders of the two studies.
        folders: [PathBuf; 2],
    },
    /// One wind twice.
    #[error(
        "{} and {} have the same wind, seed {seed}",
        folders[0].display(), folders[1].display()
    )]
    #[diagnostic(help("name each study once; another wind is made with --set wind.seed=N -o DIR"))]
    SameWind {
        /// Seed of both.
        seed: u64,
        /// Folders of the two studies.
        folders: [PathBuf; 2],
    },
}

fn common_help(common: &[String]) -> String {
    if common.is_empty() {
        "complete the study with --resume; the studies have no gains in common".to_owned()
    } else {
        let runs: Vec<String> = common.iter().map(|run| format!("--run {run}")).collect();
        format!("complete the study with --resume, or ask for what all have: {}", runs.join(" "))
    }
}
