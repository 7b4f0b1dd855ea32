//! Gaussian-process regression of many observations over many inputs.

mod covariance;
mod coverage;
mod cross;
mod expression;
mod inducing;
mod marginal;
mod outside;
mod panels;
mod predictor;
mod problem;
mod process;
mod replicates;
mod search;
mod threads;

pub use coverage::Coverage;
pub use cross::Validation;
pub use expression::{Kernel, Parameters, Part, Term};
pub use inducing::Sparse;
pub use outside::Outside;
pub use panels::Panels;
pub use predictor::MeanCurve;
pub use problem::{Collapsed, NoiseGroups, Trend};
pub use process::{Regression, RegressionSettings};
pub use search::{SearchSettings, Searched, shuffled};

#[cfg(test)]
mod tests;
