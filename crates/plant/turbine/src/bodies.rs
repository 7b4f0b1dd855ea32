//! Bluff bodies: tower segments and the nacelle with its hub, as point drag forces.

use crate::definition::{Definition, TowerProfile};
use crate::rotor::Frame;
use basis::{PointForce, Vector3};
use std::f64::consts::PI;

/// Drag coefficient of hub and nacelle on the hub's frontal area (–): a blunt cylinder along the flow, one to
/// two diameters long. Source: Hoerner, Fluid-Dynamic Drag (1965), ch. III.
const NACELLE_DRAG_COEFFICIENT: f64 = 0.85;
/// Tower segments are no longer than this share of the smearing length, so that their Gaussians blend.
const LONGEST_SEGMENT: f64 = 0.75;

/// A bluff body with drag along the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Centre, farm frame (m).
    pub position: Vector3,
    /// Drag area, coefficient × frontal area (m²).
    pub drag_area: f64,
    /// Deficit at the body's centre due to its own smeared drag, over the free wind (–).
    self_induction: f64,
    /// Axis of the body, along which it has no drag; zero for a compact one.
    axis: Vector3,
    /// Radius of the disc from whose edge its wake leaves it (m); none for a piece of something longer.
    disc_radius: Option<f64>,
}

/// The bodies of a turbine of `definition` with its tower's foot at `position` (m): tower from the bottom up,
/// then nacelle.
pub fn of(
    definition: &Definition,
    position: Vector3,
    frame: &Frame,
    smearing_length: f64,
) -> Vec<Body> {
    let profile = &definition.tower.profile;
    let mut bodies = Vec::new();
    if let [bottom, .., top] = profile.as_slice() {
        let (low, high) = (bottom.height.max(0.0), top.height);
        let n_segments = ((high - low) / (LONGEST_SEGMENT * smearing_length)).ceil().max(1.0);
        let height = (high - low) / n_segments;
        for segment in 0..n_segments as usize {
            let middle = low + (segment as f64 + 0.5) * height;
            let (diameter, drag_coefficient) = tower_at(profile, middle);
            let at = position + Vector3::Z * middle;
            bodies.push(Body::tower_segment(
                at,
                height,
                diameter,
                drag_coefficient,
                smearing_length,
            ));
        }
    }
    let frontal_area = PI * definition.rotor.hub_radius.powi(2);
    let nacelle =
        Body::compact(frame.hub, NACELLE_DRAG_COEFFICIENT * frontal_area, smearing_length);
    bodies.push(Body { disc_radius: Some(definition.rotor.hub_radius), ..nacelle });
    bodies
}

/// Diameter (m) and drag coefficient (–) of a tower at `height` (m), linear in between.
fn tower_at(profile: &[TowerProfile], height: f64) -> (f64, f64) {
    let next =
        profile.partition_point(|section| section.height <= height).clamp(1, profile.len() - 1);
    let (low, high) = (&profile[next - 1], &profile[next]);
    let share = (height - low.height) / (high.height - low.height);
    (
        low.diameter + share * (high.diameter - low.diameter),
        low.drag_coefficient + share * (high.drag_coefficient - low.drag_coefficient),
    )
}

impl Body {
    /// A segment of a round tower: `height` (m) of it around `position`, `diameter` (m) wide.
    ///
    /// The wake of a two-dimensional drag smeared over ε takes c_d d / (4 √π ε) from the wind at its own
    /// centre, Martínez-Tossas (2017): half the wake's centre-line deficit.
    pub fn tower_segment(
        position: Vector3,
        height: f64,
        diameter: f64,
        drag_coefficient: f64,
        smearing_length: f64,
    ) -> Self {
        Self {
            position,
            drag_area: drag_coefficient * diameter * height,
            self_induction: drag_coefficient * diameter / (4.0 * PI.sqrt() * smearing_length),
            axis: Vector3::Z,
            disc_radius: None,
        }
    }

    /// A compact body such as a nacelle; its smeared wake takes c_d A / (4 π ε²) from the wind at its centre.
    pub fn compact(position: Vector3, drag_area: f64, smearing_length: f64) -> Self {
        let self_induction = drag_area / (4.0 * PI * smearing_length * smearing_length);
        Self { position, drag_area, self_induction, axis: Vector3::ZERO, disc_radius: None }
    }

    /// From now on the wind given to the body is the free wind, without the effect of its own drag.
    pub fn use_free_wind(&mut self) {
        self.self_induction = 0.0;
    }

    /// Force on the air in `wind` (m/s) sampled at the body's position, ½ ρ c_d A |v| v against the free wind
    /// v.
    pub fn force(&self, wind: Vector3, air_density: f64, smearing_length: f64) -> PointForce {
        let across = wind - self.axis * wind.dot(self.axis);
        // A body wider than its smearing would reduce its own wind to nothing; at most half of the wind is
        // restored.
        let free = across / (1.0 - self.self_induction.min(0.5));
        let force = free * (-0.5 * air_density * self.drag_area * free.length());
        let disc_radius = self.disc_radius;
        PointForce { disc_radius, ..PointForce::of_body(self.position, force, smearing_length) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drag_holds_the_air_back_with_the_square_of_the_wind() {
        let body = Body::compact(Vector3::ZERO, 60.0, 1e9);
        let drag = body.force(Vector3::new(10.0, 0.0, 0.0), 1.2, 30.0);
        assert!((drag.force.x + 0.5 * 1.2 * 60.0 * 100.0).abs() < 1e-9);
        let twice = body.force(Vector3::new(0.0, 20.0, 0.0), 1.2, 30.0);
        assert!((twice.force.y / drag.force.x - 4.0).abs() < 1e-12);
        assert_eq!(body.force(Vector3::ZERO, 1.2, 30.0).force, Vector3::ZERO);
    }

    #[test]
    fn a_tower_feels_no_wind_along_itself_and_gets_its_own_shadow_back() {
        let tower = Body::tower_segment(Vector3::ZERO, 20.0, 10.0, 1.0, 30.0);
        assert_eq!(tower.force(Vector3::Z * 5.0, 1.2, 30.0).force, Vector3::ZERO);
        let shadow = 10.0 / (4.0 * PI.sqrt() * 30.0);
        let drag = tower.force(Vector3::new(10.0 * (1.0 - shadow), 0.0, 3.0), 1.2, 30.0);
        assert!((drag.force.x + 0.5 * 1.2 * 200.0 * 100.0).abs() < 1e-9);
    }
}
