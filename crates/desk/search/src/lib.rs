//! The greatest value of something expensive and noisy, from few evaluations: a first design, a Gaussian
//! process for each of its parts, and the next point where most is to be gained.
//!
//! [`maximise`] is the loop over a closure; it knows nothing of files or simulations. What is maximised is a
//! weighted sum of outputs, each with a process of its own, as the power of an array is the sum of its
//! turbines' (van der Hoek et al., "Gaussian process surrogate modeling for efficient controller tuning and
//! fatigue load prediction of the helix wake-mixing method", Eqs. 3-5, 10 and 11).
//!
//! ```
//! use search::{Axis, Evaluation, Settings, Space, maximise};
//! // A summit of 7 at 0.3, each evaluation with two readings of it.
//! let space = Space::new(vec![Axis::new(0.0, 1.0)])?;
//! let settings = Settings { n_first: 4, budget: 10, ..Settings::of_one() };
//! let curve = |x: f64| 7.0 - 20.0 * (x - 0.3).powi(2);
//! let found = maximise(&space, &settings, |proposal| {
//!     let blocks = |y| Evaluation { outputs: vec![vec![y - 0.01, y + 0.01]] };
//!     let one = |point: &Vec<f64>| (point.clone(), blocks(curve(point[0])));
//!     Ok::<_, search::SearchError>(proposal.points.iter().map(one).collect())
//! })?;
//! assert!((found.optimum.point[0] - 0.3).abs() < 0.05);
//! # Ok::<(), search::SearchError>(())
//! ```

mod acquisition;
mod design;
mod draws;
mod history;
mod maximise;
mod model;
mod normal;
mod optimum;
mod space;
mod sum;

pub use acquisition::Acquisition;
pub use design::Design;
pub use history::{Evaluation, History};
pub use maximise::{Found, Proposal, Settings, Step, maximise};
pub use model::{Model, Normal};
pub use optimum::Optimum;
pub use space::{Axis, Space};
pub use sum::Sum;
pub use surrogate::Shape;

use surrogate::SurrogateError;
use thiserror::Error;

/// Why a search cannot go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SearchError {
    /// Nothing to search over.
    #[error("there is no variable to search over; give one or more")]
    NoAxes,
    /// An axis without extent.
    #[error(
        "variable {axis}, counted from 0, goes from {from} to {to}; give a range of finite numbers that ascend"
    )]
    Range {
        /// Which one.
        axis: usize,
        /// Its lower end (its unit).
        from: f64,
        /// Its upper end (its unit).
        to: f64,
    },
    /// A step that does not fit.
    #[error("the step {step} of variable {axis}, counted from 0, is not between 0 and its range")]
    Step {
        /// Which one.
        axis: usize,
        /// The step (its unit).
        step: f64,
    },
    /// A first design that is too small.
    #[error("a first design of {n} points is too small, {needed} are needed")]
    FewPoints {
        /// Points asked for (–).
        n: usize,
        /// Fewest (–).
        needed: usize,
    },
    /// A point of another number of variables, or outside of their ranges.
    #[error(
        "point {index} of the first design, counted from 0, is not within the ranges of the variables"
    )]
    Outside {
        /// Which one.
        index: usize,
    },
    /// Evaluations that do not belong together.
    #[error(
        "an evaluation gave {found} outputs where {needed} are needed, each with a finite value or more"
    )]
    Outputs {
        /// Outputs found (–).
        found: usize,
        /// Outputs needed (–).
        needed: usize,
    },
    /// No process fits.
    #[error("no Gaussian process fits {n} observations")]
    NoProcess {
        /// Observations (–).
        n: usize,
    },
    /// A process that cannot be used.
    #[error(transparent)]
    Surrogate(#[from] SurrogateError),
}

#[cfg(test)]
mod tests;
