//! Filaments of well-known shape, cut into segments, and what is known of them.

use crate::vortex::Segment;
use crate::vortex::examples::chain;
use basis::Vector3;
use std::f64::consts::{PI, TAU};

/// A ring about the x axis at `x`, of `radius` (m), in `n` segments whose ends lie on it; it moves towards
/// positive x.
pub(super) fn ring(x: f64, radius: f64, circulation: f64, core: f64, n: usize) -> Vec<Segment> {
    let at = |k: usize| {
        let angle = TAU * k as f64 / n as f64;
        Vector3::new(x, radius * angle.cos(), radius * angle.sin())
    };
    chain((0..=n).map(at), circulation, core)
}

/// Complete elliptic integrals of the first and second kind of the parameter m = k², by the
/// arithmetic-geometric mean.
pub(super) fn elliptic(m: f64) -> [f64; 2] {
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
pub(super) fn of_thin_ring(radius: f64, x: f64, r: f64) -> [f64; 2] {
    let far = x * x + (radius + r).powi(2);
    let near = x * x + (radius - r).powi(2);
    let [first, second] = elliptic(4.0 * radius * r / far);
    let scale = 1.0 / (TAU * far.sqrt());
    let axial = scale * (first + (radius * radius - r * r - x * x) / near * second);
    let radial = scale * x / r * (-first + (radius * radius + r * r + x * x) / near * second);
    [axial, radial]
}

/// Speed (m/s) with which a ring of `radius` and `core` (m) and unit circulation moves where each piece of it
/// is regularised over the distance from its own tangent, h = 2 R sin²(φ/2): the integral along the ring.
pub(super) fn speed_of_ring(radius: f64, core: f64) -> f64 {
    const N: usize = 20_000;
    let ratio = core / radius;
    // φ = π s³ puts points where the core decides.
    let integrand = |s: f64| {
        let half = 0.5 * PI * s.powi(3);
        let sine = half.sin();
        let h = 2.0 * sine * sine;
        let weight = h * h / (ratio.powi(4) + h.powi(4)).sqrt();
        weight / (4.0 * sine) * 3.0 * PI * s * s
    };
    let sum: f64 = (0..N).map(|k| integrand((k as f64 + 0.5) / N as f64)).sum();
    2.0 * sum / N as f64 / (4.0 * PI * radius)
}
