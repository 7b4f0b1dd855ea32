//! What a turbine's parts are set up with.

use super::settings::Induction;
use super::{FARTHEST_STRUCTURAL_STEP, LONGEST_STRUCTURAL_STEP};
use crate::definition::Definition;
use crate::rotor::Frame;
use crate::structure::DegreeOfFreedom;
use basis::Vector3;

/// Smearing length and distance of sample points (m).
pub(super) fn lengths(induction: &Induction, definition: &Definition) -> (f64, f64) {
    match *induction {
        Induction::ByFlow { smearing_length, sample_spacing, .. } => {
            (smearing_length, sample_spacing)
        }
        // Nothing is smeared; the length only divides the tower into segments.
        Induction::ByBoundVortices { .. } | Induction::ByMomentum(_) => {
            (0.1 * definition.rotor_radius(), 0.0)
        }
    }
}

/// Centre and attitude of the undeflected rotor whose tower stands at `position` (m).
pub(super) fn frame_at(position: Vector3, definition: &Definition) -> Frame {
    let geometry = definition.rotor;
    let shaft = Frame::new(Vector3::ZERO, geometry.shaft_tilt).shaft;
    // The overhang runs along the shaft; the hub height is the apex's own.
    let apex = position + Vector3::new(-geometry.overhang * shaft.x, 0.0, geometry.hub_height);
    Frame::new(apex, geometry.shaft_tilt)
}

/// Longest step of the structure of `definition` (s).
pub(super) fn longest_step(definition: &Definition) -> f64 {
    LONGEST_STRUCTURAL_STEP.min(FARTHEST_STRUCTURAL_STEP / definition.rated_rotor_speed)
}

/// What does not move where only the rotor turns.
pub(super) fn all_but_the_generator() -> Vec<DegreeOfFreedom> {
    DegreeOfFreedom::ALL
        .into_iter()
        .filter(|degree| *degree != DegreeOfFreedom::Generator)
        .collect()
}
