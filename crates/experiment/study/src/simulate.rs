//! One run: from time zero, or from its checkpoint, to its last step.

mod checkpoint;

use crate::StudyError;
use crate::hosting;
use crate::observer::{Observer, Progress, making_turbulence};
use crate::outputs::{Outputs, Stage, Writers};
use crate::ready::Ready;
use crate::summarise::Left;
use basis::records::{Cost, Warning};
use checkpoint::Before;
use farm::case::Run;
use farm::{Air, Farm, FarmError, Machine, Plan};
use flow::inflow::InflowError;
use formats::checkpoint::{CheckpointReader, CheckpointWriter, Identity};
use formats::records::RunFolder;
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Wall time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// One run to be made.
pub(crate) struct Job<'a> {
    /// What it shares with the others.
    pub(crate) ready: &'a Ready,
    /// The run.
    pub(crate) run: &'a Run,
    /// Its folder.
    pub(crate) folder: &'a RunFolder,
    /// The kinds of output that it may have.
    pub(crate) outputs: &'a Outputs,
    /// Go on from its checkpoint, if there is one.
    pub(crate) resume: bool,
    /// Its place among the runs to be made, and their number.
    pub(crate) place: (usize, usize),
}

impl<'a> Job<'a> {
    /// What the outputs see of `farm`.
    fn stage(&self, farm: &'a Farm<Air>) -> Stage<'a> {
        Stage { setup: &self.ready.prepared, run: self.run, folder: self.folder, farm }
    }

    /// What a checkpoint of it, computed on `backend`, is known by.
    fn identity(&self, backend: &'a str) -> Identity<'a> {
        let (case_text, run) = (&self.ready.prepared.case_text, &self.run.name);
        Identity { case_text, run, version: env!("CARGO_PKG_VERSION"), backend }
    }
}

/// How a run ended.
pub(crate) enum Ending {
    /// All steps made.
    Complete {
        /// What it cost, all processes that made it together.
        cost: Cost,
        /// What its turbines leave beside the series, turbine by turbine.
        left: Vec<Left>,
        /// What a reader of its numbers must know of what its outputs took in.
        warnings: Vec<Warning>,
        /// What of the machine decided its bits, in words.
        backend: String,
    },
    /// Stopped on request; a checkpoint stands, unless no step was made.
    Interrupted,
}

/// A run under way.
struct Simulation<'a> {
    job: &'a Job<'a>,
    farm: Farm<Air>,
    outputs: Writers<'a>,
    /// What of the machine decides its bits, in words.
    backend: String,
    started: Instant,
    before: Before,
}

/// Makes the run of `job`; `stop` asks it to leave a checkpoint and return.
///
/// # Errors
/// [`StudyError`]; the last good checkpoint stands.
pub(crate) fn simulate(
    job: &Job,
    stop: &AtomicBool,
    observer: &mut dyn Observer,
) -> Result<Ending, StudyError> {
    let farm = {
        let observer: RefCell<&mut dyn Observer> = RefCell::new(&mut *observer);
        let setup = &job.ready.prepared;
        let run = hosting::recorded(&setup.case, setup.folder(), job.run, job.folder);
        job.ready.farm_until(&run, &making_turbulence(stop, &observer))
    };
    let farm = match farm {
        Err(StudyError::Inflow(InflowError::BrokenOff)) => return Ok(Ending::Interrupted),
        farm => farm?,
    };
    let mut simulation = Simulation::begin(job, farm)?;
    let n_steps = job.ready.prepared.plan.n_steps;
    let every = Duration::from_secs_f64(job.ready.prepared.case.output.checkpoint_interval);
    let mut last_checkpoint = Instant::now();
    // However short the run is, it is told of once.
    let mut last_progress: Option<Instant> = None;
    while simulation.farm.step() < n_steps {
        if stop.load(Ordering::Relaxed) {
            simulation.checkpoint()?;
            return Ok(Ending::Interrupted);
        }
        simulation.step()?;
        if last_checkpoint.elapsed() >= every {
            simulation.checkpoint()?;
            last_checkpoint = Instant::now();
        }
        if last_progress.is_none_or(|last| last.elapsed() >= PROGRESS_INTERVAL) {
            observer.advanced(&simulation.progress());
            last_progress = Some(Instant::now());
        }
    }
    simulation.finish()
}

impl<'a> Simulation<'a> {
    /// The run of `job` with `farm` at time zero, or where its checkpoint has it.
    fn begin(job: &'a Job<'a>, farm: Farm<Air>) -> Result<Self, StudyError> {
        let backend = backend(&farm);
        let path = job.folder.checkpoint_path();
        let mut stored = if job.resume && path.exists() {
            Some(CheckpointReader::open(&path, &job.identity(&backend))?)
        } else {
            None
        };
        let started = Instant::now();
        let (farm, before) = match &mut stored {
            Some(reader) => checkpoint::read(reader, farm)?,
            None => (farm, Before::default()),
        };
        let outputs = Writers::begin(
            job.outputs.kinds(),
            &job.ready.prepared.case,
            &job.stage(&farm),
            stored.as_mut(),
        )?;
        Ok(Self { job, farm, outputs, backend, started, before })
    }

    fn step(&mut self) -> Result<(), StudyError> {
        self.outputs.before_step(&self.job.stage(&self.farm));
        if let Err(error) = self.farm.advance(&mut self.outputs) {
            return Err(self.diverged(error));
        }
        self.outputs.write(&self.job.stage(&self.farm))
    }

    /// On return the checkpoint on disk holds this very instant.
    ///
    /// # Errors
    /// [`StudyError::Diverged`] for air that is no longer valid, [`StudyError::File`].
    fn checkpoint(&mut self) -> Result<(), StudyError> {
        if let Err(error) = self.farm.flow_mut().check() {
            return Err(self.diverged(error.into()));
        }
        let (path, made) = (self.job.folder.checkpoint_path(), self.made());
        let writer = CheckpointWriter::create(&path, &self.job.identity(&self.backend))?;
        checkpoint::write(writer, &mut self.farm, &mut self.outputs, made)
    }

    /// What all processes have made of the run so far, and what that cost.
    fn made(&self) -> Before {
        Before {
            step: self.farm.step(),
            wall_time: self.before.wall_time + self.started.elapsed().as_secs_f64(),
            peak_memory: self.before.peak_memory.max(formats::machine::peak_memory()),
        }
    }

    fn diverged(&mut self, source: FarmError) -> StudyError {
        // What was measured up to here is kept; the checkpoint before it stands.
        let series = self.outputs.salvage();
        let checkpoint = self.job.folder.checkpoint_path();
        StudyError::Diverged {
            run: self.job.run.name.clone(),
            source: Box::new(source),
            steadier: self.job.ready.prepared.case.flow.solver.steadier,
            checkpoint: checkpoint.exists().then_some(checkpoint),
            series,
        }
    }

    fn progress(&self) -> Progress<'a> {
        let Job { run, place: (run_index, n_runs), .. } = *self.job;
        let plan = &self.job.ready.prepared.plan;
        let (effort, step) = (plan.effort(), self.farm.step());
        let elapsed = self.started.elapsed().as_secs_f64();
        let steps_per_second = (step - self.before.step) as f64 / elapsed;
        let [before, now, all] = [self.before.step, step, plan.n_steps].map(|n| effort.until(n));
        let left = all - now + (n_runs - run_index - 1) as f64 * all;
        Progress {
            run: &run.name,
            run_index,
            n_runs,
            step,
            n_steps: plan.n_steps,
            updates_per_second: plan.updates_of_step() * steps_per_second,
            time_left: left * elapsed / (now - before),
            first_step: self.before.step,
            n_at_a_time: 1,
            share_of_all: 1.0 - left / (n_runs as f64 * all),
        }
    }

    fn finish(mut self) -> Result<Ending, StudyError> {
        if self.job.ready.prepared.case.output.keeps_checkpoint {
            // Before the outputs complete their files: from here they can go on.
            self.checkpoint()?;
        }
        let warnings = self.outputs.warnings(&self.job.stage(&self.farm));
        self.outputs.finish(&self.job.stage(&self.farm))?;
        let (plan, made) = (&self.job.ready.prepared.plan, self.made());
        let cost = cost(plan, &self.farm, made.wall_time, made.peak_memory);
        let left = left(&self.farm);
        Ok(Ending::Complete { cost, left, warnings, backend: self.backend })
    }
}

/// What of the machine decides the bits of `farm`, in words.
fn backend(farm: &Farm<Air>) -> String {
    match farm.flow().backend() {
        "" => flow::numerics(),
        own => format!("{}, air {own}", flow::numerics()),
    }
}

/// What the run that `farm` has made took of wall time (s) and, at most, of memory (bytes).
pub(crate) fn cost(
    plan: &Plan,
    farm: &Farm<Air>,
    wall_time: f64,
    peak_memory: Option<u64>,
) -> Cost {
    Cost {
        wall_time,
        n_cells: plan.cells() as u64,
        n_steps: plan.n_steps,
        updates_per_second: plan.updates() / wall_time,
        n_threads: farm.flow().n_threads(),
        memory: farm.flow().memory(),
        peak_memory,
    }
}

/// What the turbines of `farm` leave beside the series, turbine by turbine.
pub(crate) fn left(farm: &Farm<Air>) -> Vec<Left> {
    let of_machine = |machine: &Machine| {
        let (instants, limited) = machine.turbine.limited_instants();
        let clipped_share = limited as f64 / instants.max(1) as f64;
        Left { clipped_share, remarks: machine.controller.remarks() }
    };
    farm.machines().iter().map(of_machine).collect()
}
