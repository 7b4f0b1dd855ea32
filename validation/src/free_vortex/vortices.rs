//! Vortices with closed forms, and the sum over boxes of them.

use crate::Row;
use crate::folds::larger;
use crate::random::Random;
use crate::row::Tolerance::{AtMost, Within};
use basis::Vector3;
use flow::vortex::examples::{chain, wake};
use flow::vortex::rings::{Loops, Pair, period, ring as loop_of, speed_of_pieces, speed_of_ring};
use flow::vortex::{Accuracy, Segment, direct, induced};
use std::f64::consts::{PI, TAU};

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
const LINE: &str = "closed form of a straight vortex, Γ/4πh (cos θ₁ − cos θ₂)";
const MOVING: &str = "thin rings, Saffman, Vortex Dynamics, § 10.2";
const SECOND: &str = "second order";
/// Accepted distance of an order of convergence from two (–): one halving of steps tells no more.
const ORDER: f64 = 0.4;
/// Accepted error of a straight segment (–): rounding, where terms cancel to a hundredth.
const ROUNDING: f64 = 1e-12;
/// Accepted error of a ring's speed, and of the period of two rings (–): a weighted law of Biot and Savart is
/// no vortex with a core, and thin rings have none for one another.
const OF_CORES: f64 = 0.05;
const SUM: &str = "direct summation in double precision";

/// Rings, helices, and boxes beside the sum over segments.
pub(super) fn rows() -> Vec<Row> {
    let mut rows = vec![segment()];
    rows.extend(ring());
    rows.extend(moving_ring());
    rows.extend(leapfrog());
    rows.extend(helices());
    rows.extend(boxes());
    rows
}

/// The largest error of thin segments at a thousand places not nearer than a twentieth of their length, over
/// the velocity there.
fn segment() -> Row {
    const N: usize = 1000;
    let mut random = Random(11);
    let mut place = |scale: f64| {
        Vector3::from_array(std::array::from_fn(|_| scale * (2.0 * random.uniform() - 1.0)))
    };
    let (mut n, mut worst) = (0, 0.0);
    while n < N {
        let (from, to, position) = (place(3.0), place(3.0), place(5.0));
        let along = (to - from).normalize();
        let [near, far] = [from, to].map(|end| position - end);
        let distance = near.cross(along).length();
        if distance < 0.05 * (to - from).length() {
            continue;
        }
        n += 1;
        let cosines = [near, far].map(|way| way.dot(along) / way.length());
        let expected =
            along.cross(near) / distance * ((cosines[0] - cosines[1]) / (4.0 * PI * distance));
        let found = Segment { from, to, circulation: 1.0, core_squared: 0.0 }.velocity(position);
        // What a straight vortex of the same distance has: beyond the ends the cosines cancel.
        worst = larger(worst, (found - expected).length() * 4.0 * PI * distance);
    }
    Row {
        what: format!("straight segments, {N} places: largest error of the velocity over Γ/4πh"),
        measured: worst,
        expected: ROUNDING,
        tolerance: AtMost,
        unit: "–",
        source: LINE,
    }
}

/// How fast the error of a ring's speed falls with its segments.
fn moving_ring() -> Vec<Row> {
    let (radius, core) = (1.0, 0.1);
    let speed = |n: usize| {
        let mut one = Loops::new(loop_of(0.0, radius, 1.0, core, n), n);
        one.velocities().iter().map(|velocity| velocity.x).sum::<f64>() / n as f64
    };
    let numbers = [24, 48, 192, 384];
    let speeds = numbers.map(speed);
    let [pieces, whole] = [speed_of_pieces, speed_of_ring].map(|of| of(radius, core));
    tell!("ring of {numbers:?} segments: speed over Saffman's {:.4?}", speeds.map(|s| s / whole));
    tell!("of infinitely many {:.4}", pieces / whole);
    let error = |k: usize| (speeds[k] / pieces - 1.0).abs();
    let row = |what: String, measured, expected, tolerance, source| Row {
        what,
        measured,
        expected,
        tolerance,
        unit: "–",
        source,
    };
    let of_speed = |k: usize| {
        let n = numbers[k];
        let what =
            format!("ring with a core of 0.1 radii, {n} segments: speed over that of a thin ring");
        row(what, speeds[k] / whole, 1.0, Within(OF_CORES), MOVING)
    };
    vec![
        of_speed(0),
        of_speed(1),
        of_speed(2),
        row(
            "ring with a core of 0.1 radii, 192 to 384 segments: order of convergence of its speed to that of infinitely many".to_owned(),
            (error(2) / error(3)).log2(),
            2.0,
            Within(ORDER),
            SECOND,
        ),
    ]
}

/// Two rings on one axis that pass through each other in turn.
fn leapfrog() -> Vec<Row> {
    const N: usize = 48;
    let start = Pair { places: [[0.0, 1.0], [0.6, 1.0]], core: 0.1 };
    let loops = || {
        let rings = start.places.iter().flat_map(|[x, r]| loop_of(*x, *r, 1.0, start.core, N));
        Loops::new(rings.collect(), N)
    };
    let mut pair = start;
    let interval = 0.01;
    let expected = period(interval, || {
        let now = pair.ahead();
        pair = pair.after(interval);
        now
    });
    let of_filaments = |interval: f64| {
        let mut loops = loops();
        period(interval, || {
            let places: Vec<[f64; 2]> = loops.places().collect();
            loops.advance(interval);
            places[1][0] - places[0][0]
        })
    };
    let found = of_filaments(0.02);
    tell!("leapfrogging rings: period {found:.4} s, thin rings {expected:.4} s");
    let time = 4.0;
    let places = [50, 100, 200, 800].map(|n_steps| {
        let mut loops = loops();
        (0..n_steps).for_each(|_| loops.advance(time / f64::from(n_steps)));
        loops.places().next().unwrap_or([f64::NAN; 2])
    });
    let error = |k: usize| (places[k][0] - places[3][0]).hypot(places[k][1] - places[3][1]);
    tell!(
        "after 50, 100, 200 steps the first is off by {:.2e}, {:.2e}, {:.2e}",
        error(0),
        error(1),
        error(2)
    );
    vec![
        Row {
            what: format!("two coaxial rings 0.6 radii apart, cores of 0.1 radii, {N} segments each: period of their leapfrogging over that of thin rings"),
            measured: found / expected,
            expected: 1.0,
            tolerance: Within(OF_CORES),
            unit: "–",
            source: MOVING,
        },
        Row {
            what: "two coaxial rings, 100 to 200 steps to 4 radii² over the circulation: order of convergence of the place of the first".to_owned(),
            measured: (error(1) / error(2)).log2(),
            expected: 2.0,
            tolerance: Within(ORDER),
            unit: "–",
            source: SECOND,
        },
    ]
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

/// Relative error of the velocity in the middles of their own segments, where wakes ask for it, by boxes as a
/// case has them.
fn boxes() -> Vec<Row> {
    [1_000, 10_000, 34_000]
        .map(|n| {
            let segments = wake(PER_BLADE, n / (3 * PER_BLADE) + 1);
            // All of them are asked for: the more there are, the closer those stand that go through the
            // boxes together, and the more boxes are far.
            let positions: Vec<Vector3> =
                segments.iter().map(|s| 0.5 * (s.from + s.to)).collect();
            let mut found = vec![Vector3::ZERO; positions.len()];
            induced(&segments, Accuracy::USUAL, 1, &positions, &mut found);
            let compared = |all: &[Vector3]| -> Vec<Vector3> {
                all.iter().step_by(n / 500).copied().collect()
            };
            let (positions, found) = (compared(&positions), compared(&found));
            let mut exact = vec![Vector3::ZERO; positions.len()];
            direct(&segments, &positions, &mut exact);
            let missed: f64 = exact.iter().zip(&found).map(|(a, b)| (*a - *b).length_squared()).sum();
            let whole: f64 = exact.iter().map(|a| a.length_squared()).sum();
            Row {
                what: format!("wake of three blades, {n} segments, boxes as in cases: error of the velocity in their middles, mean square"),
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
