//! What can be wrong with a checkpoint.

use thiserror::Error;

/// Version of the layout.
pub(super) const VERSION: u32 = 3;
const FRESH: &str = "start the run afresh, without --resume";

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
            Self::OtherVersion { .. } => {
                "resume with the version of the program that wrote it, or start the run anew, without --resume"
            }
            Self::OtherCase => {
                "undo the change to go on, or start the run afresh, without --resume; threads, checkpoint interval and other runs may change"
            }
            _ => FRESH,
        }
    }
}
