//! Why a run cannot go on from a checkpoint, and what to do then.

use thiserror::Error;

/// Version of the layout.
pub(super) const VERSION: u32 = 5;
/// The advice to begin a run again, as a literal, so that others can be put together with it.
macro_rules! anew {
    () => {
        "start the run anew: --run NAME --overwrite in place of --resume"
    };
}

/// What to do where a run cannot go on from what it left.
pub(crate) const ANEW: &str = anew!();
/// What is wrong where a file that a checkpoint goes on with is not there.
pub(crate) const GONE: &str =
    "it is gone, and without it the run cannot go on from the checkpoint beside it";

/// What is wrong with a checkpoint.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CheckpointProblem {
    /// Some other file.
    #[error("it is not a checkpoint")]
    NoCheckpoint,
    /// Written by a program that writes them otherwise.
    #[error("its layout has version {found}, this program knows version {VERSION}")]
    OtherVersion {
        /// Version found.
        found: u32,
    },
    /// Of another run.
    #[error("it belongs to run `{found}`, not to run `{expected}`")]
    OtherRun {
        /// Run found.
        found: String,
        /// Run given.
        expected: String,
    },
    /// Of another case, or of this one before it was changed.
    #[error("the case has changed since it was written")]
    OtherCase,
    /// Of another version of the program.
    #[error("wakemix {found} wrote it, this is wakemix {expected}: results would be of neither")]
    OtherProgram {
        /// Version that wrote it.
        found: String,
        /// Version of this program.
        expected: String,
    },
    /// Of a machine that computes otherwise.
    #[error(
        "it was computed on \"{found}\", this machine computes on \"{expected}\": the run's bits would be of neither"
    )]
    OtherBackend {
        /// What it was computed on.
        found: String,
        /// What this machine computes on.
        expected: String,
    },
    /// Its end is missing.
    #[error("it is cut off after {bytes} bytes")]
    CutOff {
        /// Bytes that are there.
        bytes: u64,
    },
    /// Its bytes are not those written.
    #[error("its section `{section}` is damaged")]
    Damaged {
        /// Section.
        section: String,
    },
    /// It lacks a section.
    #[error("it has no section `{section}`")]
    Missing {
        /// Section.
        section: String,
    },
    /// A section is sound but holds something else.
    #[error("its section `{section}` does not hold what this program expects: {reason}")]
    Unfitting {
        /// Section.
        section: String,
        /// Why.
        reason: String,
    },
}

impl CheckpointProblem {
    /// How to fix it.
    pub(crate) fn fix(&self) -> &'static str {
        match self {
            Self::OtherVersion { .. } | Self::OtherProgram { .. } => {
                concat!("resume with the version of the program that wrote it, or ", anew!())
            }
            Self::OtherCase => {
                concat!(
                    "undo the change to go on, or ",
                    anew!(),
                    "; threads, checkpoint interval and other runs may change"
                )
            }
            Self::OtherBackend { .. } => {
                concat!("resume on a machine with the same instructions, or ", anew!())
            }
            _ => ANEW,
        }
    }
}
