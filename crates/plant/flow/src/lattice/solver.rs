//! The lattice as a solver: built, advanced, checked.

use super::cpu::Cpu;
use super::engine::Engine;
use super::joint::Joint;
use super::probe::RowState;
use super::scaling::Scaling;
use super::settings::{LatticeError, LatticeSettings};
use crate::{FlowError, FlowSolver, Inflow};
use basis::{PointForce, Vector3};
use std::sync::{Arc, Mutex};

/// Steps between two looks at part of the field.
const LOOK_STRIDE: u64 = 32;
/// Looks in which the whole field is seen.
const LOOKS: u64 = 8;

/// A box of air under lattice-Boltzmann large-eddy simulation.
///
/// Populations, and what the boundaries remember, are its [`Engine`]'s. Time is the number of steps times the
/// interval. The same settings, inflow and forces give the same bits on any number of threads.
pub struct Lattice {
    settings: LatticeSettings,
    scaling: Scaling,
    inflow: Arc<dyn Inflow>,
    pub(super) engine: Box<dyn Engine>,
    /// Acceleration of every cell alike, in lattice units.
    pub(super) acceleration: [f32; 3],
    pub(super) forces: Vec<PointForce>,
    /// Rows that planes and volumes are read through.
    pub(super) room: Mutex<[RowState; 2]>,
    /// Height of its lower side above the ground (m).
    pub(super) floor: f64,
}

impl Lattice {
    /// Air that moves as `inflow` does at time zero, at every cell, on this machine's processor.
    ///
    /// # Errors
    /// [`LatticeError`] when the settings break an assumption of the method or ask for more memory than there
    /// is.
    pub fn new(settings: LatticeSettings, inflow: Arc<dyn Inflow>) -> Result<Self, LatticeError> {
        settings.check()?;
        let engine = Box::new(Cpu::new(&settings)?);
        Self::on(engine, settings, inflow)
    }

    /// The same of a box that lies in another as `joint` says.
    ///
    /// # Errors
    /// As above.
    pub(super) fn joined(
        settings: LatticeSettings,
        joint: &Joint,
        inflow: Arc<dyn Inflow>,
    ) -> Result<Self, LatticeError> {
        settings.check()?;
        let engine = Box::new(Cpu::joined(&settings, joint)?);
        Ok(Self { floor: joint.floor, ..Self::on(engine, settings, inflow)? })
    }

    /// The same on `engine`, which was made for `settings`.
    ///
    /// # Errors
    /// [`LatticeError`] when the settings break an assumption of the method.
    pub fn on(
        mut engine: Box<dyn Engine>,
        settings: LatticeSettings,
        inflow: Arc<dyn Inflow>,
    ) -> Result<Self, LatticeError> {
        settings.check()?;
        engine.start(&*inflow);
        let scaling = settings.scaling();
        Ok(Self {
            engine,
            inflow,
            acceleration: scaling
                .to_lattice_acceleration(settings.acceleration)
                .as_vec3()
                .to_array(),
            forces: Vec::new(),
            room: Mutex::new(std::array::from_fn(|_| RowState::new(settings.n_cells[0]))),
            floor: 0.0,
            scaling,
            settings,
        })
    }

    /// What it was built from.
    pub fn settings(&self) -> &LatticeSettings {
        &self.settings
    }

    /// Between SI and lattice units.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// Threads that it runs on (–).
    pub fn n_threads(&self) -> usize {
        self.engine.n_threads()
    }

    /// What of the machine decides the bits of the air, such as `avx512`.
    pub fn backend(&self) -> &'static str {
        self.engine.backend()
    }

    /// Cells along x, y, z (–).
    pub fn n_cells(&self) -> [usize; 3] {
        self.settings.n_cells
    }

    /// Steps made (–).
    pub fn n_steps(&self) -> u64 {
        self.engine.n_steps()
    }

    /// Time since the start (s).
    pub fn time(&self) -> f64 {
        self.n_steps() as f64 * self.scaling.interval()
    }

    /// Memory of the field (bytes).
    pub fn memory(&self) -> u64 {
        self.engine.memory()
    }

    /// The viscosity of eddies at every cell in the step to come (m²/s), x fastest, then y; none where it is
    /// found in the collision.
    pub fn eddy_viscosity(&self) -> Option<Vec<f64>> {
        let unit = self.scaling.to_lattice_viscosity(1.0);
        let rows = (0..self.n_rows()).map(|row| self.engine.eddy_viscosity(row));
        let rows: Option<Vec<&[f32]>> = rows.collect();
        let values = rows?.concat();
        Some(values.into_iter().map(|viscosity| f64::from(viscosity) / unit).collect())
    }

    /// Looks at every cell.
    ///
    /// # Errors
    /// [`FlowError::Diverged`] with the first cell that the lattice cannot carry on from.
    pub fn check(&mut self) -> Result<(), FlowError> {
        self.look(0, 1)
    }

    /// Holds `forces` from now on.
    pub(super) fn hold(&mut self, forces: &[PointForce]) {
        self.forces.clear();
        self.forces.extend_from_slice(forces);
        self.engine.set_forces(&self.forces);
    }

    /// Makes a step.
    pub(super) fn step(&mut self) {
        self.engine.step(&*self.inflow);
    }

    /// Looks at a part of the field every few steps, so that in time all of it is seen.
    pub(super) fn watch(&mut self) -> Result<(), FlowError> {
        let n_steps = self.engine.n_steps();
        if !n_steps.is_multiple_of(LOOK_STRIDE) {
            return Ok(());
        }
        self.look((n_steps / LOOK_STRIDE % LOOKS) as usize, LOOKS as usize)
    }

    /// Rows along x (–).
    pub(super) fn n_rows(&self) -> usize {
        self.settings.n_cells[1] * self.settings.n_cells[2]
    }

    /// Looks at every `stride`-th row from `first`.
    fn look(&mut self, first: usize, stride: usize) -> Result<(), FlowError> {
        match self.engine.look(first, stride) {
            None => Ok(()),
            Some(([x, y, z], speed)) => Err(FlowError::Diverged {
                time: self.time(),
                position: self.scaling.to_si_position(Vector3::new(x as f64, y as f64, z as f64)),
                speed: f64::from(speed) * self.scaling.si_velocity_unit(),
            }),
        }
    }
}

impl FlowSolver for Lattice {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        let n_steps = steps_in(duration, self.scaling.interval())?;
        self.hold(forces);
        for _ in 0..n_steps {
            self.step();
            self.watch()?;
        }
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        true
    }
}

/// Steps of `step` (s) in `duration` (s), which is to be a whole number of them.
pub(super) fn steps_in(duration: f64, step: f64) -> Result<u64, FlowError> {
    let n_steps = (duration / step).round();
    // Written so that a duration that is not a number is refused.
    let whole = n_steps >= 0.0 && (duration / step - n_steps).abs() <= 1e-6 * n_steps.max(1.0);
    if whole { Ok(n_steps as u64) } else { Err(FlowError::FractionalStep { duration, step }) }
}
