//! Sums of velocity and of its products at points.

use basis::records::{Moments, STRESSES};
use serde::{Deserialize, Serialize};

/// Memory of a point in a bin (bytes): count, three sums, six sums of products.
pub const POINT_BYTES: u64 = (size_of::<u32>() + 9 * size_of::<f64>()) as u64;
/// Points that are summed side by side: as many as the registers of any machine hold sums of.
const LANES: usize = 2;

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
        let n_points = self.n.len();
        let even = n_points - n_points % LANES;
        for start in (0..even).step_by(LANES) {
            self.add_at::<LANES>(start, instants, velocity, reference);
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
        let n = &self.n;
        moments.n_samples.clone_from(n);
        let first = &self.first;
        for (component, values) in moments.mean.iter_mut().enumerate() {
            let (sums, from) = (&first[component], &reference[component]);
            values.clear();
            let each = sums.iter().zip(n).zip(from);
            values.extend(
                each.map(|((sum, n), from)| (f64::from(*from) + sum / f64::from(*n)) as f32),
            );
        }
        for (place, values) in moments.stress.iter_mut().enumerate() {
            let [a, b] = STRESSES[place].map(|component| &first[component]);
            let sums = &self.second[place];
            values.clear();
            let each = sums.iter().zip(n).zip(a.iter().zip(b));
            values.extend(each.map(|((sum, n), (a, b))| {
                let n = f64::from(*n);
                (sum / n - (a / n) * (b / n)) as f32
            }));
        }
    }
}

/// The first `N` of `values`.
#[inline(always)]
fn taken<T: Copy + Default, const N: usize>(values: &[T]) -> [T; N] {
    let mut own = [T::default(); N];
    own.copy_from_slice(&values[..N]);
    own
}
