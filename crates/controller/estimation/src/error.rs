//! Why an estimator cannot be made.

use thiserror::Error;

/// Why an estimator cannot be made with these settings, or a record cannot be used.
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
    /// A noise covariance that is not positive definite.
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
    /// A record without a whole excitation period after the settling time.
    #[error("{found} samples are too few for a calibration; {needed} are needed")]
    RecordTooShort {
        /// Samples given (–).
        found: usize,
        /// Fewest samples that are enough (–).
        needed: usize,
    },
    /// A record of a rotor that did not pitch.
    #[error(
        "the rotor of the record does not pitch at the excitation rate: there is nothing to calibrate"
    )]
    NothingToCalibrate,
    /// The update interval is too long to resolve the excitation.
    #[error(
        "an excitation of {rate:.4} rad/s on a rotor that turns at up to {rotor_speed:.3} rad/s cannot be resolved by samples {interval} s apart, whose Nyquist rate is {nyquist:.3} rad/s; update more often"
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
    /// A rotor with too few blades for tilt and yaw components.
    #[error(
        "a rotor of {n_blades} blades has no tilt and yaw components; at least three blades are needed"
    )]
    FewBlades {
        /// Blades.
        n_blades: usize,
    },
    /// A record too short for its purpose.
    #[error("the record has {n_samples} samples; {needed} are needed for {purpose}")]
    TooShort {
        /// Samples given.
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
    /// A sample that is not a number, or an instant that does not fit.
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
