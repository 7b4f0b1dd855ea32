//! Shared libraries of others as controllers: found, copied, opened, called.
//!
//! A library keeps its state in itself, so that each turbine runs a copy of its file. What is foreign and
//! unsafe stays here, behind [`control::library::Library`].

mod image;
mod instance;
#[cfg(unix)]
mod last_words;
mod registers;

use control::library::{Libraries, Library, LibraryError, Request};
use instance::Instance;
use std::path::{Path, PathBuf};

/// Opens the libraries of a case for one turbine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Host {
    folder: PathBuf,
    outputs: Option<PathBuf>,
    turbine: String,
}

impl Host {
    /// For the turbine called `turbine` of a case whose paths are relative to `folder`; what its library
    /// writes goes away with it.
    pub fn new(folder: &Path, turbine: &str) -> Self {
        Self { folder: folder.to_owned(), outputs: None, turbine: turbine.to_owned() }
    }

    /// The same, with what its library writes in the folder `outputs`, in files whose names begin with the
    /// turbine's.
    pub fn with_outputs(self, outputs: &Path) -> Self {
        Self { outputs: Some(outputs.to_owned()), ..self }
    }
}

impl Libraries for Host {
    fn open(&self, asked: &Request) -> Result<Box<dyn Library>, LibraryError> {
        Ok(Box::new(Instance::open(self, asked)?))
    }
}
