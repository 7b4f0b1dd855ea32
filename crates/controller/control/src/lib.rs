//! Decisions: what a turbine does, from its measurements alone.
//!
//! A [`Controller`] runs on one turbine. Controllers compose by wrapping: an [`Excitation`] goes [on
//! top](OnTop) of what another controller decides, in the end of [`Baseline`]. Each kind of controller has a
//! folder of its own with its law and its
//! [`ControllerKind`]: its keys in the case file, its checks, how it is built, what the summary says of it.
//! The list of kinds is [`CONTROLLERS`]. Nothing here allocates, blocks or fails in [`Controller::update`];
//! what a shared library of others does in it is behind [`library`].

mod absent;
pub mod baseline;
mod controller;
pub mod derate;
pub mod discon;
mod error;
mod excitation;
pub mod held_speed;
pub mod helix;
mod keys;
mod kind;
pub mod library;
pub mod lidar_loop;
mod linear_law;
pub mod meandering;
mod outcome;
pub mod phase_sync;
pub mod probing;
pub mod pulse;
mod samples;
pub mod steering;
mod stop;

pub use absent::ABSENT;
pub use baseline::Baseline;
pub use basis::Sense;
pub use controller::{Controller, ForeignState, from_bytes, to_bytes};
pub use derate::Derate;
pub use discon::Discon;
pub use error::ControlError;
pub use excitation::{Excitation, OnTop, excitation_rate};
pub use held_speed::HeldSpeed;
pub use helix::Helix;
pub use kind::{
    Control, ControllerKind, FurtherSensor, Identification, Motion, Pitching, Place, Site,
};
pub use lidar_loop::LidarLoop;
pub use linear_law::{LawFiles, LinearLaw, LinearLaws};
pub use meandering::Meandering;
pub use outcome::{MissingChannel, Outcome, TurbineRecord};
pub use phase_sync::PhaseSync;
pub use probing::Probing;
pub use pulse::Pulse;
pub use steering::Steering;

use basis::registry::Registry;

/// The kinds of controllers. A new kind is a folder beside these and a line here; a program built on wakemix
/// [adds](Registry::add) its own.
pub static CONTROLLERS: Registry<dyn ControllerKind> = Registry::new(&[
    &baseline::BASELINE,
    &held_speed::HELD_SPEED,
    &helix::HELIX,
    &pulse::PULSE,
    &phase_sync::PHASE_SYNC,
    &meandering::MEANDERING,
    &probing::PROBING,
    &lidar_loop::LIDAR_LOOP,
    &steering::STEERING,
    &derate::DERATE,
    &discon::DISCON,
    &ABSENT,
]);
