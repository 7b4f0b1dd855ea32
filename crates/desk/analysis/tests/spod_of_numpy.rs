//! Modes of a small field beside those that `validation/scripts/spod_beside_numpy.py` found by other means.

use analysis::modes::{HeldSnapshots, PodSettings, SpodSettings, Window, area_share, pod, spod};
use basis::records::Grid;
use serde_json::Value;

const NUMPY: &str = include_str!("../../../../validation/data/modes/spod.json");
/// Greatest relative difference of an energy, and of a mode in its direction (–).
const TOLERANCE: f64 = 1e-6;
const N_POINTS: usize = 42;
const N_INSTANTS: usize = 160;
const N_SERIES: usize = 5;

/// Numbers from −0.5 to 0.5.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// The field of the script.
fn field() -> HeldSnapshots {
    let mut numbers = Numbers(20);
    let shapes: Vec<[[f64; 4]; 3]> =
        (0..N_SERIES).map(|_| [0; 3].map(|_| [0; 4].map(|_| numbers.next()))).collect();
    let series: Vec<Vec<f64>> = (0..N_SERIES)
        .map(|_| {
            let mut value = 0.0;
            let mut next = || {
                value = 0.75 * value + numbers.next();
                value
            };
            (0..N_INSTANTS).map(|_| next()).collect()
        })
        .collect();
    let velocity = [0, 1, 2].map(|component: usize| {
        let mut at = |index: usize| {
            let (instant, point) = (index / N_POINTS, index % N_POINTS);
            let (y, z) = ((point % 7) as f64, (point / 7) as f64);
            let mut value = 0.125 * numbers.next();
            for (shape, series) in shapes.iter().zip(&series) {
                let [a, b, c, d] = shape[component];
                value += (((a + b * y) + c * z) + d * y * z) * series[instant];
            }
            value as f32
        };
        (0..N_INSTANTS * N_POINTS).map(&mut at).collect()
    });
    let grid = Grid { origin: [0.0; 3], spacing: [1.0, 2.0, 3.0], n_points: [1, 7, 6] };
    let times = (0..N_INSTANTS).map(|step| 0.5 * step as f64).collect();
    HeldSnapshots { grid, times, velocity }
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// Size of the product of two modes, each a complex number at each point of u, v and w.
fn product(grid: &Grid, one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let area: f64 = (0..N_POINTS).map(|index| area_share(grid, index)).sum();
    let (mut real, mut imaginary) = (0.0, 0.0);
    for (index, (a, b)) in one.iter().zip(other).enumerate() {
        let weight = area_share(grid, index % N_POINTS) / area;
        real += weight * (a[0] * b[0] + a[1] * b[1]);
        imaginary += weight * (a[0] * b[1] - a[1] * b[0]);
    }
    real.hypot(imaginary)
}

#[test]
fn spectral_modes_are_those_of_numpy() {
    let numpy: Value = serde_json::from_str(NUMPY).expect("stored numbers");
    let mut field = field();
    let settings = SpodSettings {
        components: [true; 3],
        n_block: 32,
        overlap: 0.5,
        window: Window::Hamming,
        n_modes: 2,
        frequencies: vec![3.0 / 16.0],
        memory: 40_000,
    };
    let found = spod(&mut field, &settings).expect("a sound field");
    assert_eq!(numpy["n_blocks"].as_u64(), Some(found.n_blocks as u64));
    let expected = numpy["densities"].as_array().expect("a list");
    assert_eq!(expected.len(), found.densities.len());
    for (own, other) in found.densities.iter().zip(expected) {
        let other = numbers(other);
        assert_eq!(own.len(), other.len());
        for (own, other) in own.iter().zip(other) {
            assert!((own / other - 1.0).abs() < TOLERANCE, "{own} {other}");
        }
    }
    assert_eq!(numpy["index"].as_u64(), Some(found.modes[0].index as u64));
    for (mode, other) in found.modes[0].modes.iter().zip(numpy["modes"].as_array().unwrap()) {
        let pair = |value: &Value| <[f64; 2]>::try_from(numbers(value)).expect("a pair");
        let other: Vec<[f64; 2]> = other.as_array().unwrap().iter().map(pair).collect();
        let own: Vec<[f64; 2]> = mode.iter().flatten().map(|v| v.map(f64::from)).collect();
        assert!((product(&field.grid, &own, &other) - 1.0).abs() < TOLERANCE);
    }
}

#[test]
fn modes_by_energy_are_those_of_numpy() {
    let numpy: Value = serde_json::from_str(NUMPY).expect("stored numbers");
    let mut field = field();
    let settings = PodSettings { components: [true; 3], n_modes: 2, memory: 40_000 };
    let found = pod(&mut field, &settings).expect("a sound field");
    let total = numpy["total"].as_f64().expect("a number");
    assert!((found.total / total - 1.0).abs() < TOLERANCE);
    for (own, other) in found.energies.iter().zip(numbers(&numpy["energies"])) {
        assert!((own / other - 1.0).abs() < TOLERANCE, "{own} {other}");
    }
    for (mode, other) in found.modes.iter().zip(numpy["modes_by_energy"].as_array().unwrap()) {
        let own: Vec<[f64; 2]> = mode.iter().flatten().map(|v| [f64::from(*v), 0.0]).collect();
        let other: Vec<[f64; 2]> = numbers(other).into_iter().map(|v| [v, 0.0]).collect();
        assert!((product(&field.grid, &own, &other) - 1.0).abs() < TOLERANCE);
    }
}
