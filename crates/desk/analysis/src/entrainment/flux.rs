//! Flux of mean kinetic energy into a wake by stresses.

use crate::grids::value_at;
use crate::phases::Decomposition;
use basis::records::{Grid, stress_of};
use std::f64::consts::TAU;

/// Points around a tube (–).
const N_AROUND: usize = 72;

/// A straight edge along x, and which way the wake lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The axis across it: 1 for y, 2 for z.
    pub axis: usize,
    /// Where it is: y and z (m, farm frame).
    pub place: [f64; 2],
    /// Which way along `axis` leads into the wake: 1 or −1 (–).
    pub inward: f64,
}

/// Flux of mean kinetic energy over density at one distance downwind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxPoint {
    /// Distance (m, farm frame).
    pub x: f64,
    /// Into the wake by all fluctuations, −⟨u'v'⟩ū with v inward (m³/s³).
    pub total: f64,
    /// By the periodic ones (m³/s³).
    pub periodic: f64,
    /// By the random ones (m³/s³).
    pub random: f64,
}

/// Flux through `edge` at each x of `grid` that has numbers there.
///
/// Source: van der Hoek et al. (2024), Eqs. 4, 5, 10 and 11, whose edges are z/D = ±½ in the plane y = 0; the
/// sign is that of energy which enters the wake, whichever side the edge is on.
pub fn flux_along(found: &Decomposition, grid: &Grid, edge: &Edge) -> Vec<FluxPoint> {
    let stress = stress_of(0, edge.axis);
    let point = |x: f64| {
        let at = |values: &[f64]| value_at(grid, values, [x, edge.place[0], edge.place[1]]);
        // Energy goes where −⟨u'v'⟩ū points: against the outward flux of momentum.
        let flux = |values: &[f64]| Some(edge.inward * at(values)? * at(&found.mean[0])?);
        Some(FluxPoint {
            x,
            total: flux(&found.total[stress])?,
            periodic: flux(&found.periodic[stress])?,
            random: flux(&found.random[stress])?,
        })
    };
    distances(grid).filter_map(point).collect()
}

/// Flux through a tube along x of `radius` (m) about y and z of `axis` (m), as its mean around it, at each x
/// of `grid` at which the whole of it has numbers.
pub fn flux_through_tube(
    found: &Decomposition,
    grid: &Grid,
    axis: [f64; 2],
    radius: f64,
) -> Vec<FluxPoint> {
    let point = |x: f64| {
        let mut sums = [0.0; 3];
        for step in 0..N_AROUND {
            let (sine, cosine) = (TAU * step as f64 / N_AROUND as f64).sin_cos();
            let place = [x, axis[0] + radius * cosine, axis[1] + radius * sine];
            let mean = value_at(grid, &found.mean[0], place)?;
            let parts = [&found.total, &found.periodic, &found.random];
            for (sum, stresses) in sums.iter_mut().zip(parts) {
                let across = value_at(grid, &stresses[stress_of(0, 1)], place)?;
                let up = value_at(grid, &stresses[stress_of(0, 2)], place)?;
                *sum -= (across * cosine + up * sine) * mean / N_AROUND as f64;
            }
        }
        let [total, periodic, random] = sums;
        Some(FluxPoint { x, total, periodic, random })
    };
    distances(grid).filter_map(point).collect()
}

fn distances(grid: &Grid) -> impl Iterator<Item = f64> + use<> {
    let grid = *grid;
    (0..grid.n_points[0]).map(move |step| grid.coordinate(0, step))
}

/// The integral along x of `part` of the flux at `points` (m⁴/s³ for m³/s³), by trapezia.
pub fn integral(points: &[FluxPoint], part: impl Fn(&FluxPoint) -> f64) -> f64 {
    let piece =
        |pair: &[FluxPoint]| 0.5 * (part(&pair[0]) + part(&pair[1])) * (pair[1].x - pair[0].x);
    points.windows(2).map(piece).sum()
}

/// Where the total flux, smoothed over `length` (m), first turns from leaving the wake to entering it for
/// good: the last change of sign from below; none where there is none.
pub fn sign_flip(points: &[FluxPoint], length: f64) -> Option<f64> {
    let smooth = |x: f64| {
        let near = points.iter().filter(|other| (other.x - x).abs() <= 0.5 * length * (1.0 + 1e-9));
        let (sum, n) = near.fold((0.0, 0), |(sum, n), other| (sum + other.total, n + 1));
        sum / f64::from(n)
    };
    let values: Vec<(f64, f64)> = points.iter().map(|one| (one.x, smooth(one.x))).collect();
    let flips = values.windows(2).filter(|pair| pair[0].1 < 0.0 && pair[1].1 >= 0.0);
    let place = |pair: &[(f64, f64)]| {
        let share = pair[0].1 / (pair[0].1 - pair[1].1);
        pair[0].0 + share * (pair[1].0 - pair[0].0)
    };
    flips.map(place).next_back()
}

/// Distance from `place` along `axis` (1 or 2, towards `way` 1 or −1) at which the mean speed `mean` at `x`
/// has come to `share` of `speed` (m/s): the edge of the wake (m); none where it does not on the grid.
///
/// Sought from the outside in, so that what lies in the wake does not count.
pub fn wake_edge(
    grid: &Grid,
    mean: &[f64],
    (x, place): (f64, [f64; 2]),
    (axis, way): (usize, f64),
    threshold: f64,
) -> Option<f64> {
    let step = 0.25 * grid.spacing[axis];
    let at = |steps: usize| {
        let mut position = [x, place[0], place[1]];
        position[axis] += way * step * steps as f64;
        value_at(grid, mean, position)
    };
    let outermost = (0..4 * grid.n_points[axis]).take_while(|steps| at(*steps).is_some()).last()?;
    if at(outermost)? < threshold {
        return None;
    }
    let inner = (0..outermost).rev().find(|steps| at(*steps).is_some_and(|u| u < threshold))?;
    let (low, high) = (at(inner)?, at(inner + 1)?);
    Some(step * (inner as f64 + (threshold - low) / (high - low)))
}
