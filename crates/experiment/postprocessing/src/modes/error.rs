//! What can be wrong while strips are read for modes.

use crate::PostprocessingError;
use analysis::modes::ModesError;
use formats::FileError;
use std::path::Path;

/// Why there are no modes; not yet where.
#[derive(Debug)]
pub(super) enum Trouble {
    Modes(ModesError),
    File(FileError),
}

impl From<ModesError> for Trouble {
    fn from(error: ModesError) -> Self {
        Self::Modes(error)
    }
}

impl Trouble {
    /// The same of the file at `path`.
    pub(super) fn at(self, path: &Path) -> PostprocessingError {
        match self {
            Self::File(error) => error.into(),
            Self::Modes(source) => PostprocessingError::Modes { path: path.to_owned(), source },
        }
    }
}

/// How to have modes in spite of `error`.
pub(crate) fn fix_of(error: &ModesError) -> &'static str {
    match error {
        ModesError::TooFew { .. } => {
            "make a longer run (time.duration), keep planes more often (output.plane_interval), or ask for a shorter --block"
        }
        ModesError::UnevenTimes { .. } => {
            "give instants that are evenly spaced: those of one run, with one output.plane_interval"
        }
        ModesError::Blocks { .. } => "ask for another --block or --overlap",
        ModesError::Frequency { .. } => {
            "keep planes more often (output.plane_interval), or leave --excitation and --rotor out"
        }
        ModesError::NoComponent => "name one of u, v, w with --component",
        ModesError::NoPoint { .. } => {
            "fill the holes, or give the part of the plane that was measured throughout"
        }
        ModesError::Values { .. } => "restore the file, or make the run again",
    }
}
