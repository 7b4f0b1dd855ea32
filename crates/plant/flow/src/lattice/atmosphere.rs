//! Air on a rotating earth, with temperature: rotation, buoyancy, an inversion above, heat through the
//! ground.
//!
//! Temperature is [carried](transport) in finite volumes on the same cells, after the sweep of the air, in
//! which it acts as buoyancy ([`law`]). What the ground does to wind and temperature is a matter of
//! [`similarity`], held by [`surface`].

mod beside;
pub(crate) mod coefficients;
pub(crate) mod law;
mod layer;
pub(crate) mod probe;
mod settings;
mod similarity;
mod statistics;
pub(crate) mod stratification;
pub(crate) mod surface;
pub(crate) mod transport;

pub use layer::{friction_velocity, ground_heat_flux, layer_depth, mean_stress};
pub use probe::AirRow;
pub use settings::{
    Atmosphere, AtmosphereError, Damping, Driving, GRAVITY, Heating, Perturbation, Reference,
};
pub use similarity::Similarity;
pub use statistics::LevelStatistics;
pub(crate) use statistics::Sums;
