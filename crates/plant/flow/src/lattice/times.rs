//! When the inflow is asked for its wind: every few steps, for what is interpolated in between.

/// Steps between two times at which the inflow is sampled: wind crosses half a cell in them, so nothing that
/// the grid resolves is lost.
const STRIDE: u64 = 4;

/// The two times around a step.
#[derive(Default)]
pub(crate) struct Times {
    /// Interval of `STRIDE` steps that they bound.
    interval: Option<u64>,
}

/// What there is to do when a step lies between other times than the one before.
pub(crate) struct Turn {
    /// What belongs to the later time belongs to the earlier one from now on, and the other way round.
    pub(crate) swaps: bool,
    /// Steps to ask the inflow at for the earlier and for the later time.
    pub(crate) asks: [Option<u64>; 2],
}

impl Times {
    /// Asks anew at the next step, whichever that is.
    pub(crate) fn forget(&mut self) {
        self.interval = None;
    }

    /// Moves on to the times around step number `step`.
    pub(crate) fn turn(&mut self, step: u64) -> Turn {
        let interval = step / STRIDE;
        let before = self.interval.replace(interval);
        let [earlier, later] = [interval * STRIDE, (interval + 1) * STRIDE];
        match before {
            Some(before) if before == interval => Turn { swaps: false, asks: [None; 2] },
            Some(before) if before + 1 == interval => {
                Turn { swaps: true, asks: [None, Some(later)] }
            }
            _ => Turn { swaps: false, asks: [Some(earlier), Some(later)] },
        }
    }
}

/// Weight of the later of the two times around `step` (–).
pub(crate) fn weight(step: u64) -> f32 {
    (step % STRIDE) as f32 / STRIDE as f32
}
