//! Proper orthogonal decomposition by the method of snapshots.

use super::eigen::eigen;
use super::gram::add_products;
use super::strip::{Coverage, Strip, blank, each_strip};
use super::{ModesError, Snapshots};
use realfft::num_complex::Complex64;

/// Fewest instants that have modes (–).
const FEWEST: usize = 2;
/// Share of the greatest energy below which a mode is rounding (–).
const ROUNDING: f64 = 1e-13;

/// What is decomposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PodSettings {
    /// Which of u, v, w count.
    pub components: [bool; 3],
    /// Modes that are kept (–).
    pub n_modes: usize,
    /// Memory of a strip (bytes).
    pub memory: u64,
}

/// Modes by energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Pod {
    /// Energy of each mode, greatest first (m²/s²): mean over area and time of its share of |u'|², twice a
    /// kinetic energy.
    pub energies: Vec<f64>,
    /// Energy in all (m²/s²).
    pub total: f64,
    /// Of the modes that are kept: coefficient at each instant (m/s), whose mean square is the energy.
    pub coefficients: Vec<Vec<f64>>,
    /// The modes that are kept, u, v, w in the order of the grid (–): mean over the area of the square is 1;
    /// not a number at holes and in components that do not count.
    pub modes: Vec<[Vec<f32>; 3]>,
    /// Mean velocity (m/s), likewise.
    pub mean: [Vec<f32>; 3],
    /// Points that have a hole at any instant, and are left out (–).
    pub n_masked: usize,
}

/// Modes by energy of `snapshots`: eigenvectors of the correlation of instants, each point weighted by its
/// area.
///
/// It reads all twice, and holds a strip, the square of the number of instants, and the modes that are kept.
///
/// # Errors
/// [`ModesError::TooFew`], [`ModesError::NoComponent`], [`ModesError::NoPoint`], and what reading gives.
pub fn pod<S: Snapshots>(snapshots: &mut S, settings: &PodSettings) -> Result<Pod, S::Error> {
    let (n_instants, n_points) = (snapshots.times().len(), snapshots.grid().len());
    if n_instants < FEWEST {
        return Err(ModesError::TooFew { n_instants, needed: FEWEST }.into());
    }
    if !settings.components.contains(&true) {
        return Err(ModesError::NoComponent.into());
    }
    let mut correlation = vec![0.0; n_instants * n_instants];
    let mut coverage = Coverage::default();
    let mut mean = blank(n_points, f32::NAN);
    each_strip(snapshots, settings.components, settings.memory, |strip| {
        coverage.add(strip);
        for (all, part) in mean.iter_mut().zip(&strip.mean) {
            all[strip.points.clone()].copy_from_slice(part);
        }
        for (_, values) in &strip.components {
            add_products(values, strip.points.len(), &mut correlation);
        }
        Ok(())
    })?;
    coverage.check(n_points)?;
    let scale = 1.0 / (coverage.weight * n_instants as f64);
    let (energies, vectors) = decomposed(&correlation, n_instants, scale)?;
    let total = (0..n_instants).map(|i| scale * correlation[i * n_instants + i]).sum();
    let least = ROUNDING * energies[0].max(0.0);
    let n_modes = energies.iter().take(settings.n_modes).take_while(|e| **e > least).count();
    let coefficients: Vec<Vec<f64>> = (0..n_modes)
        .map(|mode| {
            let size = (n_instants as f64 * energies[mode]).sqrt();
            vectors[mode].iter().map(|entry| size * entry).collect()
        })
        .collect();
    let mut modes = vec![blank(n_points, f32::NAN); n_modes];
    each_strip(snapshots, settings.components, settings.memory, |strip| {
        for ((mode, coefficients), energy) in modes.iter_mut().zip(&coefficients).zip(&energies) {
            project(strip, coefficients, n_instants as f64 * energy, mode);
        }
        Ok(())
    })?;
    let n_masked = coverage.n_masked;
    Ok(Pod { energies, total, coefficients, modes, mean, n_masked })
}

/// Eigenvalues of `correlation`, `n` × `n`, times `scale`, greatest first, with their vectors, whose
/// greatest entry is positive.
fn decomposed(
    correlation: &[f64],
    n: usize,
    scale: f64,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), ModesError> {
    let matrix: Vec<Complex64> = correlation.iter().map(|value| Complex64::from(*value)).collect();
    let found = eigen(&matrix, n)?;
    let energies = found.values.iter().map(|value| scale * value).collect();
    let upright = |vector: &Vec<Complex64>| {
        let largest = vector.iter().map(|entry| entry.re);
        let largest = largest.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
        vector.iter().map(|entry| largest.signum() * entry.re).collect()
    };
    Ok((energies, found.vectors.iter().map(upright).collect()))
}

/// On return `mode` holds, at the points of `strip`, the mean of its fluctuations times `coefficients`, over
/// `square` instead of the number of instants.
fn project(strip: &Strip, coefficients: &[f64], square: f64, mode: &mut [Vec<f32>; 3]) {
    for (component, values) in &strip.components {
        let n_strip = strip.points.len();
        let mut sums = vec![0.0; n_strip];
        for (instant, a) in values.chunks_exact(n_strip.max(1)).zip(coefficients) {
            for (sum, value) in sums.iter_mut().zip(instant) {
                *sum += a * value;
            }
        }
        let out = &mut mode[*component][strip.points.clone()];
        for ((out, sum), root) in out.iter_mut().zip(&sums).zip(&strip.roots) {
            if *root > 0.0 {
                *out = (sum / (square * root)) as f32;
            }
        }
    }
}
