//! Boxes of segments against the sum over segments.

use crate::pool::Pool;
use crate::simd::Backend;
use crate::vortex::examples::wake;
use crate::vortex::field::Field;
use crate::vortex::{Accuracy, Segment, direct};
use basis::Vector3;

/// Root of the mean square of the error over that of the velocity, at every seventh node.
fn error(field: &Field, segments: &[Segment]) -> f64 {
    let at: Vec<Vector3> = segments.iter().step_by(7).map(|segment| segment.from).collect();
    let mut exact = vec![Vector3::ZERO; at.len()];
    direct(segments, &at, &mut exact);
    let (mut missed, mut whole) = (0.0, 0.0);
    for (position, exact) in at.iter().zip(&exact) {
        missed += (field.velocity(*position) - *exact).length_squared();
        whole += exact.length_squared();
    }
    (missed / whole).sqrt()
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
        assert!(error < 3e-6, "{backend:?} {error}");
    }
}

#[test]
fn boxes_are_as_exact_as_their_polynomials() {
    let segments = wake(7, 600);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        let errors =
            [2, 3, 4, 5].map(|degree| error(&field(degree, 0.6, backend, &segments), &segments));
        assert!(errors[1] < 1e-3 && errors[3] < 1e-4, "{backend:?} {errors:?}");
        assert!(errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{backend:?} {errors:?}");
    }
}

#[test]
fn what_changes_in_place_is_what_is_made_anew() {
    let before = wake(5, 200);
    let mut after = before.clone();
    for (k, segment) in after.iter_mut().enumerate() {
        segment.circulation *= 1.0 + 0.2 * (0.01 * k as f64).sin();
    }
    let mut changed = field(3, 0.6, Backend::detect(), &before);
    changed.refresh(&after, &mut Pool::new(1));
    let anew = field(3, 0.6, Backend::detect(), &after);
    for position in [before[40].from, Vector3::new(50.0, 20.0, 70.0)] {
        assert_eq!(changed.velocity(position), anew.velocity(position));
    }
    // No segments, no velocity.
    assert_eq!(field(3, 0.6, Backend::detect(), &[]).velocity(Vector3::ONE), Vector3::ZERO);
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
        let old = changed.velocity(before[710].to);
        changed.rebuild(&before, &mut pool);
        assert_eq!(changed.velocity(before[710].to), old);
        changed.refresh(&after, &mut pool);
        for position in [before[710].to, before[40].from, Vector3::new(50.0, 20.0, 70.0)] {
            assert_eq!(changed.velocity(position), anew.velocity(position), "{n_threads}");
        }
        assert_ne!(changed.velocity(before[710].to), old);
        // What is gone leaves nothing behind.
        changed.rebuild(&[], &mut pool);
        assert_eq!(changed.velocity(Vector3::ONE), Vector3::ZERO);
    }
}
