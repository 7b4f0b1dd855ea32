//! State estimation: from a turbine's own measurements to the wind that no instrument measures.
//!
//! Estimators run at control rate beside the controller: no allocation, no blocking, no failure in
//! [`Estimator::update`]. Parameters are made once from the case; the state is plain data, so that a run that
//! was killed continues with the same bits.

pub mod hub_vortex;
pub mod phase_locked;

mod error;
pub mod helix;
mod oscillation;

pub use error::EstimationError;
pub use helix::{HelixEstimate, HelixEstimator, LinearEstimator};
pub use oscillation::{Oscillation, Quantity};
pub use turbine::Definition;

use basis::Measurements;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Turns measurements into a state estimate, one control instant at a time.
pub trait Estimator {
    /// The estimate; each kind of estimator has its own, and all convert into an [`Oscillation`].
    type Estimate: Copy + Into<Oscillation>;
    /// State of the estimator, for a checkpoint.
    type State: Clone + PartialEq + Serialize + DeserializeOwned;

    /// The estimate after the `measurements` of this instant.
    fn update(&mut self, measurements: &Measurements) -> Self::Estimate;

    /// The state.
    fn state(&self) -> &Self::State;

    /// Continues with the same bits from `state`, which came from an estimator with the same settings.
    fn restore(&mut self, state: Self::State);
}
