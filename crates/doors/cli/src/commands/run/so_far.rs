//! The report of a study of which runs are still to come: its page, for those who wait.

use std::path::PathBuf;
use std::time::{Duration, Instant};
use wakemix::postprocessing::{self, PostprocessingError};

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
    /// Wall time left for all runs, as it was told last (s).
    pub(super) time_left: f64,
    /// When the last page was there, and how long it took.
    last: Option<(Instant, Duration)>,
}

impl SoFar {
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
