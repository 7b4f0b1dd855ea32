//! The report of a study of which runs are still to come: its page, for those who wait.

use std::path::PathBuf;
use std::time::{Duration, Instant};
use wakemix::postprocessing::{self, PostprocessingError};
use wakemix::study::Estimate;

/// What the first page is taken to need.
const EXPECTED: Duration = Duration::from_secs(1);
/// What a page may need at most for another one to be made before the end.
const LONGEST: Duration = Duration::from_secs(2);
/// So many times what a page needs must have passed since the one before, and be left of the runs (–).
const RARITY: u32 = 30;

/// When the page was made, and when it is due again.
#[derive(Default)]
pub(super) struct SoFar {
    /// Folder of the study, or of the sweep.
    pub(super) directory: PathBuf,
    /// Runs that are still to come, and how many are made at a time (–).
    n_left: usize,
    n_at_a_time: usize,
    /// Wall time that they take, if each takes as long as the one before (s).
    time_left: f64,
    /// When the last page was there, and how long it took.
    last: Option<(Instant, Duration)>,
}

impl SoFar {
    /// Takes in which runs are to be made.
    pub(super) fn take(&mut self, estimate: &Estimate) {
        (self.n_left, self.n_at_a_time) = (estimate.n_runs, estimate.n_jobs.max(1));
    }

    /// Takes in that a run is complete, which took `wall_time` (s).
    pub(super) fn one_less(&mut self, wall_time: f64) {
        self.n_left = self.n_left.saturating_sub(1);
        self.time_left = wall_time * self.n_left as f64 / self.n_at_a_time as f64;
    }

    /// Whether a page of the runs that are complete at `now` is worth its time.
    pub(super) fn is_due(&self, now: Instant) -> bool {
        let took = self.last.map_or(EXPECTED, |(_, took)| took);
        let pause = RARITY * took;
        let is_old = self.last.is_none_or(|(made, _)| now.duration_since(made) >= pause);
        took <= LONGEST && is_old && self.time_left >= pause.as_secs_f64()
    }

    /// Makes the page of the study in the folder `study` of the directory; gives its path the first time.
    pub(super) fn make(&mut self, study: &str) -> Result<Option<PathBuf>, PostprocessingError> {
        let began = Instant::now();
        let page = postprocessing::report_so_far(&self.directory, &self.directory.join(study));
        let is_first = self.last.replace((Instant::now(), began.elapsed())).is_none();
        page.map(|page| is_first.then_some(page))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_that_is_left_is_that_of_the_runs_to_come() {
        let mut so_far = SoFar { n_left: 5, n_at_a_time: 2, ..SoFar::default() };
        so_far.one_less(100.0);
        assert_eq!(so_far.time_left, 200.0);
        (0..4).for_each(|_| so_far.one_less(3600.0));
        assert!(so_far.time_left == 0.0 && !so_far.is_due(Instant::now()));
    }

    #[test]
    fn a_page_is_made_where_there_is_long_to_wait_and_it_takes_little() {
        let now = Instant::now() + Duration::from_secs(1000);
        let due = |time_left: f64, last: Option<[f64; 2]>| {
            let seconds = Duration::from_secs_f64;
            let last = last.map(|[ago, took]| (now - seconds(ago), seconds(took)));
            SoFar { time_left, last, ..SoFar::default() }.is_due(now)
        };
        // The first one; the last run leaves nothing to wait for.
        assert!(due(3600.0, None) && due(30.0, None) && !due(29.0, None) && !due(0.0, None));
        assert!(!due(f64::NAN, None));
        // Runs that take a moment each have no page each.
        assert!(due(3600.0, Some([20.0, 0.5])) && !due(3600.0, Some([10.0, 0.5])));
        assert!(!due(10.0, Some([600.0, 0.5])));
        // One that took long was the last before the end.
        assert!(due(3600.0, Some([600.0, 2.0])) && !due(3600.0, Some([600.0, 2.5])));
    }
}
