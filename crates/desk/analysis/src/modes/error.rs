//! Why instants have no modes.

use thiserror::Error;

/// Why instants have no modes.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ModesError {
    /// Too few instants.
    #[error("{n_instants} instants are too few; {needed} are needed")]
    TooFew {
        /// Instants given (–).
        n_instants: usize,
        /// Fewest that are enough (–).
        needed: usize,
    },
    /// Instants that are not evenly spaced.
    #[error(
        "instant {index} is {step} s after the one before; the instants are {interval} s apart on average, and modes over frequency need even times"
    )]
    UnevenTimes {
        /// The first with another interval, from 0.
        index: usize,
        /// That interval (s).
        step: f64,
        /// The mean interval (s).
        interval: f64,
    },
    /// Blocks that cannot be made.
    #[error(
        "blocks of {n_block} instants that overlap by {overlap}: a block has 4 instants at least, and the overlap is at least 0 and below 1"
    )]
    Blocks {
        /// Instants of a block (–).
        n_block: usize,
        /// Share of a block that the next one has, too (–).
        overlap: f64,
    },
    /// A frequency that the blocks do not resolve.
    #[error("{frequency} Hz is not between 0 and the highest frequency, {highest} Hz")]
    Frequency {
        /// Frequency asked for (Hz).
        frequency: f64,
        /// Highest that there is (Hz).
        highest: f64,
    },
    /// No component to look at.
    #[error("no component of the velocity is looked at")]
    NoComponent,
    /// No point has a number at every instant.
    #[error("none of {n_points} points has a velocity at every instant")]
    NoPoint {
        /// Points in all (–).
        n_points: usize,
    },
    /// The eigenvalues of the correlations were not found.
    #[error("the eigenvalues of a matrix of {n} rows were not found")]
    Eigenvalues {
        /// Its rows (–).
        n: usize,
    },
    /// What was read is not what was asked for.
    #[error("{found} values came where {expected} were asked for")]
    Values {
        /// Values that came (–).
        found: usize,
        /// Values asked for (–).
        expected: usize,
    },
}
