//! Subspace identification of systems that are known: poles, order, and what a model accounts for.

use crate::Row;
use crate::folds::worst;
use crate::random::Random;
use crate::row::Tolerance::{AtLeast, AtMost, Within};
use faer::Mat;
use identification::delay::by_correlation;
use identification::fit::{simulated, variance_accounted_for};
use identification::pbsid::{Regularisation, Settings, Subspace};
use identification::{Channel, Record, Trend};
use lti::Complex64;
use lti::matrices::StateSpace;
use serde::Deserialize;
use std::f64::consts::TAU;

const KNOWN: &str = "the system that was simulated";
const NUMPY: &str = "N4SID with weights of CVA on the same record, in numpy 2.4.6";
/// What `validation/scripts/pbsid_beside_numpy.py --simulated` found in the records of this validation.
const BY_NUMPY: &str = include_str!("../data/identification/numpy_poles.json");
/// Samples of a record (–).
const N_SAMPLES: usize = 6000;
const WINDOW: usize = 30;
/// Samples by which the outputs come late (–).
const DELAY: usize = 3;

#[derive(Deserialize)]
struct ByNumpy {
    records: Vec<Found>,
}

/// What another program found in a record.
#[derive(Deserialize)]
struct Found {
    order: usize,
    noise: f64,
    /// Outputs at the last sample, means taken off: its record is this one.
    last: [f64; 2],
    /// Real and imaginary parts.
    poles: Vec<[f64; 2]>,
}

/// Systems of order two to eight, two inputs and two outputs: poles at 20 dB of coloured noise and at 40 dB,
/// orders, variance accounted for on another record, a delay; poles beside those of another subspace method.
///
/// # Panics
/// When a record cannot be identified from, or is not that of the other program.
pub fn identification() -> Vec<Row> {
    let ByNumpy { records } = serde_json::from_str(BY_NUMPY).expect("stored poles");
    let mut rows: Vec<Row> = records.iter().map(beside_numpy).collect();
    for order in [2, 4, 6, 8] {
        let system = system(order);
        let fresh = record(&system, 0.01, 2 * order as u64 + 1);
        let noisy = subspace(&record(&system, 0.1, 2 * order as u64));
        let model = noisy.model(order).expect("a model").system;
        rows.push(Row {
            what: format!(
                "order {order}, 20 dB of coloured noise: largest error of a pole over its size"
            ),
            measured: pole_error(&poles(order), &model),
            expected: 0.01,
            tolerance: AtMost,
            unit: "–",
            source: KNOWN,
        });
        rows.push(Row {
            what: format!("order {order}, 20 dB of coloured noise: order by the largest gap"),
            measured: noisy.largest_gap(20) as f64,
            expected: order as f64,
            tolerance: Within(0.0),
            unit: "–",
            source: KNOWN,
        });
        let quiet = subspace(&record(&system, 0.01, 2 * order as u64));
        let model = quiet.model(order).expect("a model").system;
        let modelled = simulated(&model, &fresh).expect("the record fits the model");
        let shares = variance_accounted_for(&fresh, &modelled).expect("as many outputs");
        rows.push(Row {
            what: format!("order {order}, 40 dB: least variance accounted for on another record"),
            measured: -worst(shares.into_iter().map(|share| -share)),
            // Noise of 1 % of the deviation leaves 99.99 % at best.
            expected: 99.9,
            tolerance: AtLeast,
            unit: "%",
            source: KNOWN,
        });
    }
    rows.extend(delayed());
    rows
}

/// Poles beside those that numpy `found` in the same record: a tenth of the noise is to leave a tenth of the
/// difference.
fn beside_numpy(found: &Found) -> Row {
    let Found { order, noise, last, poles } = found;
    let record = record(&system(*order), *noise, 2 * *order as u64);
    for (output, last) in record.outputs().iter().zip(last) {
        let own = output.samples.last().copied().unwrap_or(f64::NAN);
        assert!((own - last).abs() < 1e-9, "numpy's record of order {order} is another one");
    }
    let model = subspace(&record).model(*order).expect("a model").system;
    let known: Vec<Complex64> = poles.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
    Row {
        what: format!(
            "order {order}, {:.0} dB of coloured noise: largest distance of a pole from numpy's over its size",
            -20.0 * noise.log10()
        ),
        measured: pole_error(&known, &model),
        expected: 0.1 * noise,
        tolerance: AtMost,
        unit: "–",
        source: NUMPY,
    }
}

/// Poles of order `order`, all within the unit circle and apart from each other.
fn poles(order: usize) -> Vec<Complex64> {
    let pairs = [(0.95, 0.25), (0.9, 0.7), (0.85, 1.3), (0.92, 2.0)];
    pairs[..order / 2]
        .iter()
        .flat_map(|(size, angle)| {
            let pole = Complex64::from_polar(*size, *angle);
            [pole, pole.conj()]
        })
        .collect()
}

/// A system with the [`poles`] of `order`, each pair moved by both inputs and seen in both outputs.
fn system(order: usize) -> StateSpace {
    let poles = poles(order);
    let a = Mat::from_fn(order, order, |row, column| {
        let pole = poles[2 * (row / 2)];
        match (row / 2 == column / 2, row % 2, column % 2) {
            (false, ..) => 0.0,
            (true, 0, 1) => -pole.im,
            (true, 1, 0) => pole.im,
            _ => pole.re,
        }
    });
    let mut random = Random(20_261_124 + order as u64);
    let mut entry = |_, _| random.uniform() + 0.5;
    let b = Mat::from_fn(order, 2, &mut entry);
    let signs =
        |row: usize, column: usize| if (row + column).is_multiple_of(3) { -1.0 } else { 1.0 };
    let c = Mat::from_fn(2, order, |row, column| signs(row, column) * (0.5 + 0.1 * column as f64));
    StateSpace::new(a, b, c, Mat::zeros(2, 2), Some(1.0))
}

/// Two independent numbers of a normal distribution.
fn normal_pair(random: &mut Random) -> [f64; 2] {
    let size = (-2.0 * random.uniform().ln()).sqrt();
    let (sine, cosine) = (TAU * random.uniform()).sin_cos();
    [size * cosine, size * sine]
}

/// A record of `system` under white inputs, its outputs with first-order noise of `share` (–) of their
/// deviation, without means; `pbsid_beside_numpy.py` makes the same.
fn record(system: &StateSpace, share: f64, seed: u64) -> Record {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut recursion = system.recursion();
    let (mut inputs, mut outputs) = (vec![Vec::new(); 2], vec![Vec::new(); 2]);
    for _ in 0..N_SAMPLES {
        let input = normal_pair(&mut random);
        let mut output = [0.0; 2];
        recursion.step(&input, &mut output);
        for channel in 0..2 {
            inputs[channel].push(input[channel]);
            outputs[channel].push(output[channel]);
        }
    }
    for output in &mut outputs {
        let deviation = (output.iter().map(|y| y * y).sum::<f64>() / N_SAMPLES as f64).sqrt();
        let mut noise = 0.0;
        for value in output {
            let [white, _] = normal_pair(&mut random);
            // An autoregression of 0.8 has a deviation of 1/0.6.
            noise = 0.8 * noise + 0.6 * white;
            *value += share * deviation * noise;
        }
    }
    named(inputs, outputs).detrended(Trend::Constant).expect("what moves")
}

fn named(inputs: Vec<Vec<f64>>, outputs: Vec<Vec<f64>>) -> Record {
    let channels = |name: &str, samples: Vec<Vec<f64>>| {
        let numbered = samples.into_iter().enumerate();
        numbered.map(|(index, samples)| Channel::new(format!("{name}{index}"), samples)).collect()
    };
    Record::new(channels("u", inputs), channels("y", outputs), 1.0).expect("a sound record")
}

fn subspace(record: &Record) -> Subspace {
    let settings = Settings {
        past: WINDOW,
        future: WINDOW,
        feedthrough: false,
        regularisation: Regularisation::CrossValidated,
    };
    Subspace::new(record, settings).expect("enough of a record")
}

/// Largest distance of one of the poles `known` from the nearest of `model`, over its size (–).
fn pole_error(known: &[Complex64], model: &StateSpace) -> f64 {
    let found = model.poles().expect("finite matrices");
    worst(known.iter().map(|pole| {
        let distances = found.iter().map(|other| (other - pole).norm() / pole.norm());
        distances.fold(f64::INFINITY, f64::min)
    }))
}

/// Outputs that come late: the first coefficient of the autoregression beyond its noise, and the first
/// prewhitened correlation, which is what `wakemix identify` prints.
fn delayed() -> [Row; 2] {
    let record = record(&system(4), 0.1, 99);
    let late = |channel: &Channel| {
        let mut samples = vec![0.0; DELAY];
        samples.extend(&channel.samples[..channel.samples.len() - DELAY]);
        Channel::new(channel.name.clone(), samples)
    };
    let outputs = record.outputs().iter().map(late).collect();
    let late = Record::new(record.inputs().to_vec(), outputs, 1.0).expect("a sound record");
    let correlation = by_correlation(&late, 0, 0, 60).expect("enough of a record");
    [
        ("autoregression", subspace(&late).delay(0, 0)),
        ("correlation", correlation.samples),
    ]
    .map(|(by, lag)| Row {
        what: format!(
            "order 4, 20 dB, outputs {DELAY} samples late: samples before an input shows, by {by}"
        ),
        measured: lag.map_or(f64::NAN, |lag| lag as f64),
        // A state makes one sample by itself.
        expected: (DELAY + 1) as f64,
        tolerance: Within(0.0),
        unit: "samples",
        source: KNOWN,
    })
}
