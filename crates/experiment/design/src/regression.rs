//! Surrogates from tables: trained, asked, validated and shown.

mod cuts;
mod kernel_text;
mod pairs;
mod predict;
mod stored;
mod train;
mod validate;

pub(crate) use stored::regression;

pub use cuts::{Cut, Scatter, cuts, draw_surrogate, fit_in_words};
pub use kernel_text::KernelText;
pub use predict::{PredictQuestion, Predicted, predict};
pub use train::{TrainQuestion, Trained, train};
pub use validate::{ValidateQuestion, Validated, validate};
