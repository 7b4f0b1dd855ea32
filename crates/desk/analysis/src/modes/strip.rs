//! A strip of points over all of time, as fluctuations that carry the root of their weight.

use super::snapshots::{area_share, row_points, slowest_axis};
use super::{ModesError, Snapshots};
use std::ops::Range;

/// Memory that a point of a strip takes for each instant (bytes): as read, as fluctuations, and as
/// transforms of blocks that overlap by half.
const STRIP_BYTES: u64 = (3 * (size_of::<f32>() + size_of::<f64>()) + 2 * 16) as u64;

/// Memory that modes of `n_instants` on `grid` take in strips of at most `memory` bytes (bytes): the strip,
/// which has one row of points at least.
pub fn strip_bytes(grid: &basis::records::Grid, n_instants: usize, memory: u64) -> u64 {
    let rows = steps_of(grid, n_instants, memory) as u64;
    rows * row_points(grid) as u64 * n_instants as u64 * STRIP_BYTES
}

/// Steps along the slowest axis that fit into `memory` (bytes), one at least.
fn steps_of(grid: &basis::records::Grid, n_instants: usize, memory: u64) -> usize {
    let of_step = (row_points(grid) as u64 * n_instants as u64 * STRIP_BYTES).max(1);
    let n_steps = grid.n_points[slowest_axis(grid)];
    usize::try_from(memory / of_step).unwrap_or(n_steps).clamp(1, n_steps.max(1))
}

/// Fluctuations in a strip.
pub(super) struct Strip {
    /// The points, by their numbers in the grid.
    pub(super) points: Range<usize>,
    /// Root of the weight of each point; zero where there is a hole at any instant.
    pub(super) roots: Vec<f64>,
    /// Mean of u, v, w at each point (m/s); not a number at holes.
    pub(super) mean: [Vec<f32>; 3],
    /// Deviations from the mean times the root of the weight, of the components looked at, instant by instant
    /// with all its points.
    pub(super) components: Vec<(usize, Vec<f64>)>,
}

/// Gives `take` all of `snapshots`, strip by strip of at most `memory` bytes; of velocity, the `components`.
pub(super) fn each_strip<S: Snapshots>(
    snapshots: &mut S,
    components: [bool; 3],
    memory: u64,
    mut take: impl FnMut(&Strip) -> Result<(), S::Error>,
) -> Result<(), S::Error> {
    let grid = *snapshots.grid();
    let (n_instants, row) = (snapshots.times().len(), row_points(&grid));
    let n_steps = grid.n_points[slowest_axis(&grid)];
    let width = steps_of(&grid, n_instants, memory);
    for start in (0..n_steps).step_by(width) {
        let steps = start..(start + width).min(n_steps);
        let points = steps.start * row..steps.end * row;
        let read = snapshots.read(steps)?;
        let expected = points.len() * n_instants;
        if let Some(odd) = read.iter().find(|values| values.len() != expected) {
            return Err(ModesError::Values { found: odd.len(), expected }.into());
        }
        let weight = |index: usize| area_share(&grid, index);
        take(&prepared(points, read, weight, components, n_instants))?;
    }
    Ok(())
}

/// The strip of `points` out of `read`, instant by instant.
fn prepared(
    points: Range<usize>,
    read: [Vec<f32>; 3],
    weight: impl Fn(usize) -> f64,
    looked_at: [bool; 3],
    n_instants: usize,
) -> Strip {
    let n = points.len();
    let mut is_there = vec![true; n];
    let wanted = || (0..3).filter(|component| looked_at[*component]);
    for component in wanted() {
        for instant in read[component].chunks_exact(n.max(1)) {
            for (there, value) in is_there.iter_mut().zip(instant) {
                *there &= value.is_finite();
            }
        }
    }
    let root = |(place, there): (usize, &bool)| {
        if *there { weight(points.start + place).sqrt() } else { 0.0 }
    };
    let roots: Vec<f64> = is_there.iter().enumerate().map(root).collect();
    let mut mean: [Vec<f32>; 3] = std::array::from_fn(|_| vec![f32::NAN; n]);
    let mut components = Vec::new();
    for component in wanted() {
        let mut sums = vec![0.0; n];
        for instant in read[component].chunks_exact(n.max(1)) {
            for (sum, value) in sums.iter_mut().zip(instant) {
                *sum += f64::from(*value);
            }
        }
        sums.iter_mut().for_each(|sum| *sum /= n_instants as f64);
        for (mean, (sum, root)) in mean[component].iter_mut().zip(sums.iter().zip(&roots)) {
            *mean = if *root > 0.0 { *sum as f32 } else { f32::NAN };
        }
        let mut values = Vec::with_capacity(n * n_instants);
        for instant in read[component].chunks_exact(n.max(1)) {
            values.extend(instant.iter().zip(sums.iter().zip(&roots)).map(
                // A hole times nothing is no number.
                |(value, (mean, root))| {
                    if *root > 0.0 { (f64::from(*value) - mean) * root } else { 0.0 }
                },
            ));
        }
        components.push((component, values));
    }
    Strip { points, roots, mean, components }
}

/// Adds what `strip` says of holes and weights.
#[derive(Default)]
pub(super) struct Coverage {
    /// Sum of the weights of points without holes.
    pub(super) weight: f64,
    /// Points with a hole (–).
    pub(super) n_masked: usize,
}

impl Coverage {
    pub(super) fn add(&mut self, strip: &Strip) {
        self.weight += strip.roots.iter().map(|root| root * root).sum::<f64>();
        self.n_masked += strip.roots.iter().filter(|root| **root == 0.0).count();
    }

    /// That there is a point to look at, of `n_points`.
    pub(super) fn check(&self, n_points: usize) -> Result<(), ModesError> {
        if self.weight > 0.0 { Ok(()) } else { Err(ModesError::NoPoint { n_points }) }
    }
}

/// A field of three components with no number in it.
pub(super) fn blank<T: Clone>(n_points: usize, nothing: T) -> [Vec<T>; 3] {
    std::array::from_fn(|_| vec![nothing.clone(); n_points])
}
