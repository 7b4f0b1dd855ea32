//! Studies whose runs several threads make: each study is made ready once, by the first that needs it, and
//! what is large of it goes with its last run.

use super::{Opened, references};
use crate::StudyError;
use crate::jobs::{Shared, held};
use crate::observer::Observer;
use crate::prepared::Prepared;
use crate::ready::Ready;
use crate::self_check::SelfChecked;
use crate::study::Study;
use farm::plan::Effort;
use formats::records::{PitchResponseRecord, RunFolder};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// A run to be made.
pub(super) struct Task {
    /// Place of its study.
    part: usize,
    /// Place of the run in its case.
    index: usize,
    /// What its steps cost.
    pub(super) effort: Effort,
    /// Steps of the run (–).
    pub(super) n_steps: u64,
    /// Places among the tasks of those whose runs it takes a reference from.
    pub(super) after: Vec<usize>,
}

/// All studies.
pub(super) struct Parts<'a> {
    pub(super) directory: PathBuf,
    pub(super) list: Vec<Part<'a>>,
    /// Pitch responses that are known, of all studies.
    pub(super) known: Mutex<Vec<PitchResponseRecord>>,
    /// Whether what was there has been taken away, where it is to be.
    pub(super) cleared: Mutex<bool>,
}

/// A study.
pub(super) struct Part<'a> {
    folder: String,
    study: Study<'a>,
    stage: Mutex<Stage>,
    /// Runs that are still to be made (–).
    n_left: AtomicUsize,
}

/// How far a study is.
enum Stage {
    Prepared(Box<(Prepared, SelfChecked)>),
    Ready(Arc<Ready>),
    Over(Box<Prepared>),
    /// It could not be made ready.
    Failed,
}

impl<'a> Part<'a> {
    pub(super) fn new(opened: Opened<'a>) -> Self {
        let Opened { folder, study, prepared, checked } = opened;
        let n_left = AtomicUsize::new(study.open.len());
        let stage = Mutex::new(Stage::Prepared(Box::new((prepared, checked))));
        Self { folder, study, stage, n_left }
    }

    /// The study with what was prepared for it, once its runs are made.
    ///
    /// # Panics
    /// When a run of it could not be made, which ends the sweep before.
    pub(super) fn over(self) -> (Study<'a>, Prepared) {
        let stage = self.stage.into_inner().unwrap_or_else(PoisonError::into_inner);
        let prepared = match stage {
            Stage::Prepared(prepared) => prepared.0,
            Stage::Over(prepared) => *prepared,
            Stage::Ready(_) | Stage::Failed => panic!("its runs are not made"),
        };
        (self.study, prepared)
    }

    /// Lets go what is large of the study after its last run.
    fn one_less(&self) {
        if self.n_left.fetch_sub(1, Ordering::AcqRel) > 1 {
            return;
        }
        let mut stage = held(&self.stage);
        *stage = match std::mem::replace(&mut *stage, Stage::Failed) {
            Stage::Ready(ready) => match Arc::try_unwrap(ready) {
                Ok(ready) => Stage::Over(Box::new(ready.prepared)),
                Err(ready) => Stage::Ready(ready),
            },
            other => other,
        };
    }

    /// The study, ready; a break when `stop` asked for an end before it was.
    fn ready(
        &self,
        known: &Mutex<Vec<PitchResponseRecord>>,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), Arc<Ready>>, StudyError> {
        let mut stage = held(&self.stage);
        let (prepared, checked) = match std::mem::replace(&mut *stage, Stage::Failed) {
            Stage::Prepared(prepared) => *prepared,
            Stage::Ready(ready) => {
                *stage = Stage::Ready(Arc::clone(&ready));
                return Ok(ControlFlow::Continue(ready));
            }
            // Another thread tells why.
            Stage::Over(_) | Stage::Failed => return Ok(ControlFlow::Break(())),
        };
        // Who has something to find keeps the others waiting, who may need the same.
        let mut all = held(known);
        let identifications = prepared.identifications(&self.study.open, all.clone());
        let foreign: BTreeSet<String> = self.foreign(&all)?;
        let ready = if identifications.is_empty() {
            drop(all);
            let keep = &mut |_: &[_]| Ok(());
            Ready::new(prepared, checked, identifications, keep, stop, observer)?
        } else {
            let keep = &mut |found: &[PitchResponseRecord]| {
                *all = found.to_vec();
                let own = found.iter().filter(|record| !foreign.contains(&record.key));
                self.study.keep_pitch_responses(&own.cloned().collect::<Vec<_>>())
            };
            Ready::new(prepared, checked, identifications, keep, stop, observer)?
        };
        let ControlFlow::Continue(ready) = ready else { return Ok(ControlFlow::Break(())) };
        let ready = Arc::new(ready);
        *stage = Stage::Ready(Arc::clone(&ready));
        Ok(ControlFlow::Continue(ready))
    }

    /// Keys of those of `known` that the study's own folder does not hold.
    fn foreign(&self, known: &[PitchResponseRecord]) -> Result<BTreeSet<String>, StudyError> {
        let own = formats::records::read_pitch_responses(&self.study.directory)?;
        let is_own = |key: &str| own.iter().any(|record| record.key == key);
        Ok(known.iter().map(|r| r.key.clone()).filter(|key| !is_own(key)).collect())
    }
}

impl Parts<'_> {
    /// All runs that are to be made, in order; those that others take a reference from come first.
    pub(super) fn tasks(&self) -> Vec<Task> {
        let mut tasks = Vec::new();
        let mut needs = Vec::new();
        for (part, Part { study, stage, .. }) in self.list.iter().enumerate() {
            let Stage::Prepared(prepared) = &*held(stage) else { continue };
            let plan = &prepared.0.plan;
            let (effort, n_steps) = (plan.effort(), plan.n_steps);
            for &index in &study.open {
                tasks.push(Task { part, index, effort, n_steps, after: Vec::new() });
                needs.push(references::places(&prepared.0, index));
            }
        }
        let own = tasks
            .iter()
            .map(|task| references::place(self.list[task.part].study.folders[task.index].path()));
        let (order, after) = references::in_order(&own.collect::<Vec<_>>(), &needs);
        let mut tasks: Vec<Option<Task>> = tasks.into_iter().map(Some).collect();
        let ordered = order.into_iter().zip(after);
        ordered.filter_map(|(place, after)| Some(Task { after, ..tasks[place].take()? })).collect()
    }

    /// Makes the run of `task`, which is the `place`-th of all; where it is to `overwrite`, what was there of
    /// any run goes before the first. A break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError`].
    pub(super) fn make(
        &self,
        task: &Task,
        place: (usize, usize),
        overwrite: bool,
        stop: &AtomicBool,
        shared: &Shared,
    ) -> Result<ControlFlow<()>, StudyError> {
        let part = &self.list[task.part];
        let mut observer = shared.of_run(&part.folder, place.0, task.effort);
        let ready = match part.ready(&self.known, stop, &mut observer)? {
            ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            ControlFlow::Continue(ready) => ready,
        };
        if overwrite {
            self.clear()?;
        }
        observer.begin();
        let made = part.study.make(&ready, task.index, place, stop, &mut observer)?;
        drop(ready);
        if made.is_continue() {
            observer.complete(task.n_steps);
            part.one_less();
        }
        Ok(made)
    }

    /// Takes away what was there before the first run, so that wherever this is stopped, what is left is of
    /// it alone and can be resumed.
    fn clear(&self) -> Result<(), StudyError> {
        let mut cleared = held(&self.cleared);
        if !*cleared {
            let studies = self.list.iter().map(|part| &part.study);
            let mut folders =
                studies.flat_map(|study| study.open.iter().map(|&index| &study.folders[index]));
            folders.try_for_each(RunFolder::clear)?;
            *cleared = true;
        }
        Ok(())
    }
}
