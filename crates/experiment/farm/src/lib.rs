//! Plant and controllers run together: layout, the loop, runs of a case, checkpoints.

pub mod case;
pub mod plan;
