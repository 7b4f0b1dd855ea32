//! The seam to linear control laws that come as files: a study reads them and hands them over.

use lti::Recursion;

/// A linear control law in discrete time, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLaw {
    /// Path of its file as the case has it.
    pub file: String,
    /// From errors to commands, in the units of the file's ports.
    pub recursion: Recursion,
    /// Time between its samples (s).
    pub interval: f64,
    /// Where its plant was in the run that the case names as reference, in the order and units of its inputs;
    /// none where the case names none, and while that run is not complete.
    pub reference: Option<[f64; 2]>,
}

/// Files that a study reads for a linear control law, as the case has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LawFiles {
    /// The law's file.
    pub law: String,
    /// Folder of the run whose means are the reference.
    pub reference_run: Option<String>,
}
