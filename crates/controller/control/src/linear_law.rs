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
}
