//! Kinematics of blade elements: from the structure to the aerodynamics.

use crate::rotor::BladeFrame;
use basis::Vector3;

/// One blade element in motion, rotation of the rotor included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementMotion {
    /// Its middle, farm frame (m).
    pub position: Vector3,
    /// Velocity of its middle, farm frame (m/s).
    pub velocity: Vector3,
    /// Its directions: precone, prebend and bending included, pitch and twist not.
    pub axes: BladeFrame,
    /// Rotation of the section about `axes.span`, away from facing `axes.normal`, positive to feather (rad):
    /// pitch, and the rotation by combined out-of-plane and in-plane bending; twist not.
    pub pitch: f64,
}
