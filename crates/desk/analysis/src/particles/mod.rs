//! Velocity on a grid from particles: bins that overlap, Gaussian weights, and a local polynomial.
//!
//! Particles stream; what is held are sums for each bin. A bin gives mean, gradients and stresses where it
//! has samples enough, and says how many and how sure.
//!
//! Sources: van der Hoek et al. (2024), Wind Energy, §2.3 (bins of 40 mm, Gaussian weights, overlap 75 %);
//! Agüera, Cafiero, Astarita and Discetti (2016), "Ensemble 3D PTV for high resolution turbulent
//! statistics", Meas. Sci. Technol. 27 (polynomials within bins); Westerweel and Scarano (2005), "Universal
//! outlier detection for PIV data", Exp. Fluids 39.

mod basis_functions;
mod binned;
mod binner;
mod error;
mod fit;
mod median;
mod order;
mod screen;
mod settings;

pub use binned::{Binned, Convergence, Tally};
pub use binner::Binner;
pub use error::ParticlesError;
pub use median::{MedianTest, outliers};
pub use order::Order;
pub use screen::{Screen, ScreenSettings, Screened};
pub use settings::BinSettings;

/// A particle at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Particle {
    /// Where it is (m).
    pub position: [f64; 3],
    /// Its velocity (m/s).
    pub velocity: [f64; 3],
}

impl Particle {
    /// Whether all of it are numbers.
    pub fn is_whole(&self) -> bool {
        self.position.iter().chain(&self.velocity).all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests;
