//! Aerodynamics of blades: what a section feels, and what a rotor feels in a steady wind.

pub mod polar;

pub use polar::{Polar, PolarError, SectionCoefficients, UnsteadyConstants};
