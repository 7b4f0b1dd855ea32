//! Beliefs: what a turbine's own measurements tell of the wind that no instrument sees.
//!
//! Estimators run at control rate beside the controller: no allocation, no blocking, no failure in
//! [`Estimator::update`]. Parameters are made once from the case; the belief itself is plain data, so that a run that
//! was killed goes on with the same bits.

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

/// Turns measurements into a belief, one control instant at a time.
pub trait Estimator {
    /// What is believed; each kind of estimator says more, all of them an [`Oscillation`].
    type Estimate: Copy + Into<Oscillation>;
    /// Everything that time changes, for a checkpoint.
    type State: Clone + PartialEq + Serialize + DeserializeOwned;

    /// The belief after `measurements` of this instant.
    fn update(&mut self, measurements: &Measurements) -> Self::Estimate;

    /// Everything that time changes.
    fn state(&self) -> &Self::State;

    /// Continues with the same bits from `state`, which an estimator made alike gave.
    fn restore(&mut self, state: Self::State);
}
