//! Control design at the desk: from a record to a model, from a model to a controller that a turbine runs.
//!
//! | wanted | use | on the command line |
//! | --- | --- | --- |
//! | a model of what answers an excitation | [`identify`] | `wakemix identify` |
//! | a controller for a model | [`synthesize`] | `wakemix synthesize` |
//!
//! Files in, numbers and a file out; the arithmetic is that of the rooms `identification` and `synthesis`.

mod data;
mod error;
mod figures;
mod identify;
mod model;
mod pages;
mod synthesize;
mod weights;

pub use data::Source;
pub use error::DesignError;
pub use identification::Trend;
pub use identify::{Identified, IdentifyQuestion, Responses, identify};
pub use pages::{report_identified, report_synthesized};
pub use synthesize::{LoopResponses, SynthesizeQuestion, Synthesized, synthesize};
pub use weights::Method;
