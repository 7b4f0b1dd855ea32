//! Probing before the runs: how the pitch of a turbine acts, found once for turbines that are alike, kept in the study's folder.

use crate::StudyError;
use crate::models::text_names;
use crate::prepared::Prepared;
use crate::watcher::{Probing, Watcher};
use basis::records::PitchResponse;
use control::Identification;
use control::phase_sync::{PhaseEstimator, PhaseNoise, response_of};
use farm::Progress;
use farm::case::DynamicInflow;
use farm::pitch_response::{
    CalibrationError, INDIVIDUAL_PITCH_STROUHAL, ProbeCost, decoupling, decoupling_cost,
    individual_pitch_offset, individual_pitch_offset_cost, own_pitch, own_pitch_cost,
};
use formats::records::{ProbeRecord, sha256};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Takes what pitch-response identification has found so far, each time something is added to it.
pub(crate) type Keep<'a> = &'a mut dyn FnMut(&[ProbeRecord]) -> Result<(), StudyError>;

/// Wall time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// One thing to be found.
struct Probe {
    /// Runs and turbines of the case that need it; the first turbine is probed for all.
    places: Vec<(usize, usize)>,
    asked: Asked,
    /// Digest of everything that decides what is found.
    key: String,
    cost: ProbeCost,
}

/// What the runs of a study need to have found, each once, and what is known.
pub(crate) struct Probes {
    wanted: Vec<Probe>,
    known: Vec<ProbeRecord>,
}

impl Probes {
    fn found(&self, probe: &Probe) -> Option<&PitchResponse> {
        let mut known = self.known.iter();
        known.find(|found| found.key == probe.key).map(|found| &found.response)
    }

    /// What is not known yet.
    fn open(&self) -> impl Iterator<Item = &Probe> {
        self.wanted.iter().filter(|probe| self.found(probe).is_none())
    }

    /// What it costs to find what is not known yet, each.
    pub(crate) fn costs(&self) -> Vec<ProbeCost> {
        self.open().map(|probe| probe.cost).collect()
    }
}

/// Whose pitch is probed for what.
#[derive(Clone, Copy)]
enum Asked {
    /// Azimuth offset of individual pitch control.
    IndividualPitch,
    /// What a kind of controller needs to know.
    Control(Identification),
}

impl Prepared {
    /// What `runs` need to have found, each with the run and the turbine that need it. Individual pitch control comes first: it
    /// is at work while a turbine is probed for the rest.
    fn asked(&self, runs: &[usize]) -> Vec<(usize, usize, Asked)> {
        let (mut first, mut rest) = (Vec::new(), Vec::new());
        for &run in runs {
            for (index, control) in self.case.runs[run].control.iter().enumerate() {
                if control.is_there() && self.models[index].lacks_individual_pitch_offset() {
                    first.push((run, index, Asked::IndividualPitch));
                }
                let identification = control.kind().identification(control);
                rest.extend(identification.map(|asked| (run, index, Asked::Control(asked))));
            }
        }
        first.append(&mut rest);
        first
    }

    /// What `runs` need to have found, each once, where `known` was found before.
    pub(crate) fn probes(&self, runs: &[usize], known: Vec<ProbeRecord>) -> Probes {
        let mut wanted: Vec<Probe> = Vec::new();
        for (run, index, asked) in self.asked(runs) {
            let key = self.key(index, &asked);
            if let Some(probe) = wanted.iter_mut().find(|probe| probe.key == key) {
                probe.places.push((run, index));
                continue;
            }
            let (case, plan, model) = (&self.case, &self.plan, &self.models[index]);
            let cost = match &asked {
                Asked::IndividualPitch => individual_pitch_offset_cost(case, plan, model),
                Asked::Control(Identification::OwnPitch(sync)) => {
                    own_pitch_cost(case, plan, model, sync)
                }
                Asked::Control(Identification::Loads { strouhal }) => {
                    decoupling_cost(case, plan, model, *strouhal)
                }
            };
            wanted.push(Probe { places: vec![(run, index)], asked, key, cost });
        }
        Probes { wanted, known }
    }

    /// Digest of everything that decides what is found for turbine number `index`: offset, start and fallback do not.
    fn key(&self, index: usize, asked: &Asked) -> String {
        let (case, plan) = (&self.case, &self.plan);
        let placement = &case.turbines[index];
        let text = |name: &String| self.turbine_texts.get(name).map_or("", String::as_str);
        let turbine = text(&placement.model);
        let controller: String = match &placement.discon {
            None => String::new(),
            Some(path) => text_names(path).iter().map(text).collect(),
        };
        let asked = match asked {
            Asked::IndividualPitch => format!("individual pitch {INDIVIDUAL_PITCH_STROUHAL:?}"),
            Asked::Control(Identification::OwnPitch(sync))
                if sync.estimator == PhaseEstimator::Published =>
            {
                format!("azimuth offset {:?}", sync.strouhal)
            }
            Asked::Control(Identification::OwnPitch(sync)) => format!(
                "calibration {:?} {:?} {:?} {}{}",
                sync.sense,
                sync.amplitude,
                sync.strouhal,
                sync.azimuth_offset.map_or("found".to_owned(), |given| format!("{given:?}")),
                trace(&sync.noise)
            ),
            Asked::Control(Identification::Loads { strouhal }) => {
                format!("decoupling {strouhal:?}")
            }
        };
        // The usual one leaves no trace, so that what was found before one could choose is still known.
        let usual = DynamicInflow::default();
        let inflow = match placement.dynamic_inflow {
            inflow if inflow == usual => String::new(),
            inflow => format!(" {inflow:?}"),
        };
        let wind = &case.wind;
        sha256(
            format!(
                "{} {} {} {}{inflow} {asked} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {turbine}{controller}",
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

    /// On return the models know the azimuth offset of every individual pitch control, and the case with which azimuth offset
    /// every turbine pitches that joins a helix, and what its phase estimator makes of that, and how pitch acts on the loads of
    /// every turbine that acts on meandering and is not told, as far as `probes` name them. What is found goes to `keep`. A
    /// break when `stop` asked for an end before all was found.
    ///
    /// # Errors
    /// [`StudyError::Calibration`] when it cannot be found, and what `keep` errs with.
    pub(crate) fn calibrate(
        &mut self,
        probes: Probes,
        keep: Keep,
        stop: &AtomicBool,
        watcher: &mut dyn Watcher,
    ) -> Result<ControlFlow<()>, StudyError> {
        let n_probes = probes.open().count();
        let all: f64 = probes.open().map(|probe| probe.cost.work).sum();
        let mut known = probes.known.clone();
        let started = Instant::now();
        let (mut place, mut done) = (0, 0.0);
        for probe in &probes.wanted {
            let index = probe.places[0].1;
            let name = self.case.turbines[index].name.clone();
            if let Some(found) = probes.found(probe) {
                watcher.probed(&name, found, true);
                self.tell(probe, found);
                continue;
            }
            let mut last: Option<Instant> = None;
            let mut told = |share: f64| {
                if stop.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                if last.is_some_and(|last| last.elapsed() < PROGRESS_INTERVAL) {
                    return ControlFlow::Continue(());
                }
                last = Some(Instant::now());
                let made = done + share * probe.cost.work;
                let elapsed = started.elapsed().as_secs_f64();
                watcher.probing(&Probing {
                    turbine: &name,
                    index: place,
                    n_probes,
                    share,
                    time_left: elapsed * (all - made) / made.max(f64::MIN_POSITIVE),
                });
                ControlFlow::Continue(())
            };
            let response = match self.find(index, &probe.asked, &mut told) {
                Err(CalibrationError::BrokenOff) => return Ok(ControlFlow::Break(())),
                found => found?,
            };
            place += 1;
            done += probe.cost.work;
            known.push(ProbeRecord { key: probe.key.clone(), turbine: name.clone(), response });
            keep(&known)?;
            watcher.probed(&name, &response, false);
            self.tell(probe, &response);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Probes turbine number `index` for what is `asked`; `progress` is told the share done.
    fn find(
        &self,
        index: usize,
        asked: &Asked,
        progress: Progress,
    ) -> Result<PitchResponse, CalibrationError> {
        let (case, plan, model) = (&self.case, &self.plan, &self.models[index]);
        match asked {
            Asked::IndividualPitch => individual_pitch_offset(case, plan, model, index, progress)
                .map(|azimuth_offset| PitchResponse::IndividualPitch { azimuth_offset }),
            Asked::Control(Identification::OwnPitch(sync)) => {
                own_pitch(case, plan, model, index, sync, progress)
                    .map(|found| response_of(found.azimuth_offset, found.calibration))
            }
            Asked::Control(Identification::Loads { strouhal }) => {
                decoupling(case, plan, model, index, *strouhal, progress).map(PitchResponse::from)
            }
        }
    }

    /// On return all that need `probe` know what was `found`.
    fn tell(&mut self, probe: &Probe, found: &PitchResponse) {
        for &(run, index) in &probe.places {
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

/// What `noise` leaves in the digest of a calibration: nothing where none is given, so that what was found before one could
/// give any is still known.
fn trace(noise: &PhaseNoise) -> String {
    if *noise == PhaseNoise::default() { String::new() } else { format!(" {noise:?}") }
}

#[cfg(test)]
mod tests;
