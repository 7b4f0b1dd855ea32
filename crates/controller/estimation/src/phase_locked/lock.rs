//! Lock detection: small phase error, and an oscillation that is large against the residual.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Root mean square of the phase error below which a loop locks (rad). An action with a phase error of this
/// standard deviation (normally distributed) still has exp(−σ²/2) = 78 % of its effect.
const LOCKS_BELOW: f64 = 0.7;
/// Root mean square of the phase error above which it has lost the lock (rad): below half of the effect. A
/// loop without an oscillation to follow has 2 to 4 rad.
const LOSES_ABOVE: f64 = 1.2;
/// Least power of the oscillation, A²/2, over that of the residual (–); half of it loses the lock.
const LEAST_POWER_RATIO: f64 = 0.5;

/// Phase (rad) over which missing samples in a row are bridged; beyond it the lock is lost.
const BRIDGED: f64 = 0.5 * TAU;

/// Lock detection; means are exponential over one period of the oscillation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Lock {
    /// Mean square of the phase error (rad²).
    phase: f64,
    /// Mean square of the residual (squared unit).
    residual: f64,
    /// Share of the time at a frequency limit (–).
    limited: f64,
    /// Phase turned since the beginning or since the lock was lost (rad).
    turned: f64,
    /// Phase turned since the last sample (rad).
    silent: f64,
    locked: bool,
}

impl Lock {
    pub(super) fn new() -> Self {
        Self { phase: 1.0, residual: 0.0, limited: 0.0, turned: 0.0, silent: 0.0, locked: false }
    }

    /// Takes in one instant: `turned` (rad) since the one before, phase error (rad), residual and amplitude
    /// (one unit), whether the rate is at a limit.
    pub(super) fn update(
        &mut self,
        turned: f64,
        error: f64,
        residual: f64,
        amplitude: f64,
        limited: bool,
    ) {
        self.silent = 0.0;
        let share = (turned / TAU).min(1.0);
        self.phase += share * (error * error - self.phase);
        self.residual += share * (residual * residual - self.residual);
        self.limited += share * (f64::from(limited) - self.limited);
        self.turned += turned;
        let slack = if self.locked { 2.0 } else { 1.0 };
        let steady = self.phase < if self.locked { LOSES_ABOVE } else { LOCKS_BELOW }.powi(2);
        let stands_out = slack * amplitude * amplitude > 2.0 * LEAST_POWER_RATIO * self.residual;
        let free = self.limited < if self.locked { 0.9 } else { 0.5 };
        let holds = steady && stands_out && free && amplitude > 0.0;
        if self.locked && !holds {
            self.turned = 0.0;
        }
        // No lock in the first period, before the means are meaningful.
        self.locked = holds && (self.locked || self.turned > TAU);
    }

    /// Takes in an instant without a sample, `turned` (rad) after the one before.
    pub(super) fn miss(&mut self, turned: f64) {
        self.silent += turned;
        if self.silent > BRIDGED {
            self.locked = false;
            self.turned = 0.0;
        }
    }

    /// Root mean square of the phase error (rad).
    pub(super) fn phase_error(&self) -> f64 {
        self.phase.sqrt()
    }

    pub(super) fn is_locked(&self) -> bool {
        self.locked
    }
}
