//! Boxes of segments against the sum over segments.

use crate::pool::Pool;
use crate::simd::Backend;
use crate::vortex::examples::wake;
use crate::vortex::field::Field;
use crate::vortex::neighbours::Neighbours;
use crate::vortex::{Accuracy, Segment, direct};
use basis::Vector3;

/// Root of the mean square of the error over that of the velocity, in the middle of every seventh segment: at
/// its ends a segment's velocity hangs on the side from which they are come near to.
fn error(field: &Field, segments: &[Segment]) -> f64 {
    let middle = |segment: &Segment| 0.5 * (segment.from + segment.to);
    let all: Vec<Vector3> = segments.iter().map(middle).collect();
    let mut neighbours = Neighbours::default();
    neighbours.sort(&all, &mut Pool::new(1));
    let (mut sorted, mut found) = (all.clone(), all.clone());
    field.sample(neighbours.sorted(), &mut sorted);
    neighbours.to_own_order(&sorted, &mut found);
    let at: Vec<Vector3> = all.iter().step_by(7).copied().collect();
    let mut exact = vec![Vector3::ZERO; at.len()];
    direct(segments, &at, &mut exact);
    let (mut missed, mut whole) = (0.0, 0.0);
    for (found, exact) in found.iter().step_by(7).zip(&exact) {
        missed += (*found - *exact).length_squared();
        whole += exact.length_squared();
    }
    (missed / whole).sqrt()
}

fn velocity(field: &Field, position: Vector3) -> Vector3 {
    let mut velocities = [Vector3::ZERO];
    field.sample(&[position], &mut velocities);
    velocities[0]
}

fn field(degree: usize, opening: f64, backend: Backend, segments: &[Segment]) -> Field {
    let accuracy = Accuracy { degree, opening };
    let mut field = Field::with_capacity(accuracy, backend, segments.len());
    field.rebuild(segments, &mut Pool::new(2));
    field
}

#[test]
fn one_by_one_single_precision_is_enough() {
    let segments = wake(7, 300);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        let error = error(&field(3, 0.0, backend, &segments), &segments);
        // Two inverse roots with a relative error of 2⁻¹⁴ at the most.
        assert!(error < 6e-5, "{backend:?} {error}");
    }
}

#[test]
fn segments_of_a_decimetre_and_of_kilometres_keep_their_digits() {
    for length in [0.1, 1.0, 30.0, 1e3, 5e3] {
        let core = 0.2 * f64::min(length, 5.0);
        let to = Vector3::new(0.6, -0.64, 0.48) * length;
        let core_squared = core * core;
        let segment = Segment { from: Vector3::ZERO, to, circulation: 40.0, core_squared };
        let across = to.normalize().any_orthonormal_vector();
        for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
            let field = field(4, 0.0, backend, &[segment]);
            for (share, away) in [(0.5, 1.0), (0.02, 1.0), (-0.1, 0.5), (0.7, 20.0), (1.2, 3.0)] {
                let at = share * to + away * core * across;
                let expected = segment.velocity(at);
                let error = (velocity(&field, at) - expected).length() / expected.length();
                assert!(error < 3e-4, "{length} {share} {away} {backend:?} {error}");
            }
        }
    }
}

#[test]
fn segments_do_nothing_at_their_own_ends() {
    // What meets in the nodes of a wake: there rounding would bring up what hangs on the side.
    let segments = wake(7, 100);
    let ends: Vec<Vector3> = segments.iter().map(|segment| segment.to).collect();
    let field = field(4, 0.0, Backend::detect(), &segments);
    let (mut found, mut expected) = (ends.clone(), ends.clone());
    field.sample(&ends, &mut found);
    direct(&segments, &ends, &mut expected);
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            (*found - *expected).length() < 1e-3 * expected.length().max(1.0),
            "{found} {expected}"
        );
    }
}

#[test]
fn the_middle_of_a_thin_chord_feels_the_others_alone() {
    // Chords a hundred thousand cores long, as of a sheet that has left a wing in long steps: their middles
    // are off their lines by rounding, of which so thin a vortex would make metres a second.
    let along = Vector3::new(0.6, -0.64, 0.48) * 25.0;
    let segments: Vec<Segment> = (0..40)
        .map(|k| {
            let from = Vector3::new(0.003, 0.11, 0.02) * f64::from(k);
            Segment { from, to: from + along, circulation: 1.0, core_squared: 2.5e-4_f64.powi(2) }
        })
        .collect();
    let middles: Vec<Vector3> =
        segments.iter().map(|segment| 0.5 * (segment.from + segment.to)).collect();
    let mut expected = middles.clone();
    direct(&segments, &middles, &mut expected);
    let fastest = expected.iter().map(|velocity| velocity.length()).fold(0.0, f64::max);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        let mut found = middles.clone();
        field(4, 0.5, backend, &segments).sample(&middles, &mut found);
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (*found - *expected).length() < 3e-3 * fastest,
                "{backend:?} {found} {expected}"
            );
        }
    }
}

#[test]
fn boxes_are_as_exact_as_their_polynomials() {
    let segments = wake(7, 600);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        let opening = Accuracy::USUAL.opening;
        let errors = [2, 3, 4, 5, 6]
            .map(|degree| error(&field(degree, opening, backend, &segments), &segments));
        // The third is that of cases.
        assert!(errors[2] < 1e-3, "{backend:?} {errors:?}");
        // Of elements all around an axis those of odd degrees say little: two degrees together bring as
        // much as the opening's square at the least.
        let least = opening * opening;
        assert!(errors.windows(3).all(|of| of[2] < least * of[0]), "{backend:?} {errors:?}");
    }
}

#[test]
fn what_changes_in_place_is_what_is_made_anew() {
    let before = wake(5, 200);
    let mut after = before.clone();
    for (k, segment) in after.iter_mut().enumerate() {
        segment.circulation *= 1.0 + 0.2 * (0.01 * k as f64).sin();
        segment.core_squared *= 2.0;
    }
    let mut changed = field(3, 0.6, Backend::detect(), &before);
    changed.refresh(&after, &mut Pool::new(1));
    let anew = field(3, 0.6, Backend::detect(), &after);
    for position in [before[40].from, Vector3::new(50.0, 20.0, 70.0)] {
        assert_eq!(velocity(&changed, position), velocity(&anew, position));
    }
    // No segments, no velocity.
    assert_eq!(velocity(&field(3, 0.6, Backend::detect(), &[]), Vector3::ONE), Vector3::ZERO);
}

#[test]
fn few_changes_and_any_threads_are_what_is_made_anew_by_one() {
    let before = wake(9, 400);
    let mut after = before.clone();
    for segment in after.iter_mut().skip(700).take(30) {
        segment.circulation += 12.0;
    }
    let mut anew = field(3, 0.6, Backend::detect(), &before);
    anew.rebuild(&after, &mut Pool::new(1));
    for n_threads in [1, 3] {
        let mut pool = Pool::new(n_threads);
        let mut changed = field(3, 0.6, Backend::detect(), &before);
        let old = velocity(&changed, before[710].to);
        changed.rebuild(&before, &mut pool);
        assert_eq!(velocity(&changed, before[710].to), old);
        changed.refresh(&after, &mut pool);
        for position in [before[710].to, before[40].from, Vector3::new(50.0, 20.0, 70.0)] {
            assert_eq!(velocity(&changed, position), velocity(&anew, position), "{n_threads}");
        }
        assert_ne!(velocity(&changed, before[710].to), old);
        // What is gone leaves nothing behind.
        changed.rebuild(&[], &mut pool);
        assert_eq!(velocity(&changed, Vector3::ONE), Vector3::ZERO);
    }
}
