//! Analyses of wakes on fields whose answers are known: phases, vortices, particles, fluxes, modes; the
//! budget of a wake on the lattice.

mod fields;
mod lattice;
mod modes;
mod particles;
mod phases;
mod vortices;

use crate::Row;
use crate::random::Random;

/// All of them, in the order of their page.
///
/// # Panics
/// When the stored spectral modes cannot be read, a synthetic field is refused, or the lattice diverges.
pub fn wake_analysis() -> Vec<Row> {
    let mut random = Random(20);
    let mut rows = vortices::rows();
    rows.extend(phases::rows(&mut random));
    rows.extend(particles::rows(&mut random));
    rows.extend(fields::rows());
    rows.extend(modes::rows());
    rows.extend(lattice::rows(&mut random));
    rows
}
