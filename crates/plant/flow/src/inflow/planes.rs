//! Planes of wind that arrive one after the other: what a turbulence box is to a turbine that stands in it.

use super::profile::veered;
use super::{InflowError, MeanProfile, TurbulenceBox, positive};
use std::sync::Arc;

/// Where the points of planes are, and how the planes follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneGrid {
    /// Points along y (–).
    pub n_y: usize,
    /// Points along z (–).
    pub n_z: usize,
    /// Distance of neighbouring points along y, z (m).
    pub spacing: [f64; 2],
    /// Place of the first point along y, z (m): the right-most looking downwind, and the lowest.
    pub first: [f64; 2],
    /// Time between planes (s).
    pub interval: f64,
    /// Speed with which planes travel along x (m/s).
    pub speed: f64,
    /// Number of planes (–).
    pub n_steps: usize,
    /// Whether the first plane follows the last.
    pub repeats: bool,
}

impl PlaneGrid {
    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    pub fn check(&self) -> Result<(), InflowError> {
        for n in [self.n_y, self.n_z, self.n_steps] {
            positive("number of points (–)", n as f64)?;
        }
        for spacing in self.spacing {
            positive("spacing (m)", spacing)?;
        }
        positive("time between planes (s)", self.interval)?;
        positive("mean speed at hub height (m/s)", self.speed)
    }

    /// What the grid spans along y (m).
    pub fn across(&self) -> [f64; 2] {
        [self.first[0], self.first[0] + (self.n_y - 1) as f64 * self.spacing[0]]
    }

    /// What the grid spans along z (m).
    pub fn up(&self) -> [f64; 2] {
        [self.first[1], self.first[1] + (self.n_z - 1) as f64 * self.spacing[1]]
    }

    /// Where the first plane stands at time zero around rotors (m along x), as OpenFAST has it: a record that
    /// does not repeat starts half its width upwind of the first turbine.
    pub fn origin_x(&self) -> f64 {
        let [right, left] = self.across();
        if self.repeats { 0.0 } else { 0.5 * (left - right) }
    }

    /// The rows below and above `height` (m), and the share that the upper one has there (–); beyond the rows
    /// the nearest one alone.
    pub fn rows_at(&self, height: f64) -> ([usize; 2], f64) {
        self.between(1, self.n_z, height)
    }

    /// The columns to the right and to the left of `y` (m), and the share that the left one has there (–);
    /// beyond the columns the nearest one alone.
    pub fn columns_at(&self, y: f64) -> ([usize; 2], f64) {
        self.between(0, self.n_y, y)
    }

    /// The two of the `n` points along `axis` (y, z) between which `place` (m) lies, and the share of the
    /// second.
    fn between(&self, axis: usize, n: usize, place: f64) -> ([usize; 2], f64) {
        let last = n - 1;
        let index = ((place - self.first[axis]) / self.spacing[axis]).clamp(0.0, last as f64);
        let before = index.floor() as usize;
        ([before, (before + 1).min(last)], index.fract())
    }

    /// Time (s) from the first plane to the last, or until the first returns.
    pub fn length(&self) -> f64 {
        let n_intervals = if self.repeats { self.n_steps } else { self.n_steps - 1 };
        n_intervals as f64 * self.interval
    }
}

/// Planes of wind in order of arrival, from memory or from a file.
pub trait Planes: Send + Sync {
    /// Where the points are.
    fn grid(&self) -> PlaneGrid;

    /// Writes the wind u, v, w (m/s, the mean included) on plane `step`, from 0 in order of arrival, into
    /// `values`, n_z × n_y, y fastest and from the right to the left, looking downwind.
    ///
    /// # Errors
    /// [`InflowError::Plane`] when it cannot be had.
    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError>;

    /// The same for potential temperature (K) into `values`, n_z × n_y. False, and nothing is written, where
    /// the planes have none.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    fn read_temperature(&mut self, step: usize, values: &mut [f32]) -> Result<bool, InflowError> {
        let _ = (step, values);
        Ok(false)
    }

    /// Whether the planes are of a kind whose right end goes on at the left, and whose top at the bottom.
    fn repeats_across(&self) -> bool {
        false
    }
}

/// Planes of a box of fluctuations on top of a mean speed per row.
#[derive(Clone, Debug)]
pub struct BoxPlanes {
    turbulence: Arc<TurbulenceBox>,
    /// Mean of u and v at each height (m/s), lowest first.
    means: Vec<[f32; 2]>,
    grid: PlaneGrid,
}

impl BoxPlanes {
    /// `turbulence` on top of `profile` and carried along with its hub speed. The middle of the box's width
    /// stands at y = 0, its lowest row at `lowest_height` (m). Plane 0 arrives first, then n_x − 1, n_x − 2,
    /// …: time runs against x.
    ///
    /// # Errors
    /// [`InflowError::Setting`] when the hub speed is not positive.
    pub fn new(
        turbulence: Arc<TurbulenceBox>,
        profile: &MeanProfile,
        lowest_height: f64,
    ) -> Result<Self, InflowError> {
        let speed = profile.hub_speed();
        let [n_steps, n_y, n_z] = turbulence.n_points();
        let [along, across, up] = turbulence.spacing();
        let grid = PlaneGrid {
            n_y,
            n_z,
            spacing: [across, up],
            first: [-0.5 * (n_y - 1) as f64 * across, lowest_height],
            interval: along / speed,
            speed,
            n_steps,
            repeats: true,
        };
        grid.check()?;
        let height = |z: usize| lowest_height + z as f64 * up;
        let means = (0..n_z).map(|z| [profile.speed(height(z)) as f32, 0.0]).collect();
        Ok(Self { turbulence, means, grid })
    }

    /// The same, its mean wind turned by `veer` (rad/m) per metre above `hub_height` (m): clockwise seen from
    /// above, upwards, as [`DeterministicWind::veer`](super::DeterministicWind::veer). The fluctuations are
    /// not turned, and all is carried along x as before.
    pub fn veering(mut self, veer: f64, hub_height: f64) -> Self {
        let PlaneGrid { first, spacing, .. } = self.grid;
        for (z, mean) in self.means.iter_mut().enumerate() {
            let height = first[1] + z as f64 * spacing[1];
            *mean = veered(f64::from(mean[0]), veer, height - hub_height).map(|value| value as f32);
        }
        self
    }
}

impl Planes for BoxPlanes {
    fn grid(&self) -> PlaneGrid {
        self.grid
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        let n_x = self.grid.n_steps;
        let x = (n_x - step % n_x) % n_x;
        let [u, v, w] = [0, 1, 2].map(|component| self.turbulence.plane(component, x));
        for (point, value) in values.iter_mut().enumerate() {
            let [along, across] = self.means[point / self.grid.n_y];
            *value = [along + u[point], across + v[point], w[point]];
        }
        Ok(())
    }
}
