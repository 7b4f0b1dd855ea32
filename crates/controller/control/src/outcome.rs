//! What a controller has to tell after a run, from the records of its turbine.

use basis::Channel;
use basis::records::{Finding, MeanderingSummary};
use thiserror::Error;

/// The analysed part of the records of one turbine.
pub trait TurbineRecord {
    /// Samples of `channel` of the turbine, or of the time, in SI units.
    ///
    /// # Errors
    /// [`MissingChannel`] when there is none.
    fn column(&self, channel: &Channel) -> Result<&[f64], MissingChannel>;

    /// Time between samples (s).
    fn interval(&self) -> f64;

    /// Blades of the turbine (–).
    fn n_blades(&self) -> usize;
}

/// A channel that records do not have.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the records have no channel `{0}`")]
pub struct MissingChannel(pub String);

/// What a controller has to tell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// What it found or reached.
    pub findings: Vec<Finding>,
    /// What it found of meandering and made of it.
    pub meandering: Option<MeanderingSummary>,
    /// What a reader of the numbers must know, each as what follows "run R: T".
    pub warnings: Vec<String>,
}
