//! Velocities of particles, brought onto a grid.
//!
//! Source: van der Hoek et al. (2024), §2.3: cells of 40 mm with Gaussian weights that overlap by 75 %.

mod binner;
mod median;
mod result;

pub use binner::{Binner, Cells, ParticleError, Taken};
pub use median::{MedianTest, outliers};
pub use result::{Binned, is_beyond};

#[cfg(test)]
mod tests;
