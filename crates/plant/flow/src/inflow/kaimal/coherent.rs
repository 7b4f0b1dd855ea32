//! Waves of u that are coherent across the grid, by Fourier modes of a torus that holds it.

use super::{Kaimal, KaimalSettings, Phases};
use crate::inflow::sizing::smooth_at_least;
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Decay lengths of coherence half-way round the torus (–): what is left there, exp(−7), is where kinks in
/// the periodic coherence, and with them negative eigenvalues, come from.
const DECAY_LENGTHS: f64 = 7.0;
/// Coherence of neighbours (–) below which waves are drawn independently.
const INCOHERENT: f64 = 1e-4;
/// Points that a torus may have (–): 8 MB.
const LARGEST: usize = 1 << 20;

/// Plans for every wave of a box whose u is coherent.
pub(super) struct Coherent {
    n_y: usize,
    spacing: [f64; 2],
    /// Decay of coherence (1/m) of each wave from index 1, with its torus.
    waves: Vec<(f64, Torus)>,
}

/// Points around the torus along y and z with the transforms over them.
#[derive(Clone)]
struct Torus {
    n_y: usize,
    n_z: usize,
    over_y: Arc<dyn Fft<f32>>,
    over_z: Arc<dyn Fft<f32>>,
}

/// Memory that one thread works in.
#[derive(Default)]
pub(super) struct Workspace {
    pub(super) bytes: Vec<u8>,
    roots: Vec<f32>,
    modes: Vec<Complex32>,
    turned: Vec<Complex32>,
    scratch: Vec<Complex32>,
}

impl Coherent {
    pub(super) fn new(settings: &KaimalSettings, model: &Kaimal) -> Self {
        let [n_x, n_y, n_z] = settings.n_points;
        let [_, spacing_y, spacing_z] = settings.spacing;
        let mut planner = FftPlanner::new();
        let mut known: BTreeMap<[usize; 2], Torus> = BTreeMap::new();
        let nearest = spacing_y.min(spacing_z);
        let waves = (1..n_x / 2)
            .map(|wave| model.coherence_decay(settings.frequency(wave)))
            .take_while(|decay| (-decay * nearest).exp() > INCOHERENT)
            .map(|decay| {
                let around = 2.0 * DECAY_LENGTHS / decay;
                let points = |n: usize, spacing: f64| {
                    let needed = (around / spacing).ceil().max(2.0 * (n as f64 - 1.0));
                    smooth_at_least((needed as usize).clamp(2, LARGEST))
                };
                let mut size = [points(n_y, spacing_y), points(n_z, spacing_z)];
                if size[0] * size[1] > LARGEST {
                    let share = (LARGEST as f64 / (size[0] * size[1]) as f64).sqrt();
                    let least = [2 * (n_y - 1), 2 * (n_z - 1)];
                    size = [0, 1].map(|axis| {
                        smooth_at_least(((size[axis] as f64 * share) as usize).max(least[axis]))
                    });
                }
                let torus = known.entry(size).or_insert_with(|| Torus {
                    n_y: size[0],
                    n_z: size[1],
                    over_y: planner.plan_fft_inverse(size[0]),
                    over_z: planner.plan_fft_inverse(size[1]),
                });
                (decay, torus.clone())
            })
            .collect();
        Self { n_y, spacing: [spacing_y, spacing_z], waves }
    }

    /// On return `plane` holds `wave` with `amplitude`, coherent across it; false, and nothing done, for
    /// waves too short to be coherent.
    pub(super) fn fill(
        &self,
        wave: usize,
        amplitude: f32,
        phases: &Phases,
        workspace: &mut Workspace,
        plane: &mut [Complex32],
    ) -> bool {
        let Some((decay, torus)) = self.waves.get(wave - 1) else { return false };
        self.roots(*decay, torus, workspace);
        let Workspace { bytes, roots, modes, turned, scratch } = workspace;
        phases.fill(0, wave, amplitude, bytes, modes);
        for (mode, root) in modes.iter_mut().zip(roots.iter()) {
            *mode *= root;
        }
        torus.transform(modes, turned, self.n_y, scratch);
        // Turned values stand z fastest; the grid is a corner of the torus.
        for (z, row) in plane.chunks_mut(self.n_y).enumerate() {
            for (value, column) in row.iter_mut().zip(turned.chunks(torus.n_z)) {
                *value = column[z];
            }
        }
        true
    }

    /// See [`super::clipped_share`].
    pub(super) fn clipped_share(&self) -> f64 {
        let mut workspace = Workspace::default();
        self.waves
            .iter()
            .map(|(decay, torus)| self.roots(*decay, torus, &mut workspace))
            .fold(0.0, f64::max)
    }

    /// On return `workspace.roots` are the roots of the eigenvalues over their sum, n_z × n_y of the torus,
    /// with the share that was negative and is zero now as result; `modes` has the torus' size.
    fn roots(&self, decay: f64, torus: &Torus, workspace: &mut Workspace) -> f64 {
        let Workspace { roots, modes, turned, scratch, .. } = workspace;
        let size = torus.n_y * torus.n_z;
        modes.clear();
        modes.resize(size, Complex32::default());
        turned.resize(size, Complex32::default());
        roots.resize(size, 0.0);
        // A quarter of the torus is all there is, the rest its mirror images.
        for z in 0..=torus.n_z / 2 {
            for y in 0..=torus.n_y / 2 {
                let distance = (y as f64 * self.spacing[0]).hypot(z as f64 * self.spacing[1]);
                let coherence = Complex32::new((-decay * distance).exp() as f32, 0.0);
                let rows = [z, (torus.n_z - z) % torus.n_z];
                let columns = [y, (torus.n_y - y) % torus.n_y];
                for row in rows {
                    for column in columns {
                        modes[row * torus.n_y + column] = coherence;
                    }
                }
            }
        }
        torus.transform(modes, turned, torus.n_y, scratch);
        let (mut kept, mut clipped) = (0.0_f64, 0.0_f64);
        for value in turned.iter() {
            let value = f64::from(value.re);
            if value > 0.0 { kept += value } else { clipped -= value }
        }
        let scale = (1.0 / kept) as f32;
        for (column, values) in turned.chunks(torus.n_z).enumerate() {
            for (row, value) in values.iter().enumerate() {
                roots[row * torus.n_y + column] = (value.re.max(0.0) * scale).sqrt();
            }
        }
        clipped / kept
    }
}

impl Torus {
    /// On return the first `n_columns` columns of `turned` (z fastest) hold the transform of `values` (y
    /// fastest), which are overwritten.
    fn transform(
        &self,
        values: &mut [Complex32],
        turned: &mut [Complex32],
        n_columns: usize,
        scratch: &mut Vec<Complex32>,
    ) {
        let needed = [&self.over_y, &self.over_z].map(|over| over.get_inplace_scratch_len());
        scratch.resize(needed[0].max(needed[1]), Complex32::default());
        self.over_y.process_with_scratch(values, scratch);
        for (z, row) in values.chunks(self.n_y).enumerate() {
            for (y, value) in row.iter().take(n_columns).enumerate() {
                turned[y * self.n_z + z] = *value;
            }
        }
        self.over_z.process_with_scratch(&mut turned[..n_columns * self.n_z], scratch);
    }
}
