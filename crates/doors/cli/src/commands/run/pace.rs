//! The pace of the runs beside the one that their cost was told with: that of a rotor alone, of which nothing
//! is kept.

use indicatif::HumanDuration;
use std::time::{Duration, Instant};
use wakemix::study::{Estimate, Progress};

/// Wall time of runs that tells their pace.
const SURE: Duration = Duration::from_secs(5);
/// Share by which runs may take longer than was told (–).
const TOLERATED: f64 = 0.15;
/// Wall time left that is worth a word (s).
const WORTH: f64 = 20.0;

/// A pace of `speed` (1/s) in words: of cell updates, or of steps where the air has no cells.
pub(super) fn words(speed: f64, has_cells: bool) -> String {
    match speed {
        speed if has_cells => format!("{:.0} million cell updates a second", 1e-6 * speed),
        speed if speed < 10.0 => format!("{speed:.1} steps a second with wakes of full length"),
        speed => format!("{speed:.0} steps a second with wakes of full length"),
    }
}

/// What was told, and where the runs stood at first.
#[derive(Default)]
pub(super) struct Pace {
    /// Work of all runs, and what it was to take (s); none when there is nothing to set right.
    told: Option<(f64, f64)>,
    has_cells: bool,
    first: Option<(Instant, f64)>,
}

impl Pace {
    /// Takes in what was told of the cost.
    pub(super) fn take(&mut self, estimate: &Estimate) {
        self.told = estimate.updates_per_second.map(|speed| (estimate.work, estimate.work / speed));
        self.has_cells = estimate.n_cells[0] > 0;
    }

    /// What the runs take from here on, in words, where `progress` at `now` shows that it is more than was
    /// told; once.
    pub(super) fn set_right(&mut self, progress: &Progress, now: Instant) -> Option<String> {
        let (began, first) = *self.first.get_or_insert((now, progress.share_of_all));
        let (elapsed, open) = (now.duration_since(began), 1.0 - progress.share_of_all);
        if elapsed < SURE {
            return None;
        }
        let (work, expected) = self.told.take()?;
        let left = elapsed.as_secs_f64() * open / (progress.share_of_all - first);
        (left >= WORTH && left > (1.0 + TOLERATED) * expected * open && left.is_finite()).then(
            || {
                format!(
                    "cost: rather {} from here on: with all turbines and records the runs make {}",
                    HumanDuration(Duration::from_secs_f64(left)),
                    words(work * open / left, self.has_cells)
                )
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_take_longer_than_was_told_are_told_of_once() {
        let began = Instant::now();
        let at = |pace: &mut Pace, seconds: f64, share_of_all: f64| {
            let progress = Progress {
                run: "a",
                run_index: 0,
                n_runs: 2,
                step: 1,
                n_steps: 2,
                updates_per_second: 1.0,
                time_left: f64::NAN,
                first_step: 0,
                n_at_a_time: 1,
                share_of_all,
            };
            pace.set_right(&progress, began + Duration::from_secs_f64(seconds))
        };
        // A hundred seconds for 20 billion updates.
        let told = || Pace { told: Some((2e10, 100.0)), has_cells: true, first: None };
        let mut slow = told();
        assert_eq!(at(&mut slow, 0.0, 0.1), None);
        assert_eq!(at(&mut slow, 4.0, 0.12), None);
        // A tenth in twenty seconds.
        let words = at(&mut slow, 20.0, 0.2).expect("words");
        assert!(words.starts_with("cost: rather 3 minutes from here on"), "{words}");
        assert!(words.ends_with("make 100 million cell updates a second"), "{words}");
        assert_eq!(at(&mut slow, 40.0, 0.3), None);
        let mut as_told = told();
        assert_eq!((at(&mut as_told, 0.0, 0.0), at(&mut as_told, 10.0, 0.09)), (None, None));
        let mut nearly_done = told();
        assert_eq!(
            (at(&mut nearly_done, 0.0, 0.0), at(&mut nearly_done, 150.0, 0.9)),
            (None, None)
        );
        assert_eq!(at(&mut Pace::default(), 0.0, 0.0), None);
    }
}
