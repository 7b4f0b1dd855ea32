//! What one thread owns of the lattice on the processor, and what it does with its rows.

use crate::Inflow;
use crate::lattice::atmosphere::stratification::{HeatShare, Stratification};
use crate::lattice::ends::RowEnds;
use crate::lattice::inlet::Inlet;
use crate::lattice::kernel::Kernel;
use crate::lattice::layout::Layout;
use crate::lattice::probe::{RowState, View};
use crate::lattice::scaling::Scaling;
use crate::lattice::settings::{LatticeSettings, Sides};
use crate::lattice::sides::OpenSides;
use crate::lattice::spreading::Spreader;
use crate::lattice::sweep::Share;
use crate::lattice::wall::WallMemory;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Fastest speed that the lattice carries, in cells per step: at Mach 0.7 the expansion in Mach has broken
/// down.
const FASTEST: f32 = 0.4;
/// Largest departure of the density from one that it carries.
const DENSEST: f32 = 0.5;

/// What one thread owns.
pub(super) struct Worker {
    pub(super) share: Share,
    pub(super) inlet: Inlet,
    pub(super) wall: WallMemory,
    pub(super) heat: Option<HeatShare>,
    /// Forces on the levels that the worker's rows are part of.
    pub(super) spreader: Spreader,
    /// Room for a row.
    pub(super) row: RowState,
    /// First bad cell of the last look and its speed.
    pub(super) found: Option<([usize; 3], f32)>,
}

impl Worker {
    pub(super) fn new(
        thread: usize,
        n_threads: usize,
        settings: &LatticeSettings,
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
        let reference = settings.atmosphere.as_ref().map(|air| air.reference_temperature);
        let wall = || vec![0.0; n_wall_rows * layout.row_stride];
        Self {
            inlet: Inlet::new(layout, &settings.scaling(), rows.clone(), reference),
            wall: WallMemory::new(layout, n_wall_rows),
            spreader: Spreader::new(settings.scaling(), settings.n_cells).on_levels(levels),
            row: RowState::new(layout.n_cells[0]),
            heat: settings.atmosphere.as_ref().map(|_| HeatShare::new(layout, &rows)),
            found: None,
            share: Share {
                ends: RowEnds::new(settings.ends, rows.len()),
                sides: (settings.sides == Sides::Open)
                    .then(|| OpenSides::new(layout, &rows, reference)),
                wall: [wall(), wall()],
                force: std::array::from_fn(|_| vec![0.0; padded]),
                rows,
            },
        }
    }

    /// On return the worker's rows move as `inflow` does at time zero.
    pub(super) fn fill(
        &mut self,
        kernel: &Kernel,
        view: &View<'_>,
        scaling: &Scaling,
        inflow: &dyn Inflow,
        air: Option<&Stratification>,
    ) {
        // Nothing of an earlier run is left.
        self.row.density_excess.fill(0.0);
        if let RowEnds::Open { .. } = self.share.ends {
            self.inlet.start(inflow, scaling);
        }
        if let Some(sides) = &mut self.share.sides {
            sides.start(inflow, scaling);
        }
        self.wall.forget();
        if let Some(heat) = &mut self.heat {
            heat.surface.forget();
        }
        let n = view.layout.n_cells[0];
        let mut positions = vec![Vector3::ZERO; n + 1];
        let mut velocities = vec![Vector3::ZERO; n + 1];
        let mut temperatures = vec![0.0; n + 1];
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
                } else if let RowEnds::Open { outlet: [density, columns @ ..], .. } =
                    &mut self.share.ends
                {
                    density[row - self.share.rows.start] = 0.0;
                    for (column, value) in columns.iter_mut().zip(velocity) {
                        column[row - self.share.rows.start] = value;
                    }
                }
            }
            kernel.write_row(view, row, &self.row);
            if let (Some(air), Some(heat)) = (air, &mut self.heat) {
                let given = inflow.sample_temperature(0.0, &positions, &mut temperatures);
                let sum = &mut heat.sums[row - self.share.rows.start];
                air.fill(row, given.then_some(&temperatures), sum);
            }
        }
    }

    /// On return its rows meet the wind and the temperature of `inflow` at step number `n_steps`, at the
    /// inlet and at open sides; `air` is the atmosphere, if there is one.
    pub(super) fn meet(
        &mut self,
        n_steps: u64,
        inflow: &dyn Inflow,
        scaling: &Scaling,
        air: Option<&Stratification>,
    ) {
        let Self { share, inlet, .. } = self;
        inlet.update(n_steps, inflow, scaling, &mut share.ends);
        if let (Some(air), Some(entering)) = (air, inlet.temperatures(n_steps)) {
            air.enter(n_steps, share.rows.start, entering);
        }
        if let Some(sides) = &mut share.sides {
            sides.update(n_steps, inflow, scaling);
            if let Some(air) = air {
                air.enter_sides(n_steps, sides);
            }
        }
    }

    pub(super) fn look(&mut self, kernel: &Kernel, view: &View<'_>, first: usize, stride: usize) {
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
