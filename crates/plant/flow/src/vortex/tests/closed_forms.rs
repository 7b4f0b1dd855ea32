//! Rings and helices against what is known of them.

use crate::vortex::examples::chain;
use crate::vortex::rings::{Loops, of_thin_ring, ring, speed_of_pieces, speed_of_ring};
use crate::vortex::{Segment, direct};
use basis::Vector3;
use std::f64::consts::TAU;

fn velocity(segments: &[Segment], position: Vector3) -> Vector3 {
    let mut velocity = [Vector3::ZERO];
    direct(segments, &[position], &mut velocity);
    velocity[0]
}

#[test]
fn a_ring_induces_what_lamb_has() {
    let (radius, circulation) = (2.0, 5.0);
    let segments = ring(0.3, radius, circulation, 1e-3, 2000);
    // Chords of 2000 pieces miss the circle by 1e-6 of its radius.
    let centre = velocity(&segments, Vector3::X * 0.3);
    assert!((centre.x - circulation / (2.0 * radius)).abs() < 1e-5 * centre.x, "{centre}");
    for (x, r) in [(0.5, 0.7), (-1.5, 1.9), (0.2, 2.4), (3.0, 5.0)] {
        let found = velocity(&segments, Vector3::new(0.3 + x, 0.0, r));
        let [axial, radial] = of_thin_ring(radius, x, r).map(|per_unit| per_unit * circulation);
        let error = (found - Vector3::new(axial, 0.0, radial)).length();
        assert!(error < 1e-5 * axial.hypot(radial), "{found} {axial} {radial}");
    }
}

#[test]
fn a_ring_moves_at_the_speed_of_its_core_to_second_order() {
    let (radius, core) = (1.0, 0.1);
    let pieces = speed_of_pieces(radius, core);
    let errors = [40, 160, 320, 640].map(|n| {
        let mut one = Loops::new(ring(0.0, radius, 1.0, core, n), n);
        let speeds = one.velocities().iter().map(|velocity| velocity.x);
        (speeds.sum::<f64>() / n as f64 / pieces - 1.0).abs()
    });
    // Longer than a core, pieces cut off at a quarter of their length: ln (0.07 / 0.04) of ln 80 − ½.
    assert!(errors[0] < 0.17, "{errors:?}");
    for pair in errors[1..].windows(2) {
        assert!((3.0..5.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    // Saffman's speed leaves out terms of the core over the radius, squared.
    assert!((pieces / speed_of_ring(radius, core) - 1.0).abs() < 0.01, "{pieces}");
}

/// The helices of three blades behind x = 0 as OpenFAST's case of infinite helices has them: R 100 m, pitch
/// 104.72 m, Γ 232.7106 m²/s; `turns` of them.
fn helices(turns: usize, from: f64) -> Vec<Segment> {
    const PER_TURN: usize = 180;
    let (radius, pitch, circulation) = (100.0, 104.72, 232.7106);
    let of_blade = |blade: usize| {
        let node = move |k: usize| {
            let angle = TAU * (blade as f64 / 3.0 - k as f64 / PER_TURN as f64);
            let x = from + pitch * k as f64 / PER_TURN as f64;
            Vector3::new(x, radius * angle.sin(), radius * angle.cos())
        };
        chain((0..=turns * PER_TURN).map(node), -circulation, 0.5)
    };
    (0..3).flat_map(of_blade).collect()
}

#[test]
fn infinite_helices_hold_a_third_of_the_wind_inboard() {
    // Half of a long helix is missing at its end: 1 − cos of the angle under which it ends, a few 1e-5.
    let wind = 10.0;
    let turns = 120;
    let half = helices(turns, 0.0);
    let whole = helices(2 * turns, -104.72 * turns as f64);
    let on_axis = velocity(&half, Vector3::ZERO).x.abs() / wind;
    assert!((on_axis - 1.0 / 3.0).abs() < 5e-4, "{on_axis}");
    let mean = |segments: &[Segment], r: f64| {
        let at = |k: usize| {
            let angle = TAU * k as f64 / 12.0;
            velocity(segments, Vector3::new(0.0, r * angle.sin(), r * angle.cos())).x / 12.0
        };
        (0..12).map(at).sum::<f64>().abs() / wind
    };
    for r in [30.0, 60.0] {
        // Averaged around, infinite helices are a cylinder and a line: nothing else is induced inside.
        let found = mean(&whole, r);
        assert!((found - 2.0 / 3.0).abs() < 2e-3, "{r} {found}");
    }
}
