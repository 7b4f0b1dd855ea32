//! A stiff rotor in motion, for tests.

use crate::actuator_line::ActuatorLine;
use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::Frame;
use crate::structure::Pitch;
use basis::mbc::blade_azimuth;
use basis::{PerBlade, Vector3};
use std::sync::Arc;

const N_ELEMENTS: usize = 24;

/// The blades of `definition` in elements.
pub(super) fn line(definition: &Definition) -> ActuatorLine {
    ActuatorLine::new(Arc::new(definition.clone()), N_ELEMENTS, 1.225, 4.0, 0.0)
}

/// A stiff rotor of `definition` that turns.
pub(super) struct Stiff {
    pub(super) definition: Definition,
    pub(super) line: ActuatorLine,
    pub(super) frame: Frame,
    pub(super) rotor_speed: f64,
}

impl Stiff {
    pub(super) fn new(definition: Definition, rotor_speed: f64) -> Self {
        let line = line(&definition);
        let hub = Vector3::Z * definition.rotor.hub_height;
        let frame = Frame::new(hub, definition.rotor.shaft_tilt);
        Self { definition, line, frame, rotor_speed }
    }

    /// Its elements with blade 1 at `azimuth` (rad), blades pitched by `pitch` (rad).
    pub(super) fn motions(&self, azimuth: f64, pitch: f64) -> Vec<ElementMotion> {
        let n_blades = self.definition.n_blades;
        let precone = self.definition.rotor.precone;
        (0..n_blades)
            .flat_map(|blade| {
                let azimuth = blade_azimuth(azimuth, blade, n_blades);
                self.line.elements().iter().map(move |element| {
                    let position = element.position(&self.frame, azimuth, precone);
                    let turning = self.frame.shaft * self.rotor_speed;
                    ElementMotion {
                        position,
                        velocity: turning.cross(position - self.frame.hub),
                        axes: self.frame.blade(azimuth, element.cone_angle),
                        pitch,
                    }
                })
            })
            .collect()
    }

    /// Blades that stand at `angle` (rad).
    pub(super) fn pitch(&self, angle: f64) -> PerBlade<Pitch> {
        PerBlade::splat(self.definition.n_blades, Pitch { angle, ..Pitch::default() })
    }
}
