//! A loop around a delay that its controller predicts: margins of what really runs.

use crate::SynthesisError;
use crate::loop_analysis::Loop;
use crate::margins::{ChannelMargins, DiscMargin};
use faer::{Mat, c64};
use lti::Complex64;
use lti::matrices::dense::{complex_eigenvalues, identity, largest_singular_value};
use lti::matrices::{MatrixError, PeakGain, StateSpace};
use std::f64::consts::{PI, TAU};

/// Frequencies that are looked at, spread over decades (–), and how many of them.
const DECADES: f64 = 6.0;
const N_SPREAD: usize = 1200;
/// Frequencies in even steps, at least (–), and in a turn of the delay's phase.
const N_EVEN: usize = 600;
const N_A_TURN: usize = 48;
/// Frequencies beside a pole, as many (–) at angles up to this (rad) whose tangent is the distance over the
/// pole's damping.
const N_AT_POLE: usize = 61;
const WIDEST: f64 = 1.5;
/// Parts (–) into which a step is cut where a crossing may lie between two that cancel.
const N_PARTS: usize = 8;
/// Crossings in a part of a step that are looked for at most (–).
const MOST_IN_A_STEP: usize = 8;
/// Distance (–) from 1 of a diagonal entry of T below which its open loop is infinite: it integrates.
const INTEGRATES: f64 = 1e-9;
/// Halvings of a bracket (–).
const N_HALVINGS: usize = 50;
/// Distance (–) from the real part 1/2 up to which an eigenvalue is one that crosses there.
const AT_CROSSING: f64 = 1e-6;

/// Margins of a loop whose controller predicts the plant's delay.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictedMargins {
    /// Of each of the plant's outputs, broken one at a time.
    pub channels: Vec<ChannelMargins>,
    /// Of all of the plant's outputs at once.
    pub disc: DiscMargin,
    /// Peak of the sensitivity.
    pub sensitivity: PeakGain,
    /// By how much (s) the plant's delay may be shorter, and longer, than the predicted one, in all outputs
    /// alike, before the loop is not stable; none where no delay that there can be leaves it so.
    pub mismatch: [Option<f64>; 2],
}

/// Margins of the loop in which a plant answers `delay` samples later than that of `undelayed`, whose
/// controller has a Smith predictor of that delay added.
///
/// The sensitivity is I − z⁻ᵈ T, T the complementary sensitivity without the delay, so that a long delay adds
/// no states: everything is found from T over frequency. Discrete time.
pub fn predicted_margins(
    undelayed: &Loop,
    delay: usize,
) -> Result<PredictedMargins, SynthesisError> {
    undelayed.stable_or_error()?;
    undelayed.plant.stable_or_error().map_err(SynthesisError::UnstableModel)?;
    let complementary = undelayed.complementary_sensitivity()?;
    let interval = complementary.interval.ok_or(MatrixError::Time { needed: "discrete" })?;
    let delayed = Delayed { complementary, delay: delay as f64 * interval, interval };
    let sweep = delayed.sweep(delay)?;
    let n = delayed.complementary.outputs();
    let channels = (0..n).map(|channel| delayed.channel(&sweep, channel));
    let half = delayed.peak(&sweep, 0.5)?;
    Ok(PredictedMargins {
        channels: channels.collect::<Result<_, _>>()?,
        disc: DiscMargin::of(half),
        sensitivity: delayed.peak(&sweep, 1.0)?,
        mismatch: delayed.mismatch(&sweep)?,
    })
}

/// Frequencies (rad/s), rising, and the complementary sensitivity there.
type Sweep = Vec<(f64, Mat<c64>)>;

/// The complementary sensitivity with its delay.
struct Delayed {
    complementary: StateSpace,
    /// s.
    delay: f64,
    /// Time between samples (s).
    interval: f64,
}

impl Delayed {
    /// Its response at `frequency` (rad/s).
    fn at(&self, frequency: f64) -> Result<Mat<c64>, MatrixError> {
        let turn = Complex64::cis(-frequency * self.delay);
        let response = self.complementary.response(frequency)?;
        Ok(Mat::from_fn(response.nrows(), response.ncols(), |i, j| turn * response[(i, j)]))
    }

    /// Its responses from rest to half the sample rate, close beside each pole as far as it reaches.
    fn sweep(&self, delay: usize) -> Result<Sweep, MatrixError> {
        let fastest = PI / self.interval;
        let spread = (0..N_SPREAD)
            .map(|i| fastest * 10_f64.powf(DECADES * (i as f64 / N_SPREAD as f64 - 1.0)));
        let n_even = N_EVEN.max(N_A_TURN * delay / 2);
        let even = (0..=n_even).map(|i| fastest * i as f64 / n_even as f64);
        let mut frequencies: Vec<f64> = spread.chain(even).collect();
        for pole in self.complementary.poles()? {
            let rate = pole.ln() / self.interval;
            let about = (0..N_AT_POLE).map(|i| {
                let turn = WIDEST * (2.0 * i as f64 / (N_AT_POLE - 1) as f64 - 1.0);
                rate.im.abs() + rate.re * turn.tan()
            });
            frequencies.extend(about.filter(|found| *found > 0.0 && *found < fastest));
        }
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup();
        frequencies.into_iter().map(|frequency| Ok((frequency, self.at(frequency)?))).collect()
    }

    /// Margins of one channel, the others closed: its open loop is τ/(1 − τ), τ its entry on the diagonal,
    /// real where τ is, and of unit modulus where τ has the real part 1/2.
    fn channel(&self, sweep: &Sweep, channel: usize) -> Result<ChannelMargins, MatrixError> {
        let of = |response: &Mat<c64>| response[(channel, channel)];
        let mut margins = ChannelMargins::default();
        let real = self.crossings(sweep, |response| Ok(vec![of(response).im]))?;
        let ends = [0, sweep.len() - 1].map(|end| sweep[end].0);
        for frequency in real.into_iter().chain(ends) {
            let value = of(&self.at(frequency)?).re;
            if (1.0 - value).abs() > INTEGRATES {
                margins.take_real(value / (1.0 - value));
            }
        }
        let even = self.crossings(sweep, |response| Ok(vec![of(response).re - 0.5]))?;
        for frequency in even {
            let value = of(&self.at(frequency)?);
            margins.take_unit(value / (1.0 - value), frequency);
        }
        if of(&sweep[sweep.len() - 1].1).re > 0.5 {
            margins.delay = Some(margins.delay.map_or(self.interval, |d| d.min(self.interval)));
        }
        Ok(margins)
    }

    /// Largest gain over frequency of `share` I − T.
    fn peak(&self, sweep: &Sweep, share: f64) -> Result<PeakGain, MatrixError> {
        let gain = |response: &Mat<c64>| {
            let n = response.nrows();
            let direct = share * identity(n);
            let rest = Mat::from_fn(n, n, |i, j| direct[(i, j)] - response[(i, j)]);
            largest_singular_value(&rest)
        };
        let (mut best, mut place) = (PeakGain { gain: 0.0, frequency: 0.0 }, 0);
        for (index, (frequency, response)) in sweep.iter().enumerate() {
            let found = gain(response)?;
            if found > best.gain {
                (best, place) = (PeakGain { gain: found, frequency: *frequency }, index);
            }
        }
        // Thirds of the bracket about it.
        let mut low = sweep[place.saturating_sub(1)].0;
        let mut high = sweep[(place + 1).min(sweep.len() - 1)].0;
        for _ in 0..N_HALVINGS {
            let third = (high - low) / 3.0;
            let frequencies = [low + third, high - third];
            let mut gains = [0.0; 2];
            for (found, frequency) in gains.iter_mut().zip(frequencies) {
                *found = gain(&self.at(frequency)?)?;
                if *found > best.gain {
                    best = PeakGain { gain: *found, frequency };
                }
            }
            if gains[0] < gains[1] {
                low = frequencies[0];
            } else {
                high = frequencies[1];
            }
        }
        Ok(best)
    }

    /// How much shorter and longer the delay of all outputs may be: a further delay turns all eigenvalues
    /// λ = τ/(1 − τ) of the open loop alike, and the loop is at its border where one of unit modulus
    /// comes to −1.
    fn mismatch(&self, sweep: &Sweep) -> Result<[Option<f64>; 2], MatrixError> {
        let [mut shorter, mut longer] = [self.delay, f64::INFINITY];
        let past = |response: &Mat<c64>| {
            let values = complex_eigenvalues(response)?;
            Ok(values.iter().map(|value| value.re - 0.5).collect::<Vec<f64>>())
        };
        // At half the sample rate a sample more or less turns the sign: a root comes in along the negative
        // axis, without a border in between.
        if past(&sweep[sweep.len() - 1].1)?.iter().any(|distance| *distance > 0.0) {
            longer = self.interval;
            shorter = shorter.min(self.interval);
        }
        for frequency in self.crossings(sweep, past)?.into_iter().filter(|rate| *rate > 0.0) {
            for value in complex_eigenvalues(&self.at(frequency)?)? {
                if (value.re - 0.5).abs() > AT_CROSSING {
                    continue;
                }
                let turn = ((value / (1.0 - value)).arg() + PI).rem_euclid(TAU);
                longer = longer.min(turn / frequency);
                shorter = shorter.min((TAU - turn) / frequency);
            }
        }
        Ok([(shorter < self.delay).then_some(shorter), longer.is_finite().then_some(longer)])
    }

    /// Frequencies (rad/s) at which one of the `distances` of a response changes its sign.
    fn crossings(
        &self,
        sweep: &Sweep,
        distances: impl Fn(&Mat<c64>) -> Result<Vec<f64>, MatrixError>,
    ) -> Result<Vec<f64>, MatrixError> {
        let count = |found: &[f64]| found.iter().filter(|distance| **distance > 0.0).count();
        let count_at = |frequency: f64| Ok(count(&distances(&self.at(frequency)?)?));
        let mut before = distances(&sweep[0].1)?;
        let mut marks = vec![(sweep[0].0, count(&before))];
        for pair in sweep.windows(2) {
            let [start, end] = [pair[0].0, pair[1].0];
            let here = distances(&pair[1].1)?;
            let nearest = here.iter().chain(&before).map(|d| d.abs()).fold(f64::INFINITY, f64::min);
            let n = if nearest < (&pair[1].1 - &pair[0].1).norm_l2() { N_PARTS } else { 1 };
            for part in 1..n {
                let frequency = start + part as f64 * ((end - start) / n as f64);
                marks.push((frequency, count_at(frequency)?));
            }
            marks.push((end, count(&here)));
            before = here;
        }
        let mut found = Vec::new();
        for pair in marks.windows(2) {
            changes(pair[0], pair[1], count_at, &mut found)?;
        }
        Ok(found)
    }
}

/// Adds to `found` the frequencies (rad/s) between two at which `count_at` is known where it changes; several
/// that go the same way one after the other.
fn changes(
    (mut from, mut here): (f64, usize),
    (end, there): (f64, usize),
    count_at: impl Fn(f64) -> Result<usize, MatrixError>,
    found: &mut Vec<f64>,
) -> Result<(), MatrixError> {
    for _ in 0..MOST_IN_A_STEP {
        if here == there {
            break;
        }
        let [mut low, mut high] = [from, end];
        for _ in 0..N_HALVINGS {
            let middle = 0.5 * (low + high);
            if count_at(middle)? == here {
                low = middle;
            } else {
                high = middle;
            }
        }
        found.push(high);
        from = high;
        here = if high < end { count_at(high)? } else { there };
    }
    Ok(())
}
