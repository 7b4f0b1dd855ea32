//! Pitch travel: the duty of a pitch actuator.

use super::load::check_duration;
use crate::AnalysisError;

/// Accumulates the motion of one blade's pitch, sample by sample.
#[derive(Clone, Debug, Default)]
pub struct PitchTravel {
    pitch: f64,
    n_samples: usize,
    travel: f64,
    largest_step: f64,
    n_moves: usize,
    n_reversals: usize,
    direction: f64,
}

/// Duty of a pitch actuator over a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// Sum of all motion, whichever way (rad).
    pub travel: f64,
    /// Travel per time (rad/s).
    pub mean_rate: f64,
    /// Fastest motion between two samples (rad/s).
    pub maximum_rate: f64,
    /// Share of the time in which pitch moved at all (–).
    pub moving_share: f64,
    /// Changes of direction (–).
    pub n_reversals: usize,
}

impl PitchTravel {
    /// An actuator that has not moved.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes one sample of `pitch` (rad).
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index; the count is as before.
    pub fn push(&mut self, pitch: f64) -> Result<(), AnalysisError> {
        if !pitch.is_finite() {
            return Err(AnalysisError::NotFinite { index: self.n_samples });
        }
        if self.n_samples > 0 {
            let step = pitch - self.pitch;
            self.travel += step.abs();
            self.largest_step = self.largest_step.max(step.abs());
            if step != 0.0 {
                self.n_moves += 1;
                self.n_reversals += usize::from(step * self.direction < 0.0);
                self.direction = step.signum();
            }
        }
        self.pitch = pitch;
        self.n_samples += 1;
        Ok(())
    }

    /// The motion so far, sampled every `interval` (s).
    ///
    /// # Errors
    /// [`AnalysisError::TooShort`] for fewer than two samples, [`AnalysisError::NotPositive`] for the
    /// interval.
    pub fn travel(&self, interval: f64) -> Result<Travel, AnalysisError> {
        if self.n_samples < 2 {
            return Err(AnalysisError::TooShort { n_samples: self.n_samples, needed: 2 });
        }
        let n_steps = (self.n_samples - 1) as f64;
        check_duration(n_steps * interval)?;
        Ok(Travel {
            travel: self.travel,
            mean_rate: self.travel / (n_steps * interval),
            maximum_rate: self.largest_step / interval,
            moving_share: self.n_moves as f64 / n_steps,
            n_reversals: self.n_reversals,
        })
    }
}

impl Travel {
    /// Actuator duty cycle (–): the mean rate over the actuator's largest rate, `maximum_rate` (rad/s).
    ///
    /// Source: Bottasso et al., "Optimization-based study of bend-twist coupled rotor blades for passive and
    /// integrated passive/active load alleviation", Wind Energy 16, 2013.
    pub fn duty_cycle(&self, maximum_rate: f64) -> f64 {
        self.mean_rate / maximum_rate
    }
}
