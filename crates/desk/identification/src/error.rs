//! Why something cannot be identified.

use lti::matrices::MatrixError;
use thiserror::Error;

/// Why a record is refused, or a model cannot be made of it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentificationError {
    /// A record without inputs or without outputs.
    #[error("the record has no {what}")]
    NoChannels {
        /// "inputs" or "outputs".
        what: &'static str,
    },
    /// Channels of unequal length.
    #[error("`{name}` has {found} samples where the first channel has {expected}")]
    UnequalLengths {
        /// The channel's name.
        name: String,
        /// Its samples (–).
        found: usize,
        /// Samples of the first channel (–).
        expected: usize,
    },
    /// A sample that is infinite or not a number.
    #[error("`{name}` is not a finite number at sample {sample}")]
    NotFinite {
        /// The channel's name.
        name: String,
        /// Index of the sample, from 0.
        sample: usize,
    },
    /// A channel that does not move.
    #[error("`{name}` stays at {value} throughout; nothing can be identified from it")]
    Constant {
        /// The channel's name.
        name: String,
        /// Its value, in its own unit.
        value: f64,
    },
    /// A record too short for what is asked of it.
    #[error("{found} samples are too few for {purpose}; {needed} are needed")]
    TooFewSamples {
        /// Samples given (–).
        found: usize,
        /// Fewest samples that are enough (–).
        needed: usize,
        /// What they are needed for.
        purpose: &'static str,
    },
    /// An input that does not move in enough ways, such as a single sine or the same as another one.
    #[error(
        "over {depth} samples `{name}` adds {found} independent movements to those of other inputs where \
         {needed} are needed: excite it over a broader band, independently of the others, or decimate the \
         record where samples are far closer than the band calls for"
    )]
    Excitation {
        /// The input's name.
        name: String,
        /// Samples in the window looked at (–).
        depth: usize,
        /// Independent movements found (–).
        found: usize,
        /// Fewest that are enough (–).
        needed: usize,
    },
    /// A number outside what makes sense.
    #[error("{quantity} is {value}; it must lie between {least} and {most}")]
    OutOfRange {
        /// What it is, with its unit.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Least that is accepted.
        least: f64,
        /// Most that is accepted.
        most: f64,
    },
    /// A model and a record, or a matrix, whose numbers of channels differ.
    #[error("{what}: {found} where {expected} are expected")]
    Sizes {
        /// What was counted.
        what: &'static str,
        /// Count found (–).
        found: usize,
        /// Count expected (–).
        expected: usize,
    },
    /// An iteration that did not end.
    #[error("the {what} did not converge")]
    NotConverged {
        /// What was sought.
        what: &'static str,
    },
    /// What is wrong with a system or a matrix.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
}

/// Refuses `value` outside `least` to `most`, and what is no number.
pub(crate) fn within(
    quantity: &'static str,
    value: f64,
    least: f64,
    most: f64,
) -> Result<(), IdentificationError> {
    if value >= least && value <= most {
        return Ok(());
    }
    Err(IdentificationError::OutOfRange { quantity, value, least, most })
}
