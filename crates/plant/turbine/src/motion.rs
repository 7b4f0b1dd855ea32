//! Where the elements of a blade are and how they move: what structure tells aerodynamics.

use crate::rotor::BladeFrame;
use basis::Vector3;

/// One blade element in motion, rotation of the rotor included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementMotion {
    /// Its middle, farm frame (m).
    pub position: Vector3,
    /// Velocity of its middle, farm frame (m/s).
    pub velocity: Vector3,
    /// Directions at it: precone, prebend and bending included, pitch and twist not.
    pub axes: BladeFrame,
    /// Turn of the section about `axes.span`, away from facing `axes.normal`, positive to feather (rad): pitch, and what bending
    /// out of the plane and in it at once adds; twist not.
    pub pitch: f64,
}
