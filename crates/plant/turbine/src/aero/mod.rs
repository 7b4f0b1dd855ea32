//! Aerodynamics of blades: section polars, dynamic stall, blade-element momentum theory and dynamic inflow.

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
