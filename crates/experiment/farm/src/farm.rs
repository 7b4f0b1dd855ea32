//! The loop: read, decide, sample, move rotors, move air.

use basis::{Commands, PerBlade, PointForce, Truth, Vector3};
use control::Controller;
use flow::{FlowError, FlowSolver, WindField};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use sensing::{Scene, Sensing};
use thiserror::Error;
use turbine::{Breakdown, Turbine};

/// Why a farm could not go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FarmError {
    /// The air could not.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// A turbine could not: it is no longer a machine.
    #[error(
        "{turbine} broke down at {time:.2} s at x {x:.0} m, y {y:.0} m, z {z:.0} m: its {breakdown}",
        x = position.x, y = position.y, z = position.z
    )]
    Turbine {
        /// Its name.
        turbine: String,
        /// Simulated time (s).
        time: f64,
        /// Centre of its rotor, farm frame (m).
        position: Vector3,
        /// What is no longer finite.
        breakdown: Breakdown,
    },
    /// A turbine's controller could not.
    #[error("the controller of {turbine} stopped the run at {time:.2} s: {message}")]
    Controller {
        /// Name of the turbine.
        turbine: String,
        /// Simulated time (s).
        time: f64,
        /// What it says.
        message: String,
    },
}

/// Observes a run: files, statistics, live plots.
pub trait Recorder {
    /// Takes state and commands of turbine number `turbine` at one control instant: the truth, whatever its
    /// instruments showed of it.
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands);
}

/// Takes nothing down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unrecorded;

impl Recorder for Unrecorded {
    fn record(&mut self, _turbine: usize, _truth: &Truth, _commands: &Commands) {}
}

/// One turbine with what runs on it.
pub struct Machine {
    /// Its name, for who is told of it; empty where it has none.
    pub name: String,
    /// The machine in the air.
    pub turbine: Turbine,
    /// What stands between it and its controller.
    pub sensing: Sensing,
    /// What decides for it; sees only what the instruments show.
    pub controller: Box<dyn Controller>,
    winds: Vec<Vector3>,
    commands: Commands,
}

impl Machine {
    /// A turbine under `controller`, with perfect instruments.
    pub fn new(turbine: Turbine, controller: Box<dyn Controller>) -> Self {
        let winds = vec![Vector3::ZERO; turbine.stations().len()];
        let pitch = PerBlade::splat(turbine.definition().n_blades, 0.0);
        let commands = Commands { pitch, generator_torque: 0.0, yaw_rate: 0.0 };
        let (name, sensing) = (String::new(), Sensing::perfect());
        Self { name, turbine, sensing, controller, winds, commands }
    }

    /// The same, called `name`.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// The same with other instruments.
    pub fn with_instruments(self, sensing: Sensing) -> Self {
        Self { sensing, ..self }
    }

    /// Reads the instruments at `time` (s) in the `wind` and decides for an `interval` (s); gives the truth
    /// that was read.
    fn decide(&mut self, time: f64, interval: f64, wind: &dyn WindField) -> Truth {
        let truth = self.turbine.truth(time, interval);
        let scene = Scene { truth: &truth, turbine: &self.turbine, wind };
        self.commands = self.controller.update(&self.sensing.read(&scene));
        truth
    }

    /// Feels the wind of `flow` where the blades are, and moves on by `interval` (s) under the last commands;
    /// its place among the machines is `index`.
    fn advance(&mut self, interval: f64, flow: &impl FlowSolver, index: usize) {
        flow.sample(self.turbine.stations(), &mut self.winds);
        let answer = flow.answer(index);
        self.turbine.advance_answered(interval, &self.winds, answer, &self.commands);
    }

    fn shown_name(&self) -> String {
        if self.name.is_empty() { "a turbine" } else { &self.name }.to_owned()
    }

    /// Whether its controller can go on at `time` (s).
    fn check_controller(&self, time: f64) -> Result<(), FarmError> {
        self.controller.failure().map_or(Ok(()), |message| {
            let (turbine, message) = (self.shown_name(), message.to_owned());
            Err(FarmError::Controller { turbine, time, message })
        })
    }

    /// Whether it is still a machine at `time` (s).
    fn check(&self, time: f64) -> Result<(), FarmError> {
        self.turbine.check().map_err(|breakdown| FarmError::Turbine {
            turbine: self.shown_name(),
            time,
            position: self.turbine.frame().hub,
            breakdown,
        })
    }
}

/// Turbines in one body of air, all on one clock.
pub struct Farm<Flow> {
    machines: Vec<Machine>,
    flow: Flow,
    forces: Vec<PointForce>,
    interval: f64,
    step: u64,
    /// Threads that turbines share; none for a single turbine or a single thread.
    threads: Option<ThreadPool>,
}

impl<Flow: FlowSolver + Sync> Farm<Flow> {
    /// A farm at time zero that moves on in steps of `interval` (s), its turbines on at most `n_threads`
    /// threads; their number changes no bit of the result.
    ///
    /// # Errors
    /// [`ThreadPoolBuildError`] when the system has no more threads to give.
    pub fn new(
        machines: Vec<Machine>,
        flow: Flow,
        interval: f64,
        n_threads: usize,
    ) -> Result<Self, ThreadPoolBuildError> {
        let n_forces = machines.iter().map(|machine| machine.turbine.stations().len()).sum();
        let n_threads = n_threads.min(machines.len());
        let threads = if n_threads > 1 {
            Some(ThreadPoolBuilder::new().num_threads(n_threads).build()?)
        } else {
            None
        };
        Ok(Self {
            machines,
            flow,
            forces: Vec::with_capacity(n_forces),
            interval,
            step: 0,
            threads,
        })
    }

    /// The same farm after `step` steps, as a checkpoint is taken up; its states are restored one by one.
    pub fn at_step(mut self, step: u64) -> Self {
        self.step = step;
        self
    }

    /// Moves everything on by one control interval.
    ///
    /// # Errors
    /// [`FarmError`] when the flow solver or a turbine breaks down, or a controller cannot go on; the step is
    /// then not counted.
    pub fn advance(&mut self, recorder: &mut impl Recorder) -> Result<(), FarmError> {
        let time = self.time();
        self.forces.clear();
        for (index, machine) in self.machines.iter_mut().enumerate() {
            let truth = machine.decide(time, self.interval, &self.flow);
            machine.check_controller(time)?;
            recorder.record(index, &truth, &machine.commands);
        }
        let (flow, interval) = (&self.flow, self.interval);
        let advance = |(index, machine): (usize, &mut Machine)| {
            machine.advance(interval, flow, index);
        };
        match &self.threads {
            Some(threads) => threads.install(|| {
                self.machines.par_iter_mut().enumerate().for_each(advance);
            }),
            None => self.machines.iter_mut().enumerate().for_each(advance),
        }
        let after = (self.step + 1) as f64 * interval;
        for (index, machine) in self.machines.iter().enumerate() {
            machine.check(after)?;
            // Copied as a block, then signed: a turbine does not know its place in the farm.
            let first = self.forces.len();
            self.forces.extend_from_slice(machine.turbine.forces());
            self.forces[first..].iter_mut().for_each(|force| force.turbine = index);
        }
        self.flow.advance(self.interval, &self.forces)?;
        self.step += 1;
        Ok(())
    }

    /// Time since the start of the run (s): steps × interval, never a running sum.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.interval
    }

    /// Steps made (–).
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The air.
    pub fn flow(&self) -> &Flow {
        &self.flow
    }

    /// The air, to be restored from a checkpoint.
    pub fn flow_mut(&mut self) -> &mut Flow {
        &mut self.flow
    }

    /// The turbines and their controllers.
    pub fn machines(&self) -> &[Machine] {
        &self.machines
    }

    /// The turbines and their controllers, to be restored from a checkpoint.
    pub fn machines_mut(&mut self) -> &mut [Machine] {
        &mut self.machines
    }
}
