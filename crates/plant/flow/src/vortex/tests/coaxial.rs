//! Two rings on one axis pass through each other in turn.

use crate::vortex::rings::{Loops, Pair, period, ring};

const CORE: f64 = 0.1;
/// Nodes of a ring.
const N: usize = 48;
const START: Pair = Pair { places: [[0.0, 1.0], [0.6, 1.0]], core: CORE };

fn loops() -> Loops {
    let rings = START.places.iter().flat_map(|[x, r]| ring(*x, *r, 1.0, CORE, N));
    Loops::new(rings.collect(), N)
}

fn ahead(loops: &Loops) -> f64 {
    let mut places = loops.places().map(|place| place[0]);
    let first = places.next().expect("there are two");
    places.next().expect("there are two") - first
}

#[test]
fn coaxial_rings_pass_through_each_other_in_their_period() {
    let interval = 0.01;
    let mut pair = START;
    let expected = period(interval, || {
        let now = pair.ahead();
        pair = pair.after(interval);
        now
    });
    let errors = [0.04, 0.02].map(|interval| {
        let mut loops = loops();
        let found = period(interval, || {
            let now = ahead(&loops);
            loops.advance(interval);
            now
        });
        (found / expected - 1.0).abs()
    });
    // What is left is the cores, which thin rings do not have for one another.
    assert!(errors[1] < 0.02, "{errors:?} of {expected}");
}

#[test]
fn nodes_move_to_second_order() {
    let time = 4.0;
    let places = [50, 100, 200, 800].map(|n_steps| {
        let mut loops = loops();
        (0..n_steps).for_each(|_| loops.advance(time / f64::from(n_steps)));
        loops.places().next().expect("there are two")
    });
    let error = |k: usize| (places[k][0] - places[3][0]).hypot(places[k][1] - places[3][1]);
    for k in 0..2 {
        let ratio = error(k) / error(k + 1);
        assert!((3.0..6.0).contains(&ratio), "{k} {ratio} {places:?}");
    }
}
