//! Two rings on one axis pass through each other in turn.

use super::shapes::{of_thin_ring, ring, speed_of_ring};
use crate::vortex::strip::Strip;
use crate::vortex::{Segment, direct};
use basis::Vector3;

const CORE: f64 = 0.1;
const CIRCULATION: f64 = 1.0;
/// Nodes of a ring.
const N: usize = 48;

/// Place and radius of two rings of unit circulation.
type Pair = [[f64; 2]; 2];

/// Their rates: each moves by itself and with what the other one induces.
fn rates(pair: &Pair) -> Pair {
    [(0, 1), (1, 0)].map(|(me, other)| {
        let [[x, r], [from, radius]] = [pair[me], pair[other]];
        let [axial, radial] = of_thin_ring(radius, x - from, r);
        [CIRCULATION * (speed_of_ring(r, CORE) + axial), CIRCULATION * radial]
    })
}

/// Runge and Kutta's step of the fourth order.
fn stepped(pair: Pair, interval: f64) -> Pair {
    let with = |rates: &Pair, share: f64| -> Pair {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| pair[i][j] + share * interval * rates[i][j])
        })
    };
    let a = rates(&pair);
    let b = rates(&with(&a, 0.5));
    let c = rates(&with(&b, 0.5));
    let d = rates(&with(&c, 1.0));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            pair[i][j] + interval / 6.0 * (a[i][j] + 2.0 * b[i][j] + 2.0 * c[i][j] + d[i][j])
        })
    })
}

/// Places and radii after `time` of rings that begin as `pair` has them, by filaments in `n_steps` steps.
fn by_filaments(pair: Pair, time: f64, n_steps: usize) -> Pair {
    let rings = || pair.iter().flat_map(|[x, r]| ring(*x, *r, CIRCULATION, CORE, N));
    let mut strip = Strip::with_capacity(2 * N, 1);
    let nodes = rings().map(|segment| (segment.from, Vector3::ZERO));
    strip.push(nodes, 0.0, std::iter::empty());
    let mut segments: Vec<Segment> = rings().collect();
    let mut velocities = vec![Vector3::ZERO; 2 * N];
    for _ in 0..n_steps {
        for (index, segment) in segments.iter_mut().enumerate() {
            let (first, k) = (index / N * N, index % N);
            segment.from = strip.positions[index];
            segment.to = strip.positions[first + (k + 1) % N];
        }
        direct(&segments, &strip.positions, &mut velocities);
        strip.advance(time / n_steps as f64, &velocities);
    }
    let of_ring = |nodes: &[Vector3]| {
        let mean = |value: fn(&Vector3) -> f64| nodes.iter().map(value).sum::<f64>() / N as f64;
        [mean(|node| node.x), mean(|node| node.y.hypot(node.z))]
    };
    [of_ring(&strip.positions[..N]), of_ring(&strip.positions[N..])]
}

#[test]
fn coaxial_rings_pass_through_each_other_in_their_period() {
    let start = [[0.0, 1.0], [0.6, 1.0]];
    // Until the one behind, having passed through the other and been passed through, is as far behind again.
    let interval = 0.02;
    let (mut pair, mut n, mut sides) = (start, 0, 0);
    let ahead = |pair: &Pair| pair[1][0] - pair[0][0];
    while sides < 2 {
        let next = stepped(pair, interval);
        sides += usize::from(ahead(&next) * ahead(&pair) < 0.0);
        pair = next;
        n += 1;
        assert!(n < 5000, "they never pass");
    }
    let time = n as f64 * interval;
    let errors = [150, 300].map(|n_steps| {
        let found = by_filaments(start, time, n_steps);
        let errors = found.iter().flatten().zip(pair.iter().flatten());
        errors.map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max)
    });
    // Lengths are in radii. What is left is the cores, which thin rings do not have for one another.
    assert!(errors[1] < 0.03, "{errors:?} after {time}");
    assert!(errors[1] < errors[0], "{errors:?}");
}

#[test]
fn nodes_move_to_second_order() {
    let start = [[0.0, 1.0], [0.6, 1.0]];
    let time = 4.0;
    let places = [50, 100, 200, 800].map(|n_steps| by_filaments(start, time, n_steps)[0]);
    let error = |k: usize| (places[k][0] - places[3][0]).hypot(places[k][1] - places[3][1]);
    for k in 0..2 {
        let ratio = error(k) / error(k + 1);
        assert!((3.0..6.0).contains(&ratio), "{k} {ratio} {places:?}");
    }
}
