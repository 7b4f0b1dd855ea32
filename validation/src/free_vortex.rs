//! The free wake against closed forms, and its rotors against momentum theory and the flow of rings together.

mod held;
mod rotor;
mod vortices;
mod wake;
mod wing;

use crate::Row;
pub use wake::{pictures as free_vortex_wake_pictures, rows as free_vortex_wake};

/// Segments, rings and helices, an elliptic wing, and the sum over boxes of vortices.
pub fn free_vortex() -> Vec<Row> {
    let mut rows = vortices::rows();
    rows.extend(wing::rows());
    rows
}

/// Power and thrust of three rotors at their best tip-speed ratio.
pub fn free_vortex_rotor() -> Vec<Row> {
    rotor::rows()
}
