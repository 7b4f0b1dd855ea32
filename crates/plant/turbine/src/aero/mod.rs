//! Aerodynamics of blades: what a section feels, and what a ring of air and its blade sections agree on.

pub mod blade_element;
pub mod polar;

pub use polar::{Polar, PolarError, SectionCoefficients, UnsteadyConstants};
