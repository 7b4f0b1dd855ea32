//! Which way the sections of a bent blade face.

use super::samples::plain;
use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::Frame;
use crate::structure::{Pitch, Structure, StructureSettings};
use basis::{PerBlade, Vector3};

/// Straight blades that turn in an upright plane.
fn flat() -> Definition {
    let mut definition = plain();
    definition.rotor.precone = 0.0;
    definition.rotor.shaft_tilt = 0.0;
    definition.blade.iter_mut().for_each(|station| (station.prebend, station.sweep) = (0.0, 0.0));
    definition
}

/// Elements of blade 1 of [`flat`], upright, pitched by `pitch` (rad) and bent by `q`: flapwise 1 and 2,
/// edgewise 1 (m). Their positions count from the hub.
fn bent(pitch: f64, q: [f64; 3]) -> Vec<ElementMotion> {
    let settings =
        StructureSettings { spans: &[8.0, 20.0, 33.0, 41.0], ..StructureSettings::AT_REST };
    let mut structure = Structure::new(&flat(), &settings).unwrap();
    structure.state.coordinates.blades[0] = q;
    let still = ElementMotion {
        position: Vector3::ZERO,
        velocity: Vector3::ZERO,
        axes: Frame::new(Vector3::ZERO, 0.0).blade(0.0, 0.0),
        pitch: 0.0,
    };
    let mut elements = vec![still; 12];
    let pitch = PerBlade::splat(3, Pitch { angle: pitch, ..Pitch::default() });
    structure.observe(0.0, &pitch, &mut elements);
    elements.truncate(4);
    let hub = structure.frame(0.0).hub;
    elements.iter_mut().for_each(|element| element.position -= hub);
    elements
}

/// Where a section of `element` faces, twist aside.
fn facing(element: &ElementMotion) -> Vector3 {
    let (sine, cosine) = element.pitch.sin_cos();
    element.axes.normal * cosine + element.axes.tangent * sine
}

#[test]
fn a_straight_blade_is_turned_by_its_pitch() {
    for pitch in [-0.3, 0.0, 0.02, 1.5] {
        for element in bent(pitch, [0.0; 3]) {
            assert!((element.pitch - pitch).abs() < 1e-12);
            assert!((element.axes.normal - Vector3::X).length() < 1e-12);
        }
    }
}

/// A blade that bends in one plane, without torsion, turns each section about the axis across that plane and
/// not about itself: by the smallest rotation that carries the straight blade over into the bent one.
#[test]
fn sections_of_a_bent_blade_turn_as_little_as_they_can() {
    for (flap, edge) in [(6.0, 1.0), (6.0, -1.0), (-3.0, 1.5), (5.0, 0.0), (0.0, 1.5)] {
        for element in bent(0.0, [flap, 0.0, edge]) {
            let span = element.axes.span;
            let axis = Vector3::Z.cross(span);
            let exact = Vector3::X
                + axis.cross(Vector3::X)
                + axis.cross(axis.cross(Vector3::X)) / (1.0 + span.z);
            let miss = (facing(&element) - exact).length();
            // What is left is of third order in the slopes.
            let slope = axis.length();
            assert!(miss < 0.6 * slope.powi(3) + 1e-12, "{flap} {edge}: {miss} {slope}");
            // Half the product of the slopes, less what the swept surface turns where the blade lies beside
            // its radius.
            let beside = element.position.y / element.position.z;
            let expected = span.x * (0.5 * span.y - beside);
            assert!((element.pitch - expected).abs() < 0.6 * slope.powi(3) + 1e-12, "{element:?}");
            if flap * edge != 0.0 {
                assert!(element.pitch.abs() > 0.5 * expected.abs(), "{element:?}");
            }
        }
    }
}

#[test]
fn the_swept_surface_holds_the_way_of_the_blade() {
    for element in bent(0.1, [4.0, 0.3, 1.2]) {
        let way = Vector3::X.cross(element.position);
        assert!(element.axes.normal.dot(way).abs() < 1e-12 * way.length());
        assert!(element.axes.normal.dot(element.axes.span).abs() < 1e-12);
    }
}
