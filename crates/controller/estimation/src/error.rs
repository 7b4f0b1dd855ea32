//! Why an estimator cannot be made.

use thiserror::Error;

/// Why an estimator cannot be made as asked.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EstimationError {
    /// A setting out of its range.
    #[error("{name} = {value} cannot be used: {expected}")]
    Setting {
        /// Setting, in words.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A covariance that no noise can have.
    #[error(
        "the {name} noise is not positive definite: {entry} = {value}, and every variance must be above zero"
    )]
    NotPositiveDefinite {
        /// Which noise: process or measurement.
        name: &'static str,
        /// Entry, in words.
        entry: &'static str,
        /// Its value.
        value: f64,
    },
    /// A record without a whole excitation period after the settling.
    #[error("{found} samples are too few to calibrate with, {needed} are needed")]
    RecordTooShort {
        /// Samples given (–).
        found: usize,
        /// Fewest samples that would do (–).
        needed: usize,
    },
    /// A record of a rotor that did not pitch.
    #[error(
        "the rotor of the record does not pitch at the excitation's rate: there is nothing to calibrate"
    )]
    NothingToCalibrate,
    /// The samples are too few for what is to be seen.
    #[error(
        "an excitation of {rate:.4} rad/s on a rotor that turns with up to {rotor_speed:.3} rad/s cannot be seen in samples {interval} s apart, which end at {nyquist:.3} rad/s; update more often"
    )]
    AboveNyquist {
        /// Excitation rate (rad/s).
        rate: f64,
        /// Rated rotor speed (rad/s).
        rotor_speed: f64,
        /// Time between updates (s).
        interval: f64,
        /// Nyquist rate of the updates (rad/s).
        nyquist: f64,
    },
    /// A rotor that tilt and yaw cannot be told on.
    #[error(
        "tilt and yaw cannot be told on a rotor of {n_blades} blades; three at least are needed"
    )]
    FewBlades {
        /// Blades.
        n_blades: usize,
    },
    /// A record too short for what is asked of it.
    #[error("the record has {n_samples} samples, and {needed} are needed for {purpose}")]
    TooShort {
        /// Samples there are.
        n_samples: usize,
        /// Samples needed.
        needed: usize,
        /// What for.
        purpose: &'static str,
    },
    /// Columns of a record that do not belong together.
    #[error("{name} has {found} samples where the record has {expected}")]
    Length {
        /// Column.
        name: &'static str,
        /// Its samples.
        found: usize,
        /// Samples of the record.
        expected: usize,
    },
    /// A sample that is no number, or an instant that does not fit.
    #[error("sample {index} of {name} is {value}: {expected}")]
    Sample {
        /// Column.
        name: &'static str,
        /// Place in the record, from 0.
        index: usize,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}
