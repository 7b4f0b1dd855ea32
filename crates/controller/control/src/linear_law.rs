//! The seam to linear control laws that come as files: a study reads them and hands them over.

use lti::Recursion;

/// A linear control law in discrete time, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLaw {
    /// Path of its file as the case has it.
    pub file: String,
    /// From errors to commands, in the units of the file's ports.
    pub recursion: Recursion,
}

/// The linear control laws of one turbine: one, or a family of them that are blended.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLaws {
    /// The laws, in the order of the case.
    pub laws: Vec<LinearLaw>,
    /// Time between samples of each (s).
    pub interval: f64,
    /// Where their plant was in the run that the case names as reference, in the order and units of their
    /// inputs; none where the case names none, and while that run is not complete.
    pub reference: Option<[f64; 2]>,
}

/// Files that a study reads for linear control laws, as the case has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LawFiles {
    /// Those of the laws: one, or those of a family.
    pub laws: Vec<String>,
    /// Folder of the run whose means are the reference.
    pub reference_run: Option<String>,
}
