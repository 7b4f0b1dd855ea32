//! Aerodynamics of blades: what a section feels, and what a ring of air and its blade sections agree on.

pub mod blade_element;
pub mod blade_moments;
pub mod dynamic_stall;
pub mod induction;
pub mod polar;
pub mod rotor;
#[cfg(test)]
mod sample;
mod section;
pub mod tower_influence;

pub use dynamic_stall::DynamicStall;
pub use induction::Induction;
pub use polar::{Polar, PolarError, SectionCoefficients, UnsteadyConstants};
pub use rotor::RotorAerodynamics;
pub use tower_influence::TowerInfluence;
