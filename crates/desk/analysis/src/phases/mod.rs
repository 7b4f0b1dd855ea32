//! Velocity averaged by phase: bins of rotor and helix azimuth, sums that stream, the triple decomposition.
//!
//! Source: van der Hoek, Van den Abbeele, Simao Ferreira and van Wingerden (2024), "Maximizing wind farm
//! power output with the helix approach: experimental validation and wake analysis using tomographic
//! particle image velocimetry", Wind Energy, §3.1 to §3.3.

mod average;
mod batch;
mod bins;
mod decomposition;
mod error;
mod sums;

pub use average::PhaseAverager;
pub use batch::{PhaseBatch, PhaseInstant};
pub use bins::{Bins, cycles_that_close, helix_azimuth};
pub use decomposition::{Decomposer, Decomposition, decompose, standard_error};
pub use error::PhaseError;
pub use sums::POINT_BYTES;

#[cfg(test)]
mod tests;
