//! Vortices as they are shown, and wakes of full length at once.

use super::wakes::{INTERVAL, advanced, forces, settings, wake};
use crate::FlowSolver;
use crate::vortex::body::N_SIDES;
use crate::vortex::ending::left_at;
use crate::vortex::{Resolution, WakeSettings};
use basis::records::PieceKind;
use basis::{PointForce, Vector3};
use std::collections::BTreeSet;

#[test]
fn pieces_are_the_segments_that_are_summed() {
    for steps in [1, 8, 90] {
        let mut wake = wake(settings());
        advanced(&mut wake, 0..steps);
        let found = wake.filaments();
        // The rings of bodies, which are not shown, come after those of blades.
        let rings: usize = wake.bodies.iter().map(|body| body.n_rings() * N_SIDES).sum();
        assert_eq!(found.pieces.len() + rings, wake.segments().len());
        assert_eq!(found.time, wake.time());
        for (piece, segment) in found.pieces.iter().zip(wake.segments()) {
            let [from, to] = piece.ends.map(|end| found.nodes[end as usize]);
            let expected = [segment.from, segment.to].map(|end| end.to_array().map(|x| x as f32));
            assert_eq!([from, to], expected, "{piece:?}");
            assert_eq!(piece.circulation, segment.circulation as f32);
            assert_eq!(piece.core_radius, segment.core_squared.sqrt() as f32);
            let is_bound = piece.kind == PieceKind::Bound;
            assert_eq!(is_bound, piece.age == 0.0 && piece.kind != PieceKind::Trailing);
        }
        let blades: BTreeSet<u32> = found.pieces.iter().map(|piece| piece.blade).collect();
        assert_eq!(blades, BTreeSet::from([0, 1]));
        let bound = found.pieces.iter().filter(|piece| piece.kind == PieceKind::Bound);
        // Six elements on each of two blades.
        assert_eq!(bound.count(), 12);
        // Tips and roots trail in all rows.
        let at = |span: f32| {
            let trailing = found.pieces.iter().filter(|p| p.kind == PieceKind::Trailing);
            trailing.filter(|piece| piece.span == span).count()
        };
        assert!(at(1.0) >= 2 && at(1.0) == at(0.0), "{} {}", at(0.0), at(1.0));
    }
}

#[test]
fn a_wake_of_full_length_is_there_at_once_and_goes_on() {
    // Room for all of it, slow as it is taken to be.
    let resolution = Resolution { far_rows: 100, ..settings().resolution };
    let mut wake = wake(WakeSettings { resolution, ..settings() });
    advanced(&mut wake, 0..1);
    let young = wake.segments().len();
    wake.reach_full_length();
    let grown = wake.filaments();
    let far = grown.nodes.iter().map(|node| node[0]).fold(0.0, f32::max);
    assert!((150.0..160.0).contains(&far), "{far}");
    let of_nacelle = wake.bodies[0].n_rings() * N_SIDES;
    let of_blades = wake.segments().len() - of_nacelle;
    assert!(of_blades > 10 * young && of_blades < 2500);
    // A helix that is carried along with 0.65 of some 8 m/s, turns by 0.15 a step and keeps its radius.
    let tip =
        |piece: &&basis::records::Piece| piece.kind == PieceKind::Trailing && piece.span == 1.0;
    for piece in grown.pieces.iter().filter(tip) {
        let ends =
            piece.ends.map(|end| Vector3::from_array(grown.nodes[end as usize].map(f64::from)));
        let middle = 0.5 * (ends[0].x + ends[1].x);
        let expected = f64::from(piece.age) * 0.65 * 8.0;
        assert!((middle - expected).abs() < 0.05 * expected + 1.0, "{middle} {expected}");
        for end in ends {
            let radius = (end - Vector3::new(end.x, 0.0, 80.0)).length();
            assert!((radius - 40.0).abs() < 0.5, "{radius}");
        }
    }
    // So are the rings behind the nacelle: half of its radius apart, and what a step's way is more.
    let rings = &wake.bodies[0];
    let places: Vec<f64> = rings.positions.iter().step_by(N_SIDES).map(|node| node.x).collect();
    assert!(places.windows(2).all(|pair| (1.0..=2.1).contains(&(pair[0] - pair[1]))), "{places:?}");
    assert!((97.9..=100.0).contains(&places[0]), "{}", places[0]);
    // What it costs stays: as much is added as comes to its end.
    let before = wake.segments().len() as f64;
    advanced(&mut wake, 1..7);
    let change = wake.segments().len() as f64 / before - 1.0;
    assert!(change.abs() < 0.1, "{change}");
}

#[test]
fn wakes_end_where_they_are_told_to() {
    let far = |wake: &crate::vortex::FreeWake| {
        wake.filaments().nodes.iter().map(|node| node[0]).fold(0.0, f32::max)
    };
    let resolution = Resolution { end: 100.0, far_rows: 100, ..settings().resolution };
    assert_eq!([-20.0, 30.0].map(|place| resolution.length_behind(place)), [120.0, 70.0]);
    assert_eq!(resolution.length_behind(-80.0), resolution.length);
    let settings = WakeSettings { resolution, ..settings() };
    let (mut grown, mut at_once) = (wake(settings.clone()), wake(settings));
    advanced(&mut grown, 0..120);
    advanced(&mut at_once, 0..1);
    at_once.reach_full_length();
    for wake in [&grown, &at_once] {
        // Rows stay until the next one is beyond, by their mean place: tips may be further.
        assert!((100.0..115.0).contains(&far(wake)), "{}", far(wake));
        let sum: Vector3 = wake.segments().iter().map(|s| s.circulation * (s.to - s.from)).sum();
        assert!(sum.length() < 1e-9, "{sum}");
    }
    // All rings further down leave with the same circulation, and fade before the end.
    let shown = at_once.filaments();
    let middle = |piece: &basis::records::Piece| {
        piece.ends.map(|end| f64::from(shown.nodes[end as usize][0])).iter().sum::<f64>() / 2.0
    };
    let tips = shown.pieces.iter().filter(|p| p.kind == PieceKind::Trailing && p.span == 1.0);
    let tips: Vec<(f64, f64)> = tips
        .map(|piece| (middle(piece), f64::from(piece.circulation.abs())))
        .filter(|(place, _)| *place > 40.0)
        .collect();
    let whole = tips.iter().map(|(_, circulation)| *circulation).fold(0.0, f64::max);
    for (place, circulation) in tips {
        let expected = left_at(place / 100.0);
        assert!((circulation / whole - expected).abs() < 0.01, "{place} {expected}");
    }
}

#[test]
fn a_wake_that_has_not_begun_has_no_length_to_reach() {
    let mut wake = wake(WakeSettings { threads: Some(2), ..settings() });
    wake.reach_full_length();
    assert!(wake.segments().is_empty() && wake.filaments().pieces.is_empty());
}

#[test]
fn elements_in_the_cores_of_others_are_counted() {
    let mut wake = wake(WakeSettings { n_blades: 4, far_rows_in_all: 240, ..settings() });
    // The second rotor stands 60 m behind the first.
    let both = |step: usize| {
        let behind = forces(step, 20.0).into_iter().map(|mut force| {
            force.turbine = 1;
            force.position.x += 60.0;
            if let Some(bound) = &mut force.bound {
                bound.position_after.x += 60.0;
            }
            force
        });
        forces(step, 25.0).into_iter().chain(behind).collect::<Vec<_>>()
    };
    let mut sums = [0; 2];
    for step in 0..80 {
        let all = both(step);
        wake.advance(INTERVAL, &all).expect("it stays finite");
        let found = wake.filaments();
        for (turbine, sum) in sums.iter_mut().enumerate() {
            let close = |force: &&PointForce| {
                let Some(bound) = force.bound.filter(|_| force.turbine == turbine) else {
                    return false;
                };
                found.pieces.iter().any(|piece| {
                    let end = found.nodes[piece.ends[1] as usize].map(f64::from);
                    let distance = (Vector3::from_array(end) - bound.position_after).length();
                    piece.turbine as usize != turbine
                        && piece.circulation != 0.0
                        && distance < f64::from(piece.core_radius)
                })
            };
            let expected = all.iter().filter(close).count() as u64;
            assert_eq!(wake.elements_in_cores(turbine), [expected, 12], "{step}");
            *sum += expected;
        }
    }
    // The first one stands in nobody's wake, and there is no third.
    assert!(sums[0] == 0 && sums[1] > 3, "{sums:?}");
    assert_eq!(wake.elements_in_cores(2), [0; 2]);
}
