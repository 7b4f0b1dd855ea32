//! Vortices with closed forms, and solvers against each other.

mod closed_forms;
mod fields;
mod shapes;
