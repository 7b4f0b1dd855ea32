//! Instants of a file as modes read them: strip by strip.

use crate::PostprocessingError;
use crate::wake_fields::refused;
use analysis::modes::{ModesError, Snapshots};
use basis::records::Grid;
use formats::FileError;
use formats::fields::FieldFile;
use std::ops::Range;
use std::path::Path;

/// Instants in a file.
pub(super) struct Source {
    pub(super) file: FieldFile,
    /// Those that count.
    pub(super) places: Range<usize>,
}

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
            Self::Modes(error) => refused(path, problem(&error), fix_of(&error)),
        }
    }
}

impl Snapshots for Source {
    type Error = Trouble;

    fn grid(&self) -> &Grid {
        self.file.grid()
    }

    fn times(&self) -> &[f64] {
        &self.file.times()[self.places.clone()]
    }

    fn read(&mut self, steps: Range<usize>) -> Result<[Vec<f32>; 3], Trouble> {
        self.file.read_strip(self.places.clone(), steps).map_err(Trouble::File)
    }
}

fn problem(error: &ModesError) -> String {
    format!("has no modes: {error}")
}

/// How to have modes in spite of `error`.
fn fix_of(error: &ModesError) -> &'static str {
    match error {
        ModesError::TooFew { .. } => {
            "make a longer run (time.duration), keep planes more often (output.plane_interval), or ask for a shorter --block"
        }
        ModesError::UnevenTimes { .. } => {
            "give instants that are evenly spaced: those of one run, with one output.plane_interval"
        }
        ModesError::Blocks { .. } => "ask for another --block or --overlap",
        ModesError::Frequency { .. } => {
            "keep planes more often (output.plane_interval), or leave --excitation-hz and --rotor-hz out"
        }
        ModesError::NoComponent => "name one of u, v, w with --component",
        ModesError::NoPoint { .. } => {
            "fill the holes, or give the part of the plane that was measured throughout"
        }
        ModesError::Values { .. } | ModesError::Eigenvalues { .. } => {
            "restore the file, or make the run again"
        }
    }
}
