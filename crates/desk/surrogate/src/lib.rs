//! Surrogate models: a curve with its uncertainty from a few expensive results, loads over many inputs from
//! thousands.
//!
//! [`GaussianProcess`] is exact Gaussian-process regression: a covariance kernel, noise that is known,
//! estimated or both, and hyperparameters of maximum marginal likelihood. Power over a phase offset is
//! periodic and known from a handful of runs; its kernel is [`Shape::Periodic`]. [`Regression`] is the same
//! for many observations over many inputs: kernels as sums and products, replicates, blocks and threads,
//! inducing points.
//!
//! ```
//! use surrogate::{GaussianProcess, Observations, FitSettings, Shape};
//! use std::f64::consts::TAU;
//! // Eight offsets, a gain that has one summit at 150°.
//! let offsets: Vec<f64> = (0..8).map(|i| TAU * f64::from(i) / 8.0).collect();
//! let gains = offsets.iter().map(|o| 0.1 * (o - 150_f64.to_radians()).cos()).collect();
//! let observations = Observations::of_curve(offsets, gains);
//! let shape = Shape::Periodic { period: TAU };
//! let process = GaussianProcess::fit(shape, observations, &FitSettings::default())?;
//! let [low, high] = process.predict(&[150_f64.to_radians()])?.band_95();
//! assert!(low < 0.1 && 0.1 < high && high - low < 0.02);
//! # Ok::<(), surrogate::SurrogateError>(())
//! ```

mod ascent;
mod curve;
mod factor;
mod fit;
mod kernel;
mod likelihood;
mod observations;
mod process;
mod regression;
mod sample;
mod vector;

pub use curve::{Curve, CurveSettings, Extreme};
pub use fit::{FitSettings, Noise};
pub use kernel::{Hyperparameters, Shape};
pub use likelihood::Mean;
pub use observations::Observations;
pub use process::{GaussianProcess, LeaveOneOut, Prediction};
pub use regression::{
    Collapsed, Coverage, Kernel, MeanCurve, NoiseGroups, Outside, Panels, Parameters, Part,
    Regression, RegressionSettings, SearchSettings, Searched, Sparse, Term, Trend, Validation,
    shuffled,
};

use thiserror::Error;

/// Why a surrogate cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SurrogateError {
    /// Too few observations.
    #[error("{n} observations are too few, {needed} are needed")]
    TooFew {
        /// Observations given (–).
        n: usize,
        /// Fewest that are enough (–).
        needed: usize,
    },
    /// Parts of the data that do not belong together.
    #[error("{what} has {found} numbers, {needed} are needed")]
    Lengths {
        /// Which part, in words.
        what: &'static str,
        /// Numbers found (–).
        found: usize,
        /// Numbers needed (–).
        needed: usize,
    },
    /// An infinite number, or none.
    #[error("number {index} of {what} is not finite")]
    NotFinite {
        /// Which part, in words.
        what: &'static str,
        /// Its place, the first is 0.
        index: usize,
    },
    /// A quantity that has to be positive.
    #[error("{what} must be positive, not {value}")]
    NotPositive {
        /// Which quantity, in words.
        what: &'static str,
        /// What was given, in its unit.
        value: f64,
    },
    /// An input that says nothing.
    #[error("input {input}, counted from 0, is {value} in every observation; leave it out")]
    Constant {
        /// Which one, the first is 0.
        input: usize,
        /// What it is everywhere, in its unit.
        value: f64,
    },
    /// A group of noise without observations.
    #[error("no observation is of noise group {group}; number the groups from 0 on without gaps")]
    EmptyGroup {
        /// Which one, the first is 0.
        group: usize,
    },
    /// Different values at one input, where nothing is noisy.
    #[error(
        "{n} observations at the input of number {place} of the different ones have different values; allow for noise"
    )]
    Replicates {
        /// Which of the different inputs, the first is 0.
        place: usize,
        /// Observations there (–).
        n: usize,
    },
    /// A covariance that is not positive definite, as of two noiseless observations at the same input.
    #[error(
        "the covariance of {n} observations is not positive definite; allow for noise or remove repeated inputs"
    )]
    NotPositiveDefinite {
        /// Observations (–).
        n: usize,
    },
}
