//! Design at the desk: from a record to a model, from a model to a controller that a turbine runs; from a
//! table to a surrogate.
//!
//! | wanted | use | on the command line |
//! | --- | --- | --- |
//! | a model of what answers an excitation | [`identify`] | `wakemix identify` |
//! | a controller for a model | [`synthesize`] | `wakemix synthesize` |
//! | a surrogate of what a table holds | [`regression::train`] | `wakemix surrogate` |
//! | what surrogates say of a layout | [`layout::predict_layout`] | `wakemix surrogate layout` |
//!
//! Files in, numbers and a file out; the arithmetic is that of the rooms `identification`, `synthesis` and
//! `surrogate`.

mod data;
mod error;
mod figures;
mod identify;
pub mod layout;
mod model;
mod pages;
pub mod regression;
mod synthesize;
mod weights;

pub use data::Source;
pub use error::DesignError;
pub use formats::surrogate_model::SurrogateModel;
pub use identification::Trend;
pub use identify::{Identified, IdentifyQuestion, Offset, Responses, Roots, identify};
pub use pages::{report_identified, report_synthesized};
pub use surrogate::{Trend as SurrogateTrend, Validation as SurrogateValidation};
pub use synthesis::{ChannelMargins, DiscMargin, PredictedMargins};
pub use synthesize::{ChannelResponse, LoopResponses, SynthesizeQuestion, Synthesized, synthesize};
pub use weights::{Method, WeightProblem};
