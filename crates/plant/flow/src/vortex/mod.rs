//! A free-vortex wake: lifting lines shed their vorticity into the wind, which carries it, and which it
//! moves.

mod body;
mod close;
mod direct;
mod division;
mod ending;
pub mod examples;
mod far;
mod field;
mod filaments;
mod full_length;
mod graph;
mod harmonics;
mod narrow;
mod near;
mod neighbours;
mod planes;
pub mod rings;
mod rotor;
mod segment;
mod settings;
mod sheet;
mod state;
mod strain;
mod strip;
#[cfg(test)]
mod tests;
mod tree;
mod wake;

pub use body::BodyWakes;
pub use direct::direct;
pub use ending::share_of_endless;
pub use field::{Accuracy, induced};
pub use harmonics::{HIGHEST_DEGREE, LOWEST_DEGREE};
pub use segment::{Cores, Segment};
pub use settings::{MeanShear, Points, WakeError, WakeSettings};
pub use sheet::Resolution;
pub use wake::{FARTHEST_TURN, FreeWake};
