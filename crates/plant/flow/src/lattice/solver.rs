//! The lattice as a solver: built, advanced, checked.

use super::collision::SUBGRID_FACTOR;
use super::ends::RowEnds;
use super::inlet::Inlet;
use super::kernel::Kernel;
use super::layout::{Edge, Layout, Parity};
use super::memory::Memory;
use super::pool::Pool;
use super::probe::{RowState, View};
use super::scaling::Scaling;
use super::settings::{Ends, Ground, Settings, SettingsError, Sides};
use super::simd::{Backend, MAXIMUM_LANES};
use super::spreading::Spreader;
use super::sweep::{Share, Step};
use super::wall::{Wall, WallMemory};
use crate::{FlowError, FlowSolver, Inflow};
use basis::{PointForce, Vector3};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Steps between two looks at part of the field.
const LOOK_STRIDE: u64 = 32;
/// Looks in which the whole field is seen.
const LOOKS: u64 = 8;
/// Fastest speed that the lattice carries, in cells per step: at Mach 0.7 the expansion in Mach has broken down.
const FASTEST: f32 = 0.4;
/// Largest departure of the density from one that it carries.
const DENSEST: f32 = 0.5;
/// Longest zone of raised viscosity before the outlet, in cells.
const LONGEST_SPONGE: usize = 24;
/// Share of the box's length that it may take, as a divisor.
const SPONGE_DIVISOR: usize = 10;
/// Viscosity at the outlet, in cells² per step.
const SPONGE_VISCOSITY: f64 = 0.05;
/// Pull of the outlet's pressure to the undisturbed one: 0.25 is what Poinsot and Lele (1992) found to work.
const OUTLET_PULL: f64 = 0.25;

/// A box of air under lattice-Boltzmann large-eddy simulation.
///
/// The state is one array of populations, updated in place, plus what the boundaries remember. Time is the number
/// of steps times the interval. The same settings, inflow and forces give the same bits on any number of threads.
pub struct Lattice {
    settings: Settings,
    scaling: Scaling,
    backend: Backend,
    inflow: Arc<dyn Inflow>,
    pub(super) kernel: Kernel,
    pub(super) layout: Layout,
    pub(super) memory: Memory,
    pub(super) workers: Vec<Mutex<Worker>>,
    pool: Pool,
    wall: Option<Wall>,
    relaxation_times: Vec<f32>,
    subgrid: Vec<f32>,
    pub(super) acceleration: [f32; 3],
    outlet_stiffness: f32,
    pub(super) forces: Vec<PointForce>,
    pub(super) n_steps: u64,
}

/// What one thread owns.
pub(super) struct Worker {
    pub(super) share: Share,
    pub(super) inlet: Inlet,
    pub(super) wall: WallMemory,
    /// Forces on the levels that the worker's rows are part of.
    pub(super) spreader: Spreader,
    /// Room for a row.
    row: RowState,
    /// First bad cell of the last look and its speed.
    found: Option<([usize; 3], f32)>,
}

impl Lattice {
    /// Air that moves as `inflow` does at time zero, at every cell.
    ///
    /// # Errors
    /// [`SettingsError`] when the settings break an assumption of the method or ask for more memory than there is.
    pub fn new(settings: Settings, inflow: Arc<dyn Inflow>) -> Result<Self, SettingsError> {
        settings.check()?;
        let scaling = settings.scaling();
        let backend = settings.backend.unwrap_or_else(Backend::detect);
        let kernel = Kernel::new(settings.stencil, backend);
        let sides = match settings.sides {
            Sides::Periodic => Edge::Periodic,
            Sides::Slip => Edge::Slip,
        };
        let levels = match settings.ground {
            Ground::Periodic => Edge::Periodic,
            Ground::Slip | Ground::WallStress { .. } => Edge::Slip,
        };
        let layout = Layout::new(settings.n_cells, kernel.directions, sides, levels);
        let refused =
            SettingsError::Memory { n_cells: settings.cells(), bytes: 4 * layout.n_values() };
        let memory = Memory::zeroed(layout.n_values()).ok_or(refused)?;
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let n_threads = settings.threads.unwrap_or_else(cores).min(layout.n_rows());
        let wall = Wall::new(&settings, &scaling);
        let workers = (0..n_threads)
            .map(|thread| {
                Mutex::new(Worker::new(thread, n_threads, &settings, &layout, wall.is_some()))
            })
            .collect();
        let acceleration =
            scaling.to_lattice_acceleration(settings.acceleration).as_vec3().to_array();
        let subgrid = (SUBGRID_FACTOR * settings.smagorinsky.powi(2)) as f32;
        let mut lattice = Self {
            kernel,
            memory,
            workers,
            pool: Pool::new(n_threads),
            wall,
            relaxation_times: relaxation_times(&settings, &scaling),
            subgrid: vec![subgrid; settings.n_cells[2]],
            acceleration,
            outlet_stiffness: (2.0 * OUTLET_PULL / (3.0_f64.sqrt() * settings.n_cells[0] as f64))
                as f32,
            forces: Vec::new(),
            n_steps: 0,
            layout,
            settings,
            scaling,
            backend,
            inflow,
        };
        lattice.start();
        Ok(lattice)
    }

    /// What it was built from.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Between SI and lattice units.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// Instruction set that it runs on.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// Threads that it runs on (–).
    pub fn n_threads(&self) -> usize {
        self.pool.n_threads()
    }

    /// Cells along x, y, z (–).
    pub fn n_cells(&self) -> [usize; 3] {
        self.layout.n_cells
    }

    /// Steps made (–).
    pub fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Time since the start (s).
    pub fn time(&self) -> f64 {
        self.n_steps as f64 * self.scaling.interval()
    }

    /// Memory of the field (bytes).
    pub fn memory(&self) -> u64 {
        let wall: usize = match self.wall {
            Some(_) => 4 * self.layout.row_stride * self.layout.n_cells[1] * size_of::<f32>(),
            None => 0,
        };
        // Each row has its place at the inlet: two vectors in double and ten single values.
        let ends = self.layout.n_rows() * (2 * size_of::<Vector3>() + 13 * size_of::<f32>());
        (self.memory.bytes() + wall + ends) as u64
    }

    /// Looks at every cell.
    ///
    /// # Errors
    /// [`FlowError::Diverged`] with the first cell that the lattice cannot carry on from.
    pub fn check(&mut self) -> Result<(), FlowError> {
        self.look(0, 1)
    }

    pub(super) fn view(&self) -> View<'_> {
        View { air: self.memory.start(), layout: &self.layout, parity: Parity::of(self.n_steps) }
    }

    fn start(&mut self) {
        let view = View { air: self.memory.start(), layout: &self.layout, parity: Parity::Even };
        let (workers, kernel, scaling) = (&self.workers, &self.kernel, &self.scaling);
        let inflow = &*self.inflow;
        self.pool.run(&|thread| own(&workers[thread]).fill(kernel, &view, scaling, inflow));
    }

    fn step(&mut self) {
        let view = View {
            air: self.memory.start(),
            layout: &self.layout,
            parity: Parity::of(self.n_steps),
        };
        let (workers, kernel, scaling) = (&self.workers, &self.kernel, &self.scaling);
        if let Some(wall) = &self.wall {
            self.pool.run(&|thread| {
                let Worker { share, wall: memory, .. } = &mut *own(&workers[thread]);
                wall.update(kernel, &view, memory, share);
            });
        }
        let step = Step {
            air: self.memory.start(),
            layout: &self.layout,
            parity: view.parity,
            relaxation_times: &self.relaxation_times,
            subgrid: &self.subgrid,
            acceleration: self.acceleration,
            outlet_stiffness: self.outlet_stiffness,
        };
        let (inflow, n_steps) = (&*self.inflow, self.n_steps);
        self.pool.run(&|thread| {
            let Worker { share, inlet, spreader, .. } = &mut *own(&workers[thread]);
            inlet.update(n_steps, inflow, scaling, &mut share.ends);
            kernel.sweep(&step, spreader.blocks(), share);
        });
        self.n_steps += 1;
    }

    /// On return every worker holds its part of the forces.
    pub(super) fn spread(&mut self) {
        let (workers, forces) = (&self.workers, &self.forces);
        self.pool.run(&|thread| {
            own(&workers[thread]).spreader.spread(forces);
        });
    }

    /// Looks at every `stride`-th row from `first`.
    fn look(&mut self, first: usize, stride: usize) -> Result<(), FlowError> {
        let view = View {
            air: self.memory.start(),
            layout: &self.layout,
            parity: Parity::of(self.n_steps),
        };
        let (workers, kernel) = (&self.workers, &self.kernel);
        self.pool.run(&|thread| own(&workers[thread]).look(kernel, &view, first, stride));
        match self.workers.iter().find_map(|worker| own(worker).found) {
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
        let step = self.scaling.interval();
        let n_steps = (duration / step).round();
        // Written so that a duration that is not a number is refused.
        let whole = n_steps >= 0.0 && (duration / step - n_steps).abs() <= 1e-6 * n_steps.max(1.0);
        if !whole {
            return Err(FlowError::FractionalStep { duration, step });
        }
        self.forces.clear();
        self.forces.extend_from_slice(forces);
        self.spread();
        for _ in 0..n_steps as u64 {
            self.step();
            if self.n_steps.is_multiple_of(LOOK_STRIDE) {
                self.look((self.n_steps / LOOK_STRIDE % LOOKS) as usize, LOOKS as usize)?;
            }
        }
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        true
    }
}

impl Worker {
    fn new(
        thread: usize,
        n_threads: usize,
        settings: &Settings,
        layout: &Layout,
        has_wall: bool,
    ) -> Self {
        let n_rows = layout.n_rows();
        let rows = thread * n_rows / n_threads..(thread + 1) * n_rows / n_threads;
        let levels = rows.start / layout.n_cells[1]..rows.end.div_ceil(layout.n_cells[1]);
        let n_wall_rows = match has_wall {
            true => rows.end.min(layout.n_cells[1]) - rows.start.min(layout.n_cells[1]),
            false => 0,
        };
        let padded = layout.n_cells[0].next_multiple_of(MAXIMUM_LANES);
        let wall = || vec![0.0; n_wall_rows * layout.row_stride];
        Self {
            inlet: Inlet::new(layout, &settings.scaling(), rows.clone()),
            wall: WallMemory::new(layout, n_wall_rows),
            spreader: Spreader::new(settings.scaling(), settings.n_cells).on_levels(levels),
            row: RowState::new(layout.n_cells[0]),
            found: None,
            share: Share {
                ends: RowEnds::new(settings.ends, rows.len()),
                wall: [wall(), wall()],
                force: std::array::from_fn(|_| vec![0.0; padded]),
                rows,
            },
        }
    }

    /// On return the worker's rows move as `inflow` does at time zero.
    fn fill(&mut self, kernel: &Kernel, view: &View<'_>, scaling: &Scaling, inflow: &dyn Inflow) {
        let n = view.layout.n_cells[0];
        let mut positions = vec![Vector3::ZERO; n + 1];
        let mut velocities = vec![Vector3::ZERO; n + 1];
        for row in self.share.rows.clone() {
            let [y, z] = view.layout.place(row);
            for (x, position) in positions.iter_mut().enumerate() {
                *position = scaling.to_si_position(Vector3::new(x as f64, y as f64, z as f64));
            }
            inflow.sample(0.0, &positions, &mut velocities);
            for (x, velocity) in velocities.iter().enumerate() {
                let velocity = scaling.to_lattice_velocity(*velocity).as_vec3().to_array();
                if x < n {
                    for (column, value) in self.row.velocity.iter_mut().zip(velocity) {
                        column[x] = value;
                    }
                } else if let RowEnds::Open { outlet: [_, columns @ ..], .. } = &mut self.share.ends
                {
                    for (column, value) in columns.iter_mut().zip(velocity) {
                        column[row - self.share.rows.start] = value;
                    }
                }
            }
            kernel.write_row(view, row, &self.row);
        }
    }

    fn look(&mut self, kernel: &Kernel, view: &View<'_>, first: usize, stride: usize) {
        self.found = None;
        for row in self.share.rows.clone().filter(|row| row % stride == first) {
            kernel.read_row(view, row, &mut self.row);
            let [u, v, w] = &self.row.velocity;
            for x in 0..view.layout.n_cells[0] {
                let squared = u[x] * u[x] + v[x] * v[x] + w[x] * w[x];
                // Written so that a value that is not a number is found, too.
                let good =
                    squared <= FASTEST * FASTEST && self.row.density_excess[x].abs() <= DENSEST;
                if !good {
                    let [y, z] = view.layout.place(row);
                    self.found = Some(([x, y, z], squared.sqrt()));
                    return;
                }
            }
        }
    }
}

/// A worker is locked by its own thread during a job, and by the caller between jobs.
pub(super) fn own(worker: &Mutex<Worker>) -> MutexGuard<'_, Worker> {
    worker.lock().unwrap_or_else(PoisonError::into_inner)
}

/// 1/2 + 3 ν along x, with the sponge before the outlet; padded to whole vectors.
fn relaxation_times(settings: &Settings, scaling: &Scaling) -> Vec<f32> {
    let n = settings.n_cells[0];
    let viscosity = scaling.to_lattice_viscosity(settings.kinematic_viscosity);
    let length = match settings.ends {
        Ends::InletOutlet => (n / SPONGE_DIVISOR).min(LONGEST_SPONGE),
        Ends::Periodic => 0,
    };
    (0..n.next_multiple_of(MAXIMUM_LANES))
        .map(|x| {
            let depth = (x + length + 1).saturating_sub(n).min(length);
            let share = if length > 0 { depth as f64 / length as f64 } else { 0.0 };
            (0.5 + 3.0 * (viscosity + SPONGE_VISCOSITY * share * share)) as f32
        })
        .collect()
}
