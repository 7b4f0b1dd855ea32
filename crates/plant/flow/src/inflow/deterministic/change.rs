//! What happens everywhere at once: steps and ramps, and the gusts and turns of IEC 61400-1.

use super::{Now, finite};
use crate::inflow::{InflowError, not_negative, positive};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// A change of the wind, the same at all places. Times in s since the run's start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// The whole profile is multiplied so that its hub speed becomes `speed` at once.
    Step {
        /// Time of the step (s).
        start: f64,
        /// Hub speed afterwards (m/s).
        speed: f64,
    },
    /// As [`Step`](Self::Step), linearly over `duration`.
    Ramp {
        /// Beginning (s).
        start: f64,
        /// How long it takes (s).
        duration: f64,
        /// Hub speed afterwards (m/s).
        speed: f64,
    },
    /// Steps of equal rise, each held for `hold`.
    Staircase {
        /// Time of the first step (s).
        start: f64,
        /// Time between steps (s).
        hold: f64,
        /// Rise of the hub speed per step (m/s), negative falls.
        rise: f64,
        /// Number of steps (–).
        n_steps: u32,
    },
    /// Extreme operating gust: a dip, a rise, a dip. [IEC61400-1 ed. 3, eq. 18]
    OperatingGust {
        /// Beginning (s).
        start: f64,
        /// Duration (s), [`OPERATING_GUST_DURATION`](super::OPERATING_GUST_DURATION).
        duration: f64,
        /// Gust V_gust (m/s), [`operating_gust`](crate::inflow::iec::operating_gust).
        gust: f64,
    },
    /// Extreme direction change. [IEC61400-1 ed. 3, eq. 21]
    DirectionChange {
        /// Beginning (s).
        start: f64,
        /// Duration (s), [`DIRECTION_CHANGE_DURATION`](super::DIRECTION_CHANGE_DURATION).
        duration: f64,
        /// Change (rad), counter-clockwise seen from above; its size is
        /// [`direction_change`](crate::inflow::iec::direction_change).
        change: f64,
    },
    /// Extreme coherent gust with direction change. [IEC61400-1 ed. 3, eqs. 22, 24]
    CoherentGust {
        /// Beginning (s).
        start: f64,
        /// Rise time (s), [`COHERENT_GUST_DURATION`](super::COHERENT_GUST_DURATION).
        duration: f64,
        /// Rise of the speed (m/s), [`COHERENT_GUST`](crate::inflow::iec::COHERENT_GUST).
        rise: f64,
        /// Change of direction (rad), counter-clockwise seen from above; its size is
        /// [`coherent_direction_change`](crate::inflow::iec::coherent_direction_change).
        change: f64,
    },
}

impl Change {
    /// When it begins (s).
    pub fn start(&self) -> f64 {
        match *self {
            Self::Step { start, .. }
            | Self::Ramp { start, .. }
            | Self::Staircase { start, .. }
            | Self::OperatingGust { start, .. }
            | Self::DirectionChange { start, .. }
            | Self::CoherentGust { start, .. } => start,
        }
    }

    /// What cannot be used, in a wind of `hub_speed` (m/s) before it.
    pub(super) fn check(&self, hub_speed: f64) -> Result<(), InflowError> {
        match *self {
            Self::Step { start, speed } => {
                finite("start of the step (s)", start)?;
                not_negative("speed after the step (m/s)", speed)
            }
            Self::Ramp { start, duration, speed } => {
                finite("start of the ramp (s)", start)?;
                positive("duration of the ramp (s)", duration)?;
                not_negative("speed after the ramp (m/s)", speed)
            }
            Self::Staircase { start, hold, rise, n_steps } => {
                finite("start of the staircase (s)", start)?;
                positive("time between steps (s)", hold)?;
                finite("rise per step (m/s)", rise)?;
                let last = hub_speed + rise * f64::from(n_steps);
                not_negative("speed after the last step (m/s)", last)
            }
            Self::OperatingGust { start, duration, gust } => {
                finite("start of the gust (s)", start)?;
                positive("duration of the gust (s)", duration)?;
                finite("gust (m/s)", gust)
            }
            Self::DirectionChange { start, duration, change } => {
                finite("start of the direction change (s)", start)?;
                positive("duration of the direction change (s)", duration)?;
                finite("change of direction (rad)", change)
            }
            Self::CoherentGust { start, duration, rise, change } => {
                finite("start of the gust (s)", start)?;
                positive("rise time of the gust (s)", duration)?;
                finite("rise of the gust (m/s)", rise)?;
                finite("change of direction (rad)", change)
            }
        }
    }

    /// Sets what of it holds at `time` (s) in `now`, in a wind of `hub_speed` (m/s) before it.
    pub(super) fn apply(&self, hub_speed: f64, time: f64, now: &mut Now) {
        let to_speed = |speed: f64, share: f64| {
            if hub_speed > 0.0 { 1.0 + share * (speed / hub_speed - 1.0) } else { 1.0 }
        };
        match *self {
            Self::Step { start, speed } => now.factor = to_speed(speed, f64::from(time >= start)),
            Self::Ramp { start, duration, speed } => {
                now.factor = to_speed(speed, ((time - start) / duration).clamp(0.0, 1.0));
            }
            Self::Staircase { start, hold, rise, n_steps } => {
                let steps = ((time - start) / hold).floor() + 1.0;
                let rise = rise * steps.clamp(0.0, f64::from(n_steps));
                now.factor = to_speed(hub_speed + rise, 1.0);
            }
            Self::OperatingGust { start, duration, gust } => {
                let turn = (time - start) / duration;
                if (0.0..=1.0).contains(&turn) {
                    let shape = (3.0 * PI * turn).sin() * (1.0 - (TAU * turn).cos());
                    now.added = -0.37 * gust * shape;
                }
            }
            Self::DirectionChange { start, duration, change } => {
                now.direction = change * risen((time - start) / duration);
            }
            Self::CoherentGust { start, duration, rise, change } => {
                let share = risen((time - start) / duration);
                now.added = rise * share;
                now.direction = change * share;
            }
        }
    }
}

/// (1 − cos π t)/2 from 0 to 1 while `turn` goes from 0 to 1, constant outside.
fn risen(turn: f64) -> f64 {
    0.5 * (1.0 - (PI * turn.clamp(0.0, 1.0)).cos())
}
