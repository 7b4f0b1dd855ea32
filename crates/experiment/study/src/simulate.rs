//! One run: from time zero, or from its checkpoint, to its last step.

use crate::StudyError;
use crate::air;
use crate::channels::Row;
use crate::lines::{self, WindLines};
use crate::outb;
use crate::prepare::Setup;
use crate::watcher::{Progress, Watcher};
use crate::wind_records::{self, WindRecord};
use analysis::wake::PhaseAverage;
use basis::Vector3;
use basis::records::{Cost, Plane, PlaneAxes};
use control::{ControllerState, excitation_rate};
use farm::case::Run;
use farm::{Air, Farm, assemble};
use flow::inflow::prescribed::Clock;
use flow::lattice::{Lattice, PlaneAverage, PlaneAverageState};
use flow::{FlowError, WindField};
use formats::checkpoint::{CheckpointReader, CheckpointWriter};
use formats::records::{self, RunFolder, SeriesWriter};
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Distance of the wind probe upstream of the first turbine (rotor diameters), or halfway to the inlet if nearer.
const PROBE_DISTANCE: f64 = 2.0;
/// Planes are averaged from instants about this far apart (s).
const AVERAGING_INTERVAL: f64 = 2.0;
/// Every so many cells along each axis are kept in a volume.
pub(crate) const VOLUME_STRIDE: usize = 2;
/// Section of a checkpoint with the most memory that the run has held so far; checkpoints of earlier programs have none.
const PEAK_MEMORY: &str = "peak memory";
/// Wall time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(250);

/// How a run ended.
pub(crate) enum Ending {
    /// All steps made.
    Complete {
        /// What it cost, all its sessions together.
        cost: Cost,
        /// Share of instants at which a pitch limit held a command back, turbine by turbine (–).
        clipped_shares: Vec<f64>,
    },
    /// Stopped on request; a checkpoint stands.
    Interrupted,
}

/// Everything besides the air that time changes.
#[derive(Serialize, Deserialize)]
struct RunState {
    step: u64,
    wall_time: f64,
    series_bytes: u64,
    turbines: Vec<turbine::TurbineState>,
    controllers: Vec<ControllerState>,
    averages: Vec<PlaneAverageState>,
    phases: Option<PhaseAverage>,
    n_plane_instants: u64,
    n_volumes: u64,
    inflow_bytes: Vec<u64>,
}

/// A run under way.
struct Simulation<'a> {
    setup: &'a Setup,
    folder: &'a RunFolder,
    farm: Farm<Air>,
    row: Row,
    series: SeriesWriter,
    averages: Vec<PlaneAverage>,
    /// The hub-height plane by phase of the helix.
    phases: Option<PhaseAverage>,
    n_plane_instants: u64,
    n_volumes: u64,
    probe: Vector3,
    lines: Vec<WindLines>,
    inflows: Vec<WindRecord>,
    started: Instant,
    wall_time_before: f64,
    /// What the processes before this one held of memory at most (bytes).
    peak_memory_before: Option<u64>,
    first_step: u64,
}

/// Makes `run`, or goes on with it from its checkpoint when `resume`; `place` is its place among the `n_runs` runs.
pub(crate) fn simulate(
    setup: &Setup,
    run: &Run,
    folder: &RunFolder,
    resume: bool,
    place: (usize, usize),
    stop: &AtomicBool,
    watcher: &mut dyn Watcher,
) -> Result<Ending, StudyError> {
    let mut simulation = Simulation::begin(setup, run, folder, resume)?;
    let n_steps = setup.plan.n_steps;
    let every = Duration::from_secs_f64(setup.case.output.checkpoint_interval);
    let mut last_checkpoint = Instant::now();
    let mut last_progress = Instant::now();
    while simulation.farm.step() < n_steps {
        if stop.load(Ordering::Relaxed) {
            simulation.checkpoint(run)?;
            return Ok(Ending::Interrupted);
        }
        if let Err(error) = simulation.step() {
            return Err(match error {
                StepError::Flow(error) => simulation.diverged(run, error),
                StepError::Study(error) => error,
            });
        }
        if last_checkpoint.elapsed() >= every {
            simulation.checkpoint(run)?;
            last_checkpoint = Instant::now();
        }
        if last_progress.elapsed() >= PROGRESS_INTERVAL {
            watcher.advanced(&simulation.progress(run, place));
            last_progress = Instant::now();
        }
    }
    simulation.finish(run)
}

/// Why a step failed.
enum StepError {
    Flow(FlowError),
    Study(StudyError),
}

impl<T: Into<StudyError>> From<T> for StepError {
    fn from(error: T) -> Self {
        Self::Study(error.into())
    }
}

impl<'a> Simulation<'a> {
    fn begin(
        setup: &'a Setup,
        run: &Run,
        folder: &'a RunFolder,
        resume: bool,
    ) -> Result<Self, StudyError> {
        let air = air::begin(setup)?;
        let farm = assemble::farm(&setup.case, run, &setup.plan, &setup.models, air)?;
        let names = run.present().map(|index| setup.case.turbines[index].name.as_str());
        let lines = lines::of(setup, run);
        let places: Vec<&str> = lines.iter().map(|lines| lines.name.as_str()).collect();
        let all_loads = setup.case.flow.solver.is_prescribed();
        let row = Row::new(names.zip(farm.machines()), &places, all_loads);
        let averages = match farm.flow().lattice() {
            Some(lattice) => slices(setup)
                .into_iter()
                .map(|(name, axes, position)| PlaneAverage::new(lattice, &name, axes, position))
                .collect(),
            None => Vec::new(),
        };
        let phases = phases(setup, run, &farm);
        let checkpoint = folder.checkpoint_path();
        let stored = if resume && checkpoint.exists() {
            Some(CheckpointReader::open(&checkpoint, &setup.case_text, &run.name)?)
        } else {
            None
        };
        let started = Instant::now();
        let probe = probe(setup);
        let Some(mut reader) = stored else {
            let series = SeriesWriter::create(&folder.series_path(), row.names())?;
            return Ok(Self {
                setup,
                folder,
                farm,
                row,
                series,
                averages,
                phases,
                n_plane_instants: 0,
                n_volumes: 0,
                probe,
                lines,
                inflows: wind_records::of(setup, run, folder, None)?,
                started,
                wall_time_before: 0.0,
                peak_memory_before: None,
                first_step: 0,
            });
        };
        let state: RunState = reader.state("run")?;
        let peak_memory_before: Option<u64> =
            if reader.holds(PEAK_MEMORY) { reader.state(PEAK_MEMORY)? } else { None };
        let mut simulation = Self {
            setup,
            folder,
            row,
            series: SeriesWriter::resume(&folder.series_path(), state.series_bytes)?,
            averages,
            phases: state.phases,
            n_plane_instants: state.n_plane_instants,
            n_volumes: state.n_volumes,
            probe,
            lines,
            inflows: wind_records::of(setup, run, folder, Some(&state.inflow_bytes))?,
            started,
            wall_time_before: state.wall_time,
            peak_memory_before,
            first_step: state.step,
            farm: farm.at_step(state.step),
        };
        for (machine, (turbine, controller)) in simulation
            .farm
            .machines_mut()
            .iter_mut()
            .zip(state.turbines.into_iter().zip(state.controllers))
        {
            machine.turbine.restore(turbine);
            machine.controller.restore(controller);
        }
        if simulation.has_instruments() {
            let stored: Vec<sensing::State> = reader.state("instruments")?;
            for (machine, stored) in simulation.farm.machines_mut().iter_mut().zip(stored) {
                machine.sensing.restore(stored);
            }
        }
        for (average, stored) in simulation.averages.iter_mut().zip(state.averages) {
            average.restore(stored)?;
        }
        match simulation.farm.flow_mut() {
            Air::Lattice(lattice) => reader.stream("air", |bytes| lattice.read_state(bytes))?,
            Air::Prescribed(wind) => wind.restore(reader.state::<Clock>("wind")?)?,
        }
        Ok(simulation)
    }

    fn step(&mut self) -> Result<(), StepError> {
        let plan = &self.setup.plan;
        let kept = self.farm.step().is_multiple_of(plan.row_stride);
        if kept {
            let mut wind = [Vector3::ZERO];
            self.farm.flow().sample(&[self.probe], &mut wind);
            self.row.start(self.farm.time(), wind[0]);
            for (index, machine) in self.farm.machines().iter().enumerate() {
                self.row.loads(index, &machine.turbine);
            }
            for (index, lines) in self.lines.iter_mut().enumerate() {
                self.row.lines(index, lines.wind(self.farm.flow()));
            }
        }
        self.farm.advance(&mut self.row).map_err(StepError::Flow)?;
        if kept {
            for (index, machine) in self.farm.machines().iter().enumerate() {
                self.row.beliefs(index, machine);
            }
            self.series.write(self.row.values())?;
        }
        let step = self.farm.step();
        if let Some(since) = step.checked_sub(plan.n_spin_up_steps) {
            for inflow in &mut self.inflows {
                inflow.see(since, self.farm.flow())?;
            }
        }
        let Some(lattice) = self.farm.flow().lattice() else { return Ok(()) };
        if step > plan.n_spin_up_steps {
            let since = step - plan.n_spin_up_steps;
            if since.is_multiple_of(whole_steps(AVERAGING_INTERVAL, plan.interval)) {
                for average in &mut self.averages {
                    average.add(lattice);
                }
                if let Some(phases) = &mut self.phases {
                    phases.add(&hub_height(self.setup, lattice))?;
                }
            }
            let due = |every: Option<f64>| {
                every.is_some_and(|every| since.is_multiple_of(whole_steps(every, plan.interval)))
            };
            if due(self.setup.case.output.plane_interval) {
                for (name, axes, position) in slices(self.setup) {
                    let plane = lattice.plane(&name, axes, position);
                    records::write_instant_plane(self.folder, self.n_plane_instants, &plane)?;
                }
                self.n_plane_instants += 1;
            }
            if due(self.setup.case.output.volume_interval) {
                let volume = lattice.volume(VOLUME_STRIDE);
                records::write_volume(self.folder, self.n_volumes, &volume)?;
                self.n_volumes += 1;
            }
        }
        Ok(())
    }

    /// Whether any instrument errs, and so has a state that a checkpoint must hold.
    fn has_instruments(&self) -> bool {
        self.farm.machines().iter().any(|machine| !machine.sensing.instruments().are_perfect())
    }

    fn wall_time(&self) -> f64 {
        self.wall_time_before + self.started.elapsed().as_secs_f64()
    }

    /// Most memory that a process of this run has held at once so far (bytes); none where the system does not tell.
    fn peak_memory(&self) -> Option<u64> {
        self.peak_memory_before.max(formats::machine::peak_memory())
    }

    /// On return the checkpoint on disk holds this very instant.
    ///
    /// # Errors
    /// [`StudyError::Diverged`] for air that no longer is worth keeping, [`StudyError::File`].
    fn checkpoint(&mut self, run: &Run) -> Result<(), StudyError> {
        if let Air::Lattice(lattice) = self.farm.flow_mut()
            && let Err(error) = lattice.check()
        {
            return Err(self.diverged(run, error));
        }
        let series_bytes = self.series.flush()?;
        let inflow_bytes =
            self.inflows.iter_mut().map(WindRecord::flush).collect::<Result<_, StudyError>>()?;
        let state = RunState {
            step: self.farm.step(),
            wall_time: self.wall_time(),
            series_bytes,
            turbines: self.farm.machines().iter().map(|m| m.turbine.state().clone()).collect(),
            controllers: self.farm.machines().iter().map(|m| m.controller.state()).collect(),
            averages: self.averages.iter().map(PlaneAverage::state).collect(),
            phases: self.phases.clone(),
            n_plane_instants: self.n_plane_instants,
            n_volumes: self.n_volumes,
            inflow_bytes,
        };
        let path = self.folder.checkpoint_path();
        let mut writer = CheckpointWriter::create(&path, &self.setup.case_text, &run.name)?;
        writer.state("run", &state)?;
        writer.state(PEAK_MEMORY, &self.peak_memory())?;
        if self.has_instruments() {
            let sensing: Vec<sensing::State> =
                self.farm.machines().iter().map(|machine| *machine.sensing.state()).collect();
            writer.state("instruments", &sensing)?;
        }
        match self.farm.flow_mut() {
            Air::Lattice(lattice) => writer.stream("air", |bytes| lattice.write_state(bytes))?,
            Air::Prescribed(wind) => writer.state("wind", &wind.state())?,
        }
        writer.finish()?;
        Ok(())
    }

    fn diverged(&mut self, run: &Run, source: FlowError) -> StudyError {
        // What was measured up to here is kept; the checkpoint before it stands.
        let kept = self.series.flush().is_ok();
        let checkpoint = self.folder.checkpoint_path();
        StudyError::Diverged {
            run: run.name.clone(),
            source: Box::new(source),
            checkpoint: checkpoint.exists().then_some(checkpoint),
            series: kept.then(|| self.series.part_path().to_owned()),
        }
    }

    fn progress<'b>(&self, run: &'b Run, (run_index, n_runs): (usize, usize)) -> Progress<'b> {
        let plan = &self.setup.plan;
        let made = (self.farm.step() - self.first_step) as f64;
        let steps_per_second = made / self.started.elapsed().as_secs_f64();
        let runs_after = (n_runs - run_index - 1) as f64;
        let left = (plan.n_steps - self.farm.step()) as f64 + runs_after * plan.n_steps as f64;
        Progress {
            run: &run.name,
            run_index,
            n_runs,
            step: self.farm.step(),
            n_steps: plan.n_steps,
            updates_per_second: plan.cells() as f64 * steps_per_second,
            time_left: left / steps_per_second,
        }
    }

    fn finish(mut self, run: &Run) -> Result<Ending, StudyError> {
        self.series.finish()?;
        for inflow in &mut self.inflows {
            inflow.finish()?;
        }
        if self.setup.case.flow.solver.is_prescribed() {
            for index in run.present() {
                outb::write(self.setup, run, self.folder, index)?;
            }
        }
        let (plan, wall_time) = (&self.setup.plan, self.wall_time());
        let mut cost = Cost {
            wall_time,
            n_cells: plan.cells() as u64,
            n_steps: plan.n_steps,
            updates_per_second: plan.updates() / wall_time,
            n_threads: 1,
            memory: 0,
            peak_memory: self.peak_memory(),
        };
        if let Some(lattice) = self.farm.flow().lattice() {
            cost.n_threads = lattice.n_threads();
            cost.memory = lattice.memory();
            // The last instant is always kept: the report shows it.
            for (name, axes, position) in slices(self.setup) {
                records::write_last_plane(self.folder, &lattice.plane(&name, axes, position))?;
            }
        }
        for average in &self.averages {
            if average.n_instants() > 0 {
                let mean: Plane = average.mean();
                records::write_mean_plane(self.folder, &mean)?;
            }
        }
        for phase in self.phases.iter().flat_map(PhaseAverage::planes) {
            records::write_phase_plane(self.folder, phase.phase, &phase.plane)?;
        }
        let clipped_shares = self
            .farm
            .machines()
            .iter()
            .map(|machine| {
                let (instants, limited) = machine.turbine.limited_instants();
                limited as f64 / instants.max(1) as f64
            })
            .collect();
        Ok(Ending::Complete { cost, clipped_shares })
    }
}

/// Whole steps of `interval` (s) nearest to `duration` (s), at least one.
fn whole_steps(duration: f64, interval: f64) -> u64 {
    (duration / interval).round().max(1.0) as u64
}

/// Point at hub height where the arriving wind is read (m): upstream of the first turbine, in prescribed wind at it.
fn probe(setup: &Setup) -> Vector3 {
    let plan = &setup.plan;
    let foot = plan.positions[0];
    if setup.case.flow.solver.is_prescribed() {
        return Vector3::new(foot.x, foot.y, plan.hub_height);
    }
    let distance = (PROBE_DISTANCE * plan.diameter).min(0.5 * (foot.x - plan.origin.x));
    Vector3::new(foot.x - distance, foot.y, plan.hub_height)
}

/// The plane at hub height now.
fn hub_height(setup: &Setup, lattice: &Lattice) -> Plane {
    lattice.plane("hub-height", PlaneAxes::Horizontal, setup.plan.hub_height)
}

/// Averages by phase, where the case asks for them and `run` has a helix.
fn phases(setup: &Setup, run: &Run, farm: &Farm<Air>) -> Option<PhaseAverage> {
    let count = setup.case.output.helix_phases?;
    let (_, strouhal) = setup.case.first_helix(run)?;
    let rate = excitation_rate(strouhal, setup.case.wind.speed, setup.plan.diameter);
    let plane = hub_height(setup, farm.flow().lattice()?);
    Some(PhaseAverage::new(&plane, rate, count))
}

/// Planes that are averaged and kept: name, axes, position across them (m).
fn slices(setup: &Setup) -> Vec<(String, PlaneAxes, f64)> {
    let plan = &setup.plan;
    let foot = plan.positions[0];
    let mut slices = vec![
        ("hub-height".to_owned(), PlaneAxes::Horizontal, plan.hub_height),
        ("streamwise".to_owned(), PlaneAxes::Streamwise, foot.y),
    ];
    for distance in &setup.case.output.crosswind_diameters {
        let position = foot.x + distance * plan.diameter;
        slices.push((format!("{distance}D"), PlaneAxes::Crosswind, position));
    }
    slices
}
