//! Vortices in fields of velocity: criteria, places, circulations and cores, tracks from phase to phase.
//!
//! Source of what is asked: van der Hoek, Van den Abbeele, Simao Ferreira and van Wingerden (2024), §3.4.

mod criteria;
mod cubic;
mod fit;
mod leapfrog;
mod peaks;
mod section;
mod sine;
mod track;

pub use criteria::{Gradient, gradients, lambda_2, q_criterion, vorticity};
pub use cubic::{CubicFit, cubic_fit};
pub use fit::{PEAK_OVER_LENGTH, Vortex, fit_vortex};
pub use leapfrog::{Blades, Leapfrog, Pairs, blades_of, leapfrogs};
pub use peaks::{Search, vortices};
pub use section::Section;
pub use sine::{SineFit, sine_fit};
pub use track::{Sighting, Track, Tracking, follow};

#[cfg(test)]
mod tests;
#[cfg(test)]
mod track_tests;
