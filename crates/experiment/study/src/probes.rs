//! Probing before the runs: how the pitch of a turbine acts, found once for turbines that are alike, kept in the study's folder.

use crate::StudyError;
use crate::prepare::Setup;
use crate::watcher::{Probing, Watcher};
use basis::records::PitchResponse;
use estimation::helix::Calibration;
use farm::case::{Control, Decoupling, Meandering, PhaseEstimator, PhaseSync};
use farm::pitch_response::{ProbeCost, calibration, calibration_cost, decoupling, decoupling_cost};
use formats::records::{ProbeRecord, read_probes, sha256, write_probes};
use std::path::Path;
use std::time::{Duration, Instant};

/// Wall time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// One thing to be found.
pub(crate) struct Probe {
    /// Turbine of the case.
    index: usize,
    asked: Asked,
    /// Digest of everything that decides what is found.
    key: String,
    cost: ProbeCost,
}

/// Whose pitch is probed for what.
#[derive(Clone, Copy)]
enum Asked {
    Calibration(PhaseSync),
    Decoupling(Meandering),
}

impl Probe {
    /// What it costs.
    pub(crate) fn cost(&self) -> ProbeCost {
        self.cost
    }
}

impl Asked {
    /// What `control` needs to have found; nothing where it is told, or pitches nothing.
    fn of(control: &Control) -> Option<Self> {
        match *control {
            Control::PhaseSync(sync) => {
                let needs = sync.estimator == PhaseEstimator::Robust && sync.amplitude != 0.0;
                needs.then_some(Self::Calibration(sync))
            }
            Control::Meandering(asked) => {
                let needs = asked.decoupling.is_none() && asked.amplitude != 0.0;
                needs.then_some(Self::Decoupling(asked))
            }
            _ => None,
        }
    }
}

impl Setup {
    /// What `runs` need to have found, each once.
    fn probes(&self, runs: &[usize]) -> Vec<Probe> {
        let mut probes: Vec<Probe> = Vec::new();
        for &run in runs {
            for (index, control) in self.case.runs[run].control.iter().enumerate() {
                let Some(asked) = Asked::of(control) else { continue };
                let key = self.key(index, &asked);
                if probes.iter().all(|probe| probe.key != key) {
                    let (case, plan, model) = (&self.case, &self.plan, &self.models[index]);
                    let cost = match &asked {
                        Asked::Calibration(sync) => calibration_cost(case, plan, model, sync),
                        Asked::Decoupling(asked) => decoupling_cost(case, plan, model, asked),
                    };
                    probes.push(Probe { index, asked, key, cost });
                }
            }
        }
        probes
    }

    /// Digest of everything that decides what is found for turbine number `index`: offset, start and fallback do not.
    fn key(&self, index: usize, asked: &Asked) -> String {
        let (case, plan) = (&self.case, &self.plan);
        let placement = &case.turbines[index];
        let turbine = self.turbine_texts.get(&placement.model).map_or("", String::as_str);
        let asked = match asked {
            Asked::Calibration(sync) => format!(
                "calibration {:?} {:?} {:?} {:?}",
                sync.sense, sync.amplitude, sync.strouhal, sync.azimuth_offset
            ),
            Asked::Decoupling(asked) => format!("decoupling {:?}", asked.strouhal),
        };
        let wind = &case.wind;
        sha256(
            format!(
                "{} {} {} {} {asked} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {turbine}",
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

    /// What `runs` need to have found; with `resume` what an earlier session found in the folder `directory` is left out.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn open_probes(
        &self,
        runs: &[usize],
        directory: &Path,
        resume: bool,
    ) -> Result<Vec<Probe>, StudyError> {
        let known = if resume { read_probes(directory)? } else { Vec::new() };
        let mut probes = self.probes(runs);
        probes.retain(|probe| known.iter().all(|old| old.key != probe.key));
        Ok(probes)
    }

    /// On return the case knows, for `runs`, what the phase estimator of every turbine that joins a helix makes of its own
    /// pitch, and how pitch acts on the loads of every turbine that acts on meandering and is not told. What was found is
    /// kept in the folder `directory`; with `resume` what an earlier session found there is taken.
    ///
    /// # Errors
    /// [`StudyError::Calibration`] when it cannot be found, [`StudyError::File`] when it cannot be kept.
    pub fn calibrate(
        &mut self,
        runs: &[usize],
        directory: &Path,
        resume: bool,
        watcher: &mut dyn Watcher,
    ) -> Result<(), StudyError> {
        let mut known = if resume { read_probes(directory)? } else { Vec::new() };
        let open = self.open_probes(runs, directory, resume)?;
        let started = Instant::now();
        let all: f64 = open.iter().map(|probe| probe.cost.work()).sum();
        let mut done = 0.0;
        for (place, probe) in open.iter().enumerate() {
            let name = &self.case.turbines[probe.index].name;
            let mut last: Option<Instant> = None;
            let mut told = |share: f64| {
                if last.is_some_and(|last| last.elapsed() < PROGRESS_INTERVAL) {
                    return;
                }
                last = Some(Instant::now());
                let made = done + share * probe.cost.work();
                let elapsed = started.elapsed().as_secs_f64();
                watcher.probing(&Probing {
                    turbine: name,
                    index: place,
                    n_probes: open.len(),
                    share,
                    time_left: elapsed * (all - made) / made.max(f64::MIN_POSITIVE),
                });
            };
            let (case, plan, model) = (&self.case, &self.plan, &self.models[probe.index]);
            let response = match &probe.asked {
                Asked::Calibration(sync) => record_of_calibration(&calibration(
                    case,
                    plan,
                    model,
                    probe.index,
                    sync,
                    &mut told,
                )?),
                Asked::Decoupling(asked) => record_of_decoupling(&decoupling(
                    case,
                    plan,
                    model,
                    probe.index,
                    asked,
                    &mut told,
                )?),
            };
            done += probe.cost.work();
            let (key, turbine) = (probe.key.clone(), name.clone());
            known.push(ProbeRecord { key, turbine, response });
            write_probes(directory, &known)?;
        }
        for probe in self.probes(runs) {
            let name = &self.case.turbines[probe.index].name;
            if let Some(found) = known.iter().find(|found| found.key == probe.key) {
                let again = open.iter().all(|open| open.key != probe.key);
                watcher.probed(name, &found.response, again);
            }
        }
        self.tell(runs, &known);
        Ok(())
    }

    /// On return the controllers of `runs` are told what is `known`.
    fn tell(&mut self, runs: &[usize], known: &[ProbeRecord]) {
        for &run in runs {
            for index in 0..self.case.turbines.len() {
                let control = self.case.runs[run].control[index];
                let Some(asked) = Asked::of(&control) else { continue };
                let key = self.key(index, &asked);
                let Some(found) = known.iter().find(|found| found.key == key) else { continue };
                let told = match asked {
                    Asked::Calibration(sync) => {
                        let calibration = calibration_of(&found.response);
                        Control::PhaseSync(PhaseSync { calibration, ..sync })
                    }
                    Asked::Decoupling(asked) => {
                        let decoupling = decoupling_of(&found.response);
                        Control::Meandering(Meandering { decoupling, ..asked })
                    }
                };
                self.case.runs[run].control[index] = told;
            }
        }
    }
}

/// What `control` was told of its turbine's own pitch, for the record.
pub(crate) fn response_of(control: &Control) -> Option<PitchResponse> {
    match control {
        Control::PhaseSync(sync) => sync.calibration.as_ref().map(record_of_calibration),
        Control::Meandering(asked) => asked.decoupling.as_ref().map(record_of_decoupling),
        _ => None,
    }
}

fn record_of_calibration(found: &Calibration) -> PitchResponse {
    let Calibration { gain, azimuth_offset, before, after } = *found;
    PitchResponse::Estimator { gain, azimuth_offset, before, after }
}

fn record_of_decoupling(found: &Decoupling) -> PitchResponse {
    let Decoupling { azimuth_offset, delay, gain } = *found;
    PitchResponse::Loads { azimuth_offset, delay, gain }
}

fn calibration_of(response: &PitchResponse) -> Option<Calibration> {
    match *response {
        PitchResponse::Estimator { gain, azimuth_offset, before, after } => {
            Some(Calibration { gain, azimuth_offset, before, after })
        }
        PitchResponse::Loads { .. } => None,
    }
}

fn decoupling_of(response: &PitchResponse) -> Option<Decoupling> {
    match *response {
        PitchResponse::Loads { azimuth_offset, delay, gain } => {
            Some(Decoupling { azimuth_offset, delay, gain })
        }
        PitchResponse::Estimator { .. } => None,
    }
}
