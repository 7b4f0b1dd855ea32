//! Decisions: what a turbine is told, from its measurements alone.
//!
//! Controllers compose by wrapping: an [`Excitation`] adds to what [`Baseline`] decides. Every controller is
//! plain data, so a run that was killed goes on with the same bits. Nothing here allocates, blocks or fails
//! in [`Controller::update`].

pub mod baseline;
mod excitation;
pub mod meandering;
pub mod phase_sync;
mod turbine_controller;

pub use baseline::Baseline;
pub use excitation::{Excitation, Helix, Pulse, Sense, excitation_rate};
pub use meandering::Meandering;
pub use phase_sync::PhaseSync;
pub use turbine_controller::{ControllerState, TurbineController};

use basis::{Commands, Measurements};

/// Runs on the turbine: must not allocate, block or fail.
pub trait Controller: Send {
    /// What the turbine is told until the next control instant, given its `measurements` at this one.
    fn update(&mut self, measurements: &Measurements) -> Commands;
}
