//! A travelling wave with known mean, periodic and random parts.

use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::{AtMost, Within};
use analysis::phases::{Bins, PhaseAverager, decompose};
use basis::Sense;
use basis::records::{Grid, PhaseAverages};
use std::f64::consts::TAU;

const SET: &str = "as the field was made";
const THEORY: &str = "standard error σ/√n";
/// Points along the wave (–).
const N_POINTS: usize = 24;
/// Mean, amplitude, standard deviation of u, and correlation of u and w of the random part (m/s, m/s, m/s,
/// –).
const MEAN: f64 = 4.0;
const AMPLITUDE: f64 = 0.8;
const RANDOM: f64 = 0.25;
const CORRELATION: f64 = -0.6;

fn wave(helix: f64, point: usize) -> f64 {
    AMPLITUDE * (helix + TAU * point as f64 / N_POINTS as f64).cos()
}

/// Averages of the published ccw bins, 204 with windows of 40°, of as many instants as make `n_each` a bin.
fn averages(random: &mut Random, n_each: usize) -> PhaseAverages {
    let bins =
        Bins::of_helix(12, 5.68, 3, Sense::CounterClockwise, Bins::WIDTH).expect("sound bins");
    let grid = Grid { origin: [0.0; 3], spacing: [0.01; 3], n_points: [N_POINTS, 1, 1] };
    let mut averager = PhaseAverager::new(grid, bins);
    let n = (n_each * bins.len()) as f64 / bins.overlap();
    let mut velocity = [const { [0.0_f32; N_POINTS] }; 3];
    for step in 0..n as usize {
        let (rotor, helix) = (TAU * random.uniform(), TAU * random.uniform());
        let [along, _, up] = &mut velocity;
        for (point, (along, up)) in along.iter_mut().zip(up).enumerate() {
            let (first, second) = (random.normal(), random.normal());
            let other = CORRELATION * first + (1.0 - CORRELATION.powi(2)).sqrt() * second;
            *along = (MEAN + wave(helix, point) + RANDOM * first) as f32;
            *up = (0.5 * wave(helix, point) + RANDOM * other) as f32;
        }
        let rows = velocity.each_ref().map(|row| &row[..]);
        averager.add(step as f64, rotor, Some(helix), rows).expect("a sound instant");
    }
    averager.averages()
}

/// Share of the wave's amplitude that a window of 40° keeps (–).
fn kept() -> f64 {
    let half = 0.5 * Bins::WIDTH;
    half.sin() / half
}

/// Root mean square over bins and points of what the mean of u is off (m/s): of what is known of each bin.
fn off(found: &PhaseAverages) -> f64 {
    let mut sum = 0.0;
    for (bin, moments) in found.bins.iter().zip(&found.each) {
        for point in 0..N_POINTS {
            let expected = MEAN + kept() * wave(bin.helix.unwrap_or(0.0), point);
            sum += (f64::from(moments.mean[0][point]) - expected).powi(2);
        }
    }
    (sum / (found.bins.len() * N_POINTS) as f64).sqrt()
}

pub(super) fn rows(random: &mut Random) -> Vec<Row> {
    let found = averages(random, 150);
    let parts = decompose(&found);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / N_POINTS as f64;
    let square = 0.5 * AMPLITUDE.powi(2);
    // What the wave changes across a window counts as random: it is in the bins.
    let within = square * (1.0 - kept().powi(2));
    let conditions = "travelling wave, 204 bins, windows of 40°, 150 samples a bin";
    let row = |what: &str, measured: f64, expected: f64, source| Row {
        what: format!("{conditions}: {what}"),
        measured: 100.0 * (measured / expected - 1.0).abs(),
        expected: 1.0,
        tolerance: AtMost,
        unit: "%",
        source,
    };
    let mut rows = vec![
        row("error of the mean", mean(&parts.mean[0]), MEAN, SET),
        row(
            "error of the periodic amplitude",
            mean(&parts.periodic[0]).sqrt(),
            square.sqrt() * kept(),
            SET,
        ),
        row(
            "error of the random deviation",
            mean(&parts.random[0]).sqrt(),
            (RANDOM.powi(2) + within).sqrt(),
            SET,
        ),
        row(
            "error of the periodic shear stress",
            mean(&parts.periodic[4]),
            0.5 * square * kept().powi(2),
            SET,
        ),
        row(
            "error of the random shear stress",
            mean(&parts.random[4]),
            CORRELATION * RANDOM.powi(2) + 0.5 * within,
            SET,
        ),
    ];
    rows.extend(error_rows(random, &found, (RANDOM.powi(2) + within).sqrt(), conditions));
    rows
}

/// How far bins are off: beside their standard error, of a deviation of `deviation` (m/s), and with fewer
/// samples.
fn error_rows(
    random: &mut Random,
    found: &PhaseAverages,
    deviation: f64,
    conditions: &str,
) -> [Row; 2] {
    let fewer = averages(random, 37);
    [
        Row {
            what: format!("{conditions}: error of a bin over what its samples promise"),
            measured: off(found) / (deviation / 150.0_f64.sqrt()),
            expected: 1.0,
            tolerance: Within(0.05),
            unit: "–",
            source: THEORY,
        },
        Row {
            what: "travelling wave: error of a bin of 37 samples over that of 150".to_owned(),
            measured: off(&fewer) / off(found),
            expected: (150.0_f64 / 37.0).sqrt(),
            tolerance: Within(0.15),
            unit: "–",
            source: THEORY,
        },
    ]
}
