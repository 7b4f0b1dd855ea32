//! How far an estimate can be trusted: spread of its phases, steadiness of what it follows, size of what it leaves over.

use basis::FixedFrame;
use lti::lag::kept;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Excitation periods over which the helix is picked out of the wind (–).
const PICKING: f64 = 1.0;
/// Excitation periods over which its steadiness is judged (–).
const JUDGING: f64 = 4.0;

/// How far the phases can be trusted; all numbers from 0, not at all, to 1, fully.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// exp(−σ²/2) of the less certain axis, σ² the variance of its phase by noise and by what the model may get wrong of the
    /// rotor's own pitch (–): the length that the mean of a unit vector of that phase keeps.
    pub certainty: f64,
    /// How steadily the wind's component at the excitation rate keeps its phase against the excitation (–): near 1 for a
    /// helix, near 0 for turbulence alone.
    pub coherence: f64,
    /// 1 while the innovations are as small as the filter believes, less as they grow (–).
    pub consistency: f64,
}

impl Trust {
    /// All three at once, their product (–).
    pub fn overall(&self) -> f64 {
        self.certainty * self.coherence * self.consistency
    }
}

/// Running sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Watch {
    /// Tilt's and yaw's component at the excitation rate: in phase and a quarter ahead (m/s), over one period.
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

impl Watch {
    /// Takes in the `wind` (m/s) as the blades tell it now, lasting parts aside, at `angle` (rad) of an excitation of `rate`
    /// (rad/s), an `interval` (s) after the last one.
    pub(super) fn see(&mut self, interval: f64, rate: f64, angle: f64, wind: FixedFrame) {
        let period = TAU / rate;
        let (sine, cosine) = angle.sin_cos();
        let share = share(interval, PICKING * period);
        lean(&mut self.picked_weight, share, 1.0);
        for (picked, wind) in self.picked.iter_mut().zip([wind.tilt, wind.yaw]) {
            lean(&mut picked[0], share, 2.0 * wind * sine);
            lean(&mut picked[1], share, 2.0 * wind * cosine);
        }
        let share = self::share(interval, JUDGING * period);
        let scale = 1.0 / self.picked_weight;
        let mut square = 0.0;
        for (mean, picked) in self.mean.iter_mut().zip(&self.picked) {
            for (mean, picked) in mean.iter_mut().zip(picked) {
                lean(mean, share, scale * picked);
                square += (scale * picked).powi(2);
            }
        }
        lean(&mut self.square, share, square);
        lean(&mut self.weight, share, 1.0);
    }

    /// Takes in the mean `square` (–) of innovations over their standard deviation.
    pub(super) fn compare(&mut self, interval: f64, rate: f64, square: f64) {
        let share = share(interval, PICKING * TAU / rate);
        lean(&mut self.innovation, share, square);
        lean(&mut self.innovation_weight, share, 1.0);
    }

    /// Mean of the normalised innovation squared over an excitation period (–), one in a filter that knows its noise.
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
        // What is left of noise alone, whose components forget themselves within the picking time.
        let chance = 1.0 / (1.0 + self.weight * JUDGING / PICKING);
        ((steady - chance) / (1.0 - chance)).clamp(0.0, 1.0)
    }
}

fn share(interval: f64, time_constant: f64) -> f64 {
    1.0 - kept(interval, time_constant)
}

fn lean(value: &mut f64, share: f64, target: f64) {
    *value += share * (target - *value);
}
