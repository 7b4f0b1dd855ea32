//! Tuning of a wake-mixing controller from few simulations: the study file, its runs, and what came of them.
//!
//! [`tune`] reads a file, makes runs in a folder where the [`search`] wants them, and leaves numbers and a
//! page there; [`TuneOptions::resume`] goes on with a folder. After van der Hoek et al., "Gaussian process
//! surrogate modeling for efficient controller tuning and fatigue load prediction of the helix wake-mixing
//! method", sections 2.3 and 3.

mod data;
mod error;
mod figures;
mod file;
mod folder;
mod loads;
mod pages;
mod record;
mod rounds;
mod runs;
mod tune;
mod tuned;
mod watch;

pub use error::TuningError;
pub use file::{Cheaper, TuningFile, Variable};
pub use loads::Compromise;
pub use search::Normal;
pub use tune::tune;
pub use tuned::{Cost, TuneOptions, TuneOutcome, Tuned};
pub use watch::Watch;
