//! Runs side by side: how many fit, and one observer for all of them.

use crate::observer::{Estimate, IdentificationProgress, Observer, Progress};
use crate::threads::cores;
use basis::records::{PitchResponse, Summary};
use farm::plan::Effort;
use farm::self_check::SelfCheck;
use formats::machine;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// How many of `n_runs` runs are made at a time where `wanted` is not given: as many as there are cores and
/// as memory carries, which each takes `memory` (bytes) of.
///
/// In resolved flow too, where a run can use all cores by itself: its threads wait for each other, and all
/// for what is in series, so that two runs of one thread each take 0.7 to 0.8 of the time of one after the
/// other.
pub(crate) fn number(wanted: Option<usize>, n_runs: usize, memory: u64) -> usize {
    let usual = || {
        let fitting = match machine::free_memory() {
            Some(free) if memory > 0 => usize::try_from(free / memory).unwrap_or(usize::MAX),
            _ => usize::MAX,
        };
        cores().min(fitting)
    };
    wanted.unwrap_or_else(usual).min(n_runs).max(1)
}

/// What is held by `mutex`, also after another thread has panicked: that ends the study by itself.
pub(crate) fn held<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How much of all runs is made.
struct Tally {
    /// Work of all runs to be made, in cell updates or what takes as long.
    all: f64,
    /// Work that complete runs have made.
    complete: f64,
    /// Work that this process need not make, because an earlier one has.
    given: f64,
    n_complete: usize,
    /// Runs under way by their place: work when this process took them up, and now.
    under_way: BTreeMap<usize, [f64; 2]>,
    started: Option<Instant>,
}

impl Tally {
    /// Takes in that run number `place`, which this process took up at the work `before`, stands at `now`.
    fn advance(&mut self, place: usize, before: f64, now: f64) {
        self.under_way.insert(place, [before, now]);
    }

    /// Takes in that run number `place` of `work` in all is complete.
    fn complete(&mut self, place: usize, work: f64) {
        let [before, _] = self.under_way.remove(&place).unwrap_or([0.0, work]);
        self.given += before;
        self.complete += work;
        self.n_complete += 1;
    }

    fn made(&self) -> f64 {
        self.complete + self.under_way.values().map(|[_, now]| now).sum::<f64>()
    }

    /// Wall time left (s).
    fn time_left(&self) -> f64 {
        let before: f64 = self.under_way.values().map(|[before, _]| before).sum();
        let own = self.made() - self.given - before;
        let elapsed = self.started.map_or(0.0, |started| started.elapsed().as_secs_f64());
        elapsed * (self.all - self.made()).max(0.0) / own
    }
}

struct Inner<'o> {
    observer: &'o mut (dyn Observer + Send),
    tally: Tally,
    /// Study that the observer was told of last.
    study: String,
}

/// One observer for runs that are made side by side; each of them has it for itself while it tells something.
pub(crate) struct Shared<'o> {
    inner: Mutex<Inner<'o>>,
    stop: &'o AtomicBool,
    /// Runs to be made (–).
    n_runs: usize,
    n_jobs: usize,
}

impl<'o> Shared<'o> {
    /// Of `observer`, for `n_runs` runs of `work` in all, `n_jobs` at a time.
    pub(crate) fn new(
        observer: &'o mut (dyn Observer + Send),
        stop: &'o AtomicBool,
        (n_runs, work): (usize, f64),
        n_jobs: usize,
    ) -> Self {
        let tally = Tally {
            all: work,
            complete: 0.0,
            given: 0.0,
            n_complete: 0,
            under_way: BTreeMap::new(),
            started: None,
        };
        let inner = Mutex::new(Inner { observer, tally, study: String::new() });
        Self { inner, stop, n_runs, n_jobs }
    }

    /// What the run number `place` of the study in the folder `study`, empty without a sweep of studies,
    /// tells; `effort` is what its steps cost.
    pub(crate) fn of_run<'s>(
        &'s self,
        study: &'s str,
        place: usize,
        effort: Effort,
    ) -> OfRun<'s, 'o> {
        OfRun { shared: self, study, place, effort }
    }
}

/// What one of several runs tells the observer of all.
pub(crate) struct OfRun<'s, 'o> {
    shared: &'s Shared<'o>,
    study: &'s str,
    place: usize,
    effort: Effort,
}

impl OfRun<'_, '_> {
    fn tell(&self, tell: impl FnOnce(&mut dyn Observer)) {
        self.with(|inner| tell(&mut *inner.observer));
    }

    fn with(&self, with: impl FnOnce(&mut Inner)) {
        let mut inner = held(&self.shared.inner);
        if inner.study != self.study {
            self.study.clone_into(&mut inner.study);
            inner.observer.in_study(self.study);
        }
        with(&mut inner);
    }

    /// Takes in that the run begins now.
    pub(crate) fn begin(&self) {
        held(&self.shared.inner).tally.started.get_or_insert_with(Instant::now);
    }

    /// Takes in that the run, of `n_steps`, is complete.
    pub(crate) fn complete(&self, n_steps: u64) {
        held(&self.shared.inner).tally.complete(self.place, self.effort.until(n_steps));
    }
}

impl Observer for OfRun<'_, '_> {
    fn estimated(&mut self, estimate: &Estimate) {
        self.tell(|observer| observer.estimated(estimate));
    }

    fn preparing(&mut self, what: &str, share: f64) {
        self.tell(|observer| {
            // Beside others, one may have been at it when another was told to stop.
            if self.shared.n_jobs < 2 || !self.shared.stop.load(Ordering::Relaxed) {
                observer.preparing(what, share);
            }
        });
    }

    fn checked(&mut self, check: &SelfCheck) {
        self.tell(|observer| observer.checked(check));
    }

    fn identifying(&mut self, progress: &IdentificationProgress) {
        self.tell(|observer| observer.identifying(progress));
    }

    fn identified(&mut self, turbine: &str, response: &PitchResponse, again: bool) {
        self.tell(|observer| observer.identified(turbine, response, again));
    }

    fn advanced(&mut self, progress: &Progress) {
        let [before, now] =
            [progress.first_step, progress.step].map(|step| self.effort.until(step));
        let Shared { n_runs, n_jobs, .. } = *self.shared;
        self.with(|inner| {
            inner.tally.advance(self.place, before, now);
            let progress = Progress {
                run_index: if n_jobs > 1 { inner.tally.n_complete } else { progress.run_index },
                n_runs,
                time_left: inner.tally.time_left(),
                n_at_a_time: n_jobs,
                share_of_all: inner.tally.made() / inner.tally.all,
                ..progress.clone()
            };
            inner.observer.advanced(&progress);
        });
    }

    fn finished(&mut self, summary: &Summary) {
        self.tell(|observer| observer.finished(summary));
    }

    fn warned(&mut self, warning: &str) {
        self.tell(|observer| observer.warned(warning));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_runs_come_at_a_time_as_cores_and_memory_carry() {
        assert_eq!(number(None, 1000, 0), cores());
        assert_eq!(number(Some(3), 12, 0), 3);
        assert_eq!(number(Some(8), 2, 0), 2);
        assert_eq!(number(None, 1, 0), 1);
        assert_eq!(number(None, 0, 0), 1);
        // Each would take all that there is.
        if let Some(free) = machine::free_memory() {
            assert_eq!(number(None, 12, free), 1);
        }
    }

    #[test]
    fn what_an_earlier_process_made_does_not_make_this_one_faster() {
        let mut tally = Tally {
            all: 400.0,
            complete: 0.0,
            given: 0.0,
            n_complete: 0,
            under_way: BTreeMap::new(),
            started: Some(Instant::now() - std::time::Duration::from_secs(10)),
        };
        tally.advance(0, 90.0, 95.0);
        tally.advance(0, 90.0, 100.0);
        tally.complete(0, 100.0);
        tally.advance(1, 0.0, 10.0);
        // 20 in 10 s, 290 to go.
        assert!((tally.time_left() - 145.0).abs() < 1.0, "{}", tally.time_left());
        assert_eq!(tally.made(), 110.0);
    }
}
