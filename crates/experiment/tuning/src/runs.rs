//! Runs of a tuning, each a study of its own in the tuning's folder.

use crate::folder::Folder;
use crate::{TuningError, TuningFile, Watch};
use basis::records::Summary;
use formats::records::{self, RunFolder};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use study::{Observer, Outcome, Progress, StudyOptions};

/// What a study warns of that has its baseline in another folder.
const NO_GAINS: &str = "has no gains: the run";

/// Whoever watches, shared by runs that are made side by side.
pub(crate) type Watcher<'a> = Mutex<&'a mut (dyn Watch + Send)>;

/// What makes runs.
#[derive(Clone, Copy)]
pub(crate) struct Runs<'a> {
    pub(crate) file: &'a TuningFile,
    pub(crate) stop: &'a AtomicBool,
    pub(crate) watcher: &'a Watcher<'a>,
}

/// Tells what happens in one study.
struct Told<'a>(&'a Watcher<'a>);

/// The watcher, also after a panic elsewhere.
pub(crate) fn held<'a, 'w>(watcher: &'a Watcher<'w>) -> MutexGuard<'a, &'w mut (dyn Watch + Send)> {
    watcher.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Observer for Told<'_> {
    fn advanced(&mut self, progress: &Progress) {
        held(self.0).advanced(progress);
    }

    fn preparing(&mut self, what: &str, share: f64) {
        held(self.0).preparing(what, share);
    }

    fn finished(&mut self, summary: &Summary) {
        held(self.0).finished(summary);
    }

    fn warned(&mut self, warning: &str) {
        if !warning.contains(NO_GAINS) {
            held(self.0).warned(warning);
        }
    }
}

impl Runs<'_> {
    /// Makes the baseline in `folder`, where one serves all points; whether it is complete.
    ///
    /// # Errors
    /// [`TuningError::Study`].
    pub(crate) fn baseline(&self, folder: &Folder) -> Result<bool, TuningError> {
        if !self.file.is_of_run_alone() {
            return Ok(true);
        }
        let set = self.file.set.clone();
        let options = StudyOptions {
            runs: vec![self.file.baseline.clone()],
            overrides: set,
            ..StudyOptions::default()
        };
        self.make(&folder.baseline(), options)
    }

    /// Makes `points`, the first of them number `first`, as many at a time as the file says; whether all are
    /// complete.
    ///
    /// # Errors
    /// [`TuningError::Study`].
    pub(crate) fn points(
        &self,
        folder: &Folder,
        first: usize,
        points: &[Vec<f64>],
    ) -> Result<bool, TuningError> {
        let n = self.file.parallel.min(points.len());
        let threads = (n > 1).then(|| (study::cores() / n).max(1));
        let (next, whole) = (AtomicUsize::new(0), AtomicBool::new(true));
        let failed = Mutex::new(None);
        let worker = || {
            loop {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let is_over = !whole.load(Ordering::Relaxed) || place >= points.len();
                if is_over {
                    return;
                }
                match self.point(folder, first + place, (&points[place], threads)) {
                    Ok(true) => {}
                    Ok(false) => whole.store(false, Ordering::Relaxed),
                    Err(error) => {
                        whole.store(false, Ordering::Relaxed);
                        failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..n {
                scope.spawn(worker);
            }
            worker();
        });
        match failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(error),
            None => Ok(whole.into_inner()),
        }
    }

    /// Makes `point`, number `index`, on so many `threads`; whether it is complete.
    fn point(
        &self,
        folder: &Folder,
        index: usize,
        (point, threads): (&[f64], Option<usize>),
    ) -> Result<bool, TuningError> {
        let place = folder.point(index);
        let own = vec![self.file.run.clone()];
        let runs = if self.file.is_of_run_alone() {
            known_before(&folder.baseline(), &place)?;
            own
        } else {
            [vec![self.file.baseline.clone()], own].concat()
        };
        let options = StudyOptions {
            runs,
            overrides: self.file.overrides(point),
            threads,
            // As the baseline was, of which it differs in control alone.
            is_checked: self.file.is_of_run_alone(),
            ..StudyOptions::default()
        };
        self.make(&place, options)
    }

    /// Makes what `options` ask for of the case in the folder `place`, or goes on with it.
    fn make(&self, place: &Path, options: StudyOptions) -> Result<bool, TuningError> {
        let options = StudyOptions {
            case: self.file.case.clone(),
            output: Some(place.to_owned()),
            resume: records::is_begun(place),
            jobs: Some(1),
            ..options
        };
        let outcome = study::run(&options, self.stop, &mut Told(self.watcher))?;
        Ok(matches!(outcome, Outcome::Done { .. }))
    }

    /// Folders of the run of point number `index` in `folder` and of what it compares with.
    pub(crate) fn pair(&self, folder: &Folder, index: usize) -> [RunFolder; 2] {
        let point = folder.point(index);
        let other = if self.file.is_of_run_alone() { folder.baseline() } else { point.clone() };
        [RunFolder::new(&point, &self.file.run), RunFolder::new(&other, &self.file.baseline)]
    }
}

/// Hands what was identified of pitch before the `baseline` on to the study in `place`, which would find the
/// same again.
fn known_before(baseline: &Path, place: &Path) -> Result<(), TuningError> {
    if records::is_begun(place) {
        return Ok(());
    }
    let known = records::read_pitch_responses(baseline)?;
    if !known.is_empty() {
        records::write_pitch_responses(place, &known)?;
    }
    Ok(())
}
