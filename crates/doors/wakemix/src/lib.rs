//! Wind-farm wake mixing, from wind to report: the rooms under one roof.
//!
//! Each module is a room of the house; ARCHITECTURE.md in the repository says what belongs where.
//! From a case file to a report in one call: [`study::run`].

pub use analysis;
pub use basis;
pub use control;
pub use estimation;
pub use farm;
pub use flow;
pub use formats;
pub use postprocessing;
pub use report;
pub use study;
pub use turbine;
