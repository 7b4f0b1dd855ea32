//! A free-vortex wake: lifting lines shed their vorticity into the wind, which carries it, and which it
//! moves.

mod close;
mod direct;
pub mod examples;
mod field;
mod filaments;
mod full_length;
mod interpolation;
mod planes;
mod rotor;
mod segment;
mod settings;
mod sheet;
mod state;
mod strip;
#[cfg(test)]
mod tests;
mod tree;
mod wake;

pub use direct::direct;
pub use field::{Accuracy, induced};
pub use interpolation::{HIGHEST_DEGREE, LOWEST_DEGREE};
pub use segment::{Cores, Segment};
pub use settings::{Points, WakeError, WakeSettings};
pub use sheet::{LASTING, Resolution};
pub use wake::FreeWake;
