//! Directions of rotor and blades in the farm frame.

use basis::{Matrix3, Vector3};

/// Attitude of a rotor: hub, shaft and plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Centre of the hub, farm frame (m).
    pub hub: Vector3,
    /// Along the shaft, downwind.
    pub shaft: Vector3,
    /// In the rotor plane, towards azimuth zero.
    pub up: Vector3,
    /// In the rotor plane, towards azimuth 90°: to the right looking along the shaft.
    pub right: Vector3,
}

/// Directions at a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BladeFrame {
    /// Along the blade, towards the tip.
    pub span: Vector3,
    /// Out of the surface that the blade sweeps, downwind.
    pub normal: Vector3,
    /// Along the rotation.
    pub tangent: Vector3,
}

impl Frame {
    /// A rotor that faces the wind with its hub at `hub` (m), the shaft's upwind end raised by `tilt` (rad).
    pub fn new(hub: Vector3, tilt: f64) -> Self {
        let (sine, cosine) = tilt.sin_cos();
        Self {
            hub,
            shaft: Vector3::new(cosine, 0.0, -sine),
            up: Vector3::new(sine, 0.0, cosine),
            right: Vector3::NEG_Y,
        }
    }

    /// The same rotor turned by `yaw` (rad) about the vertical through `axis` (m), counter-clockwise seen
    /// from above: positive yaw carries the upwind side to the right looking downwind, and the thrust on
    /// the air, hence the wake, to the right too.
    pub fn turned(&self, axis: Vector3, yaw: f64) -> Self {
        if yaw == 0.0 {
            return *self;
        }
        let turn = Matrix3::from_rotation_z(yaw);
        Self {
            hub: axis + turn * (self.hub - axis),
            shaft: turn * self.shaft,
            up: turn * self.up,
            right: turn * self.right,
        }
    }

    /// Directions at a blade at `azimuth` (rad), coned upwind by `precone` (rad).
    pub fn blade(&self, azimuth: f64, precone: f64) -> BladeFrame {
        let (sine, cosine) = azimuth.sin_cos();
        let radial = self.up * cosine + self.right * sine;
        let (cone_sine, cone_cosine) = precone.sin_cos();
        BladeFrame {
            span: radial * cone_cosine - self.shaft * cone_sine,
            normal: self.shaft * cone_cosine + radial * cone_sine,
            tangent: self.right * cosine - self.up * sine,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blades_follow_the_convention() {
        let frame = Frame::new(Vector3::new(-10.0, 0.0, 150.0), 0.0);
        for azimuth in [0.0_f64, 0.7, 1.6, 3.0, 5.5] {
            let blade = frame.blade(azimuth, 0.0);
            let expected = Vector3::new(0.0, -azimuth.sin(), azimuth.cos());
            assert!((blade.span - expected).length() < 1e-15);
            assert!((blade.normal - Vector3::X).length() < 1e-15);
            // The tip moves along the tangent, clockwise seen from upwind: about +x.
            assert!((Vector3::X.cross(blade.span) - blade.tangent).length() < 1e-15);
        }
    }

    #[test]
    fn yaw_turns_counter_clockwise_seen_from_above() {
        let axis = Vector3::new(3.0, 7.0, 0.0);
        let facing = Frame::new(axis + Vector3::new(-10.0, 0.0, 150.0), 0.1);
        assert_eq!(facing.turned(axis, 0.0), facing);
        let yaw = 0.3_f64;
        let turned = facing.turned(axis, yaw);
        // The upwind end goes to the right looking downwind, the downwind end of the shaft to the left.
        let hub = axis + Vector3::new(-10.0 * yaw.cos(), -10.0 * yaw.sin(), 150.0);
        assert!((turned.hub - hub).length() < 1e-12);
        let shaft =
            Vector3::new(yaw.cos() * 0.1_f64.cos(), yaw.sin() * 0.1_f64.cos(), -0.1_f64.sin());
        assert!((turned.shaft - shaft).length() < 1e-15);
        assert!((turned.right.cross(turned.shaft) - turned.up).length() < 1e-15, "right-handed");
        assert!((facing.right.cross(facing.shaft) - facing.up).length() < 1e-15);
    }

    #[test]
    fn tilt_moves_the_lower_tip_upwind_and_cone_all_of_them() {
        let frame = Frame::new(Vector3::ZERO, 0.1);
        assert!(frame.blade(std::f64::consts::PI, 0.0).span.x < 0.0);
        for azimuth in [0.0, 2.0, 4.0] {
            let blade = Frame::new(Vector3::ZERO, 0.0).blade(azimuth, 0.05);
            assert!(blade.span.x < 0.0);
            assert!(
                (blade.normal.cross(blade.span) - blade.tangent).length() < 1e-15,
                "right-handed"
            );
        }
    }
}
