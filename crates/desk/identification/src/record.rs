//! Records of inputs and outputs, checked, and what is done to them before a model is made.

use crate::error::within;
use crate::{IdentificationError, filter};
use lti::LowPass;

/// Share of a channel's deviation that rounding leaves of a trend (–).
const ROUNDING: f64 = 1e-12;

/// Samples of one quantity, equally spaced in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What it is; messages name it.
    pub name: String,
    /// In the channel's own unit.
    pub samples: Vec<f64>,
}

impl Channel {
    /// Of its name and samples.
    pub fn new(name: impl Into<String>, samples: Vec<f64>) -> Self {
        Self { name: name.into(), samples }
    }

    /// The same name with other samples.
    fn with(&self, samples: Vec<f64>) -> Self {
        Self { name: self.name.clone(), samples }
    }

    /// Root of the mean square about the mean, in the channel's unit.
    fn deviation(&self) -> f64 {
        let n_samples = self.samples.len() as f64;
        let mean = self.samples.iter().sum::<f64>() / n_samples;
        (self.samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n_samples).sqrt()
    }
}

/// What is taken off each channel of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trend {
    /// The mean.
    Constant,
    /// The line of least squares.
    Linear,
    /// All that a first-order low-pass filter with this corner (rad/s), settled at the mean, lets through.
    Slow {
        /// rad/s, below half the sampling rate.
        corner: f64,
    },
}

/// Inputs and outputs sampled at the same instants: all of one length, finite, and none of them constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    inputs: Vec<Channel>,
    outputs: Vec<Channel>,
    interval: f64,
}

impl Record {
    /// Of channels sampled every `interval` (s).
    ///
    /// # Errors
    /// Names the first channel that has another length, a sample that is no finite number, or no movement.
    pub fn new(
        inputs: Vec<Channel>,
        outputs: Vec<Channel>,
        interval: f64,
    ) -> Result<Self, IdentificationError> {
        within("the interval (s)", interval, f64::MIN_POSITIVE, f64::MAX)?;
        for (channels, what) in [(&inputs, "inputs"), (&outputs, "outputs")] {
            if channels.is_empty() {
                return Err(IdentificationError::NoChannels { what });
            }
        }
        let expected = inputs[0].samples.len();
        for channel in inputs.iter().chain(&outputs) {
            check(channel, expected)?;
        }
        Ok(Self { inputs, outputs, interval })
    }

    /// What was done to the system.
    pub fn inputs(&self) -> &[Channel] {
        &self.inputs
    }

    /// What the system did.
    pub fn outputs(&self) -> &[Channel] {
        &self.outputs
    }

    /// s between samples.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Samples of each channel (–).
    pub fn n_samples(&self) -> usize {
        self.inputs[0].samples.len()
    }

    /// Without its trend. A filter is applied to inputs and outputs alike, so that what ties them stays.
    ///
    /// # Errors
    /// [`IdentificationError::OutOfRange`] for a corner that is not below half the sampling rate;
    /// [`IdentificationError::Constant`] where nothing but the trend was there.
    pub fn detrended(&self, trend: Trend) -> Result<Self, IdentificationError> {
        if let Trend::Slow { corner } = trend {
            let most = std::f64::consts::PI / self.interval;
            within("the corner (rad/s)", corner, f64::MIN_POSITIVE, most)?;
        }
        let record = self.mapped(|samples| match trend {
            Trend::Constant => without_mean(samples),
            Trend::Linear => without_line(samples),
            Trend::Slow { corner } => without_slow(samples, corner, self.interval),
        })?;
        let before = self.inputs.iter().chain(&self.outputs);
        for (channel, before) in record.inputs.iter().chain(&record.outputs).zip(before) {
            if channel.deviation() <= ROUNDING * before.deviation() {
                let (name, value) = (channel.name.clone(), channel.samples[0]);
                return Err(IdentificationError::Constant { name, value });
            }
        }
        Ok(record)
    }

    /// Every `factor`-th sample, after a symmetric low-pass filter that passes 0.8 of the new half sampling
    /// rate and stops what would fold onto it. Ends are continued by turning the record about its end points.
    ///
    /// # Errors
    /// [`IdentificationError::TooFewSamples`] where the filter is longer than the record.
    pub fn decimated(&self, factor: usize) -> Result<Self, IdentificationError> {
        within("the decimation factor (–)", factor as f64, 1.0, f64::MAX)?;
        if factor == 1 {
            return Ok(self.clone());
        }
        let (nyquist, share) = (0.5 / factor as f64, 0.2);
        let n_taps = filter::taps_for(share * nyquist);
        self.long_enough(n_taps, "the anti-alias filter")?;
        let taps = filter::low_pass((1.0 - 0.5 * share) * nyquist, n_taps);
        let mut record = self.mapped(|samples| {
            filter::zero_phase(samples, &taps).into_iter().step_by(factor).collect()
        })?;
        record.interval *= factor as f64;
        Ok(record)
    }

    /// With every channel divided by its deviation about its mean, and those deviations (in the channels'
    /// units): first the inputs', then the outputs'.
    pub fn to_unit_deviation(&self) -> (Self, Vec<f64>) {
        let channels = self.inputs.iter().chain(&self.outputs);
        let deviations: Vec<f64> = channels.map(Channel::deviation).collect();
        let divided = |channels: &[Channel], by: &[f64]| {
            let pairs = channels.iter().zip(by);
            pairs.map(|(c, by)| c.with(c.samples.iter().map(|x| x / by).collect())).collect()
        };
        let (of_inputs, of_outputs) = deviations.split_at(self.inputs.len());
        let record = Self {
            inputs: divided(&self.inputs, of_inputs),
            outputs: divided(&self.outputs, of_outputs),
            interval: self.interval,
        };
        (record, deviations)
    }

    /// The first `share` (–, between 0 and 1) of the record, to identify from, and the rest, to validate on.
    ///
    /// # Errors
    /// [`IdentificationError::OutOfRange`] for the share; what [`Record::new`] finds in either part.
    pub fn split(&self, share: f64) -> Result<(Self, Self), IdentificationError> {
        within("the share to identify from (–)", share, 0.0, 1.0)?;
        let at = (share * self.n_samples() as f64).round() as usize;
        let first = self.mapped(|samples| samples[..at].to_vec())?;
        Ok((first, self.mapped(|samples| samples[at..].to_vec())?))
    }

    /// With outputs moved earlier by a known delay of `samples`: input and output of that distance meet.
    ///
    /// # Errors
    /// [`IdentificationError::TooFewSamples`] where nothing is left.
    pub fn outputs_advanced(&self, samples: usize) -> Result<Self, IdentificationError> {
        self.long_enough(samples + 2, "the delay")?;
        let left = self.n_samples() - samples;
        let cut = |channels: &[Channel], from: usize| {
            channels.iter().map(|c| c.with(c.samples[from..from + left].to_vec())).collect()
        };
        Self::new(cut(&self.inputs, 0), cut(&self.outputs, samples), self.interval)
    }

    /// Refuses a record of fewer samples than `needed`.
    pub(crate) fn long_enough(
        &self,
        needed: usize,
        purpose: &'static str,
    ) -> Result<(), IdentificationError> {
        let found = self.n_samples();
        if found < needed {
            return Err(IdentificationError::TooFewSamples { found, needed, purpose });
        }
        Ok(())
    }

    /// With the same done to the samples of every channel.
    fn mapped(&self, change: impl Fn(&[f64]) -> Vec<f64>) -> Result<Self, IdentificationError> {
        let changed = |channels: &[Channel]| {
            channels.iter().map(|channel| channel.with(change(&channel.samples))).collect()
        };
        Self::new(changed(&self.inputs), changed(&self.outputs), self.interval)
    }
}

/// Refuses a channel of another length, with a sample that is no finite number, or without movement.
fn check(channel: &Channel, expected: usize) -> Result<(), IdentificationError> {
    let (name, samples) = (channel.name.clone(), &channel.samples);
    if samples.len() != expected {
        return Err(IdentificationError::UnequalLengths { name, found: samples.len(), expected });
    }
    if samples.len() < 2 {
        let (found, purpose) = (samples.len(), "a record");
        return Err(IdentificationError::TooFewSamples { found, needed: 2, purpose });
    }
    if let Some(sample) = samples.iter().position(|x| !x.is_finite()) {
        return Err(IdentificationError::NotFinite { name, sample });
    }
    if samples.iter().all(|x| *x == samples[0]) {
        return Err(IdentificationError::Constant { name, value: samples[0] });
    }
    Ok(())
}

fn without_mean(samples: &[f64]) -> Vec<f64> {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    samples.iter().map(|x| x - mean).collect()
}

/// Without the line of least squares.
fn without_line(samples: &[f64]) -> Vec<f64> {
    let centred = without_mean(samples);
    let middle = 0.5 * (samples.len() as f64 - 1.0);
    let (mut product, mut square) = (0.0, 0.0);
    for (index, x) in centred.iter().enumerate() {
        product += (index as f64 - middle) * x;
        square += (index as f64 - middle).powi(2);
    }
    let slope = product / square;
    centred.iter().enumerate().map(|(i, x)| x - slope * (i as f64 - middle)).collect()
}

/// Without what a first-order low-pass filter settled at the mean lets through.
fn without_slow(samples: &[f64], corner: f64, interval: f64) -> Vec<f64> {
    let mut slow = LowPass::settled(corner, 0.0);
    without_mean(samples).iter().map(|x| x - slow.update(interval, *x)).collect()
}

#[cfg(test)]
mod tests;
