//! Records: what is refused, trends, filters, parts.

use super::*;
use std::f64::consts::TAU;

fn sine(frequency: f64, n_samples: usize) -> Vec<f64> {
    (0..n_samples).map(|i| (TAU * frequency * i as f64).sin()).collect()
}

fn record(input: Vec<f64>, output: Vec<f64>) -> Record {
    Record::new(vec![Channel::new("u", input)], vec![Channel::new("y", output)], 0.5)
        .expect("a good record")
}

#[test]
fn bad_channels_are_named() {
    let good = Channel::new("tilt", vec![0.0, 1.0, 2.0]);
    let made = |channel: Channel| {
        Record::new(vec![good.clone()], vec![channel], 1.0).expect_err("a bad record").to_string()
    };
    assert!(made(Channel::new("y", vec![0.0, f64::NAN, 2.0])).contains("`y`"));
    assert!(made(Channel::new("y", vec![0.0, f64::NAN, 2.0])).contains("sample 1"));
    assert!(made(Channel::new("y", vec![4.0; 3])).contains("stays at 4"));
    assert!(made(Channel::new("y", vec![4.0; 2])).contains("2 samples where"));
    assert!(Record::new(vec![], vec![good.clone()], 1.0).is_err());
    assert!(Record::new(vec![good.clone()], vec![good.clone()], 0.0).is_err());
    assert!(Record::new(vec![good.clone()], vec![good], f64::NAN).is_err());
}

#[test]
fn trends_go_and_the_rest_stays() {
    let wave = sine(0.05, 200);
    let tilted: Vec<f64> = wave.iter().enumerate().map(|(i, x)| 5.0 + 0.1 * i as f64 + x).collect();
    let both = record(wave.clone(), tilted);
    let flat = both.detrended(Trend::Linear).expect("something left");
    // Whole periods of a sine have a line of their own, which goes from the input as well.
    for (input, output) in flat.inputs[0].samples.iter().zip(&flat.outputs[0].samples) {
        assert!((input - output).abs() < 1e-11);
    }
    let centred = both.detrended(Trend::Constant).expect("something left");
    assert!(centred.outputs[0].samples.iter().sum::<f64>().abs() < 1e-9);
    let line: Vec<f64> = (0..200).map(|i| 2.0 * i as f64).collect();
    let found = record(wave, line).detrended(Trend::Linear);
    assert!(found.is_err_and(|e| matches!(e, IdentificationError::Constant { .. })));
}

/// A first-order high-pass passes a sine at its corner with gain 1/√2, in continuous time.
#[test]
fn the_slow_part_goes() {
    let n_samples = 4000;
    let both = record(sine(0.002, n_samples), sine(0.1, n_samples));
    let corner = TAU * 0.002 / 0.5;
    let fast = both.detrended(Trend::Slow { corner }).expect("something left");
    let power = |x: &[f64]| x[2000..].iter().map(|x| x * x).sum::<f64>() / 2000.0;
    assert!((power(&fast.inputs[0].samples) - 0.25).abs() < 0.01);
    assert!((power(&fast.outputs[0].samples) - 0.5).abs() < 0.02);
    assert!(both.detrended(Trend::Slow { corner: 7.0 }).is_err());
}

#[test]
fn decimation_keeps_what_is_slow_in_its_place_and_stops_the_rest() {
    let n_samples = 2000;
    let both = record(sine(0.01, n_samples), sine(0.23, n_samples));
    let fewer = both.decimated(4).expect("long enough");
    assert_eq!((fewer.interval(), fewer.n_samples()), (2.0, 500));
    let ends = 40..460;
    for i in ends {
        let expected = both.inputs[0].samples[4 * i];
        assert!((fewer.inputs[0].samples[i] - expected).abs() < 1e-3);
        assert!(fewer.outputs[0].samples[i].abs() < 1e-3);
    }
    assert_eq!(both.decimated(1), Ok(both.clone()));
    assert!(both.decimated(0).is_err() && both.decimated(500).is_err());
}

#[test]
fn parts_and_delays() {
    let delayed: Vec<f64> = [vec![0.0; 7], sine(0.05, 93)].concat();
    let both = record(sine(0.05, 100), delayed);
    let (first, rest) = both.split(0.6).expect("enough of both");
    assert_eq!((first.n_samples(), rest.n_samples()), (60, 40));
    assert_eq!(rest.outputs[0].samples[0], both.outputs[0].samples[60]);
    assert!(both.split(0.0).is_err() && both.split(1.2).is_err());
    let met = both.outputs_advanced(7).expect("long enough");
    assert_eq!(met.inputs[0].samples, met.outputs[0].samples);
    assert!(both.outputs_advanced(99).is_err());
    let (unit, deviations) = both.to_unit_deviation();
    assert!((unit.outputs[0].deviation() - 1.0).abs() < 1e-12);
    assert!((deviations[0] - 0.5_f64.sqrt()).abs() < 1e-12);
}
