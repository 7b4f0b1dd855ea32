//! Vortices with closed forms, and solvers against each other.

mod bodies;
mod closed_forms;
mod coaxial;
mod fields;
mod filaments;
mod wakes;
