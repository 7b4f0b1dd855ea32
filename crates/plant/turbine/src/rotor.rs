//! Directions of rotor and blades in the farm frame.

use basis::Vector3;

/// Attitude of a rotor that faces the wind: hub, shaft and plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Centre of the hub, farm frame (m).
    pub hub: Vector3,
    /// Along the shaft, downwind.
    pub shaft: Vector3,
    /// In the rotor plane, towards azimuth zero.
    pub up: Vector3,
    /// In the rotor plane, towards azimuth 90°: to the right looking downwind.
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
    /// A rotor with its hub at `hub` (m), the shaft's upwind end raised by `tilt` (rad).
    pub fn new(hub: Vector3, tilt: f64) -> Self {
        let (sine, cosine) = tilt.sin_cos();
        Self {
            hub,
            shaft: Vector3::new(cosine, 0.0, -sine),
            up: Vector3::new(sine, 0.0, cosine),
            right: Vector3::NEG_Y,
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
