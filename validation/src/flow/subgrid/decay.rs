//! Turbulence that decays behind a grid, as Comte-Bellot and Corrsin (1971) measured it: J. Fluid Mech. 48,
//! 273, mesh of 5.08 cm in wind of 10 m/s, spectra at three places in table 3.
//!
//! A box of eleven meshes moves with the wind. It starts with the spectrum of the first place at random
//! phases, cut off where cells resolve no more; after a turnover of its eddies each shell of wave numbers is
//! given that energy again, with the phases that have come about; then it decays.

use super::super::lattice;
use super::models;
use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::Within;
use basis::Vector3;
use flow::FlowSolver;
use flow::lattice::{Ends, Ground, LatticeSettings, Stencil, Subgrid};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

const SOURCE: &str =
    "measurements of Comte-Bellot and Corrsin (1971), below the cells' wave number";
/// Mesh of the grid (m) and wind through it (m/s).
const MESH: f64 = 0.0508;
const WIND: f64 = 10.0;
/// Times of the three places (meshes over the wind in front of the contraction behind the grid).
const PLACES: [f64; 3] = [42.0, 98.0, 171.0];
/// Edge of the box (m).
const EDGE: f64 = 11.0 * MESH;
/// Root of the mean square of a component at the first place (m/s).
const DEVIATION: f64 = 0.222;
/// The same in cells a step.
const LATTICE_DEVIATION: f64 = 0.03;
/// Time in which phases come about (s): a turnover of the eddies at the first place.
const TURNOVER: f64 = 0.1;

/// Wave number (1/cm) and energy at the three places (cm³/s²), from the least wave number that was measured
/// at all of them.
const SPECTRA: [[f64; 4]; 17] = [
    [0.20, 129.0, 106.0, 92.0],
    [0.25, 230.0, 196.0, 120.0],
    [0.30, 322.0, 195.0, 125.0],
    [0.40, 435.0, 202.0, 98.0],
    [0.50, 457.0, 168.0, 81.5],
    [0.70, 380.0, 127.0, 60.2],
    [1.00, 270.0, 79.2, 39.4],
    [1.50, 168.0, 47.8, 24.1],
    [2.00, 120.0, 34.6, 16.5],
    [2.50, 89.0, 28.6, 12.5],
    [3.00, 70.3, 23.1, 9.12],
    [4.00, 47.0, 14.3, 5.62],
    [6.00, 24.7, 5.95, 1.69],
    [8.00, 12.6, 2.23, 0.52],
    [10.0, 7.42, 0.900, 0.161],
    [12.5, 3.96, 0.363, 0.0520],
    [15.0, 2.33, 0.162, 0.0141],
];

/// Energy density at `wave_number` (1/m) and place number `place` (m³/s²): a power law between two of the
/// table, and beyond them as between the last two.
fn measured(wave_number: f64, place: usize) -> f64 {
    let k = wave_number / 100.0;
    let above = SPECTRA.partition_point(|row| row[0] < k).clamp(1, SPECTRA.len() - 1);
    let [low, high] = [SPECTRA[above - 1], SPECTRA[above]];
    let share = (k / low[0]).ln() / (high[0] / low[0]).ln();
    (low[1 + place].ln() + share * (high[1 + place] / low[1 + place]).ln()).exp() * 1e-6
}

/// Energy at the last place under each model.
pub(super) fn decay() -> Vec<Row> {
    let mut rows = Vec::new();
    for (n, stencil) in [(32, Stencil::D3Q19), (64, Stencil::D3Q19), (64, Stencil::D3Q27)] {
        let none = ("none".to_owned(), Subgrid::none());
        for (name, subgrid) in models().into_iter().chain([none]) {
            let name = format!("decaying turbulence on {n} cells a side, {stencil:?}, {name}");
            let [all, small] = decayed(n, stencil, subgrid, &name);
            if subgrid.constant == 0.0 {
                continue;
            }
            let row = |what: &str, measured, within| Row {
                what: format!("{name}: {what}"),
                measured,
                expected: 1.0,
                tolerance: Within(within),
                unit: "-",
                source: SOURCE,
            };
            rows.push(row("energy 171 mesh times behind the grid over the measured one", all, 0.1));
            let what = "the same of the upper half of the wave numbers";
            rows.push(row(what, small, 0.25));
        }
    }
    rows
}

/// Energy at the last place over that measured there: of the wave numbers of `n` cells from the second on,
/// and of their upper half.
fn decayed(n: usize, stencil: Stencil, subgrid: Subgrid, name: &str) -> [f64; 2] {
    let box_of = Box3 { n };
    let spacing = EDGE / n as f64;
    let interval = LATTICE_DEVIATION * spacing / DEVIATION;
    let air_of = |wind: Vec<Vector3>| {
        let reference = 0.1 * spacing / interval;
        let mut settings =
            LatticeSettings::new(Vector3::ZERO, spacing, [n; 3], interval, reference);
        settings.ends = Ends::Periodic;
        settings.ground = Ground::Periodic;
        settings.stencil = stencil;
        settings.subgrid = subgrid;
        lattice(settings, move |_, x| {
            let [x, y, z] = x.to_array().map(|x| (x / spacing) as usize % n);
            wind[(z * n + y) * n + x]
        })
    };
    let steps = |duration: f64| (duration / interval).round() * interval;
    let target = |shell: usize| measured(box_of.wave_number(shell), 0);
    let mut air = air_of(box_of.field(box_of.noise(), target));
    air.advance(steps(TURNOVER), &[]).expect("flows of a validation stay finite");
    let mut air = air_of(box_of.field(box_of.transform(&air.volume(1).velocity), target));
    let mut shares = [0.0; 2];
    for place in 1..3 {
        let time = (PLACES[place] - PLACES[place - 1]) * MESH / WIND;
        air.advance(steps(time), &[]).expect("flows of a validation stay finite");
        let found = box_of.spectrum(&box_of.transform(&air.volume(1).velocity));
        let share = |from: usize| {
            let expected = (from..n / 2).map(|shell| measured(box_of.wave_number(shell), place));
            found[from..].iter().sum::<f64>() / expected.sum::<f64>()
        };
        // The first shell lies below the wave numbers that were measured at all places.
        shares = [share(2), share(n / 4)];
        let [all, small] = shares;
        tell!("{name}: after {} mesh times {all:.3}, upper half {small:.3}", PLACES[place]);
    }
    shares
}

/// A cube of cells with [`EDGE`].
#[derive(Clone, Copy)]
struct Box3 {
    n: usize,
}

/// Three components of every wave, x fastest.
type Waves = [Vec<Complex<f64>>; 3];

impl Box3 {
    /// Wave number of a shell (1/m).
    fn wave_number(self, shell: usize) -> f64 {
        TAU * shell as f64 / EDGE
    }

    /// The wave at `index`: waves along x, y, z in the box.
    fn wave(self, index: usize) -> [f64; 3] {
        let n = self.n;
        [index % n, index / n % n, index / n / n].map(|i| {
            let i = i as f64;
            if i < 0.5 * n as f64 { i } else { i - n as f64 }
        })
    }

    /// The shell that a wave is in.
    fn shell(self, wave: [f64; 3]) -> usize {
        wave.iter().map(|i| i * i).sum::<f64>().sqrt().round() as usize
    }

    /// Waves of noise.
    fn noise(self) -> Waves {
        let mut random = Random(5);
        let values: [Vec<f32>; 3] = std::array::from_fn(|_| {
            // Twelve uniform numbers less six are as good as normal.
            let normal = |_| (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
            (0..self.n.pow(3)).map(normal).map(|value| value as f32).collect()
        });
        self.transform(&values)
    }

    /// Waves of a field.
    fn transform(self, field: &[Vec<f32>; 3]) -> Waves {
        field.each_ref().map(|column| {
            let mut values: Vec<Complex<f64>> =
                column.iter().map(|value| Complex::new(f64::from(*value), 0.0)).collect();
            self.along_axes(&mut values, false);
            let share = 1.0 / values.len() as f64;
            values.iter().map(|value| value * share).collect()
        })
    }

    /// Transforms along each axis; after three turns of the axes all are where they were.
    fn along_axes(self, values: &mut Vec<Complex<f64>>, back: bool) {
        let n = self.n;
        let mut planner = FftPlanner::new();
        let pass = if back { planner.plan_fft_inverse(n) } else { planner.plan_fft_forward(n) };
        for _ in 0..3 {
            pass.process(values);
            *values = (0..values.len())
                .map(|index| values[index / (n * n) + n * (index % (n * n))])
                .collect();
        }
    }

    /// Energy density of the shells below the cells' own wave number (m³/s²).
    fn spectrum(self, waves: &Waves) -> Vec<f64> {
        let mut energy = vec![0.0; self.n / 2];
        for index in 0..waves[0].len() {
            if let Some(energy) = energy.get_mut(self.shell(self.wave(index))) {
                *energy += 0.5 * waves.iter().map(|column| column[index].norm_sqr()).sum::<f64>();
            }
        }
        let width = self.wave_number(1);
        energy.into_iter().map(|energy| energy / width).collect()
    }

    /// The field of `waves` without divergence whose shells have the energy density `target` (m³/s²), cut off
    /// at the cells' own wave number.
    fn field(self, mut waves: Waves, target: impl Fn(usize) -> f64) -> Vec<Vector3> {
        for index in 0..waves[0].len() {
            let wave = self.wave(index);
            let squared: f64 = wave.iter().map(|i| i * i).sum();
            let along: Complex<f64> =
                wave.iter().zip(&waves).map(|(i, column)| column[index] * *i).sum();
            for (i, column) in wave.iter().zip(&mut waves) {
                column[index] -= along * (i / squared.max(1.0));
            }
        }
        let found = self.spectrum(&waves);
        let shares: Vec<f64> = (0..found.len())
            .map(|shell| if shell == 0 { 0.0 } else { (target(shell) / found[shell]).sqrt() })
            .collect();
        for index in 0..waves[0].len() {
            let share = shares.get(self.shell(self.wave(index))).copied().unwrap_or(0.0);
            waves.iter_mut().for_each(|column| column[index] *= share);
        }
        waves.iter_mut().for_each(|column| self.along_axes(column, true));
        (0..waves[0].len())
            .map(|index| Vector3::from_array(waves.each_ref().map(|column| column[index].re)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_have_the_energy_that_they_are_given_and_no_divergence() {
        let cube = Box3 { n: 16 };
        let target = |shell: usize| 1e-4 / (1.0 + shell as f64);
        let field = cube.field(cube.noise(), target);
        let columns: [Vec<f32>; 3] =
            std::array::from_fn(|axis| field.iter().map(|u| u.to_array()[axis] as f32).collect());
        let waves = cube.transform(&columns);
        let found = cube.spectrum(&waves);
        let mut sum = 0.0;
        for (shell, found) in found.iter().enumerate().take(8).skip(1) {
            assert!((found / target(shell) - 1.0).abs() < 1e-5, "{shell}: {found}");
            sum += target(shell) * cube.wave_number(1);
        }
        let mean = field.iter().map(|u| 0.5 * u.dot(*u)).sum::<f64>() / field.len() as f64;
        assert!((mean / sum - 1.0).abs() < 1e-5, "{mean} and {sum}");
        for index in 0..4096 {
            let wave = cube.wave(index);
            let along: Complex<f64> =
                wave.iter().zip(&waves).map(|(i, column)| column[index] * *i).sum();
            assert!(along.norm() < 1e-7, "{wave:?}: {along}");
        }
    }

    #[test]
    fn the_table_has_the_energy_that_was_measured() {
        // Deviations of a component (m/s) at the three places, isotropic.
        for (place, deviation) in [0.222, 0.128, 0.0895].into_iter().enumerate() {
            let energy: f64 =
                (0..15_000).map(|i| measured(20.0 + 0.1 * f64::from(i), place) * 0.1).sum();
            let share = energy / (1.5 * deviation * deviation);
            assert!((share - 1.0).abs() < 0.08, "{place}: {share}");
        }
    }
}
