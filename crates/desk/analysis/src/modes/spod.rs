//! Spectral proper orthogonal decomposition: modes at each frequency, from blocks of instants.

use super::eigen::{Eigen, eigen};
use super::gram::add_hermitian_products;
use super::strip::{Coverage, Strip, blank, each_strip};
use super::{ModesError, Snapshots};
use realfft::num_complex::Complex64;
use realfft::{RealFftPlanner, RealToComplex};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Fewest instants of a block (–).
const FEWEST: usize = 4;
/// By how much an interval may differ from the mean (–).
const UNEVEN: f64 = 1e-3;
/// Share of a frequency's greatest energy below which a mode is rounding (–).
const ROUNDING: f64 = 1e-12;

/// Weights of the instants of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// 0.54 − 0.46 cos(2π n / (N − 1)).
    Hamming,
    /// All the same.
    Even,
}

impl Window {
    /// Weights of `n` instants.
    pub fn weights(self, n: usize) -> Vec<f64> {
        let last = n.saturating_sub(1).max(1) as f64;
        let weight = |index: usize| match self {
            Self::Hamming => 0.54 - 0.46 * (TAU * index as f64 / last).cos(),
            Self::Even => 1.0,
        };
        (0..n).map(weight).collect()
    }
}

/// What is decomposed.
#[derive(Clone, Debug, PartialEq)]
pub struct SpodSettings {
    /// Which of u, v, w count.
    pub components: [bool; 3],
    /// Instants of a block (–).
    pub n_block: usize,
    /// Share of a block that the next one has, too (–).
    pub overlap: f64,
    /// Weights within a block.
    pub window: Window,
    /// Modes that are kept at a frequency (–).
    pub n_modes: usize,
    /// Frequencies whose modes are kept (Hz): of each the nearest that there is.
    pub frequencies: Vec<f64>,
    /// Frequencies with the greatest densities, zero apart, whose modes are kept beside those (–).
    pub n_strongest: usize,
    /// Memory of a strip (bytes).
    pub memory: u64,
}

/// Modes by energy at each frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Spod {
    /// Distance of the frequencies, of which the first is zero (Hz).
    pub frequency_step: f64,
    /// Energy density of each mode at each frequency, greatest first (m²/s²/Hz): mean over the area,
    /// one-sided, so that the sum over modes and frequencies times the step is the mean of |u'|² over area
    /// and blocks.
    pub densities: Vec<Vec<f64>>,
    /// Blocks (–).
    pub n_blocks: usize,
    /// Instants of a block (–).
    pub n_block: usize,
    /// Instants from one block to the next (–).
    pub hop: usize,
    /// Instants that blocks use (–).
    pub n_used: usize,
    /// Lower and upper end of the 95 % interval of a density over the density (–).
    pub interval_95: [f64; 2],
    /// The modes that are kept, by frequency.
    pub modes: Vec<SpectralModes>,
    /// Points that have a hole at any instant, and are left out (–).
    pub n_masked: usize,
}

/// Modes at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralModes {
    /// Its number.
    pub index: usize,
    /// The frequency (Hz).
    pub frequency: f64,
    /// The modes, greatest energy first: real and imaginary part of u, v, w in the order of the grid (–),
    /// whose mean square over the area is 1; not a number at holes. The real part of mode · exp (2π i f t)
    /// moves as the mode does; its phase is that at which the mode's largest value is real.
    pub modes: Vec<[Vec<[f32; 2]>; 3]>,
}

impl Spod {
    /// Frequency number `index` (Hz).
    pub fn frequency(&self, index: usize) -> f64 {
        index as f64 * self.frequency_step
    }

    /// Energy density of all modes at frequency number `index` (m²/s²/Hz).
    pub fn density(&self, index: usize) -> f64 {
        self.densities[index].iter().sum()
    }

    /// Energy over all frequencies (m²/s²).
    pub fn total(&self) -> f64 {
        (0..self.densities.len()).map(|index| self.density(index)).sum::<f64>()
            * self.frequency_step
    }
}

/// Modes of `snapshots` at each frequency. The mean over all time is removed.
///
/// It reads all twice, and holds a strip with its transforms, for each frequency the square of the number of
/// blocks, and the modes that are kept.
///
/// # Errors
/// [`ModesError`], and what reading gives.
pub fn spod<S: Snapshots>(snapshots: &mut S, settings: &SpodSettings) -> Result<Spod, S::Error> {
    let n_points = snapshots.grid().len();
    let blocks = Blocks::new(snapshots.times(), settings)?;
    let kept = blocks.kept(&settings.frequencies)?;
    let (n, n_blocks) = (blocks.n_frequencies(), blocks.n_blocks);
    let mut correlations = vec![vec![Complex64::default(); n_blocks * n_blocks]; n];
    let mut coverage = Coverage::default();
    each_strip(snapshots, settings.components, settings.memory, |strip| {
        coverage.add(strip);
        let n_strip = strip.points.len();
        for (_, values) in &strip.components {
            let spectra = blocks.spectra(values, n_strip, 0..n);
            for (correlation, spectrum) in correlations.iter_mut().zip(&spectra) {
                add_hermitian_products(spectrum, n_strip, correlation);
            }
        }
        Ok(())
    })?;
    coverage.check(n_points)?;
    let scale = blocks.scale / coverage.weight;
    let found = correlations.iter().map(|one| eigen(one, n_blocks));
    let found: Vec<Eigen> = found.collect::<Result<_, _>>()?;
    let density = |(index, found): (usize, &Eigen)| {
        let scale = scale * blocks.sides(index);
        found.values.iter().map(|value| scale * value).collect()
    };
    let densities: Vec<Vec<f64>> = found.iter().enumerate().map(density).collect();
    let kept = with_strongest(kept, &densities, settings.n_strongest);
    let modes = modes_at(snapshots, settings, &blocks, &found, &kept, &coverage)?;
    Ok(Spod {
        frequency_step: blocks.frequency_step,
        densities,
        n_blocks,
        n_block: blocks.weights.len(),
        hop: blocks.hop,
        n_used: blocks.hop * (n_blocks - 1) + blocks.weights.len(),
        interval_95: blocks.interval_95(),
        modes,
        n_masked: coverage.n_masked,
    })
}

/// `kept` and the numbers of the `n` frequencies with the greatest `densities`, zero apart; ascending.
fn with_strongest(mut kept: Vec<usize>, densities: &[Vec<f64>], n: usize) -> Vec<usize> {
    let density = |index: &usize| densities[*index].iter().sum::<f64>();
    let mut order: Vec<usize> = (1..densities.len()).collect();
    order.sort_by(|a, b| density(b).total_cmp(&density(a)));
    kept.extend(order.into_iter().take(n));
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The modes at the frequencies of the numbers `kept`.
fn modes_at<S: Snapshots>(
    snapshots: &mut S,
    settings: &SpodSettings,
    blocks: &Blocks,
    found: &[Eigen],
    kept: &[usize],
    coverage: &Coverage,
) -> Result<Vec<SpectralModes>, S::Error> {
    let n_points = snapshots.grid().len();
    let mut all: Vec<SpectralModes> = Vec::with_capacity(kept.len());
    for index in kept.iter().copied() {
        let values = &found[index].values;
        let least = ROUNDING * values.first().copied().unwrap_or(0.0);
        let n_modes = values.iter().take(settings.n_modes).take_while(|v| **v > least).count();
        let modes = vec![blank(n_points, [f32::NAN; 2]); n_modes];
        all.push(SpectralModes { index, frequency: index as f64 * blocks.frequency_step, modes });
    }
    let (Some(first), Some(last)) = (kept.first(), kept.last()) else { return Ok(all) };
    let mut largest: Vec<Vec<Complex64>> =
        all.iter().map(|one| vec![Complex64::new(0.0, 0.0); one.modes.len()]).collect();
    each_strip(snapshots, settings.components, settings.memory, |strip| {
        let n_strip = strip.points.len();
        for (component, values) in &strip.components {
            let spectra = blocks.spectra(values, n_strip, *first..last + 1);
            for (one, largest) in all.iter_mut().zip(&mut largest) {
                let (found, spectrum) = (&found[one.index], &spectra[one.index - first]);
                for (number, (mode, largest)) in one.modes.iter_mut().zip(largest).enumerate() {
                    let out = &mut mode[*component][strip.points.clone()];
                    let size = (coverage.weight / found.values[number]).sqrt();
                    project(strip, spectrum, &found.vectors[number], size, out, largest);
                }
            }
        }
        Ok(())
    })?;
    for (mode, largest) in
        all.iter_mut().flat_map(|one| &mut one.modes).zip(largest.iter().flatten())
    {
        let turn = largest.conj() / largest.norm();
        for value in mode.iter_mut().flatten() {
            let turned = Complex64::new(f64::from(value[0]), f64::from(value[1])) * turn;
            *value = [turned.re as f32, turned.im as f32];
        }
    }
    Ok(all)
}

/// On return `out` holds the mode of `vector` times `size` at the points of `strip`, whose transforms are
/// `spectrum`; `largest` the greatest value so far.
fn project(
    strip: &Strip,
    spectrum: &[Complex64],
    vector: &[Complex64],
    size: f64,
    out: &mut [[f32; 2]],
    largest: &mut Complex64,
) {
    let n_strip = strip.points.len();
    for (place, out) in out.iter_mut().enumerate().filter(|(place, _)| strip.roots[*place] > 0.0) {
        let parts = vector.iter().enumerate();
        let sum: Complex64 =
            parts.map(|(block, part)| spectrum[block * n_strip + place] * part).sum();
        let value = sum * (size / strip.roots[place]);
        if value.norm_sqr() > largest.norm_sqr() {
            *largest = value;
        }
        *out = [value.re as f32, value.im as f32];
    }
}

/// How instants are cut into blocks, and transformed.
struct Blocks {
    weights: Vec<f64>,
    hop: usize,
    n_blocks: usize,
    frequency_step: f64,
    /// Density over the square of a transform, times weights and blocks.
    scale: f64,
    transform: Arc<dyn RealToComplex<f64>>,
}

impl Blocks {
    fn new(times: &[f64], settings: &SpodSettings) -> Result<Self, ModesError> {
        let SpodSettings { n_block, overlap, window, components, .. } = settings;
        let (n_block, n_instants) = (*n_block, times.len());
        if !components.contains(&true) {
            return Err(ModesError::NoComponent);
        }
        if n_block < FEWEST || !(0.0..1.0).contains(overlap) {
            return Err(ModesError::Blocks { n_block, overlap: *overlap });
        }
        if n_instants < n_block {
            return Err(ModesError::TooFew { n_instants, needed: n_block });
        }
        let interval = even(times)?;
        let shared = ((overlap * n_block as f64).round() as usize).min(n_block - 1);
        let hop = n_block - shared;
        let n_blocks = (n_instants - shared) / hop;
        let weights = window.weights(n_block);
        let square: f64 = weights.iter().map(|weight| weight * weight).sum();
        Ok(Self {
            hop,
            n_blocks,
            frequency_step: 1.0 / (n_block as f64 * interval),
            scale: interval / (square * n_blocks as f64),
            transform: RealFftPlanner::new().plan_fft_forward(n_block),
            weights,
        })
    }

    /// Frequencies (–).
    fn n_frequencies(&self) -> usize {
        self.weights.len() / 2 + 1
    }

    /// How many of the two signs frequency number `index` stands for.
    fn sides(&self, index: usize) -> f64 {
        if index == 0 || 2 * index == self.weights.len() { 1.0 } else { 2.0 }
    }

    /// Numbers of the frequencies nearest to `wanted` (Hz), each once, ascending.
    fn kept(&self, wanted: &[f64]) -> Result<Vec<usize>, ModesError> {
        let highest = (self.n_frequencies() - 1) as f64 * self.frequency_step;
        let mut kept = Vec::new();
        for frequency in wanted {
            if !(0.0..=highest).contains(frequency) {
                return Err(ModesError::Frequency { frequency: *frequency, highest });
            }
            kept.push((frequency / self.frequency_step).round() as usize);
        }
        kept.sort_unstable();
        kept.dedup();
        Ok(kept)
    }

    /// Transforms of the blocks of `values`, instants of `n_points`, at the `frequencies`: for each of
    /// these block by block, all points of a block together.
    fn spectra(
        &self,
        values: &[f64],
        n_points: usize,
        frequencies: std::ops::Range<usize>,
    ) -> Vec<Vec<Complex64>> {
        let nothing = Complex64::new(0.0, 0.0);
        let mut spectra = vec![vec![nothing; n_points * self.n_blocks]; frequencies.len()];
        let mut input = self.transform.make_input_vec();
        let mut output = self.transform.make_output_vec();
        let mut scratch = self.transform.make_scratch_vec();
        for place in 0..n_points {
            for block in 0..self.n_blocks {
                let samples =
                    values[block * self.hop * n_points + place..].iter().step_by(n_points);
                for ((input, sample), weight) in input.iter_mut().zip(samples).zip(&self.weights) {
                    *input = sample * weight;
                }
                self.transform
                    .process_with_scratch(&mut input, &mut output, &mut scratch)
                    .expect("input and output have the lengths that the plan asks for");
                for (spectrum, value) in spectra.iter_mut().zip(&output[frequencies.clone()]) {
                    spectrum[block * n_points + place] = *value;
                }
            }
        }
        spectra
    }

    /// Ends of the 95 % interval of a density over the density: χ² of twice the number of independent blocks.
    ///
    /// Blocks that overlap count as Welch (1967) has it; the quantiles of χ² are Wilson and Hilferty's
    /// (1931).
    fn interval_95(&self) -> [f64; 2] {
        let square: f64 = self.weights.iter().map(|weight| weight * weight).sum();
        let mut shared = 0.0;
        for lag in 1..self.n_blocks {
            let shift = lag * self.hop;
            if shift >= self.weights.len() {
                break;
            }
            let product: f64 =
                self.weights.iter().zip(&self.weights[shift..]).map(|(a, b)| a * b).sum();
            shared += (1.0 - lag as f64 / self.n_blocks as f64) * (product / square).powi(2);
        }
        let degrees = 2.0 * self.n_blocks as f64 / (1.0 + 2.0 * shared);
        let quantile = |normal: f64| {
            let part = 2.0 / (9.0 * degrees);
            (1.0 - part + normal * part.sqrt()).max(f64::MIN_POSITIVE).powi(3)
        };
        [1.0 / quantile(1.959_964), 1.0 / quantile(-1.959_964)]
    }
}

/// The interval of `times` (s), which must be even.
fn even(times: &[f64]) -> Result<f64, ModesError> {
    let n = times.len();
    let interval = (times[n - 1] - times[0]) / (n - 1) as f64;
    for (index, pair) in times.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        // Not so of what is not a number, too.
        let is_even = step > 0.0 && (step - interval).abs() <= UNEVEN * interval;
        if !is_even {
            return Err(ModesError::UnevenTimes { index: index + 1, step, interval });
        }
    }
    Ok(interval)
}
