//! Air on a rotating earth, with temperature: rotation, buoyancy, an inversion above, heat through the
//! ground.
//!
//! Temperature is carried by a second [set of populations](heat) on the same cells and moved in the same
//! pass; see [`sweep`]. What the ground does to wind and temperature is a matter of
//! [`similarity`], held by [`surface`].

mod coefficients;
mod ends;
mod heat;
mod law;
pub(crate) mod probe;
mod settings;
mod similarity;
mod statistics;
pub(crate) mod stratification;
pub(crate) mod surface;
pub(crate) mod sweep;

pub(crate) use heat::N_HEAT;
pub use probe::AirRow;
pub use settings::{
    Atmosphere, AtmosphereError, Damping, Driving, GRAVITY, Heating, Perturbation, Reference,
};
pub use similarity::Similarity;
pub use statistics::LevelStatistics;
pub(crate) use statistics::Sums;
