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
