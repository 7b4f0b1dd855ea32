//! The second stage: a study whose runs can begin. Pitch responses are identified, turbulence is made.

use crate::StudyError;
use crate::air;
use crate::observer::{Observer, Silent};
use crate::pitch_identification::{Keep, PitchIdentifications};
use crate::prepared::Prepared;
use crate::self_check::SelfChecked;
use farm::case::Run;
use farm::pitch_response::CalibrationError;
use farm::self_check::SelfCheckError;
use farm::{Air, Farm, assemble, wind};
use flow::Inflow;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A study whose runs can begin, in any order.
pub struct Ready {
    /// The study; its controls and models hold what pitch-response identification found, its warnings those
    /// of the self-check, too.
    pub prepared: Prepared,
    /// The wind that enters, turbulence included.
    pub inflow: Arc<dyn Inflow>,
}

impl Prepared {
    /// Does all that the runs of the case need before they begin, in silence: checks the rotors, identifies
    /// pitch responses, makes the turbulence.
    ///
    /// # Errors
    /// [`StudyError`] of the self-check, of the identification, or of turbulence that cannot be made.
    pub fn ready(self) -> Result<Ready, StudyError> {
        let (stop, observer) = (AtomicBool::new(false), &mut Silent);
        let runs: Vec<usize> = (0..self.case.runs.len()).collect();
        let identifications = self.identifications(&runs, Vec::new());
        let ControlFlow::Continue(checked) = self.self_check(&stop, observer)? else {
            return Err(SelfCheckError::BrokenOff.into());
        };
        match Ready::new(self, checked, identifications, &mut |_| Ok(()), &stop, observer)? {
            ControlFlow::Continue(ready) => Ok(ready),
            ControlFlow::Break(()) => Err(CalibrationError::BrokenOff.into()),
        }
    }
}

impl Ready {
    /// `prepared`, whose rotors are `checked`, with what `identifications` name found and kept, and the
    /// turbulence made. A break when `stop` asked for an end before all was found.
    ///
    /// # Errors
    /// [`StudyError::Calibration`], [`StudyError::Inflow`], and what `keep` errs with.
    pub(crate) fn new(
        mut prepared: Prepared,
        checked: SelfChecked,
        identifications: PitchIdentifications,
        keep: Keep,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), Self>, StudyError> {
        if prepared.calibrate(identifications, keep, stop, observer)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let inflow = {
            let observer = RefCell::new(&mut *observer);
            let reported = |share| observer.borrow_mut().preparing("turbulence", share);
            wind::entering(&prepared.site(), reported)?
        };
        let inflow = inflow.unwrap_or_else(|| Arc::clone(&prepared.mean_inflow));
        prepared.warnings.extend(checked.warnings);
        Ok(ControlFlow::Continue(Self { prepared, inflow }))
    }

    /// The farm of `run`, one of the case's, at time zero: turbines under their control in the case's air, to
    /// be stepped with [`Farm::advance`].
    ///
    /// # Errors
    /// [`StudyError`] for air that cannot be set up, and for turbines that cannot be put together.
    pub fn farm(&self, run: &Run) -> Result<Farm<Air>, StudyError> {
        let Prepared { case, plan, models, .. } = &self.prepared;
        Ok(assemble::farm(case, run, plan, models, air::begin(&self.prepared, &self.inflow)?)?)
    }
}
