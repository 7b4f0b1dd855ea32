//! The modes of one file, with the names of their frequencies.

use super::source::{Source, Trouble};
use analysis::line::strongest;
use analysis::modes::{
    FrequencyNames, Pod, PodSettings, Spod, SpodSettings, Window, pod, spod, strip_bytes,
};
use basis::records::{FieldSetting, Grid};

/// Periods of a helix that the shortest useful block has (–).
const FEWEST_PERIODS: f64 = 1.0;
/// Blocks, which overlap by half, that a record is cut into where no block is asked for (–): so many are
/// left when a block has a third of it.
const BLOCK_SHARE: f64 = 3.0;
/// Periods of a line that has a frequency (–).
const FEWEST_OF_LINE: f64 = 3.0;
/// Blades of a rotor.
const N_BLADES: usize = 3;
/// Frequencies whose modes are kept beside those with a name: the strongest ones (–).
const N_STRONGEST: usize = 1;

/// What is asked of modes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Question {
    /// Which of u, v, w count.
    pub(super) components: [bool; 3],
    /// Instants of a block (–); whole periods of the helix in about a third of the record when absent.
    pub(super) n_block: Option<usize>,
    /// Share of a block that the next one has, too (–).
    pub(super) overlap: f64,
    /// Modes that are kept (–).
    pub(super) n_modes: usize,
    /// Memory of a strip (bytes).
    pub(super) memory: u64,
    /// Excitation frequency (Hz), where it is known.
    pub(super) excitation: Option<f64>,
    /// Rotor frequency (Hz), where it is known.
    pub(super) rotor: Option<f64>,
}

/// The modes of one file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// What the fields were taken of.
    pub(super) setting: FieldSetting,
    /// Conditions in words.
    pub(super) conditions: String,
    /// The points.
    pub(super) grid: Grid,
    /// Instants (–).
    pub(super) n_instants: usize,
    /// First and last (s).
    pub(super) span: [f64; 2],
    /// Which of u, v, w count.
    pub(super) components: [bool; 3],
    /// The frequencies that have names.
    pub(super) names: FrequencyNames,
    /// Modes by energy.
    pub(super) pod: Pod,
    /// Strongest frequency of each coefficient of those that are kept (Hz), with the share of the mode's
    /// energy that its sine has (–); none where there are too few instants, or periods.
    pub(super) pod_lines: Vec<Option<[f64; 2]>>,
    /// Modes by energy at each frequency.
    pub(super) spod: Spod,
    /// Memory of the strips (bytes).
    pub(super) memory: u64,
}

impl Found {
    /// The modes of `source`, of what `setting` tells.
    ///
    /// # Errors
    /// [`Trouble`].
    pub(super) fn of(
        source: &mut Source,
        setting: FieldSetting,
        question: &Question,
    ) -> Result<Self, Trouble> {
        let times = &source.file.times()[source.places.clone()];
        let (grid, n_instants) = (*source.file.grid(), times.len());
        let span = [times[0], times[n_instants - 1]];
        let interval = (span[1] - span[0]) / (n_instants - 1).max(1) as f64;
        let Question { components, n_modes, memory, excitation, rotor, .. } = *question;
        let names = FrequencyNames::new(excitation, rotor, N_BLADES);
        let n_block =
            question.n_block.unwrap_or_else(|| usual_block(n_instants, interval, excitation));
        let step = 1.0 / (n_block as f64 * interval);
        let highest = (n_block / 2) as f64 * step;
        let named = names.all.iter().map(|one| one.frequency);
        let settings = SpodSettings {
            components,
            n_block,
            overlap: question.overlap,
            window: Window::Hamming,
            n_modes,
            frequencies: named.filter(|f| *f >= 0.5 * step && *f <= highest).collect(),
            n_strongest: N_STRONGEST,
            memory,
        };
        let spod = spod(source, &settings)?;
        let pod = pod(source, &PodSettings { components, n_modes, memory })?;
        let line = |(coefficients, energy): (&Vec<f64>, &f64)| {
            let line = strongest(coefficients, interval).ok()?;
            // Of fewer periods the fit of a sine tells little.
            let is_told = line.frequency * (span[1] - span[0]) >= FEWEST_OF_LINE;
            is_told.then_some([line.frequency, (0.5 * line.amplitude.powi(2) / energy).min(1.0)])
        };
        let pod_lines = pod.coefficients.iter().zip(&pod.energies).map(line).collect();
        Ok(Self {
            conditions: conditions(&setting, excitation, rotor),
            setting,
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

    /// Names of frequency number `index` of the spectral modes; none where it has none.
    pub(super) fn name_of(&self, index: usize) -> Option<String> {
        self.names.of(self.spod.frequency(index), 0.5 * self.spod.frequency_step)
    }

    /// Name of the frequency of POD mode `mode`; none where it has none.
    pub(super) fn pod_name(&self, mode: usize) -> Option<String> {
        let [frequency, _] = (*self.pod_lines.get(mode)?)?;
        self.names.of(frequency, 1.0 / (self.span[1] - self.span[0]).max(f64::MIN_POSITIVE))
    }

    /// How many instants and blocks stand behind the numbers, in words.
    pub(super) fn samples(&self) -> String {
        let Self { n_instants, spod, span, .. } = self;
        format!(
            "{n_instants} instants from {:.2} to {:.2} s; {} blocks of {} instants, {} % overlap, Hamming's window",
            span[0],
            span[1],
            spod.n_blocks,
            spod.n_block,
            100 * (spod.n_block - spod.hop) / spod.n_block
        )
    }
}

/// The conditions of `setting` and the frequencies (Hz) in words.
fn conditions(setting: &FieldSetting, excitation: Option<f64>, rotor: Option<f64>) -> String {
    let mut text = crate::wake_fields::conditions(setting);
    if let Some(frequency) = excitation {
        let strouhal = frequency * setting.diameter / setting.wind_speed;
        text += &format!(", f_e {frequency:.4} Hz (St {strouhal:.2})");
    }
    if let Some(frequency) = rotor {
        text += &format!(", f_r {frequency:.4} Hz");
    }
    text
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
