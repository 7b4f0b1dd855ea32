//! Probing before the runs: how the pitch of a turbine acts, found once for turbines that are alike, kept in the study's folder.

use crate::StudyError;
use crate::models::text_names;
use crate::prepare::Setup;
use crate::watcher::{Probing, Watcher};
use basis::records::PitchResponse;
use estimation::helix::Calibration;
use farm::case::{
    Control, Decoupling, DynamicInflow, Meandering, PhaseEstimator, PhaseNoise, PhaseSync,
};
use farm::pitch_response::{
    CalibrationError, ProbeCost, calibration, calibration_cost, decoupling, decoupling_cost,
};
use formats::records::{ProbeRecord, read_probes, sha256, write_probes};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

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
    Calibration(PhaseSync),
    Decoupling(Meandering),
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
    /// What `runs` need to have found, each once; with `resume` what an earlier session found in the folder `directory` is known.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn probes(
        &self,
        runs: &[usize],
        directory: &Path,
        resume: bool,
    ) -> Result<Probes, StudyError> {
        let known = if resume { read_probes(directory)? } else { Vec::new() };
        let mut wanted: Vec<Probe> = Vec::new();
        for &run in runs {
            for (index, control) in self.case.runs[run].control.iter().enumerate() {
                let Some(asked) = Asked::of(control) else { continue };
                let key = self.key(index, &asked);
                if let Some(probe) = wanted.iter_mut().find(|probe| probe.key == key) {
                    probe.places.push((run, index));
                    continue;
                }
                let (case, plan, model) = (&self.case, &self.plan, &self.models[index]);
                let cost = match &asked {
                    Asked::Calibration(sync) => calibration_cost(case, plan, model, sync),
                    Asked::Decoupling(asked) => decoupling_cost(case, plan, model, asked),
                };
                wanted.push(Probe { places: vec![(run, index)], asked, key, cost });
            }
        }
        Ok(Probes { wanted, known })
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
            Asked::Calibration(sync) => format!(
                "calibration {:?} {:?} {:?} {:?}{}",
                sync.sense,
                sync.amplitude,
                sync.strouhal,
                sync.azimuth_offset,
                trace(&sync.noise)
            ),
            Asked::Decoupling(asked) => format!("decoupling {:?}", asked.strouhal),
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

    /// On return the case knows what the phase estimator of every turbine that joins a helix makes of its own pitch, and how
    /// pitch acts on the loads of every turbine that acts on meandering and is not told, as far as `probes` name them. What is
    /// found is kept in the folder `directory`. A break when `stop` asked for an end before all was found.
    ///
    /// # Errors
    /// [`StudyError::Calibration`] when it cannot be found, [`StudyError::File`] when it cannot be kept.
    pub(crate) fn calibrate(
        &mut self,
        probes: Probes,
        directory: &Path,
        stop: &AtomicBool,
        watcher: &mut dyn Watcher,
    ) -> Result<ControlFlow<()>, StudyError> {
        let open: Vec<&Probe> = probes.open().collect();
        let mut known = probes.known.clone();
        let started = Instant::now();
        let all: f64 = open.iter().map(|probe| probe.cost.work()).sum();
        let mut done = 0.0;
        for (place, probe) in open.iter().enumerate() {
            let index = probe.places[0].1;
            let name = &self.case.turbines[index].name;
            let mut last: Option<Instant> = None;
            let mut told = |share: f64| {
                if stop.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                if last.is_some_and(|last| last.elapsed() < PROGRESS_INTERVAL) {
                    return ControlFlow::Continue(());
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
                ControlFlow::Continue(())
            };
            let (case, plan, model) = (&self.case, &self.plan, &self.models[index]);
            let found = match &probe.asked {
                Asked::Calibration(sync) => calibration(case, plan, model, index, sync, &mut told)
                    .map(|found| record_of_calibration(&found)),
                Asked::Decoupling(asked) => decoupling(case, plan, model, index, asked, &mut told)
                    .map(|found| record_of_decoupling(&found)),
            };
            let response = match found {
                Err(CalibrationError::BrokenOff) => return Ok(ControlFlow::Break(())),
                found => found?,
            };
            done += probe.cost.work();
            known.push(ProbeRecord { key: probe.key.clone(), turbine: name.clone(), response });
            write_probes(directory, &known)?;
        }
        let now = Probes { known, wanted: Vec::new() };
        for probe in &probes.wanted {
            let Some(found) = now.found(probe) else { continue };
            let name = &self.case.turbines[probe.places[0].1].name;
            watcher.probed(name, found, probes.found(probe).is_some());
            for &(run, index) in &probe.places {
                let control = &mut self.case.runs[run].control[index];
                *control = told(*control, found);
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// What `noise` leaves in the digest of a calibration: nothing where none is given, so that what was found before one could
/// give any is still known.
fn trace(noise: &PhaseNoise) -> String {
    if *noise == PhaseNoise::default() { String::new() } else { format!(" {noise:?}") }
}

/// `control` when it is told what was `found` of its turbine's own pitch.
fn told(control: Control, found: &PitchResponse) -> Control {
    match control {
        Control::PhaseSync(sync) => {
            Control::PhaseSync(PhaseSync { calibration: calibration_of(found), ..sync })
        }
        Control::Meandering(asked) => {
            Control::Meandering(Meandering { decoupling: decoupling_of(found), ..asked })
        }
        other => other,
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

/// The calibration of an estimator in `response`.
pub(crate) fn calibration_of(response: &PitchResponse) -> Option<Calibration> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use control::Excitation;
    use estimation::helix::{Measurement, Options};
    use farm::assemble::controller;

    /// A case whose T2 joins the helix of T1 with `keys` beside the needed ones.
    fn setup(keys: &str) -> Setup {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("case.toml");
        let text = format!(
            r#"
name = "joined"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 60.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "joined"
control.T1 = {{ kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }}
control.T2 = {{ kind = "phase-sync", offset_deg = 90.0, amplitude_deg = 2.0{keys} }}
"#
        );
        std::fs::write(&path, text).expect("a file");
        Setup::read(&path, &[]).expect("a sound case")
    }

    fn key(keys: &str) -> String {
        let setup = setup(keys);
        let asked = Asked::of(&setup.case.runs[0].control[1]).expect("a calibration");
        setup.key(1, &asked)
    }

    #[test]
    fn noise_that_is_given_is_another_calibration_and_none_leaves_no_trace() {
        assert_eq!(trace(&PhaseNoise::default()), "");
        let usual = key("");
        assert_eq!(key(", start = 20.0"), usual);
        let given = key(", measurement_noise_mnm = 0.5");
        assert_ne!(given, usual);
        assert_ne!(key(", measurement_noise_mnm = 0.6"), given);
        assert_ne!(key(", wandering_amplitude = 0.5"), given);
    }

    #[test]
    fn the_estimator_of_a_run_believes_in_the_noise_that_is_given() {
        let options = |keys: &str| -> Options {
            let setup = setup(keys);
            let control = &setup.case.runs[0].control[1];
            let built = controller(control, &setup.models[1], &setup.case, &setup.plan);
            match built.expect("a controller").excitation {
                Excitation::PhaseSync(sync) => *sync.estimator().options(),
                other => panic!("{other:?}"),
            }
        };
        let usual = options("");
        let given = options(", measurement_noise_mnm = 0.5, wandering_amplitude = 3e-3");
        assert_eq!(given.noise.measurement, Measurement::Moment(5e5));
        assert_eq!((given.noise.amplitude, given.noise.phase), (3e-3, usual.noise.phase));
        assert_eq!(Options { noise: usual.noise, ..given }, usual);
        let published = options(", estimator = \"published\", wandering_phase = 3e-4");
        let own = Options::published().noise;
        assert_eq!((published.noise.phase, published.noise.amplitude), (3e-4, own.amplitude));
        assert_eq!(published.noise.measurement, own.measurement);
    }
}
