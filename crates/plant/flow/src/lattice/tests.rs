//! The lattice against closed forms and invariants, each test on every back-end that it concerns.

mod atmosphere;
mod boundaries;
mod closed_forms;
mod eddies;
mod engines;
pub(super) mod ground;
mod invariants;
mod open_sides;
mod stencils;
mod warm_inlet;
mod warm_sides;

use super::*;
use crate::Inflow;
use basis::Vector3;
use std::sync::Arc;

/// Wind given by a function of time and position.
pub(super) struct Wind<F>(pub(super) F);

impl<F: Fn(f64, Vector3) -> Vector3 + Send + Sync> Inflow for Wind<F> {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = self.0(time, *position);
        }
    }
}

/// A box on all sides periodic, of cells one metre wide, steps of a second: lattice units are SI units.
pub(super) fn periodic_box(n_cells: [usize; 3], viscosity: f64) -> LatticeSettings {
    let mut settings = LatticeSettings::new(Vector3::splat(-0.5), 1.0, n_cells, 1.0, 0.1);
    settings.air_density = 1.0;
    settings.kinematic_viscosity = viscosity;
    settings.ends = Ends::Periodic;
    settings.sides = Sides::Periodic;
    settings.ground = Ground::Periodic;
    settings.subgrid = Subgrid::smagorinsky(0.0);
    settings.threads = Some(1);
    settings
}

fn lattice(
    settings: LatticeSettings,
    wind: impl Fn(f64, Vector3) -> Vector3 + Send + Sync + 'static,
) -> Lattice {
    Lattice::new(settings, Arc::new(Wind(wind))).expect("sound settings")
}
