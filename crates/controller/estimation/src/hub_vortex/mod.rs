//! The hub vortex of a wake in a lidar's scans: where it is, in the fixed frame and in that of the helix.
//!
//! ```text
//!  scan ──> find ──place──> low-pass ──> less its mean ──> helix frame ──> tilt and yaw, constant
//!          (fast region,    (FIR)        (whole periods)   (turned to the     in a helix
//!           jet or centroid)                              time of the place)
//! ```
//!
//! [`HubVortexFilter`] takes scan after scan in a control loop, [`follow`] a whole record, with the same
//! arithmetic.
//!
//! Source: Chen, van Vondelen, van Wingerden (2026), "Lidar-enhanced closed-loop active helix approach", Wind
//! Energ. Sci. 11, 1871, sections 3.2.2 and 3.2.3 and Appendix B. Its lateral coordinate goes with yaw: to
//! the right looking downwind, where [`HubVortex::place`] has the left, as this program does.

mod background;
mod circle;
mod filter;
mod finder;
mod jet;
mod linear;
mod point;

pub use filter::{HubVortex, HubVortexFilter, HubVortexSettings, HubVortexState, follow};
pub use finder::{Method, Search};

#[cfg(test)]
mod tests;
