//! Plant and controllers run together: layout, the loop, runs of a case, the self-check.

pub mod air;
pub mod assemble;
pub mod case;
mod coefficients;
pub mod domain;
mod event;
pub mod farm;
mod layout;
mod made_grid;
pub mod operation;
pub mod outputs;
pub mod pitch_response;
pub mod plan;
pub mod precursor;
pub mod refinement;
pub mod self_check;
pub mod solvers;
pub mod tracking;
pub mod wind;

pub use air::{Air, FarmFlow};
pub use farm::{Farm, FarmError, Machine, Recorder, Unrecorded};
pub use plan::{Plan, plan};

/// Receives the share (–) of a long task that is done; a break ends it.
pub type Progress<'a> = &'a mut dyn FnMut(f64) -> std::ops::ControlFlow<()>;
