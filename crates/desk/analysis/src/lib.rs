//! Analysis of records: means with their uncertainty, spectra, fatigue, delivered pitch, phases, wakes.

pub mod entrainment;
pub mod fatigue;
pub mod grids;
pub mod isosurface;
pub mod lateral;
pub mod line;
#[cfg(feature = "modes")]
pub mod modes;
pub mod particles;
pub mod phase;
pub mod phases;
pub mod pitch;
mod small;
pub mod smooth;
pub mod spectra;
pub mod statistics;
pub mod vortices;
pub mod wake;

use thiserror::Error;

/// Why a record cannot be analysed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AnalysisError {
    /// The record has too few samples.
    #[error("{n_samples} samples are too few; {needed} are needed")]
    TooShort {
        /// Samples given (–).
        n_samples: usize,
        /// Fewest samples that are enough (–).
        needed: usize,
    },
    /// Two records that belong together differ in length.
    #[error(
        "records of {first} and {second} samples cannot be compared; they must have the same length"
    )]
    UnequalLengths {
        /// Samples of one (–).
        first: usize,
        /// Samples of the other (–).
        second: usize,
    },
    /// A length of time that is not positive.
    #[error("{quantity} must be positive, not {value} s")]
    NotPositive {
        /// What it is, in words.
        quantity: &'static str,
        /// Its value (s).
        value: f64,
    },
    /// A sample that is infinite or not a number.
    #[error("sample {index} is not a finite number")]
    NotFinite {
        /// Its index in the record, from 0.
        index: usize,
    },
    /// An S-N slope out of range.
    #[error("the S-N slope must be a number of at least 1, not {slope}")]
    Slope {
        /// Its value (–).
        slope: f64,
    },
    /// A ratio to a mean of zero.
    #[error("the reference record has a mean of zero")]
    ZeroMean,
    /// A ratio to a figure that is zero, of a whole record or of a block.
    #[error(
        "the value of the reference record, or of a block of it, is zero: there is no ratio to it"
    )]
    NoReference,
    /// A rotor with too few blades for the fixed frame.
    #[error("a rotor of {n_blades} blades has no tilt and yaw components; 3 blades are needed")]
    TooFewBlades {
        /// Blades (–).
        n_blades: usize,
    },
    /// Too few lines over a disc for the fixed frame.
    #[error("{n_lines} lines have no tilt and yaw components; 3 lines are needed")]
    TooFewLines {
        /// Lines (–).
        n_lines: usize,
    },
    /// Times that are not evenly spaced.
    #[error(
        "the times are not evenly spaced: sample {index} is {step} s after the one before; the mean interval is {interval} s"
    )]
    UnevenTimes {
        /// The first sample with another interval, from 0.
        index: usize,
        /// That interval (s).
        step: f64,
        /// The mean interval (s).
        interval: f64,
    },
    /// A frequency that the sampling does not resolve.
    #[error("{frequency} Hz is not below the Nyquist frequency of {nyquist} Hz")]
    AboveNyquist {
        /// Frequency given (Hz).
        frequency: f64,
        /// Nyquist frequency (Hz).
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
    #[error("plane {name} spans {found:?}; {needed} is needed")]
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
