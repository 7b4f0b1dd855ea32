//! What the machine can do, measured beside what a solver does with it.

pub mod bandwidth;
mod huge;
