//! What the machine can do, measured beside what a solver does with it.

pub mod arithmetic;
pub mod bandwidth;
pub mod disk;
mod huge;
