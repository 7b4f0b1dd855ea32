//! Aerodynamic parameters of blade elements: annulus, polar, dynamic stall.

use super::Polar;
use super::blade_element::Annulus;
use super::dynamic_stall::{Attached, DynamicStall};
use super::induction::Ring;
use crate::actuator_line::Element;
use crate::definition::Definition;

/// Parameters of one blade element, the same on every blade.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) ring: Ring,
    /// Length along the blade's line (m).
    pub(super) width: f64,
    /// Swept area of its ring over 2π (m²).
    pub(super) area: f64,
    pub(super) polar: Polar,
    /// None for cylinders.
    pub(super) stall: Option<DynamicStall>,
}

/// The `elements` of a blade of `definition`, root to tip.
pub(super) fn sections(definition: &Definition, elements: &[Element]) -> Vec<Section> {
    let hub_radius = definition.distance_from_shaft(definition.rotor.hub_radius, 0.0);
    elements
        .iter()
        .map(|element| {
            let polar = element.polar(definition);
            let ring = Ring::new(Annulus {
                n_blades: definition.n_blades,
                radius: element.radius,
                hub_radius,
                tip_radius: definition.rotor_radius(),
                chord: element.chord,
                section_pitch: element.twist,
                cone_angle: 0.0,
            });
            let stall = DynamicStall::new(&polar, Attached::Delayed);
            let (width, area) = (element.width, element.radius * element.width);
            Section { ring, width, area, polar, stall }
        })
        .collect()
}
