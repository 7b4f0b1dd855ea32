//! Modes beside those that a script in numpy found by other means.

use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance;
use crate::row::Tolerance::{AtMost, Within};
use analysis::modes::{HeldSnapshots, PodSettings, SpodSettings, Window, area_share, pod, spod};
use basis::records::Grid;
use serde::Deserialize;

const NUMPY: &str = "validation/scripts/spod_beside_numpy.py (numpy 2.4.6)";
const STORED: &str = include_str!("../../data/modes/spod.json");
/// The field of the script: points of a plane across the wind, instants, series.
const N_POINTS: [usize; 2] = [7, 6];
const N_INSTANTS: usize = 160;
const N_SERIES: usize = 5;
/// So little memory that the plane is read in strips (bytes).
const MEMORY: u64 = 40_000;

#[derive(Deserialize)]
struct Stored {
    first_values: [f32; 3],
    last_values: [f32; 3],
    energies: Vec<f64>,
    total: f64,
    modes_by_energy: Vec<Vec<f64>>,
    frequency_step: f64,
    n_blocks: usize,
    densities: Vec<Vec<f64>>,
    index: usize,
    modes: Vec<Vec<[f64; 2]>>,
}

/// Numbers from −0.5 to 0.5, as the script draws them.
struct Numbers(crate::random::Random);

impl Numbers {
    fn next(&mut self) -> f64 {
        (self.0.bits() >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// The field of the script.
fn field() -> HeldSnapshots {
    let mut numbers = Numbers(crate::random::Random(20));
    let shapes: Vec<[[f64; 4]; 3]> =
        (0..N_SERIES).map(|_| [0; 3].map(|_| [0; 4].map(|_| numbers.next()))).collect();
    let mut series = [const { [0.0; N_INSTANTS] }; N_SERIES];
    for one in &mut series {
        let mut value = 0.0;
        for instant in one {
            value = 0.75 * value + numbers.next();
            *instant = value;
        }
    }
    let n_points = N_POINTS[0] * N_POINTS[1];
    let velocity = [0, 1, 2].map(|component: usize| {
        let mut at = |index: usize| {
            let (instant, point) = (index / n_points, index % n_points);
            let (y, z) = ((point % N_POINTS[0]) as f64, (point / N_POINTS[0]) as f64);
            let mut value = 0.125 * numbers.next();
            for (shape, series) in shapes.iter().zip(&series) {
                let [a, b, c, d] = shape[component];
                value += (((a + b * y) + c * z) + d * y * z) * series[instant];
            }
            value as f32
        };
        (0..N_INSTANTS * n_points).map(&mut at).collect()
    });
    let [n_y, n_z] = N_POINTS;
    let grid = Grid { origin: [0.0; 3], spacing: [1.0, 2.0, 3.0], n_points: [1, n_y, n_z] };
    let times = (0..N_INSTANTS).map(|step| 0.5 * step as f64).collect();
    HeldSnapshots { grid, times, velocity }
}

pub(super) fn rows() -> Vec<Row> {
    let stored: Stored = serde_json::from_str(STORED).expect("stored modes");
    let mut field = field();
    let grid = field.grid;
    let last = field.velocity[0].len() - 1;
    let ends = [(0, stored.first_values), (last, stored.last_values)];
    let unlike = ends.iter().flat_map(|(index, values)| {
        field.velocity.iter().zip(values).filter(|(own, other)| own[*index] != **other)
    });
    let n_unlike = unlike.count() as f64;
    let settings = SpodSettings {
        components: [true; 3],
        n_block: 32,
        overlap: 0.5,
        window: Window::Hamming,
        n_modes: stored.modes.len(),
        frequencies: vec![stored.index as f64 * stored.frequency_step],
        n_strongest: 0,
        memory: MEMORY,
    };
    let spectral = spod(&mut field, &settings).expect("modes of a sound field");
    let n_modes = stored.modes_by_energy.len();
    let settings = PodSettings { components: [true; 3], n_modes, memory: MEMORY };
    let by_energy = pod(&mut field, &settings).expect("modes of a sound field");
    let apart = |own: &[f64], other: &[f64]| {
        let apart = own.iter().zip(other).map(|(own, other)| (own / other - 1.0).abs());
        if own.len() < other.len() { f64::NAN } else { worst(apart) }
    };
    let densities = spectral.densities.iter().zip(&stored.densities).map(|(a, b)| apart(a, b));
    let modes = spectral.modes[0].modes.iter().zip(&stored.modes).map(|(own, other)| {
        let own: Vec<[f64; 2]> = own.iter().flatten().map(|v| v.map(f64::from)).collect();
        1.0 - product(&grid, &own, other)
    });
    let shapes = by_energy.modes.iter().zip(&stored.modes_by_energy).map(|(own, other)| {
        let own: Vec<[f64; 2]> = own.iter().flatten().map(|v| [f64::from(*v), 0.0]).collect();
        let other: Vec<[f64; 2]> = other.iter().map(|v| [*v, 0.0]).collect();
        1.0 - product(&grid, &own, &other)
    });
    let energies = apart(&by_energy.energies, &stored.energies);
    let total = (by_energy.total / stored.total - 1.0).abs();
    vec![
        row("numbers at both ends of the field that are not the script's", n_unlike, 0.0, AtMost),
        row("blocks", spectral.n_blocks as f64, stored.n_blocks as f64, Within(0.0)),
        row("largest relative difference of a spectral density", worst(densities), 1e-6, AtMost),
        row("spectral modes: largest 1 − |product| with the script's", worst(modes), 1e-6, AtMost),
        row("largest relative difference of an energy", energies, 1e-6, AtMost),
        row("relative difference of the energy in all", total, 1e-6, AtMost),
        row(
            "modes by energy: largest 1 − |product| with the script's",
            worst(shapes),
            1e-6,
            AtMost,
        ),
    ]
}

fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
    Row {
        what: format!("modes of 5 series and noise on 42 points, read in strips: {what}"),
        measured,
        expected,
        tolerance,
        unit: "–",
        source: NUMPY,
    }
}

/// Size of the product of two modes, each a complex number at each point of u, v and w.
fn product(grid: &Grid, one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let n_points = grid.len();
    let area: f64 = (0..n_points).map(|index| area_share(grid, index)).sum();
    let (mut real, mut imaginary) = (0.0, 0.0);
    for (index, (a, b)) in one.iter().zip(other).enumerate() {
        let weight = area_share(grid, index % n_points) / area;
        real += weight * (a[0] * b[0] + a[1] * b[1]);
        imaginary += weight * (a[0] * b[1] - a[1] * b[0]);
    }
    real.hypot(imaginary)
}

#[cfg(test)]
mod tests {
    #[test]
    fn modes_are_those_of_numpy() {
        for row in super::rows() {
            assert!(row.passes(), "{}: {}", row.what, row.measured);
        }
    }
}
