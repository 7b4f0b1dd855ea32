//! Vortices of a shape that everybody tries boxes on: tests, validations and benches.

use super::Segment;
use basis::Vector3;
use std::f64::consts::TAU;

/// Segments through `nodes` of one `circulation` (m²/s) and core radius `core` (m).
pub fn chain(nodes: impl Iterator<Item = Vector3>, circulation: f64, core: f64) -> Vec<Segment> {
    let nodes: Vec<Vector3> = nodes.collect();
    let core_squared = core * core;
    let segment =
        |ends: &[Vector3]| Segment { from: ends[0], to: ends[1], circulation, core_squared };
    nodes.windows(2).map(segment).collect()
}

/// A wake like that of three blades of 60 m: trailing vortices on helices, `per_blade` of them, `n` nodes
/// each, tip and root strong.
pub fn wake(per_blade: usize, n: usize) -> Vec<Segment> {
    let filament = |blade: usize, k: usize| {
        let radius = 3.0 + 57.0 * k as f64 / (per_blade - 1) as f64;
        let node = move |step: usize| {
            let angle = TAU * (blade as f64 / 3.0 - step as f64 / 50.0);
            let x = 0.6 * step as f64 + 4.0 * (0.05 * step as f64).sin();
            Vector3::new(x, radius * angle.sin(), 90.0 + radius * angle.cos())
        };
        let circulation = match k {
            0 => 35.0,
            k if k + 1 == per_blade => -40.0,
            k => 3.0 - 0.4 * k as f64,
        };
        chain((0..n).map(node), circulation, 0.4)
    };
    let all = (0..3).flat_map(|blade| (0..per_blade).map(move |k| (blade, k)));
    all.flat_map(|(blade, k)| filament(blade, k)).collect()
}
