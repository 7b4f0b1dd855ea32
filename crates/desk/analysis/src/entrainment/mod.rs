//! Kinetic energy that a wake takes in: flux of its mean through edges, power left for a rotor, whole
//! budgets.

mod available;
mod budget;
mod flux;

pub use available::{Available, DiscError, available_power};
pub use budget::{Budget, MeanFlow, Region, budget};
pub use flux::{Edge, FluxPoint, flux_along, flux_through_tube, integral, sign_flip, wake_edge};

#[cfg(test)]
mod tests;
