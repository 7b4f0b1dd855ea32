//! Beliefs: what a turbine's own measurements tell of the wind that no instrument sees.
//!
//! Estimators run at control rate beside the controller: no allocation, no blocking, no failure in
//! [`Estimator::update`]. Parameters are made once from the case; the belief itself is plain data, so that a run that
//! was killed goes on with the same bits.

pub mod phase_locked;

mod error;
pub mod helix;

pub use error::EstimationError;
pub use helix::{HelixEstimate, HelixEstimator, LinearEstimator};

use basis::Measurements;

/// Turns measurements into a belief, one control instant at a time.
pub trait Estimator {
    /// What is believed.
    type Estimate;

    /// The belief after `measurements` of this instant.
    fn update(&mut self, measurements: &Measurements) -> Self::Estimate;
}
