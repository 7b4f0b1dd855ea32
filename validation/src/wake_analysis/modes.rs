//! Spectral modes beside those of a script in numpy.

use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::AtMost;
use analysis::modes::{InMemory, SpodSettings, spod};
use serde::Deserialize;

const NUMPY: &str = "validation/scripts/spod_beside_numpy.py (numpy 2.4.6)";
const STORED: &str = include_str!("../../data/wake-analysis/spod.json");

#[derive(Deserialize)]
struct Stored {
    interval: f64,
    block: usize,
    overlap: usize,
    weight: f64,
    places: usize,
    values: Vec<f64>,
    frequencies: Vec<f64>,
    energies: Vec<Vec<f64>>,
    peak: usize,
    mode: Vec<[f64; 2]>,
}

pub(super) fn rows() -> Vec<Row> {
    let stored: Stored = serde_json::from_str(STORED).expect("stored modes");
    let settings = SpodSettings {
        interval: stored.interval,
        n_block: stored.block,
        n_overlap: stored.overlap,
        n_modes: 1,
        at: vec![stored.frequencies[stored.peak]],
    };
    let field = InMemory { n_values: stored.places, values: stored.values };
    let found = spod(&field, stored.weight, &settings).expect("modes of a sound field");
    let greatest = stored.energies[stored.peak][0];
    let energies = found.energies.iter().zip(&stored.energies).flat_map(|(own, other)| {
        own.iter().zip(other).map(|(own, other)| (own - other).abs() / greatest)
    });
    let frequencies = found.frequencies.iter().zip(&stored.frequencies);
    let frequencies = worst(frequencies.map(|(own, other)| (own - other).abs()));
    let row = |what: &str, measured, unit| Row {
        what: format!("spectral modes of two waves in noise, 9 blocks of 64: {what}"),
        measured,
        expected: 1e-6,
        tolerance: AtMost,
        unit,
        source: NUMPY,
    };
    vec![
        row("frequencies apart", frequencies, "Hz"),
        row("energies apart, over the greatest", worst(energies), "–"),
        row(
            "first mode at the peak: what is left beside the other one",
            apart(&found.modes[0].values, &stored),
            "–",
        ),
    ]
}

/// Size of what two modes differ by, but for a phase (–).
fn apart(own: &[[f64; 2]], stored: &Stored) -> f64 {
    let product = own.iter().zip(&stored.mode).fold([0.0, 0.0], |sum, ([a, b], [c, d])| {
        // The conjugate of one times the other.
        [sum[0] + stored.weight * (a * c + b * d), sum[1] + stored.weight * (a * d - b * c)]
    });
    (2.0 * (1.0 - product[0].hypot(product[1])).abs()).sqrt()
}
