//! Known systems with noise, for tests.

use crate::{Channel, Record};
use faer::Mat;
use lti::Complex64;
use lti::matrices::StateSpace;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Independent normal numbers of deviation one. Box and Muller, Ann. Math. Statist. 29, 1958.
pub(crate) fn noise(seed: u64, n_samples: usize) -> Vec<f64> {
    let mut seeded = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || ((seeded.next_u64() >> 11) as f64 + 1.0) / (1_u64 << 53) as f64;
    (0..n_samples)
        .map(|_| {
            let (radius, turn) = ((-2.0 * uniform().ln()).sqrt(), uniform());
            radius * (TAU * turn).cos()
        })
        .collect()
}

/// Noise of deviation one through a first-order lag with this `pole`.
pub(crate) fn coloured_noise(seed: u64, n_samples: usize, pole: f64) -> Vec<f64> {
    let mut value = 0.0;
    let white = noise(seed, n_samples + 200).into_iter();
    let coloured = white.map(|w| {
        value = pole * value + (1.0 - pole * pole).sqrt() * w;
        value
    });
    coloured.skip(200).collect()
}

/// As long as `signal`, later by `samples`, zero before.
pub(crate) fn delayed(signal: &[f64], samples: usize) -> Vec<f64> {
    let kept = signal.len() - samples;
    [vec![0.0; samples], signal[..kept].to_vec()].concat()
}

/// Two inputs, two outputs, every 1 s: oscillators of order two, with poles well apart, that the inputs move
/// and the outputs see in unequal shares. `order` is even; feedthrough of 0.1 on the diagonal.
pub(crate) fn oscillators(order: usize) -> StateSpace {
    let poles: Vec<Complex64> = (0..order / 2)
        .map(|i| Complex64::from_polar(0.95 - 0.02 * i as f64, 0.25 + 0.6 * i as f64))
        .collect();
    let a = Mat::from_fn(order, order, |i, j| {
        let pole = poles[i / 2];
        match (i / 2 == j / 2, i % 2, j % 2) {
            (false, ..) => 0.0,
            (true, 0, 0) | (true, 1, 1) => pole.re,
            (true, 0, _) => pole.im,
            _ => -pole.im,
        }
    });
    let b = Mat::from_fn(order, 2, |i, j| (1.0 + i as f64 + 2.3 * j as f64).sin());
    let c = Mat::from_fn(2, order, |i, j| (0.5 + 1.7 * i as f64 - 0.8 * j as f64).cos());
    let d = Mat::from_fn(2, 2, |i, j| if i == j { 0.1 } else { 0.0 });
    StateSpace::new(a, b, c, d, Some(1.0))
}

/// What a system at rest makes of inputs.
pub(crate) fn response(system: &StateSpace, inputs: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut recursion = system.recursion();
    let mut outputs = vec![Vec::new(); system.outputs()];
    let mut now = vec![0.0; system.outputs()];
    for k in 0..inputs[0].len() {
        let input: Vec<f64> = inputs.iter().map(|channel| channel[k]).collect();
        recursion.step(&input, &mut now);
        outputs.iter_mut().zip(&now).for_each(|(channel, value)| channel.push(*value));
    }
    outputs
}

/// Deviation about zero.
pub(crate) fn level(signal: &[f64]) -> f64 {
    (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt()
}

/// Of plain samples, every 1 s.
pub(crate) fn record(inputs: Vec<Vec<f64>>, outputs: Vec<Vec<f64>>) -> Record {
    let named = |letter: &str, channels: Vec<Vec<f64>>| {
        let channels = channels.into_iter().enumerate();
        channels.map(|(i, samples)| Channel::new(format!("{letter}{i}"), samples)).collect()
    };
    Record::new(named("u", inputs), named("y", outputs), 1.0).expect("a good record")
}

/// Measurement noise added to the outputs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Noise {
    None,
    /// dB of signal over white noise.
    White(f64),
    /// dB of signal over noise through a lag with pole 0.8.
    Coloured(f64),
}

/// White inputs into `system`, with noise on its outputs.
pub(crate) fn experiment(system: &StateSpace, seed: u64, n_samples: usize, noisy: Noise) -> Record {
    let inputs: Vec<Vec<f64>> =
        (0..system.inputs() as u64).map(|i| noise(1000 * seed + i, n_samples)).collect();
    let mut outputs = response(system, &inputs);
    for (i, output) in outputs.iter_mut().enumerate() {
        let seed = 1000 * seed + 500 + i as u64;
        let (decibels, added) = match noisy {
            Noise::None => continue,
            Noise::White(decibels) => (decibels, noise(seed, n_samples)),
            Noise::Coloured(decibels) => (decibels, coloured_noise(seed, n_samples, 0.8)),
        };
        let strength = level(output) * 10.0_f64.powf(-decibels / 20.0);
        output.iter_mut().zip(added).for_each(|(value, noise)| *value += strength * noise);
    }
    record(inputs, outputs)
}
