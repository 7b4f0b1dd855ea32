//! The free wake against closed forms, and its rotors against momentum theory and the flow of rings together.

mod held;
mod rotor;
mod vortices;
mod wing;

use crate::Row;

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
