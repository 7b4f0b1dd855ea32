//! One machine: its definition, the aerodynamics of its blades, its drive train and actuators.

pub mod actuators;
pub mod aero;
pub mod definition;

pub use aero::polar::Polar;
pub use definition::Definition;
