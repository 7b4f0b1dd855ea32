//! How machines push on the air.

use crate::Vector3;

/// A force on the air, spread over a Gaussian of width `smearing_length`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Where it acts, farm frame (m).
    pub position: Vector3,
    /// Force of the machine **on the air**, farm frame (N).
    pub force: Vector3,
    /// Gaussian width ε (m): the force density is f exp(−r²/ε²) / (ε³ π^{3/2}).
    pub smearing_length: f64,
}
