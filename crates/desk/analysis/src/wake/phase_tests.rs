//! A helical wake with a known radius and phase, averaged by phase.

use super::*;
use crate::phase::Reference;
use basis::Sense;
use basis::angle::wrap_to_half_turn;
use basis::records::PlaneAxes;
use std::f64::consts::TAU;

const SPEED: f64 = 10.0;
const DIAMETER: f64 = 240.0;
const HUB: f64 = 150.0;
const PERIOD: f64 = 91.4;

fn reference(sense: Sense) -> Reference {
    Reference { rate: TAU / PERIOD, sense }
}

/// Radius (m) and wind phase (rad) of the helix at `x` (m): it grows, and is carried along.
fn helix(x: f64) -> (f64, f64) {
    (0.03 * x, 0.8 - TAU * x / (0.9 * SPEED * PERIOD))
}

/// A Gaussian wake of deviation 0.4 D that winds about (12, 140) m.
fn velocity(sense: Sense, time: f64, [x, y, z]: [f64; 3]) -> f64 {
    let (radius, phase) = helix(x);
    let angle = TAU * time / PERIOD;
    let center = [
        12.0 + radius * (angle + sense.yaw_lead() + phase).sin(),
        140.0 - radius * (angle + phase).sin(),
    ];
    let distance = (y - center[0]).powi(2) + (z - center[1]).powi(2);
    SPEED - 4.0 * (-0.5 * distance / (0.4 * DIAMETER).powi(2)).exp()
}

fn plane(axes: PlaneAxes, sense: Sense, time: f64) -> Plane {
    let spacing = [30.0, 12.0];
    let (origin, n_points) = match axes {
        PlaneAxes::Horizontal => ([240.0, -480.0, HUB], [41, 81]),
        // Without a ground, which would cut the Gaussian.
        PlaneAxes::Streamwise => ([240.0, 12.0, -340.0], [41, 81]),
        PlaneAxes::Crosswind => ([1200.0, -480.0, -340.0], [33, 81]),
    };
    let [x, y, z] = origin;
    let mut u = Vec::new();
    for second in 0..n_points[1] {
        for first in 0..n_points[0] {
            let (a, b) = (first as f64 * spacing[0], second as f64 * spacing[1]);
            let point = match axes {
                PlaneAxes::Horizontal => [x + a, y + b, z],
                PlaneAxes::Streamwise => [x + a, y, z + b],
                PlaneAxes::Crosswind => [x, y + a, z + b],
            };
            u.push(velocity(sense, time, point) as f32);
        }
    }
    let zero = vec![0.0; u.len()];
    let velocity = [u, zero.clone(), zero];
    Plane { name: "test".into(), axes, origin, spacing, n_points, time, averaged: 0.0, velocity }
}

/// Three periods and a bit, an instant every 2.3 s, which no phase repeats.
fn averaged(axes: PlaneAxes, sense: Sense) -> PhaseAverage {
    let mut average =
        PhaseAverage::new(&plane(axes, sense, 0.0), TAU / PERIOD, PhaseAverage::N_PHASES);
    for instant in 0..130 {
        average
            .add(&plane(axes, sense, 600.0 + 2.3 * f64::from(instant)))
            .expect("the same points");
    }
    average
}

#[test]
fn instants_land_at_their_phase_and_the_mean_of_all_is_kept() {
    let average = averaged(PlaneAxes::Horizontal, Sense::CounterClockwise);
    assert_eq!(average.n_instants().iter().sum::<u64>(), 130);
    assert_eq!(average.memory(), 36 * 41 * 81 * 24);
    let planes = average.planes();
    assert_eq!(planes.len(), 36);
    for phase in &planes {
        // The bin is 10° wide; the wake turns by at most half of it about the bin's middle.
        let time = phase.phase / TAU * PERIOD;
        let expected = plane(PlaneAxes::Horizontal, Sense::CounterClockwise, time);
        for (found, expected) in phase.plane.velocity[0].iter().zip(&expected.velocity[0]) {
            assert!((found - expected).abs() < 0.1, "{found} {expected}");
        }
        assert!((phase.plane.averaged - 129.0 * 2.3).abs() < 1e-9);
    }
    let mut average = average;
    let mut other = plane(PlaneAxes::Horizontal, Sense::Clockwise, 0.0);
    other.velocity[2].pop();
    assert!(average.add(&other).is_err());
    assert_eq!(average.n_instants().iter().sum::<u64>(), 130);
}

#[test]
fn phases_without_an_instant_are_left_out() {
    let first = plane(PlaneAxes::Crosswind, Sense::Clockwise, 0.0);
    let mut average = PhaseAverage::new(&first, TAU / PERIOD, 36);
    average.add(&first).expect("the same points");
    // Half a bin before a whole turn is the first phase again.
    average.add(&Plane { time: PERIOD * (1.0 - 0.49 / 36.0), ..first.clone() }).expect("the same");
    let planes = average.planes();
    assert_eq!((planes.len(), planes[0].n_instants, planes[0].phase), (1, 2, 0.0));
    let reference = reference(Sense::Clockwise);
    assert!(matches!(
        orbit(&planes, &reference, |_| SPEED, 60.0),
        Err(AnalysisError::TooShort { .. })
    ));
    assert!(recentred_deficit(&planes, |_| SPEED, 60.0, 0.0, &[0.0]).is_err());
    assert!(recentred_deficit(&[], |_| SPEED, 60.0, 0.0, &[0.0]).is_err());
}

/// In either sense, seen from above and from the side: radius to a few hundredths, phase to a few degrees.
#[test]
fn the_centre_line_swings_as_the_wake_was_wound() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        for axes in [PlaneAxes::Horizontal, PlaneAxes::Streamwise] {
            let planes = averaged(axes, sense).planes();
            let found =
                swing(&planes, &reference(sense), |_| SPEED, 60.0).expect("planes along the wind");
            let middle = if axes == PlaneAxes::Horizontal { 12.0 } else { 140.0 };
            for point in &found {
                let (radius, phase) = helix(point.x);
                assert!(
                    (point.amplitude / radius - 1.0).abs() < 0.05,
                    "{axes:?} {point:?} {radius}"
                );
                assert!(wrap_to_half_turn(point.phase - phase).abs() < 0.06, "{axes:?} {point:?}");
                assert!((point.mean - middle).abs() < 2.0, "{axes:?} {point:?}");
            }
        }
    }
}

#[test]
fn the_orbit_is_round_in_its_own_sense_and_counts_against_the_other() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        let planes = averaged(PlaneAxes::Crosswind, sense).planes();
        let (radius, phase) = helix(1200.0);
        let own = orbit(&planes, &reference(sense), |_| SPEED, 60.0).expect("planes across");
        assert!((own.radius / radius - 1.0).abs() < 0.03 && own.counter_radius < 0.05 * radius);
        assert!(wrap_to_half_turn(own.phase - phase).abs() < 0.04, "{own:?} {phase}");
        assert!((own.mean[0] - 12.0).abs() < 1.0 && (own.mean[1] - 140.0).abs() < 1.0);
        let other = match sense {
            Sense::CounterClockwise => Sense::Clockwise,
            Sense::Clockwise => Sense::CounterClockwise,
        };
        let against = orbit(&planes, &reference(other), |_| SPEED, 60.0).expect("planes across");
        assert!((against.counter_radius - own.radius).abs() < 1e-9);
    }
}

/// Seen from the line of centres, the swing is gone: the deficit is that of the wake cut at hub height.
#[test]
fn a_recentred_deficit_does_not_know_the_swing() {
    let planes = averaged(PlaneAxes::Horizontal, Sense::CounterClockwise).planes();
    let offsets = [-180.0, -60.0, 0.0, 60.0, 180.0];
    let found = recentred_deficit(&planes, |_| SPEED, 60.0, 1200.0, &offsets).expect("inside");
    let (radius, _) = helix(1200.0);
    // Mean over a turn of the vertical Gaussian at the hub, from which the centre hangs 10 ± radius below.
    let variance = (0.4 * DIAMETER).powi(2);
    let n = 720;
    let vertical = (0..n)
        .map(|i| 10.0 + radius * (TAU * f64::from(i) / f64::from(n)).sin())
        .map(|height| (-0.5 * height * height / variance).exp())
        .sum::<f64>()
        / f64::from(n);
    for (offset, deficit) in offsets.iter().zip(&found) {
        let expected = 4.0 * vertical * (-0.5 * offset * offset / variance).exp();
        assert!((deficit - expected).abs() < 0.05, "{offset}: {deficit} {expected}");
    }
    let unmoved: Vec<f64> = planes
        .iter()
        .map(|p| SPEED - velocity_at(&p.plane, 1200.0, 12.0).expect("inside")[0])
        .collect();
    assert!(unmoved.iter().sum::<f64>() / 36.0 < found[2] - 0.1);
    let beyond = recentred_deficit(&planes, |_| SPEED, 60.0, 1200.0, &[900.0]);
    assert!(matches!(beyond, Err(AnalysisError::OutsidePlane { .. })));
}
