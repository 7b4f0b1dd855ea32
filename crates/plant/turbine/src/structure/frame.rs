//! Bodies that move with the shared coordinates: position, attitude, partial velocities and remaining
//! accelerations.

use super::coordinates::{Coordinates, N_SHARED};
use basis::{Matrix3, Vector3};

/// A frame fixed in a body, and how its origin moves.
///
/// Velocity = Σ `linear`ᵢ q̇ᵢ plus prescribed motion, acceleration = Σ `linear`ᵢ q̈ᵢ + `acceleration_rest`;
/// angles likewise. Farm frame throughout.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingFrame {
    /// Origin (m).
    pub(super) origin: Vector3,
    /// Farm from body: columns are the body's axes.
    pub(super) axes: Matrix3,
    /// Velocity of the origin (m/s).
    pub(super) velocity: Vector3,
    /// Angular velocity (rad/s).
    pub(super) spin: Vector3,
    /// Partial velocities of the origin by the shared coordinates.
    pub(super) linear: [Vector3; N_SHARED],
    /// Partial angular velocities by the shared coordinates.
    pub(super) angular: [Vector3; N_SHARED],
    /// Acceleration of the origin without second derivatives of the coordinates (m/s²).
    pub(super) acceleration_rest: Vector3,
    /// Angular acceleration without second derivatives of the coordinates (rad/s²).
    pub(super) angular_rest: Vector3,
}

impl MovingFrame {
    /// At rest in the farm frame, its origin at `origin` (m).
    pub(super) fn fixed(origin: Vector3) -> Self {
        Self {
            origin,
            axes: Matrix3::IDENTITY,
            velocity: Vector3::ZERO,
            spin: Vector3::ZERO,
            linear: [Vector3::ZERO; N_SHARED],
            angular: [Vector3::ZERO; N_SHARED],
            acceleration_rest: Vector3::ZERO,
            angular_rest: Vector3::ZERO,
        }
    }

    /// The same body about the point that lies at `arm` (m, in its own axes).
    pub(super) fn at(&self, arm: Vector3) -> Self {
        let arm = self.axes * arm;
        let mut moved = *self;
        moved.origin += arm;
        moved.velocity += self.spin.cross(arm);
        moved.acceleration_rest +=
            self.angular_rest.cross(arm) + self.spin.cross(self.spin.cross(arm));
        for (linear, angular) in moved.linear.iter_mut().zip(&self.angular) {
            *linear += angular.cross(arm);
        }
        moved
    }

    /// A frame of the same body with other axes, `own_from_new` of them.
    pub(super) fn with_axes(&self, own_from_new: &Matrix3) -> Self {
        Self { axes: self.axes * *own_from_new, ..*self }
    }

    /// A body with the same origin that turns relative to this one about `axis` (farm frame) at `rate`
    /// (rad/s) and `acceleration` (rad/s²). Both are prescribed, unless `coordinates` names the shared
    /// coordinates that make the rate.
    pub(super) fn turning(
        &self,
        axis: Vector3,
        rate: f64,
        acceleration: f64,
        coordinates: &[usize],
    ) -> Self {
        let mut turned = *self;
        turned.spin += axis * rate;
        turned.angular_rest += self.spin.cross(axis * rate) + axis * acceleration;
        for &coordinate in coordinates {
            turned.angular[coordinate] += axis;
        }
        turned
    }

    /// Acceleration of the origin (m/s²) with the second derivatives `accelerations`.
    pub(super) fn acceleration(&self, accelerations: &Coordinates) -> Vector3 {
        let terms = self.linear.iter().zip(&accelerations.shared).map(|(l, a)| *l * *a);
        self.acceleration_rest + terms.sum::<Vector3>()
    }

    /// Angular acceleration (rad/s²) with the second derivatives `accelerations`.
    pub(super) fn angular_acceleration(&self, accelerations: &Coordinates) -> Vector3 {
        let terms = self.angular.iter().zip(&accelerations.shared).map(|(w, a)| *w * *a);
        self.angular_rest + terms.sum::<Vector3>()
    }
}
