//! The axes in which a lidar tells its places.

use basis::{Matrix3, Vector3};
use turbine::Frame;

/// Level axes, farm frame, that turn with the nacelle of a turbine whose undeflected `rotor` this is:
/// downwind, left, up.
pub fn level_axes(rotor: &Frame) -> Matrix3 {
    let left = -rotor.right;
    Matrix3::from_cols(left.cross(Vector3::Z), left, Vector3::Z)
}
