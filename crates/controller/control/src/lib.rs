//! Decisions: what a turbine is told, from its measurements alone.

pub mod baseline;
