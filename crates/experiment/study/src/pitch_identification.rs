//! Pitch-response identification before the runs: once for turbines that are alike, kept in the study's
//! folder.

use crate::StudyError;
use crate::models::text_names;
use crate::observer::{IdentificationProgress, Observer};
use crate::prepared::Prepared;
use basis::records::PitchResponse;
use control::Identification;
use control::phase_sync::{PhaseEstimator, response_of};
use farm::Progress;
use farm::case::{DynamicInflow, Method};
use farm::pitch_response::{
    CalibrationError, INDIVIDUAL_PITCH_STROUHAL, IdentificationCost, decoupling, decoupling_cost,
    individual_pitch_offset, individual_pitch_offset_cost, own_pitch, own_pitch_cost,
};
use formats::records::{PitchResponseRecord, sha256};
use std::collections::BTreeSet;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Takes what pitch-response identification has found so far, each time something is added to it.
pub(crate) type Keep<'a> = &'a mut dyn FnMut(&[PitchResponseRecord]) -> Result<(), StudyError>;

/// Wall time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// One thing to be found.
struct PitchIdentification {
    /// Runs and turbines of the case that need it; the first turbine is identified for all.
    places: Vec<(usize, usize)>,
    needed: Needed,
    /// Digest of everything that decides what is found.
    key: String,
    cost: IdentificationCost,
}

/// What the runs of a study need to have found, each once, and what is known.
pub(crate) struct PitchIdentifications {
    wanted: Vec<PitchIdentification>,
    known: Vec<PitchResponseRecord>,
}

impl PitchIdentifications {
    fn found(&self, identification: &PitchIdentification) -> Option<&PitchResponse> {
        let mut known = self.known.iter();
        known.find(|found| found.key == identification.key).map(|found| &found.response)
    }

    /// What is not known yet.
    fn open(&self) -> impl Iterator<Item = &PitchIdentification> {
        self.wanted.iter().filter(|identification| self.found(identification).is_none())
    }

    /// What it costs to find what is not known yet, each; what is in `counted` already is left out, and on
    /// return all of it is.
    pub(crate) fn costs(&self, counted: &mut BTreeSet<String>) -> Vec<IdentificationCost> {
        let new = self.open().filter(|identification| counted.insert(identification.key.clone()));
        new.map(|identification| identification.cost).collect()
    }

    /// Whether nothing is to be found.
    pub(crate) fn is_empty(&self) -> bool {
        self.open().next().is_none()
    }
}

/// Whose pitch response is identified for what.
#[derive(Clone, Copy)]
enum Needed {
    /// Azimuth offset of individual pitch control.
    IndividualPitch,
    /// What a kind of controller needs to know.
    Control(Identification),
}

impl Prepared {
    /// What `runs` need to have found, each with the run and the turbine that need it. Individual pitch
    /// control comes first: it is at work while a turbine is identified for the rest.
    fn needed(&self, runs: &[usize]) -> Vec<(usize, usize, Needed)> {
        let (mut first, mut rest) = (Vec::new(), Vec::new());
        for &run in runs {
            for (index, control) in self.case.runs[run].control.iter().enumerate() {
                if control.is_there() && self.models[index].lacks_individual_pitch_offset() {
                    first.push((run, index, Needed::IndividualPitch));
                }
                let identification = control.kind().identification(control);
                rest.extend(identification.map(|needed| (run, index, Needed::Control(needed))));
            }
        }
        first.append(&mut rest);
        first
    }

    /// What `runs` need to have found, each once, where `known` was found before.
    pub(crate) fn identifications(
        &self,
        runs: &[usize],
        known: Vec<PitchResponseRecord>,
    ) -> PitchIdentifications {
        let mut wanted: Vec<PitchIdentification> = Vec::new();
        for (run, index, needed) in self.needed(runs) {
            let key = self.key(index, &needed);
            if let Some(identification) =
                wanted.iter_mut().find(|identification| identification.key == key)
            {
                identification.places.push((run, index));
                continue;
            }
            let (case, plan, model) = (&self.case, &self.plan.alone(index), &self.models[index]);
            let cost = match &needed {
                Needed::IndividualPitch => individual_pitch_offset_cost(case, plan, model),
                Needed::Control(Identification::OwnPitch(sync)) => {
                    own_pitch_cost(case, plan, model, sync)
                }
                Needed::Control(Identification::Loads { strouhal }) => {
                    decoupling_cost(case, plan, model, *strouhal)
                }
            };
            wanted.push(PitchIdentification { places: vec![(run, index)], needed, key, cost });
        }
        PitchIdentifications { wanted, known }
    }

    /// Digest of everything that decides what is found for turbine number `index`: offset, start and fallback
    /// do not.
    fn key(&self, index: usize, needed: &Needed) -> String {
        let (case, plan) = (&self.case, &self.plan.alone(index));
        let placement = &case.turbines[index];
        let text = |name: &String| self.turbine_texts.get(name).map_or("", String::as_str);
        let turbine = text(&placement.model);
        let controller: String = match (&placement.discon, placement.torque_gain) {
            (Some(path), _) => text_names(path).iter().map(text).collect(),
            (None, Some(gain)) => format!(" {gain:?}"),
            (None, None) => String::new(),
        };
        let needed = match needed {
            Needed::IndividualPitch => format!("individual pitch {INDIVIDUAL_PITCH_STROUHAL:?}"),
            Needed::Control(Identification::OwnPitch(sync))
                if sync.estimator != PhaseEstimator::Robust =>
            {
                format!("azimuth offset {:?}", sync.strouhal)
            }
            Needed::Control(Identification::OwnPitch(sync)) => format!(
                "calibration {:?} {:?} {:?} {}{}",
                sync.sense,
                sync.amplitude,
                sync.strouhal,
                sync.azimuth_offset.map_or("found".to_owned(), |given| format!("{given:?}")),
                trace(&sync.noise) + &trace(&sync.choices)
            ),
            Needed::Control(Identification::Loads { strouhal }) => {
                format!("decoupling {strouhal:?}")
            }
        };
        // The usual one leaves no trace, so that what was found before one could choose is still known.
        let usual = DynamicInflow::default();
        let inflow = match placement.dynamic_inflow {
            inflow if inflow == usual => String::new(),
            inflow => format!(" {inflow:?}"),
        };
        let method = match plan.method {
            method if method == Method::default() => String::new(),
            method => format!(" {method:?}"),
        };
        let wind = &case.wind;
        sha256(
            format!(
                "{} {} {} {}{inflow}{method} {needed} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {turbine}{controller}",
                env!("CARGO_PKG_VERSION"),
                placement.model,
                placement.flexible,
                placement.dynamic_stall,
                case.flow.solver,
                wind.speed,
                wind.air_density,
                wind.kinematic_viscosity,
                plan.diameter,
                plan.spacing,
                plan.interval,
            )
            .as_bytes(),
        )
    }

    /// On return the models know the azimuth offset of every individual pitch control, and the case with
    /// which azimuth offset every turbine pitches that joins a helix, and what its phase estimator makes of
    /// that, and how pitch acts on the loads of every turbine that acts on meandering and is not given it, as
    /// far as `identifications` name them. What is found goes to `keep`. A break when `stop` asked for an end
    /// before all was found.
    ///
    /// # Errors
    /// [`StudyError::Calibration`] when it cannot be found, and what `keep` errs with.
    pub(crate) fn calibrate(
        &mut self,
        identifications: PitchIdentifications,
        keep: Keep,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<()>, StudyError> {
        let n_identifications = identifications.open().count();
        let all: f64 = identifications.open().map(|identification| identification.cost.work).sum();
        let mut known = identifications.known.clone();
        let started = Instant::now();
        let (mut place, mut done) = (0, 0.0);
        for identification in &identifications.wanted {
            let index = identification.places[0].1;
            let name = self.case.turbines[index].name.clone();
            if let Some(found) = identifications.found(identification) {
                observer.identified(&name, found, true);
                self.tell(identification, found);
                continue;
            }
            let mut last: Option<Instant> = None;
            let mut report = |share: f64| {
                if stop.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                if last.is_some_and(|last| last.elapsed() < PROGRESS_INTERVAL) {
                    return ControlFlow::Continue(());
                }
                last = Some(Instant::now());
                let made = done + share * identification.cost.work;
                let elapsed = started.elapsed().as_secs_f64();
                observer.identifying(&IdentificationProgress {
                    turbine: &name,
                    index: place,
                    n_identifications,
                    share,
                    time_left: elapsed * (all - made) / made.max(f64::MIN_POSITIVE),
                });
                ControlFlow::Continue(())
            };
            let response = match self.find(index, &identification.needed, &mut report) {
                Err(CalibrationError::BrokenOff) => return Ok(ControlFlow::Break(())),
                found => found?,
            };
            place += 1;
            done += identification.cost.work;
            known.push(PitchResponseRecord {
                key: identification.key.clone(),
                turbine: name.clone(),
                response,
            });
            keep(&known)?;
            observer.identified(&name, &response, false);
            self.tell(identification, &response);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Identifies turbine number `index` for what is `needed`; `progress` receives the share done.
    fn find(
        &self,
        index: usize,
        needed: &Needed,
        progress: Progress,
    ) -> Result<PitchResponse, CalibrationError> {
        let (case, plan, model) = (&self.case, &self.plan.alone(index), &self.models[index]);
        match needed {
            Needed::IndividualPitch => individual_pitch_offset(case, plan, model, index, progress)
                .map(|azimuth_offset| PitchResponse::IndividualPitch { azimuth_offset }),
            Needed::Control(Identification::OwnPitch(sync)) => {
                own_pitch(case, plan, model, index, sync, progress)
                    .map(|found| response_of(found.azimuth_offset, found.calibration))
            }
            Needed::Control(Identification::Loads { strouhal }) => {
                decoupling(case, plan, model, index, *strouhal, progress).map(PitchResponse::from)
            }
        }
    }

    /// On return all that need `identification` know what was `found`.
    fn tell(&mut self, identification: &PitchIdentification, found: &PitchResponse) {
        for &(run, index) in &identification.places {
            if let PitchResponse::IndividualPitch { azimuth_offset } = *found {
                if let Some(control) = &mut self.models[index].constants.individual_pitch {
                    control.azimuth_offset = Some(azimuth_offset);
                }
            } else {
                self.case.runs[run].control[index].response = Some(*found);
            }
        }
    }
}

/// What is `given` of an estimator leaves in the digest of a calibration: nothing where nothing is given, so
/// that what was found before one could give any is still known.
fn trace<T: Default + PartialEq + fmt::Debug>(given: &T) -> String {
    if *given == T::default() { String::new() } else { format!(" {given:?}") }
}

#[cfg(test)]
mod tests;
