//! Why a model or a controller cannot be made.

use crate::WeightProblem;
use formats::FileError;
use identification::IdentificationError;
use lti::Complex64;
use lti::matrices::MatrixError;
use miette::Diagnostic;
use report::ReportError;
use std::path::PathBuf;
use surrogate::SurrogateError;
use synthesis::SynthesisError;
use thiserror::Error;

/// Why a model or a controller cannot be made.
#[derive(Debug, Error, Diagnostic)]
pub enum DesignError {
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// A record says too little.
    #[error("{} cannot be identified from: {source}", path.display())]
    #[diagnostic(help(
        "take more of the record (--from, --to), shorter windows (--past, --future), or make a run with a broader excitation (kind = \"probing\")"
    ))]
    Identification {
        /// The record.
        path: PathBuf,
        /// Why.
        source: IdentificationError,
    },
    /// Rows of a record that are not evenly spaced.
    #[error("{} has rows {first} s and {other} s apart, at {time} s", path.display())]
    #[diagnostic(help("give a record of even rows, such as the series of a run"))]
    UnevenTimes {
        /// The record.
        path: PathBuf,
        /// Distance of the first two rows (s).
        first: f64,
        /// Another distance (s).
        other: f64,
        /// Where (s).
        time: f64,
    },
    /// No controller for a model and its weights.
    #[error("no controller for {}: {source}", path.display())]
    #[diagnostic(help("{}", fix_of(source)))]
    Synthesis {
        /// The model.
        path: PathBuf,
        /// Why.
        source: SynthesisError,
    },
    /// A model with a mode that is not stable and that no controller holds.
    #[error(
        "{}: `A` has a mode at {} = {mode:.4} that is not stable and that no {} it (`{}`)",
        path.display(),
        if *sampled { "z" } else { "s" },
        if *moved { "output shows" } else { "input moves" },
        if *moved { "C" } else { "B" }
    )]
    #[diagnostic(help(
        "identify a model of lower order (--order), which leaves a mode out that the record hardly tells, or take the state out of `A`, `B` and `C`"
    ))]
    HiddenMode {
        /// The model.
        path: PathBuf,
        /// The mode: – in discrete time, rad/s in continuous time.
        mode: Complex64,
        /// Whether inputs move it.
        moved: bool,
        /// Whether the model is in discrete time.
        sampled: bool,
    },
    /// A weight that cannot be one.
    #[error("{}: {place} {problem}", path.display())]
    #[diagnostic(help("{}", problem.fix()))]
    Weight {
        /// The file of weights.
        path: PathBuf,
        /// The table, with the channel that it is of.
        place: String,
        /// What is wrong with it.
        problem: WeightProblem,
    },
    /// No surrogate of a table, or none that a file describes.
    #[error("no surrogate from {}: {source}", path.display())]
    #[diagnostic(help(
        "correct the table, or choose other inputs, another kernel (--kernel) or noise (--noise)"
    ))]
    Surrogate {
        /// The table or the surrogate.
        path: PathBuf,
        /// Why.
        source: SurrogateError,
    },
    /// A quantity of a model cannot be worked out.
    #[error("{}: {source}", path.display())]
    Matrix {
        /// The model.
        path: PathBuf,
        /// Why.
        source: MatrixError,
    },
    /// Figures cannot be drawn.
    #[error("the figures cannot be drawn")]
    Report(#[from] ReportError),
}

fn fix_of(error: &SynthesisError) -> &'static str {
    match error {
        SynthesisError::UnstableModel(_) => {
            "identify a model of another order, of samples further apart, or without its delay (`output_delay_s`)"
        }
        SynthesisError::FreeControl { .. } => {
            "give [control] (--weights) a weight that does not fall off at high frequency: without one, controls cost nothing and grow without bound"
        }
        SynthesisError::DirectDisturbance => {
            "give [performance] as `numerator` and `denominator` whose numerator has the lower order, for an H2 norm wants a weight that falls off, or take method = \"h-infinity\" (--weights)"
        }
        _ => "change the weight that is named (--weights), or identify a model of lower order",
    }
}
