//! What the settings of a box mean for its rows.

use super::layout::Edge;
use super::settings::{Ground, Sides};

impl Edge {
    /// What lies beyond `sides`.
    pub(crate) fn of_sides(sides: Sides) -> Self {
        match sides {
            Sides::Periodic => Self::Periodic,
            Sides::Slip => Self::Slip,
            Sides::Open => Self::Open,
        }
    }

    /// What lies below and above, given the `ground`.
    pub(crate) fn of_ground(ground: Ground) -> [Self; 2] {
        match ground {
            Ground::Periodic => [Self::Periodic; 2],
            Ground::Slip | Ground::WallStress { .. } => [Self::Slip; 2],
            Ground::NoSlip => [Self::Hold, Self::Slip],
            Ground::Plates => [Self::Hold; 2],
        }
    }
}
