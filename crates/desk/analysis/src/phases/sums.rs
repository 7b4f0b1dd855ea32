//! Sums of velocity and of its products at points.

use basis::records::{Moments, STRESSES};
use multiversion::{multiversion, target::match_target};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Memory of a point in a bin (bytes): count, three sums, six sums of products.
pub const POINT_BYTES: u64 = (size_of::<u32>() + 9 * size_of::<f64>()) as u64;
/// Points whose moments are found side by side.
const CHUNK: usize = 64;

/// Sums at points, of differences from a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Sums {
    n: Vec<u32>,
    first: [Vec<f64>; 3],
    second: [Vec<f64>; 6],
}

impl Sums {
    pub(super) fn new(n_points: usize) -> Self {
        Self {
            n: vec![0; n_points],
            first: std::array::from_fn(|_| vec![0.0; n_points]),
            second: std::array::from_fn(|_| vec![0.0; n_points]),
        }
    }

    /// On return nothing is summed, at `n_points`; allocates where there were fewer.
    pub(super) fn clear(&mut self, n_points: usize) {
        self.n.clear();
        self.n.resize(n_points, 0);
        for sums in self.first.iter_mut().chain(&mut self.second) {
            sums.clear();
            sums.resize(n_points, 0.0);
        }
    }

    /// Adds the `instants` of `velocity`, where one stands after the other, less `reference` at each point
    /// where it has no hole. Whatever is summed at once, each point's sums grow instant by instant.
    pub(super) fn add(
        &mut self,
        instants: &[u32],
        velocity: [&[f32]; 3],
        reference: &[Vec<f32>; 3],
    ) {
        add(self, instants, velocity, reference);
    }

    /// The same, `N` points at a time.
    #[inline(always)]
    fn add_by<const N: usize>(
        &mut self,
        instants: &[u32],
        velocity: [&[f32]; 3],
        reference: &[Vec<f32>; 3],
    ) {
        let n_points = self.n.len();
        let even = n_points - n_points % N;
        for start in (0..even).step_by(N) {
            self.add_at::<N>(start, instants, velocity, reference);
        }
        for start in even..n_points {
            self.add_at::<1>(start, instants, velocity, reference);
        }
    }

    /// The same at `N` points from `start`: their sums stay in registers.
    #[inline(always)]
    fn add_at<const N: usize>(
        &mut self,
        start: usize,
        instants: &[u32],
        velocity: [&[f32]; 3],
        reference: &[Vec<f32>; 3],
    ) {
        let n_points = self.n.len();
        let points = start..start + N;
        let from = reference.each_ref().map(|values| taken::<f32, N>(&values[points.clone()]));
        let mut n = taken::<u32, N>(&self.n[points.clone()]);
        let mut first = self.first.each_ref().map(|sums| taken::<f64, N>(&sums[points.clone()]));
        let mut second = self.second.each_ref().map(|sums| taken::<f64, N>(&sums[points.clone()]));
        for instant in instants {
            let at = *instant as usize * n_points + start;
            let value = velocity.map(|values| taken::<f32, N>(&values[at..at + N]));
            for i in 0..N {
                let away: [f64; 3] =
                    std::array::from_fn(|c| f64::from(value[c][i]) - f64::from(from[c][i]));
                let is_there = (away[0] + away[1] + away[2]).is_finite();
                let [x, y, z] = away.map(|away| if is_there { away } else { 0.0 });
                n[i] += u32::from(is_there);
                for (sums, value) in first.iter_mut().zip([x, y, z]) {
                    sums[i] += value;
                }
                let products = [x * x, y * y, z * z, x * y, x * z, y * z];
                for (sums, value) in second.iter_mut().zip(products) {
                    sums[i] += value;
                }
            }
        }
        self.n[points.clone()].copy_from_slice(&n);
        for (sums, own) in self.first.iter_mut().zip(&first) {
            sums[points.clone()].copy_from_slice(own);
        }
        for (sums, own) in self.second.iter_mut().zip(&second) {
            sums[points.clone()].copy_from_slice(own);
        }
    }

    /// On return `moments` are those of what was summed, about `reference`.
    pub(super) fn moments(&self, reference: &[Vec<f32>; 3], moments: &mut Moments) {
        moments.n_samples.clone_from(&self.n);
        let n_points = self.n.len();
        for values in moments.mean.iter_mut().chain(&mut moments.stress) {
            values.resize(n_points, 0.0);
        }
        find_moments(self, reference, moments);
    }

    /// The same at `points`, as many as a chunk has at most: divided once for all moments.
    #[inline(always)]
    fn moments_at(&self, points: Range<usize>, reference: &[Vec<f32>; 3], moments: &mut Moments) {
        let mut share = [0.0; CHUNK];
        for (share, n) in share.iter_mut().zip(&self.n[points.clone()]) {
            *share = 1.0 / f64::from(*n);
        }
        let mut away = [[0.0; CHUNK]; 3];
        for (component, away) in away.iter_mut().enumerate() {
            let sums = &self.first[component][points.clone()];
            for (away, (sum, share)) in away.iter_mut().zip(sums.iter().zip(&share)) {
                *away = sum * share;
            }
            let mean = moments.mean[component][points.clone()].iter_mut();
            let from = &reference[component][points.clone()];
            mean.zip(from.iter().zip(away))
                .for_each(|(mean, (from, away))| *mean = (f64::from(*from) + *away) as f32);
        }
        for (place, components) in STRESSES.into_iter().enumerate() {
            let [a, b] = components.map(|component| &away[component]);
            let sums = self.second[place][points.clone()].iter().zip(&share);
            let stresses = moments.stress[place][points.clone()].iter_mut();
            for ((stress, (sum, share)), (a, b)) in stresses.zip(sums).zip(a.iter().zip(b)) {
                *stress = (sum * share - a * b) as f32;
            }
        }
    }
}

/// [`Sums::add`] in the instructions of this machine, so many points at a time as its registers hold sums of.
/// Products are rounded before they are summed on every machine: the sums are the same, bit by bit.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add(sums: &mut Sums, instants: &[u32], velocity: [&[f32]; 3], reference: &[Vec<f32>; 3]) {
    match_target! {
        "x86_64+avx512f" => sums.add_by::<8>(instants, velocity, reference),
        "x86_64+avx2" => sums.add_by::<4>(instants, velocity, reference),
        _ => sums.add_by::<2>(instants, velocity, reference),
    }
}

/// [`Sums::moments`] in the instructions of this machine, at points that `moments` have room for.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn find_moments(sums: &Sums, reference: &[Vec<f32>; 3], moments: &mut Moments) {
    let n_points = sums.n.len();
    for start in (0..n_points).step_by(CHUNK) {
        sums.moments_at(start..n_points.min(start + CHUNK), reference, moments);
    }
}

/// The first `N` of `values`.
#[inline(always)]
fn taken<T: Copy + Default, const N: usize>(values: &[T]) -> [T; N] {
    let mut own = [T::default(); N];
    own.copy_from_slice(&values[..N]);
    own
}
