//! Modes of fields: proper orthogonal decomposition, and its spectral form, of more instants than memory
//! holds.
//!
//! Fields are read a few places at a time, all instants of each, so that memory is bounded by places times
//! instants of one part, and by the modes that are kept.

mod names;
mod pod;
mod snapshots;
mod spod;

pub use names::frequency_name;
pub use pod::{Pod, pod};
pub use snapshots::{InMemory, ModesError, Snapshots};
pub use spod::{Spod, SpodMode, SpodSettings, spod};

#[cfg(test)]
mod tests;
