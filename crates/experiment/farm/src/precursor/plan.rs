//! How a precursor is laid out: cells, steps, planes, and the lattice's settings.

use super::Precursor;
use super::start::Start;
use crate::assemble::SMAGORINSKY_OVER_GROUND;
use crate::domain::Method;
use basis::Vector3;
use flow::Inflow;
use flow::inflow::PlaneGrid;
use flow::lattice::atmosphere::{Atmosphere, Damping, Driving, GRAVITY, Heating, Perturbation};
use flow::lattice::{Ends, Ground, LatticeSettings, Stencil, Subgrid};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Geostrophic wind of a chosen step, in cells a step: gusts and jets blow faster.
const CHOSEN_SPEED: f64 = 0.1;
/// Steps in the shortest period of a buoyancy oscillation, and a little more (–).
const STEPS_OF_A_PERIOD: f64 = 21.0;
/// Greatest rate of damping (per step).
const MOST_DAMPED: f64 = 0.4;
/// Time that is a whole number of chosen steps (s).
const MINUTE: f64 = 60.0;
/// Time between two updates of the control that holds the wind at hub height (s), which acts over hours.
const CONTROL_INTERVAL: f64 = 10.0;
/// Cells that the geostrophic wind crosses between two planes where no interval is given (–).
const CELLS_BETWEEN: f64 = 0.5;
/// Departure of the first temperatures from their profile, at most (K), and up to which height over that of
/// the inversion (–).
const NOISE: f64 = 0.3;
const NOISE_BELOW: f64 = 0.5;

/// Cells, steps and planes of a precursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecursorPlan {
    /// Cells along x, y, z (–).
    pub n_cells: [usize; 3],
    /// Edge of a cell (m).
    pub spacing: f64,
    /// Step (s).
    pub interval: f64,
    /// Steps before the first plane (–).
    pub first_plane: u64,
    /// Steps in all; the last plane stands there (–).
    pub n_steps: u64,
    /// Steps from one plane to the next (–).
    pub plane_stride: u64,
    /// Steps from one record of statistics to the next (–).
    pub statistics_stride: u64,
    /// Steps from one update of the control of the wind at hub height to the next (–).
    pub control_stride: u64,
    /// Points of the planes. Their speed is the geostrophic one, until that of the record is known.
    pub grid: PlaneGrid,
}

impl PrecursorPlan {
    /// Cells in all (–).
    pub fn cells(&self) -> usize {
        self.n_cells.iter().product()
    }

    /// Cell updates in all (–).
    pub fn updates(&self) -> f64 {
        self.cells() as f64 * self.n_steps as f64
    }

    /// Records of statistics, that of the start included (–).
    pub fn n_statistics(&self) -> u64 {
        1 + self.n_steps / self.statistics_stride
    }

    /// Time (s) after `n_steps`.
    pub fn time(&self, n_steps: u64) -> f64 {
        n_steps as f64 * self.interval
    }
}

impl Precursor {
    /// Cells along x, y, z, fractions included (–).
    pub(super) fn cells(&self) -> [f64; 3] {
        self.domain.size.map(|length| length / self.domain.cell)
    }

    /// The step that is taken where none is given (s).
    fn chosen_step(&self) -> f64 {
        let by_wind = CHOSEN_SPEED * self.domain.cell / self.geostrophic_speed();
        let by_damping = MOST_DAMPED / self.air.damping_rate;
        let longest = by_wind.min(by_damping).min(self.shortest_period() / STEPS_OF_A_PERIOD);
        MINUTE / (MINUTE / longest).ceil()
    }

    /// Shortest period of a buoyancy oscillation (s); infinite in neutral air.
    pub(super) fn shortest_period(&self) -> f64 {
        let air = &self.air;
        let steepest = (air.inversion_strength / air.inversion_depth).max(air.lapse_rate);
        TAU / (GRAVITY * steepest / air.temperature).sqrt()
    }

    /// How it is laid out. Only of use where nothing speaks [against](Self::faults) it.
    pub fn plan(&self) -> PrecursorPlan {
        let (cell, time) = (self.domain.cell, &self.time);
        let interval = time.step.unwrap_or_else(|| self.chosen_step());
        let usual = CELLS_BETWEEN * cell / self.geostrophic_speed();
        let steps = |duration: f64| ((duration / interval + 1e-6).floor() as u64).max(1);
        let plane_stride = steps(self.planes.interval.unwrap_or(usual));
        let first_plane = (time.spin_up / interval - 1e-6).ceil() as u64;
        let n_planes = (steps(time.record) / plane_stride).saturating_add(1).max(2);
        let across = |length: f64| ((length / cell + 1e-6).floor() as usize).max(1);
        let n_y = across(self.plane_width());
        let n_cells = self.cells().map(|n| n.round() as usize);
        let grid = PlaneGrid {
            n_y,
            n_z: across(self.plane_height()).min(n_cells[2]),
            spacing: [cell; 2],
            first: [-0.5 * (n_y - 1) as f64 * cell, 0.5 * cell],
            interval: plane_stride as f64 * interval,
            speed: self.geostrophic_speed(),
            n_steps: n_planes as usize,
            repeats: false,
        };
        PrecursorPlan {
            n_cells,
            spacing: cell,
            interval,
            first_plane,
            n_steps: first_plane.saturating_add((n_planes - 1).saturating_mul(plane_stride)),
            plane_stride,
            statistics_stride: steps(time.statistics_interval),
            control_stride: steps(CONTROL_INTERVAL),
            grid,
        }
    }

    /// Settings of the lattice of `plan`; the middle of its ground is the origin.
    pub fn settings(&self, plan: &PrecursorPlan) -> LatticeSettings {
        let [length, width, _] = self.domain.size;
        let origin = Vector3::new(-0.5 * length, -0.5 * width, 0.0);
        let (spacing, air) = (plan.spacing, &self.air);
        let mut settings = LatticeSettings::new(
            origin,
            spacing,
            plan.n_cells,
            plan.interval,
            self.geostrophic_speed(),
        );
        settings.ends = Ends::Periodic;
        settings.ground = Ground::WallStress { roughness_length: air.roughness_length };
        settings.subgrid = Subgrid::smagorinsky(SMAGORINSKY_OVER_GROUND);
        // Its eddies live for hours, in which nineteen directions would let the wind feed them.
        let stencil = Stencil::D3Q27;
        Method { stencil, subgrid: self.domain.subgrid, constant: None }.apply(&mut settings);
        settings.threads = self.domain.threads;
        settings.atmosphere = Some(self.atmosphere());
        settings
    }

    fn atmosphere(&self) -> Atmosphere {
        let air = &self.air;
        let (low, high) = (air.temperature, air.temperature + air.inversion_strength);
        let (foot, top) = (air.inversion_height, self.inversion_top());
        let above = top + self.domain.size[2];
        let heating = match (air.heat_flux, air.cooling_rate) {
            (Some(flux), _) => Heating::Flux(flux),
            (None, Some(rate)) => Heating::Ground { temperature: low, rate: -rate },
            (None, None) => Heating::None,
        };
        let noise = NOISE_BELOW * air.inversion_height;
        Atmosphere {
            coriolis: self.coriolis(),
            driving: Driving::Geostrophic(self.geostrophic()),
            temperature: vec![
                [0.0, low],
                [foot, low],
                [top, high],
                [above, high + air.lapse_rate * (above - top)],
            ],
            heating,
            damping: Some(Damping { from: self.damping_from(), rate: air.damping_rate }),
            perturbation: Some(Perturbation { below: noise, amplitude: NOISE, seed: self.seed }),
            ..Atmosphere::new(low)
        }
    }

    /// The wind at the start.
    pub fn start(&self) -> Arc<dyn Inflow> {
        Arc::new(Start::new(self))
    }
}
