//! Instants at which a slower sampler is due.

use serde::{Deserialize, Serialize};

/// Share of an interval by which rounding may be early (–).
const EARLY: f64 = 1e-6;

/// Samples that were taken so far; they are due at whole intervals from the first instant on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Samples {
    n_taken: u64,
    /// Time of the first (s).
    start: f64,
}

impl Samples {
    pub(crate) const NONE: Self = Self { n_taken: 0, start: 0.0 };

    /// Whether one is due at `time` (s), every `interval` (s); it counts as taken then.
    pub(crate) fn due(&mut self, time: f64, interval: f64) -> bool {
        if self.n_taken == 0 {
            self.start = time;
        }
        let next = self.start + self.n_taken as f64 * interval;
        let due = time >= next - EARLY * interval;
        self.n_taken += u64::from(due);
        due
    }
}

#[cfg(test)]
mod tests {
    use super::Samples;

    #[test]
    fn every_fifth_instant_is_one_from_the_first_on() {
        let mut samples = Samples::NONE;
        let due: Vec<u32> =
            (3..5000).filter(|step| samples.due(0.1 * f64::from(*step), 0.5)).collect();
        assert_eq!(due, (0..1000).map(|n| 3 + 5 * n).collect::<Vec<u32>>());
    }
}
