//! The triple decomposition: mean, periodic and random parts, and the stresses of each.

use basis::records::{Moments, PhaseAverages, STRESSES};
use multiversion::multiversion;
use std::ops::Range;

/// Mean velocity and the stresses of its periodic and random fluctuations, at each point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Decomposition {
    /// Mean over all instants (m/s): ū.
    pub mean: [Vec<f64>; 3],
    /// Stresses of all fluctuations, ⟨u'w'⟩ and so on (m²/s²), as [`STRESSES`] orders them.
    pub total: [Vec<f64>; 6],
    /// Those of the periodic part: of the bins' means about their own mean (m²/s²).
    pub periodic: [Vec<f64>; 6],
    /// Those of the random part: means over the bins of the stress in each (m²/s²).
    pub random: [Vec<f64>; 6],
    /// Bins with two samples at least, at each point (–): those that periodic and random parts are made of.
    pub n_bins: Vec<u32>,
    /// Fewest samples of a bin among them (–).
    pub fewest: Vec<u32>,
}

impl Decomposition {
    /// Puts `other`, whose points come next, behind this.
    pub fn append(&mut self, other: &Self) {
        let own = self.mean.iter_mut().chain(&mut self.total).chain(&mut self.periodic);
        let others = other.mean.iter().chain(&other.total).chain(&other.periodic);
        for (own, other) in own.chain(&mut self.random).zip(others.chain(&other.random)) {
            own.extend_from_slice(other);
        }
        self.n_bins.extend_from_slice(&other.n_bins);
        self.fewest.extend_from_slice(&other.fewest);
    }
}

/// Points that are taken in side by side.
const CHUNK: usize = 64;

/// What a stress of n samples weighs.
#[derive(Clone, Copy, Default)]
struct Weights {
    /// Whether it counts.
    is_in: bool,
    /// In the random part, without bias: samples about their own mean, n/(n − 1).
    random: f64,
    /// In what that mean scatters by, 1/(n − 1).
    noise: f64,
}

impl Weights {
    fn of(n: u32) -> Self {
        let is_in = n > 1;
        let n = f64::from(n);
        let noise = 1.0 / (n - 1.0);
        Self { is_in, random: n * noise, noise }
    }
}

/// Takes the bins of averages by phase one by one.
#[derive(Clone, Debug)]
pub struct Decomposer {
    mean: [Vec<f64>; 3],
    products: [Vec<f64>; 6],
    random: [Vec<f64>; 6],
    n_bins: Vec<u32>,
    fewest: Vec<u32>,
    /// Sums over the bins of the random stress over its samples: the noise of the means.
    noise: [Vec<f64>; 6],
    /// Mean of all, from which the bins' means are taken.
    about: [Vec<f64>; 3],
    total: [Vec<f64>; 6],
}

impl Decomposer {
    /// Nothing taken in yet; `all` are the moments of all instants.
    pub fn new(all: &Moments) -> Self {
        let n_points = all.n_samples.len();
        let zeros = || vec![0.0; n_points];
        let wide = |values: &Vec<f32>| values.iter().copied().map(f64::from).collect();
        Self {
            mean: [zeros(), zeros(), zeros()],
            products: std::array::from_fn(|_| zeros()),
            random: std::array::from_fn(|_| zeros()),
            noise: std::array::from_fn(|_| zeros()),
            n_bins: vec![0; n_points],
            fewest: vec![u32::MAX; n_points],
            about: all.mean.each_ref().map(wide),
            total: all.stress.each_ref().map(wide),
        }
    }

    /// Takes in a bin. Points at which it has fewer than two samples are left out.
    ///
    /// # Panics
    /// Where it has other points.
    pub fn add(&mut self, bin: &Moments) {
        assert_eq!(bin.n_samples.len(), self.n_bins.len(), "bins of one grid");
        add(self, bin);
    }

    /// The same at `points`, as many as a chunk has at most: what samples weigh is found once for all
    /// stresses.
    #[inline(always)]
    fn add_at(&mut self, bin: &Moments, points: Range<usize>) {
        let samples = &bin.n_samples[points.clone()];
        let mut weights = [Weights::default(); CHUNK];
        let counts = self.n_bins[points.clone()].iter_mut().zip(&mut self.fewest[points.clone()]);
        for ((n, weight), (n_bins, fewest)) in samples.iter().zip(&mut weights).zip(counts) {
            *weight = Weights::of(*n);
            *n_bins += u32::from(weight.is_in);
            *fewest = if weight.is_in { (*fewest).min(*n) } else { *fewest };
        }
        let mut away = [[0.0; CHUNK]; 3];
        for (component, away) in away.iter_mut().enumerate() {
            let about = &self.about[component][points.clone()];
            let mean = &bin.mean[component][points.clone()];
            let each = away.iter_mut().zip(mean.iter().zip(about)).zip(&weights);
            for ((away, (mean, about)), weight) in each {
                *away = if weight.is_in { f64::from(*mean) - about } else { 0.0 };
            }
            let sums = &mut self.mean[component][points.clone()];
            sums.iter_mut().zip(away).for_each(|(sum, away)| *sum += *away);
        }
        for (place, components) in STRESSES.into_iter().enumerate() {
            let [a, b] = components.map(|component| &away[component]);
            let products = &mut self.products[place][points.clone()];
            products.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
            let random = self.random[place][points.clone()].iter_mut();
            let sums = random.zip(&mut self.noise[place][points.clone()]);
            let stresses = bin.stress[place][points.clone()].iter().zip(&weights);
            for ((random, noise), (stress, weight)) in sums.zip(stresses) {
                let stress = if weight.is_in { f64::from(*stress) } else { 0.0 };
                *random += stress * weight.random;
                *noise += stress * weight.noise;
            }
        }
    }

    /// The decomposition.
    ///
    /// Random stresses are means over the bins (Eqs. 9 and 10 of van der Hoek et al., 2024), each with n − 1
    /// in the place of n; the random part that bins of n samples leave in their means, 1/n of it, is taken
    /// from the periodic stresses. Where bins hold equally many samples and do not overlap, periodic and
    /// random stresses add up to the total. Limits: samples of a bin are taken as independent.
    pub fn finish(self) -> Decomposition {
        let n_bins = self.n_bins;
        let over = |sum: f64, i: usize| sum / f64::from(n_bins[i]);
        let periodic = |place: usize| -> Vec<f64> {
            let [a, b] = STRESSES[place];
            let products = self.products[place].iter().enumerate();
            let own = |(i, product): (usize, &f64)| {
                let noise = over(self.noise[place][i], i);
                over(*product, i) - over(self.mean[a][i], i) * over(self.mean[b][i], i) - noise
            };
            products.map(own).collect()
        };
        let random = |place: usize| -> Vec<f64> {
            self.random[place].iter().enumerate().map(|(i, sum)| over(*sum, i)).collect()
        };
        Decomposition {
            periodic: std::array::from_fn(periodic),
            random: std::array::from_fn(random),
            mean: self.about,
            total: self.total,
            fewest: self.fewest.iter().map(|n| if *n == u32::MAX { 0 } else { *n }).collect(),
            n_bins,
        }
    }
}

/// [`Decomposer::add`] in the instructions of this machine; what comes out is the same on every one.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add(decomposer: &mut Decomposer, bin: &Moments) {
    let n_points = decomposer.n_bins.len();
    for start in (0..n_points).step_by(CHUNK) {
        decomposer.add_at(bin, start..n_points.min(start + CHUNK));
    }
}

/// The decomposition of `averages`.
///
/// Source: van der Hoek et al. (2024), Eqs. 2, 3, 5, 9 and 10; see [`Decomposer::finish`].
pub fn decompose(averages: &PhaseAverages) -> Decomposition {
    let mut decomposer = Decomposer::new(&averages.all);
    averages.each.iter().for_each(|bin| decomposer.add(bin));
    decomposer.finish()
}

/// Standard error of the mean of component `component` (0 to 2) at point number `point` (m/s), where
/// `n_independent` of the samples are independent of one another: their number at most, visits to the bin at
/// least. Not a number with fewer than two.
pub fn standard_error(
    moments: &Moments,
    component: usize,
    point: usize,
    n_independent: f64,
) -> f64 {
    let n = f64::from(moments.n_samples[point]);
    if n < 2.0 || n_independent < 2.0 {
        return f64::NAN;
    }
    let variance = f64::from(moments.stress[component][point]) * n / (n - 1.0);
    (variance.max(0.0) / n_independent.min(n)).sqrt()
}
