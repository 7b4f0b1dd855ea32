//! Rings about one axis that carry each other: in theory, and as loops of filaments.

use super::body::{middles_of, sides_to_nodes};
use super::direct::direct;
use super::examples::chain;
use super::segment::{BEYOND, Segment};
use super::strip::Strip;
use basis::Vector3;
use std::f64::consts::{PI, TAU};

/// A ring about the x axis at `x`, of `radius` (m), in `n` segments whose ends lie on it; it moves towards
/// positive x.
pub fn ring(x: f64, radius: f64, circulation: f64, core: f64, n: usize) -> Vec<Segment> {
    let at = |k: usize| {
        let angle = TAU * k as f64 / n as f64;
        Vector3::new(x, radius * angle.cos(), radius * angle.sin())
    };
    chain((0..=n).map(at), circulation, core)
}

/// Loops of as many filaments each, which carry one another as the nodes of a free wake are carried.
pub struct Loops {
    strip: Strip,
    /// Nodes of a loop (–).
    n: usize,
    segments: Vec<Segment>,
    middles: Vec<Vector3>,
    velocities: Vec<Vector3>,
}

impl Loops {
    /// Those of `segments`, `n` for each loop, each beginning where the one before it ends.
    pub fn new(segments: Vec<Segment>, n: usize) -> Self {
        let mut strip = Strip::with_capacity(segments.len(), 1);
        let nodes = segments.iter().map(|segment| (segment.from, Vector3::ZERO));
        strip.push(nodes, 0.0, std::iter::empty());
        let velocities = vec![Vector3::ZERO; segments.len()];
        Self { strip, n, middles: Vec::with_capacity(segments.len()), velocities, segments }
    }

    /// Nodes, loop after loop (m).
    pub fn nodes(&self) -> &[Vector3] {
        &self.strip.positions
    }

    /// Velocities (m/s) with which they are carried now.
    pub fn velocities(&mut self) -> &[Vector3] {
        self.middles.clear();
        for (of_loop, nodes) in
            self.segments.chunks_exact_mut(self.n).zip(self.strip.positions.chunks_exact(self.n))
        {
            for (k, segment) in of_loop.iter_mut().enumerate() {
                (segment.from, segment.to) = (nodes[k], nodes[(k + 1) % nodes.len()]);
            }
            self.middles.extend(middles_of(nodes));
        }
        direct(&self.segments, &self.middles, &mut self.velocities);
        sides_to_nodes(self.n, &mut self.velocities);
        &self.velocities
    }

    /// Moves on by `interval` (s).
    pub fn advance(&mut self, interval: f64) {
        self.velocities();
        self.strip.advance(interval, &self.velocities);
    }

    /// Mean place along the axis and mean radius of each loop (m).
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.strip.positions.chunks_exact(self.n).map(|nodes| {
            let n = nodes.len() as f64;
            let [x, radius] = [
                nodes.iter().map(|node| node.x).sum::<f64>(),
                nodes.iter().map(|node| node.y.hypot(node.z)).sum::<f64>(),
            ];
            [x / n, radius / n]
        })
    }
}

/// Two thin rings of unit circulation whose cores have the radius `core` (m).
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Place along the axis and radius of each (m).
    pub places: [[f64; 2]; 2],
    /// Radius of their cores (m).
    pub core: f64,
}

impl Pair {
    /// After another `interval` (s): Runge and Kutta's step of the fourth order. Each moves by itself and
    /// with what the other one induces.
    pub fn after(&self, interval: f64) -> Self {
        let with = |rates: &[[f64; 2]; 2], share: f64| Self {
            places: std::array::from_fn(|i| {
                std::array::from_fn(|j| self.places[i][j] + share * interval * rates[i][j])
            }),
            core: self.core,
        };
        let a = self.rates();
        let b = with(&a, 0.5).rates();
        let c = with(&b, 0.5).rates();
        let d = with(&c, 1.0).rates();
        let mean = std::array::from_fn(|i| {
            std::array::from_fn(|j| (a[i][j] + 2.0 * b[i][j] + 2.0 * c[i][j] + d[i][j]) / 6.0)
        });
        with(&mean, 1.0)
    }

    fn rates(&self) -> [[f64; 2]; 2] {
        [(0, 1), (1, 0)].map(|(me, other)| {
            let [[x, r], [from, radius]] = [self.places[me], self.places[other]];
            let [axial, radial] = of_thin_ring(radius, x - from, r);
            [speed_of_ring(r, self.core) + axial, radial]
        })
    }

    /// How far the second one is ahead (m).
    pub fn ahead(&self) -> f64 {
        self.places[1][0] - self.places[0][0]
    }
}

/// Time (s) until what is `ahead` (m) of the other, told every `interval` (s), has changed sides twice.
pub fn period(interval: f64, mut ahead: impl FnMut() -> f64) -> f64 {
    let (mut last, mut sides) = (ahead(), 0);
    for step in 1..100_000 {
        let now = ahead();
        sides += usize::from(now * last < 0.0);
        if sides == 2 {
            return interval * (f64::from(step) - now / (now - last));
        }
        last = now;
    }
    f64::NAN
}

/// Complete elliptic integrals of the first and second kind of the parameter m = k², by the
/// arithmetic-geometric mean.
fn elliptic(m: f64) -> [f64; 2] {
    let (mut a, mut b, mut power) = (1.0, (1.0 - m).sqrt(), 0.5);
    let mut sum = 0.5 * m;
    for _ in 0..30 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let first = PI / (2.0 * a);
    [first, first * (1.0 - sum)]
}

/// Axial and radial velocity (m/s) of a thin ring of `radius` (m) and unit circulation at the distance `x`
/// (m) from its plane and `r` (m) from its axis. Lamb, Hydrodynamics (1932), § 161.
pub fn of_thin_ring(radius: f64, x: f64, r: f64) -> [f64; 2] {
    let far = x * x + (radius + r).powi(2);
    let near = x * x + (radius - r).powi(2);
    let [first, second] = elliptic(4.0 * radius * r / far);
    let scale = 1.0 / (TAU * far.sqrt());
    let axial = scale * (first + (radius * radius - r * r - x * x) / near * second);
    let radial = scale * x / r * (-first + (radius * radius + r * r + x * x) / near * second);
    [axial, radial]
}

/// Speed (m/s) of a thin ring of `radius` (m) and unit circulation, its `core` (m) that of a vortex after
/// Vatistas with n = 2, whose energy is that of a hollow one at constant volume: (ln 8R/r − ½)/4πR.
/// Source: Saffman, Vortex Dynamics (1992), § 10.2.
pub fn speed_of_ring(radius: f64, core: f64) -> f64 {
    ((8.0 * radius / core).ln() - 0.5) / (4.0 * PI * radius)
}

/// The same of a ring whose pieces have the law of [`Segment`], each infinitely short: the integral along
/// the ring, weighted over the share of the way 2 R sin(φ/2) that counts.
pub fn speed_of_pieces(radius: f64, core: f64) -> f64 {
    const N: usize = 20_000;
    let ratio = core / radius;
    // φ = π s³ puts points where the core decides.
    let integrand = |s: f64| {
        let sine = (0.5 * PI * s.powi(3)).sin();
        let distance = BEYOND * 4.0 * sine * sine;
        let weight = distance / (ratio.powi(4) + distance * distance).sqrt();
        weight / (4.0 * sine) * 3.0 * PI * s * s
    };
    let sum: f64 = (0..N).map(|k| integrand((k as f64 + 0.5) / N as f64)).sum();
    2.0 * sum / N as f64 / (4.0 * PI * radius)
}
