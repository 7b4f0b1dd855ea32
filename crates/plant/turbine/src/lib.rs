//! One machine: its definition, the aerodynamics of its blades, its drive train and actuators.

pub mod actuator_line;
pub mod actuators;
pub mod aero;
pub mod blockage;
pub mod bodies;
mod breakdown;
pub mod definition;
pub mod lifting_line;
pub mod loading;
pub mod motion;
pub mod rotor;
pub mod sample;
pub mod steady;
pub mod structure;
mod turbine;

pub use aero::polar::Polar;
pub use breakdown::Breakdown;
pub use definition::Definition;
pub use rotor::Frame;
pub use turbine::{
    FARTHEST_STRUCTURAL_STEP, Induction, LONGEST_STRUCTURAL_STEP, N_ELEMENTS, Turbine,
    TurbineSettings, TurbineState,
};
