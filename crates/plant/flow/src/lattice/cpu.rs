//! The engine that runs on the processor: populations in one array, updated in place by threads that share
//! the rows.

mod eddies;
mod exchange;
mod heat;
mod state;
mod worker;

use super::atmosphere::probe::{self, AirRow};
use super::atmosphere::stratification::Stratification;
use super::collision::SUBGRID_FACTOR;
use super::engine::{Engine, Rows};
use super::forces::ForceBlock;
use super::heat_links::HeatExchange;
use super::joint::Joint;
use super::kernel::Kernel;
use super::layout::{Edge, Layout, Parity};
use super::links::Exchange;
use super::memory::Memory;
use super::probe::{RowState, View};
use super::scaling::Scaling;
use super::settings::{LatticeError, LatticeSettings, Stencil};
use super::sides::OpenSides;
use super::stencil::D3Q19;
use super::stencil27::D3Q27;
use super::subgrid::SubgridModel;
use super::sweep::Step;
use super::wall::Wall;
use crate::Inflow;
use crate::pool::Pool;
use crate::simd::{Backend, MAXIMUM_LANES};
use basis::{PointForce, Vector3};
use eddies::Eddies;
use std::io::{Read, Result, Write};
use std::sync::Mutex;
use worker::{Worker, own};

/// Viscosity at the outlet, in cells² per step.
const SPONGE_VISCOSITY: f64 = 0.05;
/// Pull of the pressure at outlet and open sides to the undisturbed one: 0.25 is what Poinsot and Lele (1992)
/// found to work.
const OUTLET_PULL: f64 = 0.25;

/// Populations in the machine's own memory, moved by its vector instructions.
///
/// The same bits come out on any number of threads.
pub(crate) struct Cpu {
    scaling: Scaling,
    kernel: Kernel,
    stencil: Stencil,
    backend: Backend,
    layout: Layout,
    memory: Memory,
    workers: Vec<Mutex<Worker>>,
    pool: Pool,
    wall: Option<Wall>,
    stratification: Option<Stratification>,
    eddies: Option<Eddies>,
    relaxation_times: Vec<f32>,
    subgrid: Vec<f32>,
    acceleration: [f32; 3],
    outlet_stiffness: f32,
    side_stiffness: f32,
    n_steps: u64,
}

/// The field between two steps, through the loops that know its layout.
struct Reader<'a> {
    kernel: &'a Kernel,
    view: View<'a>,
}

impl Rows for Reader<'_> {
    fn read_row(&self, row: usize, state: &mut RowState) {
        self.kernel.read_row(&self.view, row, state);
    }
}

/// The field after `n_steps` steps.
fn view<'a>(memory: &Memory, layout: &'a Layout, n_steps: u64) -> View<'a> {
    View { air: memory.start(), layout, parity: Parity::of(n_steps) }
}

impl Cpu {
    /// An engine for `settings`, which were checked; its air is at rest until it is started.
    ///
    /// # Errors
    /// [`LatticeError::Memory`] when the system refuses that much.
    pub(crate) fn new(settings: &LatticeSettings) -> std::result::Result<Self, LatticeError> {
        Self::joined(settings, &Joint::none(settings.n_cells[2] as f64 * settings.spacing))
    }

    /// The same for a box that lies in another as `joint` says.
    ///
    /// # Errors
    /// As above.
    pub(crate) fn joined(
        settings: &LatticeSettings,
        joint: &Joint,
    ) -> std::result::Result<Self, LatticeError> {
        let scaling = settings.scaling();
        let backend = settings.backend.unwrap_or_else(Backend::detect);
        let kernel = Kernel::new(settings.stencil, backend);
        let sides = Edge::of_sides(settings.sides);
        let levels = Edge::of_ground(settings.ground);
        let layout = Layout::new(settings.n_cells, kernel.directions, sides, levels);
        let refused =
            LatticeError::Memory { n_cells: settings.cells(), bytes: 4 * layout.n_values() };
        let memory = Memory::zeroed(layout.n_values()).ok_or_else(|| refused.clone())?;
        let stratification = match &settings.atmosphere {
            Some(atmosphere) => Some(
                Stratification::new(atmosphere, settings, joint, &layout, sides, levels)
                    .ok_or_else(|| refused.clone())?,
            ),
            None => None,
        };
        let eddies = Eddies::new(settings, &layout, sides, levels).ok_or(refused)?;
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let n_threads = settings.threads.unwrap_or_else(cores).min(layout.n_rows());
        let wall = Wall::new(settings, &scaling);
        let workers = (0..n_threads)
            .map(|thread| {
                Mutex::new(Worker::new(thread, n_threads, settings, &layout, wall.is_some()))
            })
            .collect();
        let acceleration =
            scaling.to_lattice_acceleration(settings.acceleration).as_vec3().to_array();
        Ok(Self {
            kernel,
            stencil: settings.stencil,
            backend,
            memory,
            workers,
            pool: Pool::new(n_threads),
            wall,
            stratification,
            eddies,
            relaxation_times: relaxation_times(settings, &scaling),
            subgrid: vec![smagorinsky_factor(settings); settings.n_cells[2]],
            acceleration,
            outlet_stiffness: stiffness(settings.n_cells[0]),
            side_stiffness: stiffness(settings.n_cells[1]),
            n_steps: 0,
            layout,
            scaling,
        })
    }

    /// The levels of an atmosphere follow the temperatures of their rows.
    fn follow_temperatures(&mut self) {
        if let Some(air) = &mut self.stratification {
            for worker in &self.workers {
                let Worker { share, heat, .. } = &*own(worker);
                if let Some(heat) = heat {
                    air.gather(share.rows.start, &heat.sums);
                }
            }
            air.follow(0..self.layout.n_cells[2]);
        }
    }

    /// The worker that row number `row` belongs to.
    fn worker_of(&self, row: usize) -> &Mutex<Worker> {
        // Workers' rows start at worker · n_rows / n_workers, rounded down.
        let n_workers = self.workers.len();
        &self.workers[((row + 1) * n_workers - 1) / self.layout.n_rows()]
    }
}

impl Engine for Cpu {
    fn start(&mut self, inflow: &dyn Inflow) {
        self.n_steps = 0;
        if let Some(eddies) = &mut self.eddies {
            eddies.forget(self.stratification.as_mut());
        }
        let view = view(&self.memory, &self.layout, self.n_steps);
        let (workers, kernel, scaling) = (&self.workers, &self.kernel, &self.scaling);
        let heat = self.stratification.as_ref();
        self.pool.run(&|thread| own(&workers[thread]).fill(kernel, &view, scaling, inflow, heat));
        self.follow_temperatures();
    }

    fn set_forces(&mut self, forces: &[PointForce]) {
        let workers = &self.workers;
        self.pool.run(&|thread| {
            own(&workers[thread]).spreader.spread(forces);
        });
    }

    fn drive(&mut self, wind: [f32; 2]) -> bool {
        self.stratification.as_mut().map(|air| air.drive(wind)).is_some()
    }

    fn step(&mut self, inflow: &dyn Inflow) {
        let view = view(&self.memory, &self.layout, self.n_steps);
        let (workers, kernel, scaling) = (&self.workers, &self.kernel, &self.scaling);
        let n_steps = self.n_steps;
        let air = self.stratification.as_ref();
        if let Some(wall) = &self.wall {
            let rows = Reader { kernel, view };
            let surface = air.and_then(|air| Some((air, air.surface.as_ref()?)));
            self.pool.run(&|thread| {
                let Worker { share, wall: memory, heat, row, .. } = &mut *own(&workers[thread]);
                match (surface, heat) {
                    (Some((air, surface)), Some(heat)) => {
                        surface.update(n_steps, &rows, air, row, share, heat);
                    }
                    _ => wall.update(&rows, &self.layout, memory, share),
                }
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
            side_stiffness: self.side_stiffness,
        };
        let stratified = air.map(|air| air.air(n_steps));
        let eddies = self.eddies.as_ref();
        let noted = eddies.and_then(Eddies::noted);
        self.pool.run(&|thread| {
            let worker = &mut *own(&workers[thread]);
            worker.meet(n_steps, inflow, scaling, air);
            let Worker { share, spreader, .. } = worker;
            match (&stratified, &noted) {
                (Some(air), _) => kernel.sweep_stratified(&step, air, spreader.blocks(), share),
                (None, Some(air)) => kernel.sweep_noted(&step, air, spreader.blocks(), share),
                (None, None) => kernel.sweep(&step, spreader.blocks(), share),
            }
        });
        if let Some(mixing) = eddies.map(|eddies| eddies.mixing(air, n_steps)) {
            self.pool.run(&|thread| kernel.mix(&mixing, own(&workers[thread]).share.rows.clone()));
        }
        if let Some(air) = air {
            let transport = air.transport(n_steps);
            self.pool.run(&|thread| {
                let Worker { share, heat, .. } = &mut *own(&workers[thread]);
                if let Some(heat) = heat {
                    kernel.carry(&transport, share.rows.clone(), heat);
                }
            });
        }
        self.n_steps += 1;
        self.follow_temperatures();
    }

    fn n_steps(&self) -> u64 {
        self.n_steps
    }

    fn read_row(&self, row: usize, state: &mut RowState) {
        self.kernel.read_row(&view(&self.memory, &self.layout, self.n_steps), row, state);
    }

    fn read_air(&self, row: usize, state: &mut AirRow) -> bool {
        let Some(air) = &self.stratification else { return false };
        let view = view(&self.memory, &self.layout, self.n_steps);
        let law = (self.relaxation_times.as_slice(), self.subgrid[row / self.layout.n_cells[1]]);
        let n_steps = self.n_steps;
        match self.stencil {
            Stencil::D3Q19 => probe::read_row::<D3Q19, 19>(&view, air, law, n_steps, row, state),
            Stencil::D3Q27 => probe::read_row::<D3Q27, 27>(&view, air, law, n_steps, row, state),
        }
        true
    }

    fn temperature(&self, row: usize) -> Option<&[f32]> {
        self.stratification.as_ref().map(|air| air.temperature(self.n_steps, row))
    }

    fn eddy_viscosity(&self, row: usize) -> Option<&[f32]> {
        let mixing = self.eddies.as_ref()?.mixing(self.stratification.as_ref(), self.n_steps);
        Some(mixing.viscosity(row))
    }

    fn read_cells(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4] {
        self.kernel.read_cells(&view(&self.memory, &self.layout, self.n_steps), cells)
    }

    fn see_forces(&self, row: usize, see: &mut dyn FnMut(&[ForceBlock])) {
        see(own(self.worker_of(row)).spreader.blocks());
    }

    fn look(&mut self, first: usize, stride: usize) -> Option<([usize; 3], f32)> {
        let view = view(&self.memory, &self.layout, self.n_steps);
        let (workers, kernel) = (&self.workers, &self.kernel);
        self.pool.run(&|thread| own(&workers[thread]).look(kernel, &view, first, stride));
        self.workers.iter().find_map(|worker| own(worker).found)
    }

    fn exchange(&mut self) -> Option<&mut dyn Exchange> {
        Some(self)
    }

    fn heat(&mut self) -> Option<&mut dyn HeatExchange> {
        self.stratification.is_some().then_some(self as &mut dyn HeatExchange)
    }

    fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        self.write(writer)
    }

    fn read_state(&mut self, n_steps: u64, reader: &mut dyn Read) -> Result<()> {
        self.read(n_steps, reader)
    }

    fn backend(&self) -> &'static str {
        self.backend.name()
    }

    fn n_threads(&self) -> usize {
        self.pool.n_threads()
    }

    fn memory(&self) -> u64 {
        let wall: usize = match self.wall {
            Some(_) => 4 * self.layout.row_stride * self.layout.n_cells[1] * size_of::<f32>(),
            None => 0,
        };
        // Each row has its place at the inlet: two vectors in double and ten single values; its temperature
        // in double and twice in single.
        let warm = match self.stratification {
            Some(_) => size_of::<f64>() + 2 * size_of::<f32>(),
            None => 0,
        };
        let ends = self.layout.n_rows() * (2 * size_of::<Vector3>() + 13 * size_of::<f32>() + warm);
        let sides = self
            .workers
            .iter()
            .map(|worker| own(worker).share.sides.as_ref().map_or(0, OpenSides::bytes));
        let ends = ends + sides.sum::<usize>();
        let heat = self.stratification.as_ref().map_or(0, Stratification::bytes);
        let noted = self.eddies.as_ref().map_or(0, Eddies::bytes);
        (self.memory.bytes() + wall + ends + heat + noted) as u64
    }
}

/// Smagorinsky's factor in the closed form for the relaxation time; zero under another model.
fn smagorinsky_factor(settings: &LatticeSettings) -> f32 {
    match settings.subgrid.model {
        SubgridModel::Smagorinsky => (SUBGRID_FACTOR * settings.subgrid.constant.powi(2)) as f32,
        _ => 0.0,
    }
}

/// Rate at which the pressure at a boundary is pulled to that of undisturbed air, `n_cells` cells from the
/// boundary across (per step).
fn stiffness(n_cells: usize) -> f32 {
    (2.0 * OUTLET_PULL / (3.0_f64.sqrt() * n_cells as f64)) as f32
}

/// 1/2 + 3 ν along x, with the sponge before the outlet; padded to whole vectors.
fn relaxation_times(settings: &LatticeSettings, scaling: &Scaling) -> Vec<f32> {
    let n = settings.n_cells[0];
    let viscosity = scaling.to_lattice_viscosity(settings.kinematic_viscosity);
    let length = settings.sponge_cells();
    (0..n.next_multiple_of(MAXIMUM_LANES))
        .map(|x| {
            let depth = (x + length + 1).saturating_sub(n).min(length);
            let share = if length > 0 { depth as f64 / length as f64 } else { 0.0 };
            (0.5 + 3.0 * (viscosity + SPONGE_VISCOSITY * share * share)) as f32
        })
        .collect()
}
