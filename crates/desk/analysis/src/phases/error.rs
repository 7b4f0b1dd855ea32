//! What can be wrong with instants that are averaged by phase.

use thiserror::Error;

/// Why an instant cannot be taken into averages by phase, or bins cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PhaseError {
    /// No bins of rotor azimuth.
    #[error("{n_azimuths} bins of rotor azimuth are too few; give 1 at least, such as 12 of 30°")]
    NoBins {
        /// Bins asked for (–).
        n_azimuths: usize,
    },
    /// Rotor and excitation have frequencies that make no cycle.
    #[error(
        "rotor over excitation frequency is {ratio}, times {n_cycles} helix cycles; a number of revolutions of 1 at least is needed"
    )]
    Ratio {
        /// Rotor frequency over excitation frequency (–).
        ratio: f64,
        /// Helix cycles (–).
        n_cycles: usize,
    },
    /// A window of helix azimuth that is none.
    #[error("a window of helix azimuth {width_deg}° wide; give one above 0° and at most 360°")]
    Width {
        /// Its width (deg).
        width_deg: f64,
    },
    /// An instant of other points.
    #[error("an instant of {found} points among those of {expected} points")]
    Points {
        /// Points of the instant (–).
        found: usize,
        /// Points of those before (–).
        expected: usize,
    },
    /// An instant that is not after the one before.
    #[error(
        "time runs back: {time} s after {before} s; sort the instants, or begin a new record there"
    )]
    TimeRunsBack {
        /// The instant (s).
        time: f64,
        /// The instant before (s).
        before: f64,
    },
    /// A time or an azimuth that is no number.
    #[error("the {what} of an instant at {time} s is {value}, which is no finite number")]
    NotFinite {
        /// What it is, in words.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The instant (s).
        time: f64,
    },
    /// Bins of helix azimuth, and an instant that tells none.
    #[error("the instant at {time} s tells no helix azimuth, by which the bins are made")]
    NoHelix {
        /// The instant (s).
        time: f64,
    },
}
