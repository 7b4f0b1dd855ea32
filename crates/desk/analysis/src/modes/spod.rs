//! Spectral proper orthogonal decomposition: modes that are coherent in space and time, frequency by
//! frequency.

use super::snapshots::{ModesError, Part, Snapshots, eigen, in_parts};
use faer::{Mat, c64};
use realfft::{RealFftPlanner, RealToComplex};
use std::f64::consts::TAU;
use std::sync::Arc;

/// How a record is cut into blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct SpodSettings {
    /// Time between instants (s).
    pub interval: f64,
    /// Instants of a block (–).
    pub n_block: usize,
    /// Instants that a block shares with the next (–).
    pub n_overlap: usize,
    /// Modes that are kept at each frequency of `at` (–).
    pub n_modes: usize,
    /// Frequencies whose modes are kept (Hz): the nearest of the spectrum to each.
    pub at: Vec<f64>,
}

/// Energies and modes over frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spod {
    /// Frequencies (Hz).
    pub frequencies: Vec<f64>,
    /// Energy of each mode at each frequency per frequency (unit² × weight / Hz), the strongest first; over
    /// all frequencies and modes, times their distance, it is the variance.
    pub energies: Vec<Vec<f64>>,
    /// The modes that are kept.
    pub modes: Vec<SpodMode>,
    /// Blocks (–).
    pub n_blocks: usize,
    /// Values with a hole at some instant, which play no part (–).
    pub n_masked: usize,
}

/// A mode at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SpodMode {
    /// Place of its frequency.
    pub frequency: usize,
    /// Its rank there, from 0.
    pub rank: usize,
    /// Real and imaginary part at each value, of unit size: the field is Re(mode e^{2πift}).
    pub values: Vec<[f64; 2]>,
}

/// The blocks' transforms.
struct Blocks {
    starts: Vec<usize>,
    window: Vec<f64>,
    transform: Arc<dyn RealToComplex<f64>>,
    /// Factor that makes energies densities (s).
    scale: f64,
    n_frequencies: usize,
}

impl Blocks {
    fn new(n_instants: usize, settings: &SpodSettings) -> Self {
        let SpodSettings { n_block, n_overlap, interval, .. } = *settings;
        let step = n_block - n_overlap;
        let starts = (0..).map(|block| block * step).take_while(|s| s + n_block <= n_instants);
        // Hamming's window, periodic or not being one and the same at many samples: here symmetric.
        let weight = |i: usize| 0.54 - 0.46 * (TAU * i as f64 / (n_block - 1) as f64).cos();
        let window: Vec<f64> = (0..n_block).map(weight).collect();
        let scale = interval / window.iter().map(|w| w * w).sum::<f64>();
        Self {
            starts: starts.collect(),
            window,
            transform: RealFftPlanner::new().plan_fft_forward(n_block),
            scale,
            n_frequencies: n_block / 2 + 1,
        }
    }

    /// Both signs of a frequency in one, but for zero and Nyquist's.
    fn sides(&self, frequency: usize) -> f64 {
        let is_alone = frequency == 0 || 2 * frequency == self.window.len();
        if is_alone { 1.0 } else { 2.0 }
    }

    /// Hands `take` the transforms of all blocks of each value of `part`: its place in the part, and for each
    /// block the values at all frequencies.
    fn of_part(&self, part: &Part, mut take: impl FnMut(usize, &[Vec<c64>])) {
        let width = part.range.len();
        let mut input = self.transform.make_input_vec();
        let mut outputs = vec![self.transform.make_output_vec(); self.starts.len()];
        for place in 0..width {
            for (start, output) in self.starts.iter().zip(&mut outputs) {
                for (i, (value, weight)) in input.iter_mut().zip(&self.window).enumerate() {
                    *value = weight * part.values[(start + i) * width + place];
                }
                self.transform
                    .process(&mut input, output)
                    .expect("input and output have the lengths that the plan asks for");
                for (frequency, value) in output.iter_mut().enumerate() {
                    *value *= (self.scale * self.sides(frequency)).sqrt();
                }
            }
            take(place, &outputs);
        }
    }
}

/// The spectral modes of `field` with the inner product Σ `weight` a* b over all values.
///
/// The mean over all instants is taken off; blocks have Hamming's window, and the transform e^{−2πift}.
/// Source: Towne, Schmidt and Colonius (2018), J. Fluid Mech. 847, 821, algorithm 1.
///
/// # Errors
/// [`ModesError`].
pub fn spod<S: Snapshots>(
    field: &S,
    weight: f64,
    settings: &SpodSettings,
) -> Result<Spod, ModesError<S::Error>> {
    let (n_instants, n_values) = (field.n_instants(), field.n_values());
    check(n_instants, settings)?;
    let blocks = Blocks::new(n_instants, settings);
    let n_blocks = blocks.starts.len();
    let mut correlations = vec![Mat::<c64>::zeros(n_blocks, n_blocks); blocks.n_frequencies];
    let mut n_masked = 0;
    in_parts(field, |part| {
        n_masked += part.means.iter().filter(|mean| !mean.is_finite()).count();
        blocks.of_part(part, |_, of_blocks| {
            for (frequency, matrix) in correlations.iter_mut().enumerate() {
                for i in 0..n_blocks {
                    for j in 0..=i {
                        matrix[(i, j)] += of_blocks[i][frequency].conj() * of_blocks[j][frequency];
                    }
                }
            }
        });
    })?;
    let share = weight / n_blocks as f64;
    let span = settings.interval * settings.n_block as f64;
    let mut found = Spod { n_blocks, n_masked, ..Spod::default() };
    let mut vectors = Vec::with_capacity(correlations.len());
    for (frequency, matrix) in correlations.into_iter().enumerate() {
        let (energies, own) = eigen::<S::Error>(&(matrix * faer::Scale(c64::new(share, 0.0))))?;
        found.frequencies.push(frequency as f64 / span);
        found.energies.push(energies);
        vectors.push(own);
    }
    if found.energies.iter().all(|energies| energies[0] <= 0.0) {
        return Err(ModesError::Nothing { n_values, n_masked });
    }
    found.modes = wanted(&found, settings, span, n_values);
    let modes = &mut found.modes;
    in_parts(field, |part| {
        blocks.of_part(part, |place, of_blocks| {
            for mode in modes.iter_mut() {
                let energy = found.energies[mode.frequency][mode.rank];
                let own = &vectors[mode.frequency];
                let sum: c64 = (0..n_blocks)
                    .map(|block| of_blocks[block][mode.frequency] * own[(block, mode.rank)])
                    .sum();
                let value = sum / (n_blocks as f64 * energy).sqrt();
                mode.values[part.range.start + place] = [value.re, value.im];
            }
        });
    })?;
    Ok(found)
}

/// The modes that are kept, empty, each once.
fn wanted(found: &Spod, settings: &SpodSettings, span: f64, n_values: usize) -> Vec<SpodMode> {
    let last = found.frequencies.len() - 1;
    let mut modes: Vec<SpodMode> = Vec::new();
    for at in &settings.at {
        let frequency = ((at * span).round().max(0.0) as usize).min(last);
        for rank in 0..settings.n_modes.min(found.n_blocks) {
            let is_there = modes.iter().any(|one| (one.frequency, one.rank) == (frequency, rank));
            if !is_there && found.energies[frequency][rank] > 0.0 {
                modes.push(SpodMode { frequency, rank, values: vec![[0.0; 2]; n_values] });
            }
        }
    }
    modes
}

fn check<E: std::error::Error + 'static>(
    n_instants: usize,
    settings: &SpodSettings,
) -> Result<(), ModesError<E>> {
    let SpodSettings { n_block, n_overlap, interval, .. } = *settings;
    if n_block < 4 || n_overlap >= n_block {
        let what = format!(
            "blocks of {n_block} instants that share {n_overlap}; give 4 instants at least, and fewer shared than a block has"
        );
        return Err(ModesError::Setting { what });
    }
    if !(interval > 0.0 && interval.is_finite()) {
        let what = format!("the time between instants is {interval} s; it must be above 0");
        return Err(ModesError::Setting { what });
    }
    let needed = 2 * n_block - n_overlap;
    if n_instants < needed {
        return Err(ModesError::TooFew { n_instants, needed });
    }
    Ok(())
}
