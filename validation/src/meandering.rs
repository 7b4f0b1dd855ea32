//! Meandering synchronised with phase-locked loops, beside van Veldhoven, "Closed-Loop Wake Meandering
//! Control of Downstream Wind Turbines", TU Delft 2024, chapters 2 to 4: loops alone, three masses on
//! springs, a turbine in a rotating disk.

mod bench;
mod disk;
mod follower;
mod identify;
mod judge;
mod loops;
mod pictures;
mod rig;
mod spring_mass;
mod wake;

pub use bench::bench;
pub use disk::disk;
pub use loops::loops;
pub use pictures::pictures;
pub use wake::wake;
