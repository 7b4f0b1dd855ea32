//! When the inflow is asked for its wind: every few steps, for what is interpolated in between.
//!
//! Each time is asked for once, by all threads before the next one, and what was told is kept in checkpoints:
//! an inflow that moves on with the air need not go back.

/// Steps between two times at which the inflow is sampled: wind crosses half a cell in them, so nothing that
/// the grid resolves is lost.
const STRIDE: u64 = 4;

/// The two times around a step.
pub(crate) struct Times {
    /// Interval of `STRIDE` steps that they bound.
    interval: u64,
}

/// The interval that ends at time zero.
const BEFORE: u64 = u64::MAX;

impl Times {
    /// Those before the first step: the later of them is time zero.
    pub(crate) fn before_all() -> Self {
        Self { interval: BEFORE }
    }

    /// Those around the last of `n_steps` steps.
    pub(crate) fn around_last(n_steps: u64) -> Self {
        Self { interval: n_steps.checked_sub(1).map_or(BEFORE, |last| last / STRIDE) }
    }

    /// Moves on to the times around step number `step`, which is the next one; gives the step to ask the
    /// inflow at for the later time, where that is another one: what belonged to the later time belongs to
    /// the earlier one then, and the other way round.
    pub(crate) fn turn(&mut self, step: u64) -> Option<u64> {
        let interval = step / STRIDE;
        if interval == self.interval {
            return None;
        }
        debug_assert_eq!(interval, self.interval.wrapping_add(1), "steps follow one another");
        self.interval = interval;
        Some((interval + 1) * STRIDE)
    }
}

/// Weight of the later of the two times around `step` (–).
pub(crate) fn weight(step: u64) -> f32 {
    (step % STRIDE) as f32 / STRIDE as f32
}
