//! Confidence in an estimate: variance of its phases, coherence of the estimated wave, consistency of the
//! innovation.

use basis::FixedFrame;
use lti::lag::kept;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Excitation periods over which the wind's component at the excitation rate is averaged (–).
const PICKING: f64 = 1.0;
/// Excitation periods over which its coherence is judged (–).
const JUDGING: f64 = 4.0;

/// Confidence in the phases; all numbers from 0, none, to 1, full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// exp(−σ²/2) of the less certain axis (–), σ² the variance of its phase by noise and by the model
    /// uncertainty of the pitch response: the length of the mean unit vector of that phase.
    pub certainty: f64,
    /// How steadily the wind's component at the excitation rate keeps its phase against the excitation (–):
    /// near 1 for a helix, near 0 for turbulence alone.
    pub coherence: f64,
    /// 1 while the innovations have the predicted variance, less as they grow (–).
    pub consistency: f64,
}

impl Trust {
    /// All three at once, their product (–).
    pub fn overall(&self) -> f64 {
        self.certainty * self.coherence * self.consistency
    }
}

/// Monitor of the confidence: running means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TrustMonitor {
    /// Tilt's and yaw's component at the excitation rate: in phase and a quarter ahead (m/s), over one
    /// period.
    picked: [[f64; 2]; 2],
    picked_weight: f64,
    /// Mean of the components (m/s) and of their square (m²/s²) over some periods.
    mean: [[f64; 2]; 2],
    square: f64,
    weight: f64,
    /// Mean of the normalised innovation squared (–).
    innovation: f64,
    innovation_weight: f64,
}

impl TrustMonitor {
    /// Takes in the instantaneous `wind` (m/s), without constant parts, at `angle` (rad) of an excitation of
    /// `rate` (rad/s), an `interval` (s) after the last one.
    pub(super) fn observe(&mut self, interval: f64, rate: f64, angle: f64, wind: FixedFrame) {
        let period = TAU / rate;
        let (sine, cosine) = angle.sin_cos();
        let share = share(interval, PICKING * period);
        smooth(&mut self.picked_weight, share, 1.0);
        for (picked, wind) in self.picked.iter_mut().zip([wind.tilt, wind.yaw]) {
            smooth(&mut picked[0], share, 2.0 * wind * sine);
            smooth(&mut picked[1], share, 2.0 * wind * cosine);
        }
        let share = self::share(interval, JUDGING * period);
        let scale = 1.0 / self.picked_weight;
        let mut square = 0.0;
        for (mean, picked) in self.mean.iter_mut().zip(&self.picked) {
            for (mean, picked) in mean.iter_mut().zip(picked) {
                smooth(mean, share, scale * picked);
                square += (scale * picked).powi(2);
            }
        }
        smooth(&mut self.square, share, square);
        smooth(&mut self.weight, share, 1.0);
    }

    /// Takes in the mean `square` (–) of innovations over their standard deviation.
    pub(super) fn compare(&mut self, interval: f64, rate: f64, square: f64) {
        let share = share(interval, PICKING * TAU / rate);
        smooth(&mut self.innovation, share, square);
        smooth(&mut self.innovation_weight, share, 1.0);
    }

    /// Mean of the normalised innovation squared over an excitation period (–), one where the filter's noise
    /// is right.
    pub(super) fn innovation(&self) -> f64 {
        if self.innovation_weight > 0.0 { self.innovation / self.innovation_weight } else { 1.0 }
    }

    /// With phases of variance `phase_variance` (rad²), the larger of the two.
    pub(super) fn trust(&self, phase_variance: f64) -> Trust {
        Trust {
            certainty: (-0.5 * phase_variance).exp(),
            coherence: self.coherence(),
            consistency: 1.0 / self.innovation().max(1.0),
        }
    }

    fn coherence(&self) -> f64 {
        if self.square <= 0.0 {
            return 0.0;
        }
        let mean: f64 = self.mean.iter().flatten().map(|mean| mean * mean).sum();
        let steady = mean / (self.square * self.weight);
        // Expected value for noise alone, whose components are correlated over the averaging time.
        let chance = 1.0 / (1.0 + self.weight * JUDGING / PICKING);
        ((steady - chance) / (1.0 - chance)).clamp(0.0, 1.0)
    }
}

fn share(interval: f64, time_constant: f64) -> f64 {
    1.0 - kept(interval, time_constant)
}

fn smooth(value: &mut f64, share: f64, target: f64) {
    *value += share * (target - *value);
}
