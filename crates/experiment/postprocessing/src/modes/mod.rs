//! Modes of a wake in the planes that a run kept, or in a file of its own.

mod error;
mod figures;
mod fix;
mod source;

pub(crate) use figures::signals;
pub(crate) use fix::fix_of;

use crate::PostprocessingError;
use analysis::line::strongest;
use analysis::modes::{
    FrequencyNames, Pod, PodSettings, Spod, SpodSettings, Window, pod, spod, strip_bytes,
};
use basis::records::Grid;
use error::Trouble;
use source::{Frequencies, Source};
use std::path::PathBuf;

/// Periods of a helix that the shortest useful block has (–).
const FEWEST_PERIODS: f64 = 1.0;
/// Blocks, which overlap by half, that a record is cut into where no block is asked for (–): so many are
/// left when a block has a third of it.
const BLOCK_SHARE: f64 = 3.0;
/// Periods of a line that has a frequency (–).
const FEWEST_OF_LINE: f64 = 3.0;
/// Blades of a rotor.
const N_BLADES: usize = 3;
/// Frequencies without a name whose modes are kept: the strongest ones (–).
const N_STRONGEST: usize = 1;

/// A question about modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ModesQuestion {
    /// Folder of a run, or a NetCDF file of velocity at instants.
    pub path: PathBuf,
    /// Plane of the run; its first when absent.
    pub plane: Option<String>,
    /// Which of u, v, w count.
    pub components: [bool; 3],
    /// Instants of a block (–); whole periods of the helix in about a third of the record when absent.
    pub n_block: Option<usize>,
    /// Share of a block that the next one has, too (–).
    pub overlap: f64,
    /// Modes that are kept (–).
    pub n_modes: usize,
    /// Excitation frequency (Hz); that of the run's helix when absent.
    pub excitation: Option<f64>,
    /// Rotor frequency (Hz); the mean one of the run's first turbine when absent.
    pub rotor: Option<f64>,
    /// Memory of a strip (bytes).
    pub memory: u64,
}

impl ModesQuestion {
    /// All components, blocks that overlap by half, three modes, a quarter of a gigabyte.
    pub fn of(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            plane: None,
            components: [true; 3],
            n_block: None,
            overlap: 0.5,
            n_modes: 3,
            excitation: None,
            rotor: None,
            memory: 256 << 20,
        }
    }
}

/// The modes of one plane.
#[derive(Clone, Debug, PartialEq)]
pub struct ModesAnswer {
    /// The file.
    pub path: PathBuf,
    /// Conditions in words: case, run, plane, wind.
    pub conditions: String,
    /// The points.
    pub grid: Grid,
    /// Rotor diameter (m); none where it is not known.
    pub diameter: Option<f64>,
    /// Instants (–).
    pub n_instants: usize,
    /// First and last (s).
    pub span: [f64; 2],
    /// Which of u, v, w count.
    pub components: [bool; 3],
    /// The frequencies that have names.
    pub names: FrequencyNames,
    /// Modes by energy.
    pub pod: Pod,
    /// Strongest frequency of each coefficient of these that are kept (Hz), with the share of the mode's
    /// energy that its sine has (–); none where there are too few instants, or periods.
    pub pod_lines: Vec<Option<[f64; 2]>>,
    /// Modes by energy at each frequency.
    pub spod: Spod,
    /// Memory of the strips (bytes).
    pub memory: u64,
}

impl ModesAnswer {
    /// Names of frequency number `index` of the spectral modes; none where it has none.
    pub fn name_of(&self, index: usize) -> Option<String> {
        self.names.of(self.spod.frequency(index), 0.5 * self.spod.frequency_step)
    }

    /// Name of the frequency of POD mode `mode`; none where it has none.
    pub fn pod_name(&self, mode: usize) -> Option<String> {
        let [frequency, _] = (*self.pod_lines.get(mode)?)?;
        self.names.of(frequency, self.resolution())
    }

    /// Half of the frequency that the whole record resolves (Hz).
    fn resolution(&self) -> f64 {
        1.0 / (self.span[1] - self.span[0]).max(f64::MIN_POSITIVE)
    }

    /// How many instants and blocks stand behind the numbers, in words.
    pub fn samples(&self) -> String {
        let Self { n_instants, spod, span, .. } = self;
        format!(
            "{n_instants} instants from {} to {} s; {} blocks of {} instants, {} % overlap, Hamming's window",
            span[0],
            span[1],
            spod.n_blocks,
            spod.n_block,
            100 * (spod.n_block - spod.hop) / spod.n_block
        )
    }
}

/// Answers `question`.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, or have no modes.
pub fn modes(question: &ModesQuestion) -> Result<ModesAnswer, PostprocessingError> {
    let (source, frequencies) = Source::open(question)?;
    let path = source.stored.path().to_owned();
    answered(question, source, &frequencies).map_err(|trouble| trouble.at(&path))
}

fn answered(
    question: &ModesQuestion,
    mut source: Source,
    frequencies: &Frequencies,
) -> Result<ModesAnswer, Trouble> {
    let (grid, times) = (source.stored.grid, source.stored.times.clone());
    let names = FrequencyNames::new(frequencies.excitation, frequencies.rotor, N_BLADES);
    let n_instants = times.len();
    let span = [times[0], times[n_instants - 1]];
    let interval = (span[1] - span[0]) / (n_instants - 1).max(1) as f64;
    let PodSettings { components, n_modes, memory } = PodSettings {
        components: question.components,
        n_modes: question.n_modes,
        memory: question.memory,
    };
    let n_block = question
        .n_block
        .unwrap_or_else(|| usual_block(n_instants, interval, frequencies.excitation));
    let highest = 0.5 / interval;
    let mut settings = SpodSettings {
        components,
        n_block,
        overlap: question.overlap,
        window: Window::Hamming,
        n_modes,
        frequencies: Vec::new(),
        memory,
    };
    let spectrum = spod(&mut source, &settings)?;
    settings.frequencies = shown(&spectrum, &names, highest);
    let spod = spod(&mut source, &settings)?;
    let pod = pod(&mut source, &PodSettings { components, n_modes, memory })?;
    let line = |(coefficients, energy): (&Vec<f64>, &f64)| {
        let line = strongest(coefficients, interval).ok()?;
        // Of fewer periods the fit of a sine tells little.
        let is_told = line.frequency * (span[1] - span[0]) >= FEWEST_OF_LINE;
        is_told.then_some([line.frequency, (0.5 * line.amplitude.powi(2) / energy).min(1.0)])
    };
    let pod_lines = pod.coefficients.iter().zip(&pod.energies).map(line).collect();
    Ok(ModesAnswer {
        path: source.stored.path().to_owned(),
        conditions: source.conditions(frequencies),
        diameter: source.stored.about.rotor_diameter,
        memory: strip_bytes(&grid, n_instants, memory),
        components,
        grid,
        n_instants,
        span,
        names,
        pod,
        pod_lines,
        spod,
    })
}

/// Instants of a block where none is asked for: so that the multiples of `excitation` (Hz) are frequencies
/// of the blocks, in about a third of `n_instants` that are `interval` (s) apart.
fn usual_block(n_instants: usize, interval: f64, excitation: Option<f64>) -> usize {
    let most = n_instants as f64 / BLOCK_SHARE;
    let periods = excitation.map_or(0.0, |frequency| (most * interval * frequency).floor());
    let block = match excitation {
        Some(frequency) if periods >= FEWEST_PERIODS => periods / (frequency * interval),
        _ => most,
    };
    (block.round() as usize).clamp(4, n_instants.max(4))
}

/// Frequencies whose modes are shown (Hz): those with a name that the blocks resolve, and the strongest ones.
fn shown(spectrum: &Spod, names: &FrequencyNames, highest: f64) -> Vec<f64> {
    let step = spectrum.frequency_step;
    let named = names.all.iter().map(|one| one.frequency);
    let mut shown: Vec<f64> = named.filter(|f| *f >= 0.5 * step && *f <= highest).collect();
    let mut order: Vec<usize> = (1..spectrum.densities.len()).collect();
    order.sort_by(|a, b| spectrum.density(*b).total_cmp(&spectrum.density(*a)));
    shown.extend(order.into_iter().take(N_STRONGEST).map(|index| spectrum.frequency(index)));
    let last = (spectrum.densities.len() - 1) as f64 * step;
    shown.into_iter().map(|frequency| frequency.min(last)).collect()
}

#[cfg(test)]
mod tests;
