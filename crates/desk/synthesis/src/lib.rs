//! Controller synthesis: H-infinity, H2 and LQG controllers of linear models, and how well they do.
//!
//! | wanted | use |
//! | --- | --- |
//! | weights of a source | [`performance_weight`], [`control_weight`] |
//! | a problem to solve | [`mixed_sensitivity`], or any [`GeneralisedPlant`] |
//! | a controller | [`h_infinity`], [`h2`], [`lqg`], [`lqg_with_integral_action`] |
//! | a controller beside a delay | [`smith_predictor`] |
//! | fewer states | [`reduced_to_order`], [`reduced_to_tolerance`] |
//! | how well it does | [`Loop`], [`step_response`], with a delay [`predicted_margins`] |
//!
//! Negative feedback throughout: u = K (r − y).

mod assumptions;
mod central;
mod error;
mod generalised_plant;
mod h2;
mod h_infinity;
mod loop_analysis;
mod lqg;
mod margins;
mod normalised;
mod predicted;
mod reduction;
mod smith_predictor;
mod weights;

#[cfg(test)]
mod tests;

pub use error::SynthesisError;
pub use generalised_plant::{GeneralisedPlant, SensitivityWeights, mixed_sensitivity};
pub use h_infinity::{HInfinity, HInfinityOptions, h_infinity};
pub use h2::{H2, h2};
pub use loop_analysis::{Loop, step_response};
pub use lqg::{LqgWeights, lqg, lqg_with_integral_action};
pub use margins::{ChannelMargins, DiscMargin};
pub use predicted::{PredictedMargins, predicted_margins};
pub use reduction::{Reduced, reduced_to_order, reduced_to_tolerance};
pub use smith_predictor::smith_predictor;
pub use weights::{control_weight, performance_weight};
