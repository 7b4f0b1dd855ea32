//! How the wind at a bent blade is projected: normal to the swept surface, and against the motion of its
//! sections.

use crate::rotor::BladeFrame;
use basis::{Matrix3, Vector3};

/// Frame in which aerodynamics sees the sections of a bent blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// Normal to the surface that the blade sweeps, and along its motion.
    #[default]
    Swept,
    /// As AeroDyn 5.0's standard formulation (BEM_Mod 1) has it; only to compare with it.
    ///
    /// It resolves the rotation of a section into angles about the blade's x, y and z axis, one after the
    /// other, and projects the wind on the frame of the one about y. The angle about z, which goes to the
    /// section's pitch, follows the angle about x, which that frame leaves out: sections face further into
    /// the wind by the product of the blade's slopes.
    Annular,
}

impl Projection {
    /// Axes of a section on a line along `span` (unit vector).
    ///
    /// The element moves along `swept` (m) and its blade's unpitched axes are `cone`, all in the farm frame.
    #[inline(always)]
    pub(super) fn axes(self, span: Vector3, swept: Vector3, cone: &Matrix3) -> BladeFrame {
        match self {
            Self::Swept => {
                let normal = span.cross(swept).normalize();
                BladeFrame { span, normal, tangent: normal.cross(span) }
            }
            Self::Annular => {
                let sine = cone.x_axis.dot(span);
                let normal = *cone * Vector3::new((1.0 - sine * sine).sqrt(), 0.0, -sine);
                let tangent = -cone.y_axis;
                BladeFrame { span: tangent.cross(normal), normal, tangent }
            }
        }
    }

    /// Turn (rad) of a section with these `axes` that faces `facing` on a line along `span` (unit vectors).
    #[inline(always)]
    pub(super) fn turn(
        self,
        axes: &BladeFrame,
        span: Vector3,
        facing: Vector3,
        cone: &Matrix3,
    ) -> f64 {
        match self {
            Self::Swept => facing.dot(axes.tangent).atan2(facing.dot(axes.normal)),
            Self::Annular => {
                let own_from_farm = cone.transpose();
                let (span, facing) = (own_from_farm * span, own_from_farm * facing);
                let cos_y = (1.0 - span.x * span.x).sqrt();
                let (sin_x, cos_x) = (-span.y / cos_y, span.z / cos_y);
                let unturned = Vector3::new(cos_y, sin_x * span.x, -cos_x * span.x);
                let beside = Vector3::new(0.0, cos_x, sin_x);
                -facing.dot(beside).atan2(facing.dot(unturned))
            }
        }
    }
}
