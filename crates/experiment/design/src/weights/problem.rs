//! What is wrong with a weight, and what would mend it.

use lti::Complex64;
use lti::matrices::MatrixError;
use synthesis::SynthesisError;
use thiserror::Error;

/// Why a table of a file of weights is no weight.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WeightProblem {
    /// No key of any form.
    #[error("holds no weight")]
    NoForm,
    /// No weight of what the outputs are to do.
    #[error("is missing: nothing is asked of the outputs")]
    NothingWanted,
    /// No weight of the control, nor of the complementary sensitivity.
    #[error("is missing: controls cost nothing, so that they grow without bound")]
    FreeControl,
    /// Keys of two forms.
    #[error("holds `{}` and `{}`, which are of two forms of a weight", keys[0], keys[1])]
    TwoForms {
        /// One of each.
        keys: [&'static str; 2],
    },
    /// A form without one of its keys.
    #[error("lacks `{key}`")]
    Lacks {
        /// The key.
        key: &'static str,
    },
    /// A number that is to be above zero.
    #[error("has `{key}` = {value}, where a number above zero is expected")]
    OutOfRange {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
    },
    /// A list that is not as long as there are channels.
    #[error(
        "has {found} numbers in `{key}`, where one for all channels or {channels}, one for each, are expected"
    )]
    Numbers {
        /// The key.
        key: &'static str,
        /// As there are.
        found: usize,
        /// As there are channels (–).
        channels: usize,
    },
    /// A table for all channels that names one.
    #[error("has a `channel`, where a table in single brackets is for all channels")]
    Single,
    /// An infinite number, or none at all.
    #[error("has a number in `{key}` that is not finite")]
    NotFinite {
        /// The key.
        key: &'static str,
    },
    /// A polynomial without a coefficient.
    #[error("has a `{key}` that is zero")]
    Zero {
        /// The key.
        key: &'static str,
    },
    /// A transfer function whose gain grows for ever.
    #[error(
        "is improper: `numerator` has degree {}, where at most {}, that of `denominator`, is expected",
        degrees[0],
        degrees[1]
    )]
    Improper {
        /// Of numerator and denominator (–).
        degrees: [usize; 2],
    },
    /// A matrix that does not fit the others.
    #[error(
        "has `{key}` of {} × {}, where {} × {} is expected of the rows of `A` and `D` and the columns of `D`",
        found[0],
        found[1],
        expected[0],
        expected[1]
    )]
    Shape {
        /// The matrix.
        key: &'static str,
        /// Rows, and the columns of the first row that has others than expected.
        found: [usize; 2],
        /// Rows and columns.
        expected: [usize; 2],
    },
    /// A direct gain without rows or columns.
    #[error(
        "has no number in `D`, where a row for each output and a column for each input are expected"
    )]
    NoSignals,
    /// Inputs that are not one, and not the channels.
    #[error("has {inputs} inputs, where {} expected", inputs_of(*channels))]
    Inputs {
        /// As there are.
        inputs: usize,
        /// Channels that it weighs (–).
        channels: usize,
    },
    /// A pole that no controller moves.
    #[error(
        "has a pole on the imaginary axis, at {frequency} rad/s, where poles to its left are expected: no controller moves it"
    )]
    OnAxis {
        /// rad/s.
        frequency: f64,
    },
    /// A weight that is not stable.
    #[error(
        "has a pole at {pole} rad/s, where poles to the left of the imaginary axis are expected"
    )]
    Unstable {
        /// rad/s.
        pole: Complex64,
    },
    /// A table among others that does not say which channel it weighs.
    #[error("has no `channel` in one of its tables")]
    NoChannel,
    /// A channel that the model does not have.
    #[error("has no such channel, where one of {known} is expected")]
    UnknownChannel {
        /// The model's, in words.
        known: String,
    },
    /// A channel with two tables.
    #[error("is there twice")]
    Twice,
    /// A channel without a table.
    #[error("has no table for {channel}, where one for each channel is expected")]
    Unweighted {
        /// Its name.
        channel: String,
    },
    /// A system that cannot be put together or worked out.
    #[error("cannot be worked out: {0}")]
    Matrix(#[from] MatrixError),
    /// A source's weight that cannot be made.
    #[error("cannot be made: {0}")]
    Synthesis(#[from] SynthesisError),
}

/// The inputs that a weight of `channels` may have, in words.
fn inputs_of(channels: usize) -> String {
    match channels {
        1 => "1 is".to_owned(),
        _ => {
            format!("1, for the same weight on every channel, or {channels}, for all of them, are")
        }
    }
}

impl WeightProblem {
    /// What would mend it.
    pub fn fix(&self) -> &'static str {
        match self {
            Self::NothingWanted => {
                "add [performance] with `bandwidth`, `peak` and `attenuation`, or another weight"
            }
            Self::FreeControl => {
                "add [control] with `corner`, `ratio` and `scale`, or another weight that does not fall off at high frequency"
            }
            Self::NoForm | Self::TwoForms { .. } | Self::Lacks { .. } => {
                "give `bandwidth`, `peak` and `attenuation`, or `corner`, `ratio` and `scale`, or `numerator` and `denominator`, or `A`, `B`, `C` and `D` (a gain: `D` alone)"
            }
            Self::Numbers { .. } => {
                "give one number, or a list in the order of the model's outputs (outputs, integrals, measurement_noise) or inputs (controls, input_noise)"
            }
            Self::Single => "write the table's name in double brackets, or take `channel` away",
            Self::OutOfRange { .. } => "give a number above zero",
            Self::NotFinite { .. } => "give plain numbers, no nan or inf",
            Self::Zero { .. } => {
                "give its coefficients, that of the highest power first; a channel that is to weigh nothing takes a small gain, as numerator = [1e-6]"
            }
            Self::Improper { .. } => {
                "multiply `denominator` by (s/ω + 1) for each degree that it lacks, ω in rad/s well above the frequencies that matter"
            }
            Self::Shape { .. } | Self::NoSignals => {
                "give rows of equal length: A states × states, B states × inputs, C outputs × states, D outputs × inputs"
            }
            Self::Inputs { .. } => {
                "give `B` and `D` that many columns, or a table for each channel, [[performance]] with channel = \"NAME\""
            }
            Self::OnAxis { .. } => {
                "move the pole to the left, such as s + 1e-4 in place of s, or s² + 0.02 ω s + ω² in place of s² + ω²; a controller that integrates is that of method = \"lqi\""
            }
            Self::Unstable { .. } => {
                "mirror the pole at the imaginary axis: the gain stays what it is at every frequency"
            }
            Self::NoChannel => {
                "give each table a `channel` of the model, or one table alone for all channels"
            }
            Self::UnknownChannel { .. } => {
                "name an output of the model in [[performance]] and [[complementary]], an input in [[control]]; the turbine in front of it may be left out"
            }
            Self::Twice => "keep one of the two tables",
            Self::Unweighted { .. } => {
                "add a table with that `channel`, or take `channel` away, for the same weight on every channel"
            }
            Self::Matrix(_) | Self::Synthesis(_) => {
                "give numbers of sizes that are nearer to one another"
            }
        }
    }
}
