//! The second stage: a study whose runs can begin. Pitch responses are identified, turbulence is made.

use crate::StudyError;
use crate::air;
use crate::observer::{Observer, Silent, making_turbulence};
use crate::pitch_identification::{Keep, PitchIdentifications};
use crate::prepared::Prepared;
use crate::self_check::SelfChecked;
use crate::warnings::SetupWarning;
use farm::case::Run;
use farm::pitch_response::CalibrationError;
use farm::self_check::SelfCheckError;
use farm::{Air, Farm, assemble, wind};
use flow::Inflow;
use flow::inflow::InflowError;
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
        let entering = {
            let observer: RefCell<&mut dyn Observer> = RefCell::new(&mut *observer);
            let is_read = wind::enters_from_file(&prepared.case);
            let planes = if is_read { Some(air::planes(&prepared)?) } else { None };
            wind::entering(&prepared.site(), planes, &making_turbulence(stop, &observer))
        };
        let inflow = match entering {
            Err(InflowError::BrokenOff) => return Ok(ControlFlow::Break(())),
            entering => entering?,
        };
        let inflow = inflow.unwrap_or_else(|| Arc::clone(&prepared.mean_inflow));
        prepared.warnings.extend(checked.warnings.into_iter().map(SetupWarning::from));
        Ok(ControlFlow::Continue(Self { prepared, inflow }))
    }

    /// The farm of `run`, one of the case's, at time zero: turbines under their control in the case's air, to
    /// be stepped with [`Farm::advance`].
    ///
    /// # Errors
    /// [`StudyError`] for air that cannot be set up, and for turbines that cannot be put together.
    pub fn farm(&self, run: &Run) -> Result<Farm<Air>, StudyError> {
        self.farm_until(run, &|_| ControlFlow::Continue(()))
    }

    /// The same; `progress` receives the share of the run's turbulence that is made, and a break ends that.
    ///
    /// # Errors
    /// Those of [`farm`](Self::farm), and [`StudyError::Inflow`] after a break.
    pub(crate) fn farm_until(
        &self,
        run: &Run,
        progress: &dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<Farm<Air>, StudyError> {
        let Prepared { case, plan, models, .. } = &self.prepared;
        let air = air::begin(&self.prepared, &self.inflow, progress)?;
        Ok(assemble::farm(case, run, plan, models, air)?)
    }
}
