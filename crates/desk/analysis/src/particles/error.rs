//! Why particles cannot be binned.

use thiserror::Error;

/// Why particles cannot be binned.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ParticlesError {
    /// A distance of bins that is none.
    #[error("the distance of bins is {spacing} m along {axis}; it must be above 0")]
    Spacing {
        /// Axis.
        axis: &'static str,
        /// The distance (m).
        spacing: f64,
    },
    /// A share of overlap that is none.
    #[error("the bins overlap by {overlap}; give a share of at least 0 and below 1, such as 0.75")]
    Overlap {
        /// The share (–).
        overlap: f64,
    },
    /// A region that is none.
    #[error("the region goes from {from} to {to} m along {axis}")]
    Region {
        /// Axis.
        axis: &'static str,
        /// Its lower end (m).
        from: f64,
        /// Its upper end (m).
        to: f64,
    },
    /// More memory than is allowed.
    #[error("{n_bins} bins take {needed} bytes; {allowed} are allowed")]
    Memory {
        /// Bins (–).
        n_bins: f64,
        /// What they take (bytes).
        needed: f64,
        /// What they may take (bytes).
        allowed: u64,
    },
    /// Outliers by a limit that is none.
    #[error("the limit of the median test is {limit}; it must be above 0")]
    Limit {
        /// The limit (–).
        limit: f64,
    },
}
