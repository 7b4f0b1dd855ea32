//! Vortices with closed forms, and the sum over boxes of them.

use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use flow::vortex::examples::{chain, wake};
use flow::vortex::{Accuracy, Segment, direct, induced};
use std::f64::consts::TAU;

/// The helices of OpenFAST's regression test of an infinite helical wake: radius and pitch (m), circulation
/// (m²/s), wind (m/s).
const RADIUS: f64 = 100.0;
const PITCH: f64 = 104.72;
const CIRCULATION: f64 = 232.7106;
const WIND: f64 = 10.0;
/// Trailing vortices of each blade of the wake that boxes are tried on (–).
const PER_BLADE: usize = 11;
const HELIX: &str = "infinite helices: B Γ over pitch inside, half of it at their end";
const RING: &str = "Lamb, Hydrodynamics, § 161: thin ring";
const SUM: &str = "direct summation in double precision";

/// Rings, helices, and boxes beside the sum over segments.
pub(super) fn rows() -> Vec<Row> {
    let mut rows = ring();
    rows.extend(helices());
    rows.extend(boxes());
    rows
}

fn ring() -> Vec<Row> {
    let (radius, circulation, n) = (2.0, 5.0, 2000);
    let node = |k: usize| {
        let angle = TAU * k as f64 / n as f64;
        Vector3::new(0.0, radius * angle.cos(), radius * angle.sin())
    };
    let segments = chain((0..=n).map(node), circulation, 1e-3);
    [0.0, 1.0, 4.0]
        .map(|x| {
            let expected = 0.5 * circulation * radius * radius / (radius * radius + x * x).powf(1.5);
            Row {
                what: format!("ring of 2000 segments, {x} m ahead of its centre: axial velocity over that of a thin ring"),
                measured: at(&segments, Vector3::X * x).x / expected,
                expected: 1.0,
                tolerance: Within(1e-5),
                unit: "–",
                source: RING,
            }
        })
        .into()
}

fn helices() -> Vec<Row> {
    const PER_TURN: usize = 180;
    const TURNS: usize = 120;
    let of_blade = |blade: usize| {
        let node = move |k: usize| {
            let angle = TAU * (blade as f64 / 3.0 - k as f64 / PER_TURN as f64);
            let x = PITCH * k as f64 / PER_TURN as f64;
            Vector3::new(x, RADIUS * angle.sin(), RADIUS * angle.cos())
        };
        chain((0..=TURNS * PER_TURN).map(node), -CIRCULATION, 0.5)
    };
    let segments: Vec<Segment> = (0..3).flat_map(of_blade).collect();
    let third = 3.0 * CIRCULATION / PITCH / 2.0 / WIND;
    let mean = |r: f64| {
        let point = |k: usize| {
            let angle = TAU * k as f64 / 12.0;
            -at(&segments, Vector3::new(0.0, r * angle.sin(), r * angle.cos())).x / (12.0 * WIND)
        };
        (0..12).map(point).sum::<f64>()
    };
    [0.0, 0.3, 0.6]
        .map(|share| Row {
            what: format!("three helices behind a disc, 120 turns of 180 segments, at {share} of the radius: axial induction"),
            measured: mean(share * RADIUS),
            expected: third,
            tolerance: Within(1e-3),
            unit: "–",
            source: HELIX,
        })
        .into()
}

/// Relative error of the velocity at their own nodes, by boxes as a case has them.
fn boxes() -> Vec<Row> {
    [1_000, 10_000, 34_000]
        .map(|n| {
            let segments = wake(PER_BLADE, n / (3 * PER_BLADE) + 1);
            let positions: Vec<Vector3> =
                segments.iter().step_by(n / 500).map(|segment| segment.from).collect();
            let (mut exact, mut found) =
                (vec![Vector3::ZERO; positions.len()], vec![Vector3::ZERO; positions.len()]);
            direct(&segments, &positions, &mut exact);
            induced(&segments, Accuracy::USUAL, 1, &positions, &mut found);
            let missed: f64 = exact.iter().zip(&found).map(|(a, b)| (*a - *b).length_squared()).sum();
            let whole: f64 = exact.iter().map(|a| a.length_squared()).sum();
            Row {
                what: format!("wake of three blades, {n} segments, degree 3, opening 0.6: error of the velocity at their nodes, mean square"),
                measured: (missed / whole).sqrt(),
                expected: 1e-3,
                tolerance: AtMost,
                unit: "–",
                source: SUM,
            }
        })
        .into()
}

fn at(segments: &[Segment], position: Vector3) -> Vector3 {
    let mut velocity = [Vector3::ZERO];
    direct(segments, &[position], &mut velocity);
    velocity[0]
}
