//! What an engineer reads from records: means with their uncertainty, spectra, fatigue, delivered pitch, phases, wakes.

pub mod fatigue;
pub mod line;
pub mod phase;
pub mod pitch;
pub mod spectra;
pub mod statistics;
pub mod wake;

use thiserror::Error;

/// Why a record cannot be analysed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AnalysisError {
    /// The record has too few samples.
    #[error("{n_samples} samples are too few, {needed} are needed")]
    TooShort {
        /// Samples given (–).
        n_samples: usize,
        /// Fewest samples that would do (–).
        needed: usize,
    },
    /// Two records that belong together differ in length.
    #[error("records of {first} and {second} samples do not belong together")]
    UnequalLengths {
        /// Samples of one (–).
        first: usize,
        /// Samples of the other (–).
        second: usize,
    },
    /// A length of time that does not hold one sample.
    #[error("{quantity} must be positive, not {value} s")]
    NotPositive {
        /// What it is, in words.
        quantity: &'static str,
        /// What was given (s).
        value: f64,
    },
    /// A sample that is infinite or no number.
    #[error("sample {index} is not a finite number")]
    NotFinite {
        /// Its place in the record, the first is 0.
        index: usize,
    },
    /// An S-N slope that no material has.
    #[error("the slope must be a number of at least 1, not {slope}")]
    Slope {
        /// What was given (–).
        slope: f64,
    },
    /// A ratio to a mean of zero.
    #[error("the compared record has a mean of zero")]
    ZeroMean,
    /// A ratio to a figure that is zero, of a whole record or of a block.
    #[error(
        "what the compared record, or a block of it, comes to is zero: there is no ratio to it"
    )]
    NoReference,
    /// A rotor whose blades do not make a fixed frame.
    #[error("a rotor of {n_blades} blades has no tilt and yaw, 3 are needed")]
    TooFewBlades {
        /// Blades (–).
        n_blades: usize,
    },
    /// Lines over a disc that do not make a fixed frame.
    #[error("{n_lines} lines have no tilt and yaw, 3 are needed")]
    TooFewLines {
        /// Lines (–).
        n_lines: usize,
    },
    /// Times that do not keep one distance.
    #[error(
        "the times are not evenly spaced: sample {index} follows after {step} s, the others after {interval} s"
    )]
    UnevenTimes {
        /// The first sample with another distance to the one before, the first of all is 0.
        index: usize,
        /// That distance (s).
        step: f64,
        /// The mean distance (s).
        interval: f64,
    },
    /// A frequency that the sampling does not resolve.
    #[error("{frequency} Hz is not below {nyquist} Hz, half the sampling rate")]
    AboveNyquist {
        /// What was asked for (Hz).
        frequency: f64,
        /// Half the sampling rate (Hz).
        nyquist: f64,
    },
    /// A band that holds no frequency.
    #[error("no frequency lies above zero and between {low} and {high} Hz")]
    Band {
        /// Its lower end (Hz).
        low: f64,
        /// Its upper end (Hz).
        high: f64,
    },
    /// A plane with the wrong axes.
    #[error("plane {name} spans {found:?}, {needed} is needed")]
    WrongPlane {
        /// Name of the plane.
        name: String,
        /// Axes that it spans.
        found: basis::records::PlaneAxes,
        /// Axes that are needed, in words.
        needed: &'static str,
    },
    /// A place that the plane does not reach.
    #[error("plane {name} does not reach ({first:.1}, {second:.1}) m")]
    OutsidePlane {
        /// Name of the plane.
        name: String,
        /// Coordinate along its first axis (m).
        first: f64,
        /// Coordinate along its second axis (m).
        second: f64,
    },
}
