//! Margins of stability: one channel at a time, and all channels together.

use crate::loop_analysis::{Loop, in_continuous_time, in_its_time, sensitivity};
use faer::Mat;
use lti::Complex64;
use lti::matrices::dense::{blocks, identity};
use lti::matrices::{MatrixError, PeakGain, StateSpace, lower_fractional, parallel};
use std::f64::consts::{PI, TAU};

/// Relative distance (–) from a crossing up to which a frequency is one.
const AT_CROSSING: f64 = 1e-5;
/// Real part of a zero, as a share of its modulus, up to which it may be on the imaginary axis.
const NEAR_AXIS: f64 = 1e-4;

/// Margins of one channel while all others are closed; none where no change in that direction leaves the
/// loop unstable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChannelMargins {
    /// Smallest factor (–) above one of the channel's gain that leaves the loop not stable.
    pub gain_increase: Option<f64>,
    /// Largest factor (–) between zero and one of the channel's gain that leaves the loop not stable.
    pub gain_decrease: Option<f64>,
    /// Smallest turn of the channel's phase (rad), to either side, that leaves the loop not stable.
    pub phase: Option<f64>,
    /// Shortest further delay (s) in the channel that leaves the loop not stable.
    pub delay: Option<f64>,
    /// Frequency (rad/s) of the crossing with the smallest phase margin.
    pub crossover: Option<f64>,
}

/// Gain and phase that all channels stand at once, each changing by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscMargin {
    /// α (–), the inverse of the norm of (S − T)/2; at most 2.
    pub size: f64,
    /// Factors (–) of gain that all channels stand at once: from (2 − α)/(2 + α) to its inverse.
    pub gain: [f64; 2],
    /// Turn of phase (rad) that all channels stand at once: 2 arctan(α/2).
    pub phase: f64,
    /// Frequency (rad/s) at which the loop is nearest to instability.
    pub frequency: f64,
}

impl Loop {
    /// Margins of each of the plant's outputs, broken one at a time.
    pub fn output_margins(&self) -> Result<Vec<ChannelMargins>, MatrixError> {
        self.stable_or_error()?;
        all_margins(&self.open()?)
    }

    /// Margins of each of the plant's inputs, broken one at a time.
    pub fn input_margins(&self) -> Result<Vec<ChannelMargins>, MatrixError> {
        self.stable_or_error()?;
        all_margins(&self.open_at_inputs()?)
    }

    /// Disc margin of all of the plant's outputs at once.
    pub fn output_disc_margin(&self) -> Result<DiscMargin, MatrixError> {
        disc_margin(&self.open()?)
    }

    /// Disc margin of all of the plant's inputs at once.
    pub fn input_disc_margin(&self) -> Result<DiscMargin, MatrixError> {
        disc_margin(&self.open_at_inputs()?)
    }
}

/// Symmetric disc margin: 1 over the norm of S − I/2 = (S − T)/2.
///
/// Source: Seiler, Packard and Gahinet, "An introduction to disk margins", IEEE Control Systems Magazine
/// 40, 2020, Eqs. 17 and 20.
fn disc_margin(open: &StateSpace) -> Result<DiscMargin, MatrixError> {
    let half = StateSpace::gain(-0.5 * identity(open.outputs()), open.interval);
    Ok(DiscMargin::of(parallel(&sensitivity(open)?, &half)?.h_infinity_norm()?))
}

impl DiscMargin {
    /// Of the `peak` of (S − T)/2.
    pub(crate) fn of(peak: PeakGain) -> Self {
        let size = peak.gain.recip();
        let low = ((2.0 - size) / (2.0 + size)).max(0.0);
        let phase = 2.0 * (0.5 * size).atan();
        Self { size, gain: [low, low.recip()], phase, frequency: peak.frequency }
    }
}

impl ChannelMargins {
    /// Takes that the open loop is real somewhere, of this `value`.
    pub(crate) fn take_real(&mut self, value: f64) {
        if value >= 0.0 {
            return;
        }
        let factor = -value.recip();
        if factor > 1.0 {
            lower(&mut self.gain_increase, factor);
        } else {
            let largest = self.gain_decrease.map_or(factor, |found| found.max(factor));
            self.gain_decrease = Some(largest);
        }
    }

    /// Takes that the open loop is of unit modulus at `frequency` (rad/s), of this `value`.
    pub(crate) fn take_unit(&mut self, value: Complex64, frequency: f64) {
        let phase = PI - value.arg().abs();
        if self.phase.is_none_or(|found| phase < found) {
            self.phase = Some(phase);
            self.crossover = Some(frequency);
        }
        if frequency > 0.0 {
            lower(&mut self.delay, (value.arg() + PI).rem_euclid(TAU) / frequency);
        }
    }
}

/// Margins of each channel of a square open loop.
fn all_margins(open: &StateSpace) -> Result<Vec<ChannelMargins>, MatrixError> {
    (0..open.outputs()).map(|channel| margins(&one_open(open, channel)?)).collect()
}

/// The loop with all channels closed but one.
fn one_open(open: &StateSpace, channel: usize) -> Result<StateSpace, MatrixError> {
    let mut order = vec![channel];
    order.extend((0..open.outputs()).filter(|other| *other != channel));
    let closed = StateSpace::gain(-identity(order.len() - 1), open.interval);
    lower_fractional(&open.selected(&order, &order)?, &closed)
}

/// Margins of an open loop of one channel, from the frequencies at which its response is real or of unit
/// modulus.
fn margins(open: &StateSpace) -> Result<ChannelMargins, MatrixError> {
    let (system, interval) = in_continuous_time(open)?;
    let mut margins = ChannelMargins::default();
    let mut real = real_responses(&system)?;
    real.push(system.d[(0, 0)]);
    for value in real {
        margins.take_real(value);
    }
    for warped in system.frequencies_with_gain(1.0)? {
        let Some(value) = value_at(&system, warped) else { continue };
        if (value.norm() - 1.0).abs() > AT_CROSSING {
            continue;
        }
        margins.take_unit(value, in_its_time(warped, interval));
    }
    Ok(margins)
}

/// Values of the response where it is real: at the zeros on the imaginary axis of L(s) − L(−s), and at
/// rest.
fn real_responses(system: &StateSpace) -> Result<Vec<f64>, MatrixError> {
    let StateSpace { a, b, c, .. } = system;
    let n = system.order();
    let none = Mat::zeros(n, n);
    let difference = StateSpace::new(
        blocks(&[&[a, &none], &[&none, &(-a)]]),
        blocks(&[&[b], &[b]]),
        blocks(&[&[c, c]]),
        Mat::zeros(1, 1),
        None,
    );
    let mut frequencies = vec![0.0];
    let zeros = difference.invariant_zeros()?;
    let near = zeros.iter().filter(|zero| zero.re.abs() <= NEAR_AXIS * zero.norm());
    frequencies.extend(near.map(|zero| zero.im.abs()));
    let values = frequencies.into_iter().filter_map(|frequency| value_at(system, frequency));
    let real = values.filter(|value| value.im.abs() <= AT_CROSSING * value.norm());
    Ok(real.map(|value| value.re).collect())
}

/// The response, where there is no pole.
fn value_at(system: &StateSpace, frequency: f64) -> Option<Complex64> {
    system.response(frequency).ok().map(|response| response[(0, 0)])
}

/// Lowers what was found to `value`.
fn lower(found: &mut Option<f64>, value: f64) {
    *found = Some(found.map_or(value, |found| found.min(value)));
}
