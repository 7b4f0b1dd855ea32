//! The precursor itself: from the first step, or from its checkpoint, to the last plane.

use super::Job;
use super::error::PrecursorError;
use super::history::History;
use super::levels::{Instant as BoxInstant, direction};
use super::observer::{PrecursorObserver, PrecursorProgress};
use super::recording::{Recording, RecordingState};
use super::result::UNSTEADY;
use farm::precursor::{AirBox, Drive};
use flow::FlowError;
use formats::case::PrecursorFile;
use formats::checkpoint::{CheckpointReader, CheckpointWriter, Identity};
use formats::records::PrecursorResult;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Wall time between two reports of progress, and between two checkpoints.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(600);
/// Sections of the checkpoint.
const RUN: &str = "run";
const HISTORY: &str = "history";
const AIR: &str = "air";
/// Of what a checkpoint holds: the program's, and that of the sections above, which counts their changes.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (state 3)");

/// How a precursor ended.
pub(super) enum Ending {
    /// All planes are there.
    Complete(Box<PrecursorResult>),
    /// Stopped on request; a checkpoint stands.
    Interrupted,
}

/// What a checkpoint keeps beside statistics and air.
#[derive(Serialize, Deserialize)]
struct RunState {
    step: u64,
    wall_time: f64,
    recording: Option<RecordingState>,
    drive: Drive,
}

/// A precursor under way.
pub(super) struct Simulation<'a> {
    job: &'a Job,
    air: AirBox,
    history: History,
    recording: Option<Recording>,
    /// What of the machine decides its bits, in words.
    backend: String,
    started: Instant,
    /// Steps (–) and wall time (s) of the processes before.
    before: (u64, f64),
}

impl<'a> Simulation<'a> {
    /// The precursor of `job` at time zero, or where its checkpoint has it.
    ///
    /// # Errors
    /// [`PrecursorError`]; what the folder holds is untouched then.
    pub(super) fn begin(job: &'a Job) -> Result<Self, PrecursorError> {
        let air = AirBox::new(&job.file.precursor, &job.plan)?;
        let backend = backend_of(&air);
        let mut simulation = Self {
            job,
            air,
            history: History::default(),
            recording: None,
            backend,
            started: Instant::now(),
            before: (0, 0.0),
        };
        if job.resume {
            simulation.resume()?;
        }
        job.folder.reopen()?;
        job.folder.write_case(&job.file.text)?;
        // What a checkpoint has told of is told already.
        if !job.resume {
            simulation.tell_levels();
        }
        Ok(simulation)
    }

    /// On return it stands where its checkpoint was written.
    fn resume(&mut self) -> Result<(), PrecursorError> {
        let (job, path) = (self.job, self.job.folder.checkpoint_path());
        let (mut reader, state, history) = open(&path, &job.file, &self.backend)?;
        self.history = history;
        if !self.history.fits(job.plan.n_cells[2]) {
            let reason = "statistics of other levels".to_owned();
            return Err(reader.unfitting(HISTORY, reason).into());
        }
        let kept = job.recorded(&state)?;
        let air = &mut self.air;
        reader.stream(AIR, |bytes| air.air_mut().read_state(bytes))?;
        air.restore(state.drive);
        self.before = (state.step, state.wall_time);
        if let Some(kept) = kept {
            self.recording = Some(Recording::resume(&job.folder, &job.plan.grid, kept)?);
        }
        Ok(())
    }

    /// Makes all steps; `stop` asks it to leave a checkpoint and return.
    ///
    /// # Errors
    /// [`PrecursorError`]; the last good checkpoint stands.
    pub(super) fn run(
        mut self,
        stop: &AtomicBool,
        observer: &mut dyn PrecursorObserver,
    ) -> Result<Ending, PrecursorError> {
        let plan = &self.job.plan;
        self.begin_recording(observer)?;
        let mut last_checkpoint = Instant::now();
        let mut last_progress: Option<Instant> = None;
        while self.air.air().n_steps() < plan.n_steps {
            if stop.load(Ordering::Relaxed) {
                self.checkpoint()?;
                return Ok(Ending::Interrupted);
            }
            self.step(observer)?;
            if last_checkpoint.elapsed() >= CHECKPOINT_INTERVAL {
                self.checkpoint()?;
                last_checkpoint = Instant::now();
            }
            if last_progress.is_none_or(|last| last.elapsed() >= PROGRESS_INTERVAL) {
                observer.advanced(&self.progress());
                last_progress = Some(Instant::now());
            }
        }
        self.finish(observer)
    }

    fn step(&mut self, observer: &mut dyn PrecursorObserver) -> Result<(), PrecursorError> {
        let plan = &self.job.plan;
        if let Err(error) = self.air.step() {
            return Err(self.diverged(error));
        }
        let step = self.air.air().n_steps();
        if step.is_multiple_of(plan.statistics_stride) {
            self.tell_levels();
        }
        if step == plan.first_plane {
            return self.begin_recording(observer);
        }
        match &mut self.recording {
            Some(recording) if (step - plan.first_plane).is_multiple_of(plan.plane_stride) => {
                Ok(recording.add(self.air.air())?)
            }
            _ => Ok(()),
        }
    }

    /// Adds what the levels tell now to the history.
    fn tell_levels(&mut self) {
        let hub = self.job.file.precursor.planes.hub_height;
        let levels = self.air.air().level_statistics();
        let geostrophic = self.air.drive().geostrophic;
        self.history.add(self.air.air().time(), BoxInstant { levels: &levels, hub, geostrophic });
    }

    /// Begins the record with its first plane, where that is due now.
    fn begin_recording(
        &mut self,
        observer: &mut dyn PrecursorObserver,
    ) -> Result<(), PrecursorError> {
        let plan = &self.job.plan;
        if self.recording.is_some() || self.air.air().n_steps() != plan.first_plane {
            return Ok(());
        }
        let wind = self.job.wind_of_spin_up(&self.history);
        let drift = self.job.drift_of_spin_up(&self.history);
        observer.spun_up(drift.as_ref(), direction(wind));
        if drift.is_none_or(|drift| !drift.is_steady()) {
            observer.warned(UNSTEADY);
        }
        let mut recording = Recording::begin(&self.job.folder, &plan.grid, plan.first_plane, wind)?;
        recording.add(self.air.air())?;
        self.recording = Some(recording);
        Ok(())
    }

    /// On return checkpoint and statistics on disk hold this very instant.
    ///
    /// # Errors
    /// [`PrecursorError::Diverged`] for air that is no longer valid, [`PrecursorError::File`].
    fn checkpoint(&mut self) -> Result<(), PrecursorError> {
        if let Err(error) = self.air.air_mut().check() {
            return Err(self.diverged(error));
        }
        self.write_statistics()?;
        let recording = self.recording.as_mut().map(Recording::flush).transpose()?;
        let state = RunState {
            step: self.air.air().n_steps(),
            wall_time: self.wall_time(),
            recording,
            drive: self.air.drive(),
        };
        let print = self.job.file.fingerprint();
        let identity = identity(&print, &self.job.file, &self.backend);
        let path = self.job.folder.checkpoint_path();
        let mut writer = CheckpointWriter::create(&path, &identity)?;
        writer.state(RUN, &state)?;
        writer.state(HISTORY, &self.history)?;
        let air = &mut self.air;
        writer.stream(AIR, |bytes| air.air_mut().write_state(bytes))?;
        Ok(writer.finish()?)
    }

    fn write_statistics(&self) -> Result<(), PrecursorError> {
        let title = format!("precursor {}", self.job.file.precursor.name);
        Ok(self.history.write(&self.job.folder.statistics_path(), &title)?)
    }

    /// Wall time of all processes that have made it (s).
    fn wall_time(&self) -> f64 {
        self.before.1 + self.started.elapsed().as_secs_f64()
    }

    fn diverged(&self, source: FlowError) -> PrecursorError {
        // What was told up to here is kept; the checkpoint before it stands.
        let statistics = self.write_statistics().is_ok();
        let folder = &self.job.folder;
        let checkpoint = folder.checkpoint_path();
        PrecursorError::Diverged {
            source: Box::new(source),
            checkpoint: checkpoint.exists().then_some(checkpoint),
            statistics: statistics.then(|| folder.statistics_path()),
        }
    }

    fn progress(&self) -> PrecursorProgress {
        let plan = &self.job.plan;
        let step = self.air.air().n_steps();
        let made = (step - self.before.0) as f64;
        let steps_per_second = made / self.started.elapsed().as_secs_f64();
        let [hub_speed, friction_velocity] = self.history.latest().unwrap_or([f64::NAN; 2]);
        PrecursorProgress {
            step,
            n_steps: plan.n_steps,
            time: self.air.air().time(),
            records: self.recording.is_some(),
            updates_per_second: plan.cells() as f64 * steps_per_second,
            time_left: (plan.n_steps - step) as f64 / steps_per_second,
            hub_speed,
            friction_velocity,
        }
    }

    fn finish(mut self, observer: &mut dyn PrecursorObserver) -> Result<Ending, PrecursorError> {
        // From here it can go on.
        self.checkpoint()?;
        let (job, wall_time) = (self.job, self.wall_time());
        let precursor = &job.file.precursor;
        let along = match &mut self.recording {
            Some(recording) => {
                let description = format!("wakemix: precursor {}", precursor.name);
                recording.finish(&job.plan.grid, precursor.planes.hub_height, &description)?;
                recording.along()
            }
            None => [f64::NAN; 2],
        };
        let result = job.result(&self.history, along, wall_time, &self.backend)?;
        let warnings = job.of_record(&result.record, result.boundary_layer_height);
        warnings.iter().for_each(|warning| observer.warned(warning));
        // The result comes last: with it the precursor is complete.
        job.folder.write_result(&result)?;
        Ok(Ending::Complete(Box::new(result)))
    }
}

/// What of the machine decides the bits of `air`, in words.
fn backend_of(air: &AirBox) -> String {
    format!("{}, air {}", flow::numerics(), air.air().backend())
}

/// What a checkpoint of `file` is known by, whose fingerprint is `print`.
fn identity<'a>(print: &'a str, file: &'a PrecursorFile, backend: &'a str) -> Identity<'a> {
    let run = &file.precursor.name;
    Identity { case_text: print, run, version: VERSION, backend }
}

/// The checkpoint of `file` at `path`, with what comes before its air.
fn open(
    path: &Path,
    file: &PrecursorFile,
    backend: &str,
) -> Result<(CheckpointReader, RunState, History), PrecursorError> {
    let print = file.fingerprint();
    let mut reader = CheckpointReader::open(path, &identity(&print, file, backend))?;
    let state = reader.state(RUN)?;
    let history = reader.state(HISTORY)?;
    Ok((reader, state, history))
}

/// The air of the precursor of `file` as its checkpoint at `path` has it.
///
/// # Errors
/// [`PrecursorError`] for a checkpoint of something else.
pub(crate) fn standing(path: &Path, file: &PrecursorFile) -> Result<AirBox, PrecursorError> {
    let mut air = AirBox::new(&file.precursor, &file.precursor.plan())?;
    let (mut reader, state, _) = open(path, file, &backend_of(&air))?;
    reader.stream(AIR, |bytes| air.air_mut().read_state(bytes))?;
    air.restore(state.drive);
    Ok(air)
}

impl Job {
    /// The record that goes on from `state`; none where it is begun anew, later.
    ///
    /// # Errors
    /// [`PrecursorError::Passed`] when it stands behind what the times of the file ask for.
    fn recorded(&self, state: &RunState) -> Result<Option<RecordingState>, PrecursorError> {
        let plan = &self.plan;
        let passed = |problem: &str| PrecursorError::Passed {
            directory: self.folder.path().to_owned(),
            time: plan.time(state.step),
            recorded: state.recording.map(|kept| plan.time(kept.first_plane)),
            problem: problem.to_owned(),
        };
        if state.step > plan.n_steps {
            return Err(passed("it is beyond the end of time.spin_up and time.record"));
        }
        match state.recording {
            Some(kept) if kept.first_plane == plan.first_plane => Ok(Some(kept)),
            _ if state.step <= plan.first_plane => Ok(None),
            _ => Err(passed("time.spin_up has it record from another time on, which is over")),
        }
    }
}
