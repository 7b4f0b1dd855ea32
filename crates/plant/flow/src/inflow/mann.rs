//! Mann's turbulence: a box drawn from the spectral tensor by Fourier synthesis.

pub(super) mod passes;

use super::noise::Noise;
use super::{InflowError, SpectralTensor, TurbulenceBox, not_negative};
use basis::{Matrix3, Vector3};
use rustfft::num_complex::{Complex32, Complex64};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::ops::ControlFlow;

/// What to make.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MannSettings {
    /// Points along x, y, z (–), at least 2 each; x even. Products of 2, 3 and 5 are fastest.
    pub n_points: [usize; 3],
    /// Distance of neighbouring points along x, y, z (m).
    pub spacing: [f64; 3],
    /// Length scale L of the tensor (m); 33.6 m above 60 m height after IEC 61400-1.
    pub length_scale: f64,
    /// Anisotropy Γ (–); 3.9 after IEC 61400-1, 0 is isotropic.
    pub anisotropy: f64,
    /// Standard deviation of the streamwise component over the whole box (m/s).
    pub standard_deviation: f64,
    /// Seed.
    pub seed: u64,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
}

impl MannSettings {
    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    fn check(&self) -> Result<(), InflowError> {
        super::check_grid(self.n_points, self.spacing)?;
        not_negative("standard deviation (m/s)", self.standard_deviation)
    }
}

/// Bytes that [`generate`] holds at its peak: three half-spectra and one component.
pub fn peak_memory([n_x, n_y, n_z]: [usize; 3]) -> u64 {
    let plane = n_y as u64 * n_z as u64;
    plane * (3 * 8 * (n_x as u64 / 2 + 1) + 4 * n_x as u64)
}

/// Points along x for which [`peak_memory`] stays within `memory` (bytes).
pub(crate) fn points_along_x(memory: u64, n_y: usize, n_z: usize) -> usize {
    let planes = memory / (n_y as u64 * n_z as u64).max(1);
    (planes.saturating_sub(24) / 16) as usize
}

/// Draws a box; `progress` receives the share done, 0 to 1, on the calling thread.
///
/// u(x) = Σ exp(i k·x) Z(k) over the box's wave numbers, E ZZ* = ∫ Φ dk over the cell of wave numbers around
/// k, projected normal to k: the field is free of divergence, wave by wave. Cells are integrated by midpoints
/// where Φ changes within them, which is at k below a few cells; elsewhere Φ times the cell's volume is exact
/// enough. Left out: the mean, k = 0; waves at the Nyquist numbers, whose sense is ambiguous; and u of waves
/// that are uniform across the box, which continuity forbids. The last are long gusts: of a box 19 L wide and
/// high and 154 L long at Γ = 3.9 they hold 15 % of the tensor's streamwise variance, of one 36 L × 27 L
/// across 9 %. αε^(2/3) is then set so that the streamwise standard deviation over the box is the target,
/// with which spectra lie higher by that share; all components are scaled alike.
/// Source: [Mann1998, eqs. 35-39, 46], with the projection added.
///
/// # Errors
/// [`InflowError`] for settings out of range, or a box that memory cannot hold.
pub fn generate(
    settings: &MannSettings,
    progress: impl Fn(f64),
) -> Result<TurbulenceBox, InflowError> {
    generate_until(settings, |share| {
        progress(share);
        ControlFlow::Continue(())
    })
}

/// As [`generate`]; a break of `progress`, which is asked many times a second, ends it.
///
/// # Errors
/// Those of [`generate`], and [`InflowError::BrokenOff`] after a break.
pub fn generate_until(
    settings: &MannSettings,
    progress: impl Fn(f64) -> ControlFlow<()>,
) -> Result<TurbulenceBox, InflowError> {
    settings.check()?;
    let tensor = SpectralTensor::new(settings.length_scale, settings.anisotropy)?;
    let [n_x, n_y, n_z] = settings.n_points;
    let waves = Waves { settings, tensor };
    let out_of_memory = |_| InflowError::Memory {
        n_points: settings.n_points,
        memory: peak_memory(settings.n_points),
    };
    let n_waves = (n_x / 2 + 1) * n_y * n_z;
    let mut spectra: [Vec<Complex32>; 3] = Default::default();
    for spectrum in &mut spectra {
        spectrum.try_reserve_exact(n_waves).map_err(out_of_memory)?;
        spectrum.resize(n_waves, Complex32::default());
    }
    let n_threads = settings
        .threads
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
        .clamp(1, 64);
    let fill = |x: usize, planes: [&mut [Complex32]; 3]| waves.fill(x, planes);
    let across = |share: f64| progress(0.8 * share);
    if passes::across(&mut spectra, n_y, n_z, n_threads, &fill, &across).is_break() {
        return Err(InflowError::BrokenOff);
    }
    let mut velocity: [Vec<f32>; 3] = Default::default();
    for (component, spectrum) in spectra.into_iter().enumerate() {
        let values = &mut velocity[component];
        values.try_reserve_exact(n_x * n_y * n_z).map_err(out_of_memory)?;
        values.resize(n_x * n_y * n_z, 0.0);
        let share = |done: f64| progress(0.8 + 0.2 * (component as f64 + done) / 3.0);
        let along = passes::along(spectrum, values, n_x, n_y * n_z, n_threads, &share);
        if along.is_break() || share(1.0).is_break() {
            return Err(InflowError::BrokenOff);
        }
    }
    let mut turbulence = TurbulenceBox::new(settings.n_points, settings.spacing, velocity)?;
    let [realised, ..] = turbulence.standard_deviations();
    if realised > 0.0 {
        turbulence.scale(settings.standard_deviation / realised);
    }
    Ok(turbulence)
}

/// Amplitudes of the box's waves.
struct Waves<'a> {
    settings: &'a MannSettings,
    tensor: SpectralTensor,
}

impl Waves<'_> {
    /// Signed wave index of transform index `index` of `n`; none at the Nyquist number.
    fn signed(index: usize, n: usize) -> Option<i64> {
        match (2 * index).cmp(&n) {
            std::cmp::Ordering::Less => Some(index as i64),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(index as i64 - n as i64),
        }
    }

    /// On return `planes` hold the amplitudes of the three components at streamwise index `x`, each n_z ×
    /// n_y.
    fn fill(&self, x: usize, planes: [&mut [Complex32]; 3]) {
        let [n_x, n_y, n_z] = self.settings.n_points;
        let Some(m1) = Self::signed(x, n_x) else { return };
        let mut noise = Noise::new(self.settings.seed);
        for z in 0..n_z {
            let Some(m3) = Self::signed(z, n_z) else { continue };
            // A real field: half of the waves at k₁ = 0 are the conjugates of the others.
            if m1 == 0 && m3 < 0 {
                continue;
            }
            let pencil = noise.pencil(m1, m3, n_y / 2);
            for y in 0..n_y {
                let Some(m2) = Self::signed(y, n_y) else { continue };
                if m1 == 0 && m3 == 0 && m2 <= 0 {
                    continue;
                }
                let amplitude = self.amplitude([m1, m2, m3], pencil.at(m2));
                for (plane, value) in [0, 1, 2].into_iter().zip(amplitude) {
                    planes[plane][z * n_y + y] = value;
                    if m1 == 0 {
                        planes[plane][(n_z - z) % n_z * n_y + (n_y - y) % n_y] = value.conj();
                    }
                }
            }
        }
    }

    /// Amplitudes u, v, w (for αε^(2/3) = 1) of wave `index` from two complex normal `numbers`.
    fn amplitude(&self, index: [i64; 3], numbers: [Complex64; 2]) -> [Complex32; 3] {
        let cell = Vector3::from_array(std::array::from_fn(|axis| {
            TAU / (self.settings.n_points[axis] as f64 * self.settings.spacing[axis])
        }));
        let k = cell * Vector3::from_array(index.map(|index| index as f64));
        let energy = self.cell_integral(k, cell);
        // A basis normal to k, then the square root of the 2 × 2 tensor in it, after Cholesky.
        let horizontal = k.x.hypot(k.y);
        let (first, second) = if horizontal > 0.0 {
            let first = Vector3::new(-k.y, k.x, 0.0) / horizontal;
            (first, k.normalize().cross(first))
        } else {
            (Vector3::X, Vector3::Y)
        };
        let (along_first, along_second) = (energy * first, energy * second);
        let (a, b, c) = (along_first.dot(first), along_first.dot(second), along_second.dot(second));
        let root = a.max(0.0).sqrt();
        let lower = if root > 0.0 { b / root } else { 0.0 };
        let rest = (c - lower * lower).max(0.0).sqrt();
        let one = numbers[0] * root;
        let two = numbers[0] * lower + numbers[1] * rest;
        [0, 1, 2].map(|axis| {
            let value = one * first[axis] + two * second[axis];
            Complex32::new(value.re as f32, value.im as f32)
        })
    }

    /// ∫ Φ over the cell of wave numbers of edges `cell` around `k` (rad/m), by midpoints.
    fn cell_integral(&self, k: Vector3, cell: Vector3) -> Matrix3 {
        // The tensor changes over a quarter of k, and faster below 1/L, where shear has turned eddies most.
        let size = k.length();
        let scale = 0.25 * size * (size * self.tensor.length_scale()).min(1.0);
        let points = |cell: f64| (cell / scale).ceil().clamp(1.0, 6.0) as usize;
        let n = [points(cell.x), points(cell.y), points(cell.z)];
        if n == [1, 1, 1] {
            return self.tensor.density(k) * (cell.x * cell.y * cell.z);
        }
        let place = |index: usize, n: usize| (index as f64 + 0.5) / n as f64 - 0.5;
        let mut sum = Matrix3::ZERO;
        for i in 0..n[0] {
            for j in 0..n[1] {
                for l in 0..n[2] {
                    let offset = Vector3::new(place(i, n[0]), place(j, n[1]), place(l, n[2]));
                    sum += self.tensor.density(k + cell * offset);
                }
            }
        }
        sum * (cell.x * cell.y * cell.z / (n[0] * n[1] * n[2]) as f64)
    }
}

#[cfg(test)]
#[path = "mann_tests.rs"]
mod tests;
