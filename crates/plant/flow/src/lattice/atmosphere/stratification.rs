//! Temperature and what comes with it in the machine's memory, beside the populations of the air.

use super::coefficients::{Coefficients, Level, levels};
use super::heat::{self, DIRECTIONS, N_HEAT};
use super::law::Law;
use super::settings::{Atmosphere, Perturbation, Reference};
use super::surface::{Surface, SurfaceMemory};
use super::sweep::StepHeat;
use crate::lattice::layout::{Edge, LINE, Layout, Parity};
use crate::lattice::memory::Memory;
use crate::lattice::probe::RowState;
use crate::lattice::scaling::Scaling;
use crate::lattice::settings::LatticeSettings;
use crate::lattice::simd::{Portable, Simd};
use crate::lattice::values::{read_values, write_values};
use std::io::{Read, Result, Write};
use std::ops::Range;

/// The state of an atmosphere that is not in the populations of the air.
pub(crate) struct Stratification {
    pub(crate) memory: Memory,
    pub(crate) layout: Layout,
    coefficients: Coefficients,
    pub(crate) levels: Vec<Level>,
    pub(crate) surface: Option<Surface>,
    reference: Reference,
    perturbation: Option<Perturbation>,
    reference_temperature: f64,
    spacing: f64,
    /// Sum of the temperatures of every row in the last step.
    sums: Vec<f32>,
}

/// What one thread owns of it.
pub(crate) struct HeatShare {
    pub(crate) surface: SurfaceMemory,
    /// Sum of the temperatures of each row of the last step (K above the reference).
    pub(crate) sums: Vec<f32>,
    /// Temperature of a row, padded to whole vectors.
    pub(crate) temperature: Vec<f32>,
    /// No heat from the ground, padded likewise.
    pub(crate) none: Vec<f32>,
}

impl HeatShare {
    /// What a thread owns with the rows `rows`.
    pub(crate) fn new(layout: &Layout, rows: &Range<usize>) -> Self {
        let n_y = layout.n_cells[1];
        let n_at_ground = rows.end.min(n_y) - rows.start.min(n_y);
        let padded = layout.n_cells[0].next_multiple_of(LINE);
        Self {
            surface: SurfaceMemory::new(n_at_ground * layout.row_stride),
            sums: vec![0.0; rows.len()],
            temperature: vec![0.0; padded],
            none: vec![0.0; padded],
        }
    }
}

impl Stratification {
    /// That of `atmosphere` in the box of `settings`, with `sides` beyond y and `beyond` below and above;
    /// none when the system refuses the memory.
    pub(crate) fn new(
        atmosphere: &Atmosphere,
        settings: &LatticeSettings,
        scaling: &Scaling,
        sides: Edge,
        beyond: [Edge; 2],
    ) -> Option<Self> {
        let layout = Layout::new(settings.n_cells, &DIRECTIONS, sides, beyond);
        Some(Self {
            memory: Memory::zeroed(layout.n_values())?,
            coefficients: Coefficients::new(atmosphere, settings, scaling),
            levels: levels(atmosphere, settings, scaling),
            surface: Surface::new(atmosphere, settings, scaling),
            reference: atmosphere.reference,
            perturbation: atmosphere.perturbation,
            reference_temperature: atmosphere.reference_temperature,
            spacing: settings.spacing,
            sums: vec![0.0; layout.n_rows()],
            layout,
        })
    }

    /// What a step shares.
    pub(crate) fn step(&self) -> StepHeat<'_> {
        StepHeat {
            heat: self.memory.start(),
            layout: &self.layout,
            coefficients: &self.coefficients,
            levels: &self.levels,
        }
    }

    /// What acts on the cells of level `z`, under Smagorinsky's factor `subgrid`.
    pub(crate) fn law<S: Simd>(&self, z: usize, subgrid: f32) -> Law<S> {
        Law::new(&self.coefficients, self.levels[z], subgrid)
    }

    /// Gives row number `row` its first temperatures, `given` (K) or those of its height, in air that moves
    /// as `state` says, before the first step.
    pub(crate) fn fill(&self, row: usize, state: &RowState, given: Option<&[f64]>) {
        let [y, z] = self.layout.place(row);
        let addresses: [usize; N_HEAT] = self.layout.addresses(Parity::Even, y, z);
        let height = (z as f64 + 0.5) * self.spacing;
        let [u, v, w] = &state.velocity;
        for x in 0..self.layout.n_cells[0] {
            let velocity = [u[x], v[x], w[x]].map(Portable::splat);
            let mut departure = match given {
                Some(given) => (given[x] - self.reference_temperature) as f32,
                None => self.levels[z].target,
            };
            if let Some(Perturbation { below, amplitude, seed }) = self.perturbation
                && height < below
            {
                let cell = (row * self.layout.n_cells[0] + x) as u64;
                departure += amplitude as f32 * noise(seed, cell);
            }
            let temperature = Portable::splat(departure);
            let g = heat::equilibrium(temperature, velocity);
            for (address, value) in addresses.iter().zip(g) {
                let mut lanes = [0.0; Portable::LANES];
                // SAFETY: as many values as lanes; then a cell of this thread's rows.
                unsafe {
                    value.store(lanes.as_mut_ptr());
                    *self.memory.start().add(address + x) = lanes[0];
                }
            }
        }
    }

    /// On return `temperature` holds that of row number `row` (K above the reference) before a step of
    /// `parity`.
    pub(crate) fn read(&self, parity: Parity, row: usize, temperature: &mut [f32]) {
        let [y, z] = self.layout.place(row);
        let addresses: [usize; N_HEAT] = self.layout.addresses(parity, y, z);
        let n = self.layout.n_cells[0];
        temperature[..n].fill(0.0);
        for address in addresses {
            // SAFETY: a row of the array; no sweep is running.
            let values = unsafe {
                std::slice::from_raw_parts(self.memory.start().add(address).cast_const(), n)
            };
            for (sum, value) in temperature.iter_mut().zip(values) {
                *sum += value;
            }
        }
    }

    /// Takes in the sums of the rows from number `first` on.
    pub(crate) fn gather(&mut self, first: usize, sums: &[f32]) {
        self.sums[first..first + sums.len()].copy_from_slice(sums);
    }

    /// Levels follow their means, once all sums are in, where buoyancy refers to them.
    pub(crate) fn follow(&mut self) {
        if self.reference == Reference::Start {
            return;
        }
        let [n_x, n_y, _] = self.layout.n_cells;
        let share = 1.0 / (n_x * n_y) as f64;
        for (level, sums) in self.levels.iter_mut().zip(self.sums.chunks(n_y)) {
            let sum: f64 = sums.iter().copied().map(f64::from).sum();
            level.mean = (sum * share) as f32;
        }
    }

    /// Writes all that time has changed but what the ground remembers.
    pub(crate) fn write(&self, writer: &mut dyn Write, bytes: &mut Vec<u8>) -> Result<()> {
        let means: Vec<f32> = self.levels.iter().map(|level| level.mean).collect();
        write_values(writer, bytes, &means)?;
        write_values(writer, bytes, self.memory.values())
    }

    /// Goes on from what [`write`](Self::write) wrote.
    pub(crate) fn read_state(&mut self, reader: &mut dyn Read, bytes: &mut Vec<u8>) -> Result<()> {
        let mut means = vec![0.0; self.levels.len()];
        read_values(reader, bytes, &mut means)?;
        for (level, mean) in self.levels.iter_mut().zip(means) {
            level.mean = mean;
        }
        read_values(reader, bytes, self.memory.values_mut())
    }

    /// Memory that it holds (bytes).
    pub(crate) fn bytes(&self) -> usize {
        let [_, n_y, _] = self.layout.n_cells;
        let at_ground = match self.surface {
            Some(_) => 7 * n_y * self.layout.row_stride,
            None => 0,
        };
        self.memory.bytes() + size_of::<f32>() * (at_ground + self.sums.len())
    }
}

/// A number from −1 to 1 that belongs to `cell` (the finaliser of splitmix64: Steele, Lea, Flood 2014).
fn noise(seed: u64, cell: u64) -> f32 {
    let mut z = (seed << 40 ^ cell).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 40) as f32 / (1_u32 << 23) as f32 - 1.0
}
