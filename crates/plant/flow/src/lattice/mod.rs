//! Lattice-Boltzmann large-eddy simulation: one box of air on one grid.
//!
//! A step is one pass over the cells, in place: read the populations, [collide](collision), write them back
//! where the next step finds them. Periodic and slip sides are a matter of [addresses](layout), inlet and
//! outlet of a [halo](ends) cell at either end of a row, open sides of a [row](sides) of them beyond
//! each, the ground's stress of a [force](wall). The pass is written once, generic over the
//! [velocity set](stencil) and the [vector](crate::simd), and compiled for each instruction set. Models of
//! [eddies] that look at neighbours have a pass of their own after it.
//!
//! Reading order: `settings`, `scaling`, `solver`, `engine`; then `cpu`, `layout`, `stencil`, `collision`,
//! `sweep`.

pub mod atmosphere;
mod cell_box;
mod collision;
mod cpu;
mod eddies;
mod edges;
mod ends;
mod engine;
mod fields;
mod forces;
mod heat_links;
mod inlet;
mod joint;
mod kernel;
mod layout;
mod levels;
mod links;
mod memory;
mod planes;
mod probe;
pub mod refinement;
mod sampling;
mod scaling;
mod settings;
mod sides;
mod solver;
pub mod spreading;
mod state;
mod stencil;
mod stencil27;
mod still;
mod subgrid;
mod sweep;
#[cfg(test)]
mod tests;
mod times;
mod values;
mod wall;

pub use crate::fields::{PlaneAverage, PlaneAverageState, PlaneSizeError, Volume};
pub use crate::simd::Backend;
pub use engine::Engine;
pub use forces::ForceBlock;
pub use heat_links::{Face, Given, Heat, HeatExchange, RowFill};
pub use links::{Exchange, Fill, Link, Way};
pub use probe::RowState;
pub use scaling::Scaling;
pub use settings::{Ends, Ground, LatticeError, LatticeSettings, Sides, Stencil};
pub use solver::Lattice;
pub use subgrid::{DEFAULT_SMAGORINSKY, Subgrid, SubgridModel};
pub use wall::VON_KARMAN;
