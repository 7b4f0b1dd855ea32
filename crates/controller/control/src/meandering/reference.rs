//! The amplitude that each axis would have without control, a factor of which is the target.

use estimation::phase_locked::Axis;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Where the baseline's own amplitudes come from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reference {
    /// From a run without control.
    Given {
        /// Amplitude of the tilt moment (N m).
        tilt: f64,
        /// Amplitude of the yaw moment (N m).
        yaw: f64,
    },
    /// The mean estimate while the loop is locked, for `duration` before control starts; it waits for that.
    Learned {
        /// How long to learn (s).
        duration: f64,
    },
    /// The estimate less the effect of the pitch, over two periods: follows a baseline that changes.
    Observed,
}

/// Baseline amplitudes as known so far; serialises whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Baseline {
    /// Tilt and yaw (N m).
    amplitudes: [f64; 2],
    /// How long was learned (s).
    learned: f64,
}

impl Baseline {
    /// Takes in the estimates of the axes, locked, `interval` (s) after the last: `added` (N m) is what the
    /// pitch adds in phase with the command, `ahead` (rad) the lead of each axis over its command.
    pub(super) fn update(
        &mut self,
        interval: f64,
        rate: f64,
        reference: Reference,
        axes: [&Axis; 2],
        added: [f64; 2],
        ahead: [f64; 2],
    ) {
        let needed = reference.needed(rate);
        // Means at first, then, where it goes on, exponential ones.
        let share = match reference {
            Reference::Given { .. } => return,
            Reference::Learned { .. } if self.learned >= needed => return,
            Reference::Learned { .. } => interval / (self.learned + interval),
            Reference::Observed => interval / (self.learned + interval).min(needed),
        };
        self.learned += interval;
        for (index, known) in self.amplitudes.iter_mut().enumerate() {
            let (sine, cosine) = ahead[index].sin_cos();
            let amplitude = axes[index].amplitude;
            let own = (amplitude * cosine - added[index]).hypot(amplitude * sine);
            *known += share * (own - *known);
        }
    }

    /// Amplitudes of tilt and yaw (N m), when there are any yet at `rate` (rad/s).
    pub(super) fn amplitudes(&self, rate: f64, reference: Reference) -> Option<[f64; 2]> {
        match reference {
            Reference::Given { tilt, yaw } => Some([tilt, yaw]),
            Reference::Learned { .. } | Reference::Observed => {
                (self.learned >= reference.needed(rate)).then_some(self.amplitudes)
            }
        }
    }
}

impl Reference {
    /// How long it takes to be known at `rate` (s).
    pub(super) fn needed(self, rate: f64) -> f64 {
        match self {
            Self::Given { .. } => 0.0,
            Self::Learned { duration } => duration,
            Self::Observed => 2.0 * TAU / rate,
        }
    }
}
